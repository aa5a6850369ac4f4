#!/usr/bin/env python3
"""Tours and bounds in real cities: how long, how much shorter one could be at most, how fast.

    cities.py charlotte [--authors FOLDER] [--data FOLDER] [--seconds 60] [--seeds 10]
    cities.py munich [--counts 10 20 50 100] [--seed 1] [--data FOLDER] [--seconds 60] [--keep FOLDER]
    cities.py manhattan [--data FOLDER] [--seconds 60] [--keep FOLDER]

charlotte: the experiment of the seed paper's group, 5 and 10 targets, a fixed wing of radius 40 and 100 m that climbs
by -15 to 20 degrees. Beside it their sampling: 8 places on the faces of each volume, 4 headings at each, and the
shortest tour of one pose of each volume, which is found exactly. The volumes are those of their repository
(robotics-uncc/VisualTour3DDubins), data/viewRegions in a clone of it: --authors. Without it they are computed here, of
the same targets, range and lowest heights: tours through these differ by a few per cent.
munich: squares of 10 m on open ground, drawn with a seed. Tours lead through computed volumes, bounds are over outer
volumes; obstacles between volumes are not looked at.
manhattan: roofs and squares by name, a camera, heights above the ground, a clearance: `vantage tour`.

--data has the files of shared/data. Where one is missing the part is skipped, and says so. `cpu` are seconds of both
threads together. Exit code 1 where a bound is above a tour, or a program failed."""

import argparse
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import published  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
RANGE_M, ABOVE_M = 300, 150  # of their volumes: a ball, and how far above the target they begin
ROOFS = ["FDNY Engine 65", "Algonquin Hotel", "The Penn Club", "Belasco Theatre", "Shubert Theatre",
         "Nederlander Theatre", "New Victory Theater", "St. James Theatre", "Booth Theatre", "The Kitano New York",
         "Library Hotel", "Dylan Hotel", "Bryant Park Place", "Gorham Building", "Archer Hotel", "Hotel Wolcott",
         "Collectors Club"]
SQUARES = ["Verizon Plaza", "Fifth Avenue Tower Urban Plaza", "Marsh & McLennan Public Space"]


class Failed(Exception):
    """A program, or what it found."""


def run(*words):
    finished = subprocess.run([str(w) for w in words], text=True, capture_output=True, check=False)
    if finished.returncode not in (0, 1, 4):  # `vantage tour`: a target is left out, the gap is not reached
        raise Failed(finished.stderr.strip())
    if finished.returncode and not finished.stdout:
        raise Failed(finished.stderr.strip())
    return finished.stdout


def tour(options, inner, outer, *more):
    """Prints a row of the table; returns whether it is sound."""
    words = run(options.programs / "vantage_published_tours", inner, outer, "--threads", 2, "--seconds",
                options.seconds, "--gap", options.gap, *more).split()
    kind = words.pop(2)
    length, bound, seconds, planned, cpu = map(float, words)
    print(f"{length:10.2f}{bound:10.2f}{100 * (1 - bound / length):8.2f}{kind:>11}"
          f"{seconds:8.1f}{planned:8.1f}{cpu:8.1f}", flush=True)
    return bound <= length


def heading(first):
    print(f"{first:34}{'tour m':>10}{'bound m':>10}{'gap %':>8}{'by':>11}{'s':>8}{'of tour':>8}{'cpu s':>8}")


# ---- Charlotte ------------------------------------------------------------------------------------------------------

def triangles_of(path):
    """Of an OBJ with y up, mirrored as theirs are, or a PLY as text, z up."""
    lines = path.read_text(encoding="utf-8").splitlines()
    if path.suffix == ".obj":
        corners, faces = [], []
        for words in map(str.split, lines):
            if words[:1] == ["v"]:
                x, y, z = map(float, words[1:4])
                corners.append((x, z, y))
            elif words[:1] == ["f"]:
                faces.append([int(w.split("/")[0]) - 1 for w in reversed(words[1:])])
    else:
        end = lines.index("end_header")
        count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
        corners = [tuple(map(float, line.split()[:3])) for line in lines[end + 1:end + 1 + count]]
        faces = [list(map(int, line.split()[1:])) for line in lines[end + 1 + count:] if line.strip()]
    result = [tuple(corners[i] for i in (f[0], f[k], f[k + 1])) for f in faces for k in range(1, len(f) - 1)]
    six_volumes = sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                      a[2] * (b[0] * c[1] - b[1] * c[0]) for a, b, c in result)
    return result if six_volumes > 0 else [(a, c, b) for a, b, c in result]


