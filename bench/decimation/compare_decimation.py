#!/usr/bin/env python3
"""`vantage simplify` beside meshoptimizer and Blender, on the volumes of the gallery: what is kept, and what is added.

    compare_decimation.py --meshoptimizer PYTHON --blender PYTHON [--facets 2000 500] [--scenes charlotte ...]

Each PYTHON is an interpreter that has numpy and `meshoptimizer` or `bpy`, from PyPI; one that is not given is left out.
Needs build/bin/vantage and ../shared. Prints a table; seconds are CPU time, and
`vantage`'s include reading and writing. Unsafe is what the result claims and the volume does not: by
exact booleans (`vantage compare`), or by 20,000 points where these fail, as where the result passes through itself.
Opt-in: nothing else runs it, and it takes minutes.
"""

import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SCENES = ["charlotte", "munich", "florence", "etoile", "battcave"]
POINTS = 20_000


def run(command):
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False)


def must(command):
    done = run(command)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def verdict(program, mission, result):
    """In words, by the judge that proves volumes."""
    done = run([program, "prove", mission, result, "--json"])
    if done.returncode not in (0, 1, 4):
        return "refused"
    proof = json.loads(done.stdout)
    sight = next(claim for claim in proof["claims"] if claim["name"] == "sight")["verdict"]
    return proof["verdict"] if proof["verdict"] == "proved" or sight == "wrong" else f"{proof['verdict']}, not in sight"


def sampled(python, result, volume):
    """Shares of the volume that are kept, and of the result that are unsafe, by points: percent."""
    return [float(word) for word in must([python, HERE / "sample_solids.py", result, volume, str(POINTS)]).split()]


def differences(program, python, result, volume):
    """(kept, unsafe, farthest): of the volume and of the result, percent; metres that the result reaches outside."""
    done = run([program, "compare", result, volume, "--json"])
    if done.returncode == 0:
        found = json.loads(done.stdout)
        return found["intersection_percent_of_b"], found["only_a_percent"], f"{found['worst_only_a_m']:.2f}"
    kept, unsafe = sampled(python, result, volume)
    return kept, unsafe, "by points"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--meshoptimizer", metavar="PYTHON")
    parser.add_argument("--blender", metavar="PYTHON")
    parser.add_argument("--facets", type=int, nargs="+", default=[2000, 500])
    parser.add_argument("--scenes", nargs="+", default=SCENES)
    parser.add_argument("--vantage", default=ROOT / "build" / "bin" / "vantage")
    arguments = parser.parse_args()
    others = [(name, python) for name, python in (("meshoptimizer", arguments.meshoptimizer),
                                                  ("blender", arguments.blender)) if python]
    if not others:
        parser.error("name an interpreter with numpy, by --meshoptimizer or --blender")
    python = others[0][1]
    print("| scene | facets | by | left | kept, % | unsafe, % of the result | reaches out, m | proof | CPU s |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        for scene in arguments.scenes:
            mission = ROOT / "docs" / "gallery" / f"{scene}.yaml"
            volume, result = pathlib.Path(scratch, "volume.ply"), pathlib.Path(scratch, "result.ply")
            must([arguments.vantage, "compute", mission, "-q", "-o", volume])
            for facets in arguments.facets:
                begin = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                done = json.loads(must([arguments.vantage, "simplify", volume, "--facets", facets, "-o", result,
                                        "--json"]))
                seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - begin
                rows = [("vantage", done["facets"], seconds)]
                _, unsafe, farthest = differences(arguments.vantage, python, result, volume)
                rows[0] += (done["kept_percent"], unsafe, farthest, verdict(arguments.vantage, mission, result))
                for name, interpreter in others:
                    seconds = float(must([interpreter, HERE / "decimate.py", name, volume, facets, result]).split()[-1])
                    with open(result, "rb") as file:
                        head = file.read(400).split(b"end_header")[0].decode()
                    left = int(head.split("element face ")[1].split()[0])
                    kept, unsafe, farthest = differences(arguments.vantage, python, result, volume)
                    rows.append((name, left, seconds, kept, unsafe, farthest,
                                 verdict(arguments.vantage, mission, result)))
                for name, left, seconds, kept, unsafe, farthest, proof in rows:
                    print(f"| {scene}, {done['facets_before']:,} | {facets:,} | {name} | {left:,} | {kept:.2f} | "
                          f"{unsafe:.4f} | {farthest} | {proof} | {seconds:.2f} |", flush=True)


if __name__ == "__main__":
    main()
