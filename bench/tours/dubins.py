#!/usr/bin/env python3
"""Compares lengths of Dubins paths with those of a published implementation.

    dubins.py PROGRAM [--pairs 10000] [--seed 1]

PROGRAM is bench/tours/dubins_lengths.cpp, compiled. The other side is the package `ompl` from PyPI
(I. A. Sucan, M. Moll, L. E. Kavraki). Exits 1 where a length differs by more than 1e-9 of itself.
"""

import argparse
import math
import random
import subprocess
import sys


def lengths_by_ompl(rows):
    from ompl import base

    lengths = []
    for row in rows:
        space = base.DubinsStateSpace(row[6])
        states = []
        for x, y, heading in (row[0:3], row[3:6]):
            state = space.allocState()
            state.setX(x)
            state.setY(y)
            state.setYaw(heading)
            states.append(state)
        lengths.append(space.distance(*states))
    return lengths


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--pairs", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()

    draw = random.Random(arguments.seed)
    rows = []
    for _ in range(arguments.pairs):
        radius = 10 ** draw.uniform(-1, 3)
        # From much nearer than the radius to much farther: all six words occur.
        spread = radius * 10 ** draw.uniform(-2, 2)
        rows.append(
            (draw.uniform(-spread, spread), draw.uniform(-spread, spread), draw.uniform(-math.pi, math.pi),
             draw.uniform(-spread, spread), draw.uniform(-spread, spread), draw.uniform(-math.pi, math.pi), radius))
    text = "".join(" ".join(f"{value:.17g}" for value in row) + "\n" for row in rows)
    run = subprocess.run([arguments.program], input=text, capture_output=True, text=True, check=True)
    ours = [float(line) for line in run.stdout.split()]
    theirs = lengths_by_ompl(rows)
    if len(ours) != len(rows):
        sys.exit(f"{len(ours)} lengths for {len(rows)} pairs")
    worst, place = max((abs(a - b) / max(b, 1e-300), i) for i, (a, b) in enumerate(zip(ours, theirs)))
    print(f"{len(rows)} pairs, seed {arguments.seed}, beside OMPL: largest relative difference {worst:.2e}")
    if worst > 1e-9:
        print(f"pair {place}: {rows[place]}: {ours[place]!r}, they {theirs[place]!r}")
        sys.exit(1)


if __name__ == "__main__":
    main()