def computed(options, regions, scratch):
    """One mission for each target, as each has a lowest height of its own."""
    texts = [[], []]
    for number, region in enumerate(regions):
        x, y, z = region["points"][0]
        mission = scratch / f"t{number}.yaml"
        mission.write_text(f"scene: {{mesh: {options.data / 'charlotte/uptownCharlotte.obj'}, up: y}}\n"
                           f"target: {{point: [{x}, {-y}, {z}]}}\n"
                           f"sensor: {{max_range: {RANGE_M}}}\n"
                           f"navigation: {{altitude: [{z + ABOVE_M}, {z + 2 * RANGE_M}]}}\n"
                           "exact: {tolerance: 0.05}\n", encoding="utf-8")
        files = [scratch / "one.inner", scratch / "one.outer"]
        run(options.programs / "vantage_mission_regions", mission, *files)
        for text, file in zip(texts, files):
            text.append(file.read_text(encoding="ascii").split("\n", 1)[1])
    names = [scratch / "inner", scratch / "outer"]
    for name, text in zip(names, texts):
        name.write_text(f"{len(text)}\n" + "".join(text), encoding="ascii")
    return names


def charlotte(options, scratch):
    experiments = options.data / "tours/visualtour-experiments.json"
    if not experiments.exists():
        print(f"skipped: {experiments} is not there")
        return True
    sound = True
    lists = {len(e["regions"]): e["regions"] for e in json.loads(experiments.read_text(encoding="utf-8"))}
    print("volumes: " + ("of the authors" if options.authors else "computed"))
    for count, regions in sorted(lists.items()):
        if options.authors:
            inner = outer = scratch / "authors"
            published.write(inner, [triangles_of(options.authors / pathlib.Path(r["file"]).name) for r in regions])
        else:
            inner, outer = computed(options, regions, scratch)
        for radius in (40, 100):
            words = run(options.programs / "vantage_sampled_tours", inner, "--seeds", options.seeds, "--radius",
                        radius).split()
            lengths, seconds = list(map(float, words[::2])), list(map(float, words[1::2]))
            print(f"{count} targets, radius {radius} m, their sampling, seeds 1 to {len(lengths)}: mean "
                  f"{sum(lengths) / len(lengths):.1f} m, least {min(lengths):.1f}, most {max(lengths):.1f}; "
                  f"{sum(seconds) / len(seconds):.1f} s each")
            heading("")
            print(f"{f'{count} targets, radius {radius} m':34}", end="")
            sound &= tour(options, inner, outer, "--wing", "--radius", radius, "--descent", -15, "--climb", 20)
    return sound


# ---- Munich ---------------------------------------------------------------------------------------------------------

