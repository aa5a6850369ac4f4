#!/usr/bin/env python3
"""The fewest stops of a flight in Munich: `vantage tour --fewest` beside vt.fewest_positions, for the same missions.

    fewest.py MESH [--targets 20 40] [--range 200 300] [--seed 1] [--programs build/bin] [--threads 2]

Squares of 10 m on open ground, drawn with a seed. It needs the package `vantage` with the extra `positions`. The flight
is checked with `vantage check`. Exit code 1 where one says that fewer do than the other one says are necessary.
"""

import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import vantage as vt

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/tours"))
import cities  # noqa: E402


def mission_text(mesh, targets, max_range):
    lines = [f"  - {{name: T{i}, vertices: {[[round(x, 3), round(y, 3), 0.0] for x, y in t]}, offset: 0.02}}\n"
             for i, t in enumerate(targets)]
    return (f"scene: {{mesh: {mesh}, up: z}}\ntargets:\n{''.join(lines)}combine: each\n"
            f"sensor: {{max_range: {max_range}, incidence: 75}}\nnavigation: {{altitude: [30, 120]}}\n"
            "exact: {tolerance: 0.05}\ntour: {clearance: 5, time_limit: 60}\n")


def of_program(given, mission):
    """The answer, its seconds with scene and volumes, and whether check accepts the flight."""
    plan = mission.with_suffix(".csv")
    begin = time.monotonic()
    done = subprocess.run([given.programs / "vantage", "tour", mission, "--fewest", "-o", plan, "--json", "-q",
                           "--threads", str(given.threads)], text=True, capture_output=True, check=False)
    seconds = time.monotonic() - begin
    if done.returncode not in (0, 4):
        sys.exit(done.stderr)
    answer = json.loads(done.stdout)
    check = subprocess.run([given.programs / "vantage", "check", mission, plan, "-q"], check=False)
    stops = {tuple(visit["from"]) for visit in answer["visits"]}
    assert len(stops) == len(answer["positions"]["found"]), "it hovers at each position once"
    return answer, seconds, check.returncode == 0


def of_python(given, mission):
    """The answer, and its seconds without scene and volumes, and with them."""
    begin = time.monotonic()
    results = vt.Mission.read(mission).run_each(threads=given.threads)
    search = time.monotonic()
    answer = vt.fewest_positions(results, threads=given.threads)
    return answer, time.monotonic() - search, time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("--targets", type=int, nargs="+", default=[20, 40])
    parser.add_argument("--range", type=float, nargs="+", default=[200, 300])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/bin")
    parser.add_argument("--threads", type=int, default=2)
    given = parser.parse_args()
    cells, is_right = cities.footprints(given.mesh), True
    print("| targets | range m | positions | necessary | s in all | check | flight m | Python: positions | necessary "
          "| s of search | s in all |\n|---|---|---|---|---|---|---|---|---|---|---|")
    for count in given.targets:
        draw = random.Random(f"{given.seed} {count}")
        targets = [cities.on_open_ground(cells, draw) for _ in range(count)]
        for max_range in given.range:
            with tempfile.TemporaryDirectory() as scratch:
                mission = pathlib.Path(scratch) / "mission.yaml"
                mission.write_text(mission_text(given.mesh.resolve(), targets, max_range), encoding="utf-8")
                ours, seconds, passes = of_program(given, mission)
                theirs, search, whole = of_python(given, mission)
            found, necessary = len(ours["positions"]["found"]), ours["positions"]["necessary"]
            print(f"| {count} | {max_range:g} | {found} | {necessary} | {seconds:.1f} | "
                  f"{'passes' if passes else 'fails'} | {ours['length_m']:.0f} | {len(theirs)} | {theirs.lower_bound} | "
                  f"{search:.1f} | {whole:.1f} |", flush=True)
            is_right &= passes and necessary <= len(theirs) and theirs.lower_bound <= found
    return 0 if is_right else 1


if __name__ == "__main__":
    sys.exit(main())
