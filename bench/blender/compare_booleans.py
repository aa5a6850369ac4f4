#!/usr/bin/env python3
"""Blender's exact boolean against ours, in one run, on the same sphere meshes: see compare_booleans.sh."""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

OUR_RUNS = 5
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def shared_folder():
    return pathlib.Path(os.environ.get("VANTAGE_SHARED", ROOT / ".." / "shared")).resolve()


def charlotte_missions(folder, face_sizes, ranges, spheres):
    """Mission files of the targets T1 to T3, as (label, file)."""
    city = shared_folder() / "data" / "charlotte"
    missions = []
    for target in json.loads((city / "baseline.json").read_text(encoding="utf-8"))["targets"]:
        vertices = [[x, -z, y] for x, y, z in target["vertices"]]  # the file's axes, y up, to the scene frame
        for size in face_sizes:
            for reach in ranges:
                for sphere in spheres:
                    label = (target["name"], reach, size, sphere)
                    file = folder / f"{target['name']}-{reach}-{size}-{sphere}.yaml"
                    file.write_text(
                        f"scene: {{mesh: {json.dumps(str(city / target['scene'].split()[0]))}, up: y}}\n"
                        f"target: {{name: {target['name']}, vertices: {vertices}, front: [0, 0, 1]}}\n"
                        f"sensor: {{max_range: {reach}}}\n"
                        f"method: spheres\nspheres: {{sphere: {sphere}, cubemap: {size}, max_splits: 0}}\n",
                        encoding="utf-8")
                    missions.append((label, file))
    return missions


def limited(command, seconds, memory_gib):
    """Runs a command under limits: (what ended it or None, CPU seconds, standard output, standard error)."""
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (int(memory_gib * 2**30),) * 2)

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=seconds, check=False,
                              preexec_fn=limit, text=True, errors="replace")
        fault, out, err = (f"exit {done.returncode}" if done.returncode else None), done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        fault, out, err = f"stopped after {seconds:.0f} s", "", ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return fault, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, out, err


def ours(program, mission, stages, limits):
    """The report of our run of median booleans, its CPU seconds, and the sphere meshes, which a run before it left."""
    volume = stages.parent / (stages.name + ".ply")
    command = [program, "compute", mission, "--method", "spheres", "-o", volume, "--json"]
    runs = []
    for extra in [["--stages", stages]] + [[]] * OUR_RUNS:
        fault, cpu, out, err = limited(command + extra, *limits)
        if fault:
            raise SystemExit(f"{program} compute {mission}: {fault}\n{err}")
        if not extra:
            runs.append((json.loads(out), cpu))
    runs.sort(key=lambda run: run[0]["spheres"]["boolean_seconds"])
    story = json.loads((stages / "stages.json").read_text(encoding="utf-8"))
    meshes = [stages / stage["file"] for stage in story["stages"] if stage["kind"] == "sphere"]
    return *runs[len(runs) // 2], meshes


def blenders(blender, meshes, result_file, limits):
    fault, _, out, err = limited(
        [blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
         HERE / "intersect_in_blender.py", "--", result_file, *meshes], *limits)
    result = {"seconds": [], "cpu_seconds": [], "measures": []}
    if result_file.exists():
        result = json.loads(result_file.read_text(encoding="utf-8"))
    result["wanted"] = len(meshes) - 1
    if len(result["seconds"]) < result["wanted"]:
        said = [line for line in (out + err).splitlines() if line.strip()]
        result["fault"] = fault or (said[-1] if said else "ended without a result")
    return result


def verdict(result):
    if "fault" in result:
        return f"{len(result['seconds'])} of {result['wanted']}: {result['fault']}"
    last = result["measures"][-1]
    return "closed" if last["closed"] else f"{last['open_edges']} open edges"


def row(cells):
    return "| " + " | ".join(cells) + " |"


def compare(label, mission, arguments, folder):
    """One line of the table."""
    limits = (arguments.seconds, arguments.memory)
    report, cpu, meshes = ours(arguments.vantage, mission, folder / mission.stem, limits)
    theirs = blenders(arguments.blender, meshes, folder / (mission.stem + ".blender.json"), limits)
    seconds, measured = report["spheres"]["boolean_seconds"], sum(theirs["seconds"])
    is_whole = "fault" not in theirs
    at_least = "" if is_whole else "at least "
    ratios = (measured / seconds, sum(theirs["cpu_seconds"]) / cpu)
    return row([*map(str, label), str(len(meshes)), f"{report['spheres']['render_seconds']:.3f}", f"{seconds:.3f}",
                f"{cpu:.2f}", "closed" if report["closed"] else "open", f"{measured:.2f}",
                f"{sum(theirs['cpu_seconds']):.2f}", verdict(theirs),
                *(at_least + f"{ratio:.0f}" if measured > 0 else "-" for ratio in ratios),
                f"{report['volume_m3']:,.0f}", f"{theirs['measures'][-1]['volume_m3']:,.0f}" if is_whole else "-"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vantage", type=pathlib.Path, default=ROOT / "build" / "bin" / "vantage")
    parser.add_argument("--blender", required=True)
    parser.add_argument("--seconds", type=float, default=300, help="for each run of either program")
    parser.add_argument("--memory", type=float, default=8, help="GiB of addresses for each run of either program")
    parser.add_argument("--face-size", type=int, nargs="+", default=[40])
    parser.add_argument("--range", type=int, nargs="+", default=[100, 300])
    parser.add_argument("--sphere", nargs="+", default=["centers", "conservative"])
    arguments = parser.parse_args()
    arguments.vantage = arguments.vantage.resolve()
    if not (shared_folder() / "data" / "charlotte" / "baseline.json").exists():
        raise SystemExit("needs shared/data/charlotte: set VANTAGE_SHARED to the folder that holds data/")
    load = os.getloadavg()[0]
    version = subprocess.run([arguments.blender, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    print(f"{version.splitlines()[0]}, {os.cpu_count()} processors, load {load:.1f} at the start; at most "
          f"{arguments.seconds:.0f} s and {arguments.memory:g} GiB each.")
    print(f"Ours: the median of {OUR_RUNS} runs; its booleans cut the spheres to the target's front too. CPU: of the "
          "whole run, reading the scene and writing the volume included. Blender: the spheres one after another, once; "
          "starting, reading and measuring are not counted. The CPU ratio hardly depends on what else runs, and is in "
          "Blender's favour.\n")
    print(row(["target", "range, m", "texels", "sphere", "spheres", "our spheres, s", "our booleans, s",
               "our run, CPU s", "ours", "Blender's booleans, s", "CPU s", "Blender's", "ratio", "CPU ratio",
               "our volume, m3", "Blender's, both sides"]))
    print(row(["---"] * 16), flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for label, mission in charlotte_missions(folder, arguments.face_size, arguments.range, arguments.sphere):
            print(compare(label, mission, arguments, folder), flush=True)


if __name__ == "__main__":
    sys.exit(main())
