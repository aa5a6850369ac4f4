#!/usr/bin/env python3
"""Tours and bounds of published instances (GTSPN in 3D), beside what was published of them.

    published.py FOLDER [--program FILE] [--seconds 60] [--gap 0.001] [--only WORD] [--certificates FOLDER]

FOLDER has the instances (3D_30_5_6_a.txt, ...) and published_results.csv. Regions are unions of closed polyhedra: inner
ones for tours, outer ones for bounds, so that an ellipsoid is stood for by two of which each errs on the safe side. How
much is printed first: the share by which the outer polyhedron of a ball is larger than the ball, and the inner smaller.
Prints for each file the published bound and best length, then ours, the gap between the two of ours, and seconds."""

import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import instances  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIMES = 3  # of dividing the icosahedron


def write(path, regions):
    """As published.cpp reads them; corners in one place are one vertex."""
    lines = [str(len(regions))]
    for triangles in regions:
        number = {}
        faces = [[number.setdefault(p, len(number)) for p in t] for t in triangles]
        faces = [f for f in faces if len(set(f)) == 3]
        lines.append(f"{len(number)} {len(faces)}")
        lines += [" ".join(map(repr, p)) for p in number] + [" ".join(map(str, f)) for f in faces]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def published_of(name, rows):
    """Files are called 3D_30_5_6_a, rows 3D_30_05_a."""
    kind, density, count, _, letter = name.split("_")
    row = rows.get(name) or rows.get(f"{kind}_{density}_{int(count):02}_{letter}")
    if not row:
        return None, None
    lengths = [float(row[k]) for k in row if k.endswith(("MIN_LENGTH", "UPPER_BOUND")) and row[k]]
    bound = float(row["BB_LOWER_BOUND"]) if row["BB_LOWER_BOUND"] else None
    return bound, min(lengths) if lengths else None


def main():
    parser = argparse.ArgumentParser(description="Tours and bounds of published instances.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build" / "bin" / "vantage_published_tours")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--gap", type=float, default=0.001, help="at which a search ends")
    parser.add_argument("--only", default="", help="files with this in their names")
    parser.add_argument("--certificates", type=pathlib.Path, help="where to write them")
    options = parser.parse_args()
    with (options.folder / "published_results.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["PROBLEM"]: row for row in csv.DictReader(file)}
    least = instances.ball(TIMES)[1]
    print(f"ball: the outer one is {100 * (1 / least - 1):.2f} % larger, the inner one {100 * (1 - least):.2f} % smaller")
    print(f"{'file':16}{'published':>20}{'tour':>10}{'bound':>10}{'gap %':>8}{'to best %':>11}{'by':>11}{'s':>7}")
    gaps, wrong = [], 0
    files = [f for f in options.folder.glob("3D_*.txt") if options.only in f.name]
    for path in sorted(files, key=lambda f: (int(f.stem.split("_")[2]), f.name)):
        with tempfile.TemporaryDirectory() as scratch:
            inner, outer = pathlib.Path(scratch) / "inner", pathlib.Path(scratch) / "outer"
            write(inner, instances.meshes(path, False, TIMES))
            write(outer, instances.meshes(path, True, TIMES))
            command = [str(options.program), str(inner), str(outer), "--seconds", str(options.seconds),
                       "--gap", str(options.gap)]
            if options.certificates:
                command += ["--certificate", str(options.certificates / f"{path.stem}.cert")]
            run = subprocess.run(command, text=True, capture_output=True, check=False)
        if run.returncode:
            print(f"{path.stem:16}{run.stderr.strip()}")
            wrong += 1
            continue
        length, ours, kind, seconds = (t if t.isalpha() else float(t) for t in run.stdout.split()[:4])
        bound, best = published_of(path.stem, rows)
        gaps.append(100 * (1 - ours / length))
        above = best is not None and ours > best
        wrong += above
        known = f"{bound:.1f} .. {best:.1f}" if bound and best else "-"
        print(f"{path.stem:16}{known:>20}{length:10.2f}{ours:10.2f}{gaps[-1]:8.3f}"
              f"{100 * (length / best - 1) if best else 0:11.3f}{kind:>11}{seconds:7.1f}"
              f"{'  WRONG: above a published tour' if above else ''}", flush=True)
    if gaps:
        print(f"{len(gaps)} files: mean gap {sum(gaps) / len(gaps):.3f} %, largest {max(gaps):.3f} %")
    return 1 if wrong or not gaps else 0


if __name__ == "__main__":
    sys.exit(main())
