#!/usr/bin/env python3
"""Hashes of what the program computes, to show that a change of the code changes no result.

    tools/result_hashes.py PROGRAM -o after.json            the missions of docs/ and examples/, by both methods
    tools/result_hashes.py PROGRAM -o after.json --against before.json
    tools/result_hashes.py PROGRAM -o after.json --method exact      the spheres of a town take many minutes

For each mission: SHA-256 of the arrays of the PLY (vertices as doubles, facets, cause of each facet), of the causes in
order (kind, name and area, as the report has them), and of the report without times, paths and versions. With --against
it names every mission whose arrays, causes or report differ, and exits with 1 if there is one; keys that only one of the
reports has are listed, and do not count as differences. Missions whose scene is not on this machine are left out, and
listed.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MISSIONS = sorted([*ROOT.glob("docs/*/*.yaml"), *ROOT.glob("examples/*/mission.yaml")])
LEFT_OUT = {"seconds", "mission", "scene", "volume", "version", "render_seconds", "boolean_seconds", "device"}
SIZES = {"double": 8, "float": 4, "int": 4, "uint": 4, "uchar": 1}


def arrays_of(ply: pathlib.Path) -> dict[str, str]:
    """The vertices, facets and causes of a PLY that vantage wrote, each as a hash."""
    data = ply.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    counts, properties = {}, {}
    element = ""
    for words in (line.split() for line in data[:end].decode().splitlines()):
        if words[0] == "element":
            element = words[1]
            counts[element], properties[element] = int(words[2]), []
        elif words[0] == "property":
            properties[element].append(words[1:])
    size = sum(SIZES[p[0]] for p in properties["vertex"])
    vertices = data[end : end + counts["vertex"] * size]
    row = struct.Struct("<B3iI")
    if [p[0] for p in properties["face"]] != ["list", "uint"]:
        raise SystemExit(f"{ply}: the faces are not a list and a cause")
    facets, causes = hashlib.sha256(), hashlib.sha256()
    for _, a, b, c, cause in row.iter_unpack(data[end + len(vertices) :]):
        facets.update(struct.pack("<3i", a, b, c))
        causes.update(struct.pack("<I", cause))
    return {
        "vertices": hashlib.sha256(vertices).hexdigest(),
        "facets": facets.hexdigest(),
        "cause_of": causes.hexdigest(),
    }


def stripped(value):
    """A report without what differs from run to run."""
    if isinstance(value, dict):
        return {key: stripped(entry) for key, entry in value.items() if key not in LEFT_OUT}
    return [stripped(entry) for entry in value] if isinstance(value, list) else value


def hash_of(value) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def run(program: str, mission: pathlib.Path, method: str) -> tuple[str, dict]:
    """The name of the run, and its result; an error's text where it ends in one."""
    name = f"{mission.relative_to(ROOT)} {method}"
    with tempfile.TemporaryDirectory() as scratch:
        ply = pathlib.Path(scratch) / "volume.ply"
        command = [program, "compute", str(mission), "-o", str(ply), "--method", method, "--json", "--quiet"]
        if method == "spheres":
            command += ["--device", "cpu"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return name, {"error": done.stderr.strip().splitlines()[:1]}
        report = stripped(json.loads(done.stdout))
        arrays = arrays_of(ply) if ply.exists() else {}
        return name, {**arrays, "causes": hash_of([{key: cause[key] for key in ("name", "kind", "area_m2")} for cause in report["causes"]]),
                "report": report}


def differences(before: dict, after: dict) -> tuple[list[str], list[str]]:
    """What differs between two runs of a mission, and keys of the report that only one has."""
    wrong = [key for key in ("error", "vertices", "facets", "cause_of", "causes") if before.get(key) != after.get(key)]
    old, new = before.get("report", {}), after.get("report", {})
    wrong += [f"report.{key}" for key in old if key in new and key != "causes" and old[key] != new[key]]
    return wrong, sorted(old.keys() ^ new.keys())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--against", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="missions whose path holds this")
    parser.add_argument("--method", choices=["exact", "spheres"], action="append", help="by this method alone")
    arguments = parser.parse_args()
    methods = arguments.method or ["exact", "spheres"]
    tasks = [(m, method) for m in MISSIONS if arguments.only in str(m) for method in methods]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = dict(pool.map(lambda task: run(arguments.program, *task), tasks))
    arguments.output.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    for name, result in results.items():
        if "error" in result:
            print(f"{name}: {result['error']}")
        else:
            whole = hash_of([result.get(k) for k in ("vertices", "facets", "cause_of", "causes", "report")])
            print(f"{whole[:16]}  {name}")
    if arguments.against is None:
        return 0
    before = json.loads(arguments.against.read_text(encoding="utf-8"))
    changed = 0
    for name in sorted(before.keys() & results.keys()):
        wrong, keys = differences(before[name], results[name])
        changed += bool(wrong)
        if wrong or keys:
            print(f"{name}: {'differ: ' + ', '.join(wrong) if wrong else 'same'}"
                  + (f"; keys of one report alone: {', '.join(keys)}" if keys else ""))
    print(f"{changed} of {len(before.keys() & results.keys())} runs differ")
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
