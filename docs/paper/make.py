#!/usr/bin/env python3
"""Runs the experiments of ../paper.md: both methods on every mission of this folder, compared, checked and drawn.

    make.py [--program build/bin/vantage] [--no-pictures]      prints the table; pictures go beside this file

Meshes and reports stay in build/paper. The scenes are looked for where the missions say: ../shared beside the checkout.
"""

import argparse
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CASES = [f"{city}_{case}" for city in ("charlotte", "munich") for case in ("100m", "600m_high", "600m_band", "box")]


def run(program, *arguments, may_fail=False):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode and not (may_fail and done.returncode == 1):
        sys.exit(f"vantage {' '.join(map(str, arguments))}\n{done.stderr}")
    return done.stdout


def experiment(program, case, out):
    mission, exact, spheres = HERE / f"{case}.yaml", out / f"{case}_exact.ply", out / f"{case}_spheres.ply"
    reports = {}
    reports["exact"] = json.loads(run(program, "compute", mission, "-o", exact, "--json"))
    reports["spheres"] = json.loads(run(program, "compute", mission, "--method", "spheres", "-o", spheres, "--json"))
    difference = json.loads(run(program, "compare", spheres, exact, "--json"))
    checks = {name: json.loads(run(program, "verify", mission, mesh, "--json", may_fail=True))
              for name, mesh in (("exact", exact), ("spheres", spheres))}
    return reports, difference, checks


def proof_of(check):
    """What the proof says: "all" and the number of facets that were tested, or its verdict."""
    proof = check["proof"]
    return f"all {proof['tested_facets']:,}" if proof["verdict"] == "proved" else proof["verdict"]


def row(case, reports, difference, checks):
    exact, spheres = reports["exact"], reports["spheres"]
    volume = exact["volume_m3"]
    counts = spheres["spheres"]
    return (f"| [{case}](paper/{case}.yaml) | {volume:,.0f} | {exact['pieces']} "
            f"| {proof_of(checks['exact'])} | {checks['exact']['over_claimed']} of {checks['exact']['inside']:,} | {spheres['volume_m3']:,.0f} "
            f"| {100 * difference['only_a_m3'] / volume:.2f} % | {100 * difference['only_b_m3'] / volume:.2f} % "
            f"| {counts['spheres']}, {counts['splits']} "
            f"| {proof_of(checks['spheres'])} | {checks['spheres']['over_claimed']} of {checks['spheres']['inside']:,} |")


def draw(program, case, out):
    mission = HERE / f"{case}.yaml"
    run(program, "render", mission, "--volume", out / f"{case}_exact.ply", "-o", HERE / f"{case}.png", "--size", "800x600")


def draw_sheet(program, case, out):
    stages, mission = out / "stages", HERE / f"{case}.yaml"
    run(program, "compute", mission, "--method", "spheres", "-o", out / "sheet.ply", "--stages", stages)
    run(program, "render", mission, "--stages", stages, "-o", HERE / "stages.png")


def main():
    parser = argparse.ArgumentParser(description="Runs the experiments of docs/paper.md.")
    parser.add_argument("--program", default=ROOT / "build/bin/vantage", type=pathlib.Path)
    parser.add_argument("--no-pictures", action="store_true")
    arguments = parser.parse_args()
    program, out = str(arguments.program), ROOT / "build/paper"
    out.mkdir(parents=True, exist_ok=True)
    print("| mission | exact, m³ | pieces | proved | over-claimed | spheres, m³ | too much | missed "
          "| spheres made, splits | proved | over-claimed |\n|---|---|---|---|---|---|---|---|---|---|---|")
    for case in CASES:
        print(row(case, *experiment(program, case, out)), flush=True)
        if not arguments.no_pictures:
            draw(program, case, out)
    if not arguments.no_pictures:
        draw_sheet(program, "charlotte_box", out)


if __name__ == "__main__":
    main()
