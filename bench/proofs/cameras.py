#!/usr/bin/env python3
"""Random missions with a camera that turns, computed and proved by the program: which are proved, and how long it takes.

    python3 bench/proofs/cameras.py --data ../shared/data --missions 200 --seed 1 [--only 17] [--keep FOLDER]

One line for each mission that is not proved, then a table. The exit code is 1 where a volume is wrong.
"""
import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

CITIES = {
    "charlotte": "charlotte/uptownCharlotte.obj",
    "munich": "mesh/munich_merged.ply",
    "florence": "mesh/florence_merged.ply",
    "etoile": "mesh/etoile_merged.ply",
    "canyon": "mesh/simple_street_canyon_merged.ply",
    "manhattan": "osm/empire-state-600m.osm.pbf",
    "helsinki": "osm/helsinki.osm.pbf",
}


def run(program, *arguments):
    return subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False)


def city_scenes(program, data, folder):
    """Each city as a PLY, and the middle half of its box."""
    scenes = {}
    for name, file in CITIES.items():
        scene = folder / f"{name}.ply"
        made = run(program, "scene", data / file, "-o", scene)
        if made.returncode != 0:
            sys.exit(made.stderr)
        bounds = json.loads(run(program, "inspect", scene, "--json").stdout)["bounds"]
        scenes[name] = (scene, bounds["min"], bounds["max"])
    return scenes


def draw_target(draw, low, high):
    """Convex, in any plane; lying, upright and slanted ones."""
    place = [draw.uniform(0.75 * a + 0.25 * b, 0.25 * a + 0.75 * b) for a, b in zip(low[:2], high[:2])]
    radius = 10 ** draw.uniform(-0.3, 1.2)
    tilt = draw.choice([0, 0, 90, 90, draw.uniform(0, 180)]) * math.pi / 180
    heading = draw.uniform(0, 2 * math.pi)
    normal = (math.sin(tilt) * math.cos(heading), math.sin(tilt) * math.sin(heading), math.cos(tilt))
    across = (-math.sin(heading), math.cos(heading), 0)
    along = (normal[1] * across[2] - normal[2] * across[1], normal[2] * across[0] - normal[0] * across[2],
             normal[0] * across[1] - normal[1] * across[0])
    height = low[2] + (draw.uniform(0.1, 2) if tilt == 0 else radius * math.sin(tilt) + draw.uniform(0.5, 20))
    stretch = draw.choice([1, 1, draw.uniform(0.05, 1)])
    angles = sorted(draw.uniform(0, 2 * math.pi) for _ in range(draw.randint(3, 8)))
    vertices = []
    for angle in angles:
        u, v = radius * math.cos(angle), stretch * radius * math.sin(angle)
        vertices.append([place[0] + u * across[0] + v * along[0], place[1] + u * across[1] + v * along[1],
                         height + u * across[2] + v * along[2]])
    return vertices, [round(n, 6) for n in normal], radius


def draw_mission(draw, scene, low, high):
    vertices, front, radius = draw_target(draw, low, high)
    width = draw.choice([draw.uniform(20, 90), draw.uniform(5, 150)])
    height = draw.choice([0.75 * width, draw.uniform(5, 120)])
    need = radius / math.tan(min(width, height) * math.pi / 360)
    sensor = {"max_range": round(need * draw.uniform(1.2, 6) + radius, 3), "fov": [round(width, 3), round(height, 3)]}
    pitch = draw.choice([[-90, 0], [-90, 30], [-90, 90], sorted(draw.uniform(-90, 90) for _ in range(2))])
    sensor["gimbal"] = {"pitch": [round(p, 3) for p in pitch]}
    if draw.random() < 0.15:
        sensor["gimbal"]["yaw"] = round(draw.uniform(0, 360), 3)
    if draw.random() < 0.25:
        sensor["gimbal"]["roll"] = round(draw.uniform(-180, 180), 3)
    if draw.random() < 0.15:
        sensor["incidence"] = round(draw.uniform(40, 85), 3)
    if draw.random() < 0.15:
        sensor["min_range"] = round(0.3 * sensor["max_range"] * draw.random() + 0.1, 3)
    mission = {"scene": {"mesh": str(scene)}, "target": {"vertices": vertices, "front": front}, "sensor": sensor}
    if draw.random() < 0.2:
        mission["navigation"] = {"altitude": [round(low[2] + draw.uniform(0, 20), 3), round(low[2] + draw.uniform(30, 120), 3)]}
    return mission


def judge(program, mission, folder):
    """What becomes of a mission, or nothing where there is no volume to prove."""
    file, volume = folder / "mission.yaml", folder / "volume.ply"
    file.write_text(json.dumps(mission))
    for old in (volume, volume.with_suffix(".report.json")):
        old.unlink(missing_ok=True)
    made = run(program, "compute", file, "-q", "-o", volume)
    if not volume.exists():
        return None
    report = json.loads(volume.with_suffix(".report.json").read_text())
    proved = run(program, "prove", file, volume, "--json", "-q")
    if not proved.stdout:
        sys.exit(proved.stderr)
    proof = json.loads(proved.stdout)
    engine = report["seconds"]["engine"] + report["seconds"]["navigation"]
    return {"verdict": proof["verdict"], "engine_s": engine, "proof_s": proof["seconds"], "facets": proof["facets"],
            "open": [f"{c['name']}: {c['text']}" for c in proof["claims"] if c["verdict"] != "proved"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default="build/bin/vantage")
    parser.add_argument("--data", type=pathlib.Path, default="../shared/data")
    parser.add_argument("--missions", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="the mission of this number alone")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the missions that are not proved")
    options = parser.parse_args()
    results, names = [], list(CITIES)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        scenes = city_scenes(options.program, options.data, folder)
        number = options.only or 0
        while len(results) < (options.missions if options.only is None else 1):
            draw = random.Random(f"{options.seed} {number}")
            name = names[number % len(names)]
            mission = draw_mission(draw, *scenes[name])
            result = judge(options.program, mission, folder)
            if result:
                results.append(dict(result, number=number, city=name))
                if result["verdict"] != "proved":
                    print(number, name, result["verdict"], *result["open"], sep="; ", flush=True)
                    if options.keep:
                        kept = options.keep / f"{number}"
                        kept.mkdir(parents=True, exist_ok=True)
                        (kept / "mission.yaml").write_text((folder / "mission.yaml").read_text())
                        (kept / "volume.ply").write_bytes((folder / "volume.ply").read_bytes())
            elif options.only is not None:
                sys.exit("there is no volume")
            number += 1
    print("| city | missions | proved | engine, s | proof, s | median of proof / engine | most |")
    print("|---|---|---|---|---|---|---|")
    for name in [*names, "all"]:
        of = [r for r in results if name in (r["city"], "all")]
        if not of:
            continue
        ratios = [r["proof_s"] / r["engine_s"] for r in of]
        print(f"| {name} | {len(of)} | {sum(r['verdict'] == 'proved' for r in of)} "
              f"| {sum(r['engine_s'] for r in of):.1f} | {sum(r['proof_s'] for r in of):.1f} "
              f"| {statistics.median(ratios):.1f} | {max(ratios):.1f} |")
    sys.exit(any(r["verdict"] == "wrong" for r in results))


if __name__ == "__main__":
    main()
