#!/usr/bin/env python3
"""Runs the experiments of ../gallery.md: computes every mission of this folder, checks, compares and draws it.

    make.py [--program build/bin/vantage] [--no-pictures]      prints the tables; pictures go beside this file

Meshes and reports stay in build/maps. The maps are looked for where the missions say: ../shared beside the checkout.
Needs osmium-tool, to write a map as XML.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
OUT = ROOT / "build/maps"
DATA = ROOT.parent / "shared/data"
VIEWS = {"empire_state": [], "empire_state_outlines": [], "monaco": ["--view", "oblique", "330,20"],
         "delft_cityjson": [], "delft_3dfier": [], "delft_dsm": []}


def run(*command, may_fail=False):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    if done.returncode and not (may_fail and done.returncode == 1):
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def drop_parts(source, target):
    """A copy of a map without the tags building:part, building:part:levels and so on."""
    raw = OUT / "with_parts.osm"
    run("osmium", "cat", source, "-o", raw, "--overwrite")
    tree = xml.etree.ElementTree.parse(raw)
    for element in tree.getroot():
        for tag in [tag for tag in element.findall("tag") if tag.get("k").startswith("building:part")]:
            element.remove(tag)
    tree.write(target, encoding="utf-8", xml_declaration=True)


def compute(program, case):
    """Report of `compute`, verdict of `verify`, seconds from the file to the volume on disk."""
    mission, volume = HERE / f"{case}.yaml", OUT / f"{case}.ply"
    start = time.perf_counter()
    report = json.loads(run(program, "compute", mission, "-o", volume, "--json"))
    seconds = time.perf_counter() - start
    return report, json.loads(run(program, "verify", mission, volume, "--json", may_fail=True)), seconds


def proof_of(check):
    """What the proof says: "all" and the number of facets that were tested, or its verdict."""
    proof = check["proof"]
    return f"all {proof['tested_facets']:,}" if proof["verdict"] == "proved" else proof["verdict"]


def volume_rows(program, cases):
    print("| mission | volume, m³ | pieces | facets | proved | over-claimed | under-claimed | scene read and built | engine "
          "| all |\n|---|---|---|---|---|---|---|---|---|---|")
    for case in cases:
        report, check, seconds = compute(program, case)
        spent = report["seconds"]
        print(f"| [{case}](maps/{case}.yaml) | {report['volume_m3']:,.0f} | {report['pieces']} | {report['facets']:,} "
              f"| {proof_of(check)} | {check['over_claimed']} of {check['inside']:,} | {check['under_claimed']} "
              f"| {1e3 * spent['read']:.0f} ms | {1e3 * spent['engine']:.0f} ms | {seconds:.2f} s |", flush=True)


def compare_rows(program, pairs):
    print("\n| A | B | in both | only A claims it | only B claims it |\n|---|---|---|---|---|")
    for a, b in pairs:
        found = json.loads(run(program, "compare", OUT / f"{a}.ply", OUT / f"{b}.ply", "--json"))
        print(f"| {a} | {b} | {found['intersection_m3']:,.0f} m³ "
              f"| {found['only_a_m3']:,.0f} m³, {100 * found['only_a_m3'] / found['volume_a_m3']:.2f} % of A "
              f"| {found['only_b_m3']:,.0f} m³, {100 * found['only_b_m3'] / found['volume_b_m3']:.2f} % of B |")


def standing(program):
    """How buildings stand on Monaco's ground, from the report beside the scene."""
    run(program, "scene", DATA / "osm/monaco.osm.pbf", "--terrain", DATA / "osm-terrain/N43E007.hgt.zip",
        "-o", OUT / "monaco_scene.obj")
    report = json.loads((OUT / "monaco_scene.report.json").read_text())
    built = [r for r in report["records"] if r["kind"] in ("building", "building part")]
    raised = [r["base_m"] - r["ground_m"] for r in built]
    level = [z for z in raised if abs(z) <= 1e-3]
    heights = [r["ground_m"] for r in built]
    print(f"\n{len(built)} buildings and parts on ground from {min(heights):.1f} m to {max(heights):.1f} m. Base and "
          f"ground are equal to 1 mm for {len(level)}; {sum(z > 1e-3 for z in raised)} begin above it, by "
          f"{min(z for z in raised if z > 1e-3):.2f} to {max(raised):.2f} m, {sum(z < -1e-3 for z in raised)} below.")


def draw(program, case):
    run(program, "render", HERE / f"{case}.yaml", "--volume", OUT / f"{case}.ply", "-o", HERE / f"{case}.png",
        "--size", "560x420" if case.startswith("delft") else "880x660", *VIEWS[case])


def main():
    parser = argparse.ArgumentParser(description="Runs the experiments of docs/gallery.md.")
    parser.add_argument("--program", default=ROOT / "build/bin/vantage", type=pathlib.Path)
    parser.add_argument("--no-pictures", action="store_true")
    arguments = parser.parse_args()
    program = str(arguments.program)
    OUT.mkdir(parents=True, exist_ok=True)
    drop_parts(DATA / "osm/empire-state-600m.osm.pbf", OUT / "outlines.osm")
    volume_rows(program, VIEWS)
    compare_rows(program, [("empire_state", "empire_state_outlines"), ("delft_cityjson", "delft_3dfier"),
                           ("delft_cityjson", "delft_dsm"), ("delft_3dfier", "delft_dsm")])
    standing(program)
    if not arguments.no_pictures:
        for case in VIEWS:
            draw(program, case)


if __name__ == "__main__":
    main()
