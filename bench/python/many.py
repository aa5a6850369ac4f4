#!/usr/bin/env python3
"""Many targets in one scene: vt.compute_many on one core and on all, vantage.batch, and a pool of `vantage compute`, in turn.

    PYTHONPATH=build/python .deps/python/bin/python bench/python/many.py [--targets 1000] [--turns 3]

Prints the median and the spread of rows per second. The scene is prepared before compute_many is timed; batch and the program
read and prepare it in each of their processes, in the time that is told. Needs ../shared or VANTAGE_SHARED.
"""

import argparse
import concurrent.futures
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

import numpy as np
import vantage as vt
import vantage.batch

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", PROJECT.parent / "shared"))
MUNICH = SHARED / "data" / "mesh" / "munich_merged.ply"
RANGE_M, SEED = 100, 7


def street_targets(scene, count):
    """Squares of 5 m on the ground in the open: those that can be computed, and are seen from 60 m above."""
    random = np.random.default_rng(SEED)
    low, high = scene.bounds[:, :2] * 0.6
    targets = []
    while len(targets) < count:
        x, y = random.uniform(low, high)
        square = np.array([[x, y, 0], [x + 5, y, 0], [x + 5, y + 5, 0], [x, y + 5, 0]])
        try:
            result = vt.compute(scene, square, max_range=RANGE_M)
        except vt.Error:
            continue
        if not result.empty and result.contains([[x + 2.5, y + 2.5, 60]])[0]:
            targets.append(square)
    return targets


def of_program(program, targets, workers):
    """Seconds for a process for each target, so many at a time."""
    with tempfile.TemporaryDirectory() as folder:
        for number, target in enumerate(targets):
            (pathlib.Path(folder) / f"{number}.yaml").write_text(
                f"scene: {{mesh: {MUNICH}}}\ntarget: {{vertices: {target.tolist()}}}\nsensor: {{max_range: {RANGE_M}}}\n")

        def compute(number):
            subprocess.run([program, "compute", f"{number}.yaml", "-o", f"{number}.ply", "-q", "--threads", "1"], cwd=folder,
                           check=True)

        start = time.perf_counter()
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:
            list(pool.map(compute, range(len(targets))))
        return time.perf_counter() - start


def of_batch(targets, workers):
    """Seconds for rows alone, with all that a run does."""
    with tempfile.TemporaryDirectory() as folder:
        rows = [{"id": number, "vertices": target} for number, target in enumerate(targets)]
        start = time.perf_counter()
        report = vantage.batch.run(rows, MUNICH, folder, max_range=RANGE_M, workers=workers)
        seconds = time.perf_counter() - start
        if report.errors:
            raise SystemExit(f"{report.errors} targets failed")
        return seconds


def of_threads(scene, targets, threads):
    """Seconds for compute_many."""
    start = time.perf_counter()
    vt.compute_many(scene, targets, max_range=RANGE_M, threads=threads)
    return time.perf_counter() - start


def used():
    """Seconds of the processors so far, by all and by this process with its children."""
    first = pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:]
    user, nice, system, _, _, irq, softirq, *_ = map(int, first)
    mine = os.times()
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK"), sum(mine[:4])


def quietly(way):
    """Rows per second, and the share of the processors that other processes took."""
    before, start = used(), time.perf_counter()
    seconds, count = way()
    after, wall = used(), time.perf_counter() - start
    others = (after[0] - before[0]) - (after[1] - before[1])
    return count / seconds, others / (wall * os.cpu_count())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROJECT / "build" / "bin" / "vantage")
    parser.add_argument("--targets", type=int, default=1000)
    parser.add_argument("--of-program", type=int, default=100, help="how many of them the pool of programs computes")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--others", type=float, default=1, help="the share of the processors that others may take in a turn")
    parser.add_argument("--patience", type=float, default=1e9, help="seconds to wait for such turns")
    parser.add_argument("--only", default="", help="ways whose names begin so")
    options = parser.parse_args()
    commit = subprocess.run(["git", "-C", PROJECT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    cores = len(os.sched_getaffinity(0))
    scene = vt.Scene.from_mesh(MUNICH).prepare()
    targets = street_targets(scene, options.targets)
    print(f"commit {commit.stdout.strip()}, {cores} cores, load {os.getloadavg()[0]:.1f}; {scene}; {len(targets)} targets, "
          f"range {RANGE_M} m, seed {SEED}, {options.turns} turns", flush=True)
    ways = {
        "compute_many, 1 thread": lambda: (of_threads(scene, targets, 1), len(targets)),
        f"compute_many, {cores} threads": lambda: (of_threads(scene, targets, cores), len(targets)),
        "batch, 1 process": lambda: (of_batch(targets, 1), len(targets)),
        f"batch, {cores} processes": lambda: (of_batch(targets, cores), len(targets)),
        f"vantage compute, {cores} processes": lambda: (of_program(options.program, targets[:options.of_program], cores),
                                                        min(options.of_program, len(targets))),
    }
    rates = {name: [] for name in ways if name.startswith(options.only)}
    kept, tried, ends = 0, 0, time.monotonic() + options.patience
    while kept < options.turns and (kept + tried == 0 or time.monotonic() < ends):
        tried += 1
        turn = {name: quietly(ways[name]) for name in rates}
        if max(others for _, others in turn.values()) > options.others:
            continue
        kept += 1
        for name, (rate, _) in turn.items():
            rates[name].append(rate)
    print(f"{kept} of {tried} turns, in which other processes took no more than {options.others:.0%} of the processors")
    if not kept:
        raise SystemExit("the machine was not quiet")
    for name, values in rates.items():
        print(f"{name:32} {statistics.median(values):8.2f} rows/s  ({min(values):.2f} to {max(values):.2f})")
    for name in ("compute_many", "batch"):
        both = [values for key, values in rates.items() if key.startswith(name)]
        if len(both) == 2:
            print(f"{name} on {cores} cores is {statistics.median(b / a for a, b in zip(*both)):.2f} times one core (median of "
                  f"the turns), {max(both[1]) / max(both[0]):.2f} times by the fastest turns")


if __name__ == "__main__":
    main()
