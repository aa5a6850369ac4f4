#!/usr/bin/env python3
"""What Python adds to one more target: vt.compute beside the same two calls in C++ (one_more.cpp) over the same library, in turn.

    PYTHONPATH=build/python .deps/python/bin/python bench/python/overhead.py [--program build/bin/vantage_one_more] [--turns 7]

Prints medians over the turns. Needs ../shared or VANTAGE_SHARED.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import time

import vantage as vt

PROJECT = pathlib.Path(__file__).resolve().parents[2]
CALLS = 60
"""in a turn"""


def of_program(program, mission):
    """Milliseconds for one call, the mean of a turn."""
    ran = subprocess.run([program, mission, str(CALLS)], capture_output=True, text=True)
    if ran.returncode != 0:
        raise SystemExit(ran.stderr)
    return float(ran.stdout)


def of_python(scene, target, max_range):
    """Milliseconds for one call, the mean of a turn; as in C++ the first call is not counted and the last result kept."""
    result = vt.compute(scene, target, max_range=max_range)
    start = time.perf_counter()
    for _ in range(CALLS):
        result = vt.compute(scene, target, max_range=max_range)
    seconds = time.perf_counter() - start
    assert result.outcome == "computed"
    return 1000 * seconds / CALLS


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROJECT / "build" / "bin" / "vantage_one_more")
    parser.add_argument("--turns", type=int, default=7)
    options = parser.parse_args()
    commit = subprocess.run(["git", "-C", PROJECT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    print(f"commit {commit.stdout.strip()}, {os.cpu_count()} threads, load {os.getloadavg()[0]:.1f}, "
          f"{options.turns} turns of {CALLS} calls")
    for name in ("charlotte", "munich"):
        file = PROJECT / "docs" / "gallery" / f"{name}.yaml"
        mission = vt.Mission.read(file)
        scene, target = mission.scene.prepare(), mission.target_parts[0]
        vt.compute(scene, target, max_range=mission.range_m)
        turns = [(of_program(options.program, file), of_python(scene, target, mission.range_m))
                 for _ in range(options.turns)]
        program, python = (statistics.median(column) for column in zip(*turns))
        print(f"{name}: C++ {program:.2f} ms, Python {python:.2f} ms, overhead {100 * (python / program - 1):.1f} % "
              f"(turns {min(100 * (b / a - 1) for a, b in turns):.1f} to {max(100 * (b / a - 1) for a, b in turns):.1f})")


if __name__ == "__main__":
    main()
