#!/usr/bin/env python3
"""Hashes of all that the program writes, to show that a change of the code changes no result.

    tools/result_hashes.py PROGRAM -o before.json
    tools/result_hashes.py PROGRAM -o after.json --against before.json [--only plaza] [--keep FOLDER] [--jobs 2]

For each mission of docs/ and examples/, and for each limit on the two scenes of examples/: the volume in every format, its
report, answers to 400 points, the judgement of a flight, the proof with its certificate, what verify finds, the volume
simplified, standpoints, orbits, the tour in every format of a plan, the picture and the page. For each file of
../shared/data that is a scene: what inspect says, and the scene that is written. Each output is a SHA-256; of JSON
without seconds, versions and paths. With --against every output that differs is named, and the exit code is 1 if there is
one. --keep leaves the outputs in a folder, to compare two of them. Cases whose files are not on this machine are left
out, and counted.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
DATA = ROOT.parent / "shared" / "data"
TIMES = {"seconds", "render_seconds", "boolean_seconds", "device", "version"}

PLAZA = "scene: {{mesh: %s/examples/plaza/plaza.obj, up: z}}\n" % ROOT
SQUARE = "target: {{vertices: [[-12, -9, 0], [8, -11, 0], [11, 0, 0], [4, 10, 0], [-13, 8, 0]]}}\n"
TOWN = "scene: {{osm: %s/examples/town/town.osm, center: [48.0, 11.0], radius: 120, sea_level: -450}}\n" % ROOT
MARKET = "target: {{osm: way/1}}\n"
LIMITS = "sensor: {{max_range: 70{sensor}}}\nnavigation: {{altitude: [3, 50]{navigation}}}\n"
CAMERA = ", fov: [60, 40], camera: {width: 4000, height: 3000}"
# What is added to the sensor and to the navigation of both scenes.
ROWS = {
    "plain": ("", ""),
    "min range": (", min_range: 20", ""),
    "incidence": (", incidence: 60", ""),
    "turning camera": (", fov: [60, 40], gimbal: {pitch: [-90, 10]}", ""),
    "fixed camera": (", fov: [90, 80], mount: {yaw: 40, pitch: -60, roll: 5}", ""),
    "camera of any yaw": (", fov: [70, 60], mount: {yaw: any, pitch: -50}", ""),
    "worst pixel": (CAMERA + ", pixel: {size: 0.02}", ""),
    "perpendicular pixel": (CAMERA + ", pixel: {size: 0.02, kind: perpendicular}", ""),
    "sun": (", sun: {azimuth: 200, elevation: 30, exclude: 40}", ""),
    "visible": (", visible: 0.7, cells: 8", ""),
    "clearance": ("", ", clearance: 4"),
    "keep out": ("", ", keep_out: [{min: [18, -10, 0], max: [35, 7, 43]}, {polygon: [[-30, 5], [-5, 12], [-25, 40]], z: [10, 30]}]"),
    "keep in": ("", ", keep_in: [{polygon: [[-60, -60], [60, -60], [60, 60], [0, 5], [-60, 60]], heights: any}, "
                    "{polygon: [[-20, 10], [20, 10], [20, 50], [-20, 50]], holes: [[[-5, 20], [5, 20], [0, 30]]], z: [0, 45]}]"),
}
GROUND_ROWS = {
    "above ground": ("", "", "{agl: [5, 40]}"),
    "zone above ground": ("", ", keep_out: [{polygon: [[-40, -5], [30, 5], [20, 40]], agl: [0, 20]}]", "{agl: [3, 50]}"),
}
TOUR = ("targets: [{name: a, osm: Market Square}, {name: b, osm: Town Hall, part: facade, nearest: [-2, 36, 8]}]\n"
        "sensor: {max_range: 50}\nnavigation: {altitude: {agl: [5, 60]}}\n")


def texts() -> dict[str, str]:
    """The missions that are made here."""
    made = {}
    for place, head in (("plaza", PLAZA + SQUARE), ("town", TOWN + MARKET)):
        for name, (sensor, navigation) in ROWS.items():
            made[f"{place}, {name}"] = head.format() + LIMITS.format(sensor=sensor, navigation=navigation)
    for name, (sensor, navigation, altitude) in GROUND_ROWS.items():
        limits = LIMITS.replace("[3, 50]", altitude.replace("{", "{{").replace("}", "}}"))
        made[f"town, {name}"] = (TOWN + MARKET).format() + limits.format(sensor=sensor, navigation=navigation)
    made["plaza, link"] = (PLAZA.format() + "target: {point: [0, 0, 2]}\n"
                           "sensor: {max_range: 70, link: {frequency: 2.4}}\nnavigation: {altitude: [3, 50]}\n")
    made["plaza, pilot"] = (PLAZA.format() + "target: {point: [0, 0, 0]}\nsensor: {vlos: {aircraft_size: 0.35, "
                            "kind: multirotor, visibility: 5000, eye_height: 1.7}}\nnavigation: {altitude: [3, 50]}\n")
    made["plaza, both sides"] = (PLAZA.format() + "target: {vertices: [[-4, 0, 2], [4, 0, 2], [4, 0, 6], [-4, 0, 6]], "
                                 "sides: both}\nsensor: {max_range: 50}\n")
    made["plaza, spheres"] = (PLAZA + SQUARE).format() + "sensor: {max_range: 70}\nmethod: spheres\nspheres: {device: cpu, cubemap: 40, max_splits: 1}\n"
    for combine in ("all", "any", "each"):
        made[f"town, {combine}"] = TOWN.format() + f"combine: {combine}\n" + TOUR
    for vehicle in ("{kind: multirotor, speed: 6}", "{kind: fixed_wing, speed: 12, turn_radius: 20}"):
        made[f"town, tour of {vehicle[7:17]}"] = (
            TOWN.format() + TOUR + f"tour: {{vehicle: {vehicle}, home: [48.0003, 10.9994], clearance: 4, time_limit: 1000, "
            "view: {dwell: 1}, gap: 0.9}\n")
    return made


def points_in(low: list[float], high: list[float]) -> str:
    numbers = random.Random(1)
    rows = ["x,y,z"]
    for _ in range(400):
        rows.append(",".join(f"{numbers.uniform(a - 0.1 * (b - a), b + 0.1 * (b - a)):.3f}" for a, b in zip(low, high)))
    return "\n".join(rows) + "\n"


def stripped(value):
    """JSON without what differs from run to run."""
    if isinstance(value, dict):
        return {key: stripped(entry) for key, entry in value.items() if key not in TIMES}
    return [stripped(entry) for entry in value] if isinstance(value, list) else value


class Case:
    """The outputs of one mission or scene file."""

    def __init__(self, program: str, folder: pathlib.Path) -> None:
        self.program, self.folder, self.hashes, self.printed = program, folder, {}, {}

    def run(self, step: str, *arguments: object) -> subprocess.CompletedProcess:
        done = subprocess.run([self.program, *map(str, arguments), "--quiet"], cwd=self.folder, capture_output=True)
        self.hashes[step] = f"{done.returncode} {self.hash_of(done.stdout)} {self.hash_of(done.stderr)}"
        self.printed |= {f"{step}.out": done.stdout, f"{step}.err": done.stderr}
        return done

    def hash_of(self, data: bytes) -> str:
        data = data.replace(str(self.folder).encode(), b"").replace(str(ROOT).encode(), b"")
        try:
            data = json.dumps(stripped(json.loads(data)), sort_keys=True).encode()
        except ValueError:
            data = re.sub(rb'"(?:[a-z_]*seconds)": ?[0-9.e+-]+', b"", data)
        return hashlib.sha256(data).hexdigest()[:16]

    def finish(self) -> dict[str, str]:
        for file in sorted(self.folder.rglob("*")):
            if file.is_file() and file.name not in ("mission.yaml", "points.csv", "flight.csv"):
                self.hashes[str(file.relative_to(self.folder))] = self.hash_of(file.read_bytes())
        for name, data in self.printed.items():
            (self.folder / name).write_bytes(data)
        return self.hashes


def mission_case(program: str, mission: pathlib.Path, folder: pathlib.Path) -> dict[str, str]:
    case = Case(program, folder)
    done = case.run("compute", "compute", mission, "--json", *(a for e in ("ply", "obj", "stl", "glb") for a in ("-o", f"v.{e}")))
    case.run("compute.kml", "compute", mission, "-o", "v.kml")
    text = mission.read_text(encoding="utf-8")
    low, high = [-80.0, -80.0, 0.0], [80.0, 80.0, 60.0]
    try:
        box = json.loads(done.stdout)["bounds_m"]
        low, high = box["min"], box["max"]
    except (ValueError, KeyError, TypeError):
        pass
    (folder / "points.csv").write_text(points_in(low, high))
    each = re.search(r"^combine: each", text, re.M)
    for target in (["--target", name] for name in ("a", "b")) if each else [[]]:
        name = "v." + target[1] if target else "v"
        case.run(f"query {name}", "query", mission, "points.csv", *target)
        case.run(f"fraction {name}", "query", mission, "points.csv", "--fraction", "area", "--json", *target)
        if "method: spheres" not in text:
            case.run(f"stand {name}", "stand", mission, "--json", *target)
            case.run(f"orbit {name}", "orbit", mission, "--json", "--radius", 10, *target)
        if (folder / f"{name}.ply").exists():
            case.run(f"prove {name}", "prove", mission, f"{name}.ply", "--json", "--maximal", "--certificate", f"{name}.cert", *target)
            case.run(f"verify {name}", "verify", mission, f"{name}.ply", "--json", "--points", 1000, *target)
            case.run(f"simplify {name}", "simplify", f"{name}.ply", "--error", 0.5, "-o", f"{name}.small.ply", "--json")
    rows = points_in(low, high).splitlines()[1:12]
    (folder / "flight.csv").write_text("x,y,z\n" + "\n".join(rows) + "\n")
    case.run("check", "check", mission, "flight.csv", "--json", "--heights", "scene", "--tube", 1)
    case.run("render", "render", mission, "-o", "picture.png", "--size", "320x240")
    case.run("report", "report", mission, "-o", "page.html")
    if "\ntour:" in text:
        case.run("tour", "tour", mission, "--json", "--no-bound")
        for format in ("plan", "waypoints", "kml", "gpx", "geojson", "csv", "czml"):
            case.run(f"tour.{format}", "tour", mission, "--no-bound", "--undulation", 45, "-o", f"tour.{format}")
        case.run("tour for dji", "tour", mission, "--no-bound", "--undulation", 45, "--aircraft", "77,0,66", "-o", "dji.kmz")
        case.run("check tour", "check", mission, "tour.plan", "--json")
    return case.finish()


def scene_case(program: str, file: pathlib.Path, folder: pathlib.Path) -> dict[str, str]:
    case = Case(program, folder)
    case.run("inspect", "inspect", file, "--json")
    case.run("objects", "inspect", file, "--objects", "*", "--json")
    case.run("scene", "scene", file, "-o", "scene.glb", "-o", "scene.obj", "-o", "scene.ply")
    return case.finish()


def hash_case(program: str, name: str, source, keep: pathlib.Path | None) -> tuple[str, dict[str, str]]:
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        if keep:
            folder = keep / re.sub(r"[^A-Za-z0-9.]+", "_", name)
            folder.mkdir(parents=True)
        if name.startswith("scene "):
            return name, scene_case(program, source, folder)
        if isinstance(source, str):
            (folder / "mission.yaml").write_text(source)
            source = folder / "mission.yaml"
        return name, mission_case(program, source, folder)


def cases() -> dict:
    found = {str(m.relative_to(ROOT)): m for m in sorted([*ROOT.glob("docs/*/*.yaml"), *ROOT.glob("examples/*/*.yaml")])}
    found |= texts()
    scenes = [f for folder in ("osm", "osm-fixtures", "cityjson", "dsm", "mesh", "charlotte", "battcave")
              for f in sorted((DATA / folder).glob("*")) if f.is_file() and f.suffix != ".json" or ".city." in f.name]
    scenes += sorted(DATA.glob("tiles/**/tileset.json"))
    return found | {f"scene {f.relative_to(DATA)}": f for f in scenes}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--against", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="cases whose name holds this")
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.program).resolve())
    chosen = {name: source for name, source in cases().items() if arguments.only in name}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = dict(pool.map(lambda case: hash_case(program, *case, arguments.keep), chosen.items()))
    arguments.output.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(f"{sum(map(len, results.values()))} outputs of {len(results)} cases")
    if arguments.against is None:
        return 0
    before = json.loads(arguments.against.read_text(encoding="utf-8"))
    changed = 0
    for name in results if arguments.only else before.keys() | results.keys():
        old, new = before.get(name, {}), results.get(name, {})
        wrong = sorted(step for step in old.keys() | new.keys() if old.get(step) != new.get(step))
        changed += len(wrong)
        if wrong:
            print(f"{name}: {', '.join(wrong)}")
    print(f"{changed} outputs differ")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