def footprints(path):
    """The triangles of a binary PLY of floats, from above, but for the ground; by cells of 10 m."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + 11
    counts = [int(w.split()[2]) for w in data[:end].decode("ascii", "replace").splitlines() if w.startswith("element")]
    corners = list(struct.iter_unpack("<3f", data[end:end + 12 * counts[0]]))
    cells = {}
    for _, i, j, k in struct.iter_unpack("<B3i", data[end + 12 * counts[0]:]):
        three = [corners[i], corners[j], corners[k]]
        if max(z for _, _, z in three) <= 0.01:
            continue
        low, high = ([math.floor(f(p[a] for p in three) / 10) for a in (0, 1)] for f in (min, max))
        for x in range(low[0], high[0] + 1):
            for y in range(low[1], high[1] + 1):
                cells.setdefault((x, y), []).append([p[:2] for p in three])
    return cells


def apart(a, b):
    """Of two convex polygons, whether a line along a side of one of them is between them."""
    for polygon in (a, b):
        for p, q in zip(polygon, polygon[1:] + polygon[:1]):
            normal = (q[1] - p[1], p[0] - q[0])
            one, other = ([normal[0] * x + normal[1] * y for x, y in of] for of in (a, b))
            if max(one) < min(other) or max(other) < min(one):
                return True
    return False


def square(centre, angle, side):
    return [(centre[0] + side / math.sqrt(2) * math.cos(angle + k * math.pi / 2),
             centre[1] + side / math.sqrt(2) * math.sin(angle + k * math.pi / 2)) for k in range(4)]


def on_open_ground(cells, draw):
    while True:
        centre, angle = (draw.uniform(-600, 500), draw.uniform(-500, 380)), draw.uniform(0, math.pi / 2)
        wide = square(centre, angle, 12)
        column, row = (math.floor(x / 10) for x in centre)
        near = {(column + x, row + y) for x in (-1, 0, 1) for y in (-1, 0, 1)}
        if all(apart(wide, triangle) for cell in near for triangle in cells.get(cell, [])):
            return square(centre, angle, 10)


def munich(options, scratch):
    mesh = options.data / "mesh/munich_merged.ply"
    if not mesh.exists():
        print(f"skipped: {mesh} is not there")
        return True
    cells, sound = footprints(mesh), True
    heading(f"seed {options.seed}")
    for count in options.counts:
        draw = random.Random(f"{options.seed} {count}")
        name = f"munich-{options.seed}-{count}"
        mission, inner, outer = (scratch / f"{name}.{end}" for end in ("yaml", "inner", "outer"))
        targets = [on_open_ground(cells, draw) for _ in range(count + 2 + count // 10)]
        lines = [f"  - {{name: T{i}, vertices: {[[round(x, 3), round(y, 3), 0.0] for x, y in t]}, offset: 0.02}}\n"
                 for i, t in enumerate(targets)]
        mission.write_text(f"scene: {{mesh: {mesh}, up: z}}\ntargets:\n{''.join(lines)}combine: each\n"
                           "sensor: {max_range: 200, incidence: 75}\n"
                           "navigation: {altitude: [30, 120]}\nexact: {tolerance: 0.05}\n", encoding="utf-8")
        if not outer.exists():
            words = run(options.programs / "vantage_mission_regions", mission, inner, outer, "--count", count).split()
            print(f"{count} volumes in {float(words[1]):.1f} s, outer ones in {float(words[2]):.1f} s", flush=True)
        print(f"{f'{count} targets':34}", end="")
        sound &= tour(options, inner, outer)
    return sound


# ---- Manhattan ------------------------------------------------------------------------------------------------------

def manhattan(options, scratch):
    data = options.data / "osm/manhattan-midtown.osm.pbf"
    if not data.exists():
        print(f"skipped: {data} is not there")
        return True
    mission = scratch / "manhattan.yaml"
    lines = [f'  - {{osm: "{name}"{part}}}\n' for names, part in ((ROOFS, ", part: roof"), (SQUARES, ""))
             for name in names]
    mission.write_text(f"scene: {{osm: {data}, center: [40.7527, -73.9830], radius: 1100, without: [trees, walls]}}\n"
                       f"targets:\n{''.join(lines)}combine: each\n"
                       "sensor: {camera: {model: dji_mavic_3e_wide}, pixel: {size: 0.02}}\n"
                       "navigation: {altitude: {agl: [30, 120]}, clearance: 5}\nexact: {tolerance: 0.05}\n"
                       f"tour: {{clearance: 5, gap: {options.gap}, time_limit: {options.seconds / 2}}}\n",
                       encoding="utf-8")
    begin = time.monotonic()
    found = json.loads(run(options.programs / "vantage", "tour", mission, "--json", "--threads", 2, "-q"))
    seconds = time.monotonic() - begin
    length, bound = found["length_m"], found["bound"]
    print(f"{len(found['visits'])} of {len(ROOFS) + len(SQUARES)} targets visited, {len(found['left_out'])} left out")
    print(f"{length:.1f} m, {found['time_s']:.0f} s of flight; bound {bound['length_m']:.1f} m by {bound['kind']}, "
          f"gap {100 * bound['gap']:.2f} %; {seconds:.1f} s with scene and volumes")
    return bound["length_m"] <= length


def main():
    parser = argparse.ArgumentParser(description="Tours and bounds in real cities.")
    parser.add_argument("city", choices=["charlotte", "munich", "manhattan"])
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "bin")
    parser.add_argument("--authors", type=pathlib.Path, help="their data/viewRegions")
    parser.add_argument("--seconds", type=float, default=60, help="of a tour and its bound together")
    parser.add_argument("--gap", type=float, default=0.0001, help="at which a search ends")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=10, help="of their sampling")
    parser.add_argument("--counts", type=int, nargs="+", default=[10, 20, 50, 100], help="of targets in Munich")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for missions and volumes, to use them again")
    options = parser.parse_args()
    options.data = options.data.resolve()
    part = {"charlotte": charlotte, "munich": munich, "manhattan": manhattan}[options.city]
    try:
        if options.keep:
            options.keep.mkdir(parents=True, exist_ok=True)
            return 0 if part(options, options.keep) else 1
        with tempfile.TemporaryDirectory() as scratch:
            return 0 if part(options, pathlib.Path(scratch)) else 1
    except Failed as problem:
        print(problem, file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
