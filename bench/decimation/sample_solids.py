#!/usr/bin/env python3
"""How two closed meshes differ, by points: for meshes that pass through themselves, which no boolean takes.

    sample_solids.py RESULT.ply VOLUME.ply POINTS     prints the percent of the volume that the result has, and of the
                                                      result that the volume has not

A point is inside where the winding number is above a half. Needs numpy.
"""

import sys

import numpy

from decimate import read_ply


def dot(u, v):
    return numpy.einsum("ijk,ijk->ij", u, v)


def windings(points, corners):
    """By signed solid angles (Van Oosterom and Strackee 1983)."""
    turns = numpy.empty(len(points))
    for begin in range(0, len(points), 16):
        a, b, c = (corners[None, :, k] - points[begin:begin + 16, None] for k in range(3))
        la, lb, lc = (numpy.linalg.norm(v, axis=2) for v in (a, b, c))
        whole = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
        angle = numpy.arctan2(dot(a, numpy.cross(b, c)), whole)
        turns[begin:begin + 16] = angle.sum(axis=1) / (2 * numpy.pi)
    return turns


def main():
    result, volume = (positions[triangles] for positions, triangles in map(read_ply, sys.argv[1:3]))
    low = numpy.minimum(result.min(axis=(0, 1)), volume.min(axis=(0, 1)))
    high = numpy.maximum(result.max(axis=(0, 1)), volume.max(axis=(0, 1)))
    points = numpy.random.default_rng(1).uniform(low, high, (int(sys.argv[3]), 3))
    in_result, in_volume = windings(points, result) > 0.5, windings(points, volume) > 0.5
    both = numpy.count_nonzero(in_result & in_volume)
    print(100 * both / numpy.count_nonzero(in_volume), 100 - 100 * both / numpy.count_nonzero(in_result))


if __name__ == "__main__":
    main()
