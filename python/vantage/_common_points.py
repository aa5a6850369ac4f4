"""Where several solids have a point in common, how deep it can lie, and when there is none: branch and bound.

How deep a point lies in a solid, a signed distance, changes by no more than the point moves. So in a box with the
middle c and the half diagonal r, no point lies deeper in all solids than min(depth(c)) + r. Boxes in which that is too
little are left out, and the others are halved, the most promising first.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._cover import Clock

Numbers = npt.NDArray[np.float64]

_BATCH = 256
"""Boxes that are halved at once."""

_ROUNDING = 1e-9
"""Of sizes and coordinates: more than distances are off by."""


class Solid:
    """A closed mesh, the closed set that it bounds."""

    def __init__(self, core: _core.Volume):
        vertices, faces = core.vertices, core.faces
        self.core = core
        self.index = _core.SolidIndex(core)
        used = vertices[np.unique(faces)] if len(faces) else vertices[:0]
        self.low: Numbers = used.min(axis=0) if len(used) else np.full(3, np.inf)
        self.high: Numbers = used.max(axis=0) if len(used) else np.full(3, -np.inf)
        size = float(np.linalg.norm(self.high - self.low)) if len(used) else 0.0
        self.rounding_m = _ROUNDING * size + 1e-12 * float(np.abs(used).max()) if len(used) else 0.0

    @property
    def is_empty(self) -> bool:
        return not len(self.core.faces)

    def depths(self, points: _arrays.Points, threads: int = 0) -> Numbers:
        """Of (n, 3) points: the distance to the surface, negative outside."""
        return self.index.depths(points, threads) if len(points) else np.zeros(0)

    def meets(self, other: Solid) -> bool:
        """Whether they have a common point, as closed sets. "No" is certain."""
        return self.index.comes_near(other.index, self.rounding_m + other.rounding_m)


class Search(NamedTuple):
    """What was found of the points that several solids have in common."""

    point: Numbers | None
    """the deepest that was found, if it is deep enough"""
    depth_m: float
    """how deep it is; without one, of the best"""
    most_m: float
    """no point lies deeper in all of them"""


def deepest(solids: Sequence[Solid], least_m: float, *, share: float = 0.9, most_boxes: int = 40_000,
            threads: int = 0, clock: Clock | None = None) -> Search:
    """The point that lies deepest in all of the solids.

    Args:
        solids: one or more.
        least_m: what lies less deep is not looked for.
        share: of the greatest depth; a point that deep is good enough.
        most_boxes: that are looked at before it ends with what it has.
        threads: 0: as many as there are.
        clock: it ends with what it has when the time is over, too.
    """
    low = np.max([one.low for one in solids], axis=0)
    high = np.min([one.high for one in solids], axis=0)
    if not np.all(np.isfinite(high - low)) or np.any(low > high):
        gap = float(np.max(low - high)) if np.all(np.isfinite(high - low)) else np.inf
        return Search(None, -gap / 2, -gap / 2)
    order = sorted(solids, key=lambda one: float(np.prod(one.high - one.low)))
    middles, halves = ((low + high) / 2)[None, :], ((high - low) / 2)[None, :]
    best, best_point, looked, good = -np.inf, middles[0], 0, least_m
    open_middles, open_halves = np.zeros((0, 3)), np.zeros((0, 3))
    bounds: Numbers = np.zeros(0)
    dropped = -np.inf
    while True:
        radii = np.linalg.norm(halves, axis=1)
        depths, known = _least_depths(order, middles, radii, good, threads)
        looked += len(middles)
        if known.any():
            deep = int(np.where(known, depths, -np.inf).argmax())
            if depths[deep] > best:
                best, best_point = float(depths[deep]), middles[deep]
        good = max(least_m, best / share if best > 0 else least_m)
        bounds = np.concatenate([bounds, depths + radii])
        open_middles = np.concatenate([open_middles, middles])
        open_halves = np.concatenate([open_halves, halves])
        keep = bounds > good
        if not keep.all():
            dropped = max(dropped, float(bounds[~keep].max()))
        bounds, open_middles, open_halves = bounds[keep], open_middles[keep], open_halves[keep]
        if not len(bounds) or looked >= most_boxes or (clock is not None and clock.is_over):
            break
        first = np.argsort(-bounds, kind="stable")[:_BATCH]
        middles, halves = _halved(open_middles[first], open_halves[first])
        rest = np.ones(len(bounds), bool)
        rest[first] = False
        bounds, open_middles, open_halves = bounds[rest], open_middles[rest], open_halves[rest]
    most = max(best, dropped, float(bounds.max()) if len(bounds) else -np.inf)
    return Search(best_point if best > least_m else None, best, most)


def _least_depths(solids: Sequence[Solid], points: Numbers, radii: Numbers, good_m: float,
                  threads: int) -> tuple[Numbers, npt.NDArray[np.bool_]]:
    """Of each point, how deep it lies in all solids, and whether that is known: else its box is out, and it is a bound
    from above."""
    depths = np.full(len(points), np.inf)
    alive = np.arange(len(points))
    for one in solids:
        depths[alive] = np.minimum(depths[alive], one.depths(np.ascontiguousarray(points[alive]), threads))
        alive = alive[depths[alive] + radii[alive] > good_m]
    known = np.zeros(len(points), bool)
    known[alive] = True
    return depths, known


def _halved(middles: Numbers, halves: Numbers) -> tuple[Numbers, Numbers]:
    """Each box across its longest side, and each half again."""
    for _ in range(3):
        longest = halves.argmax(axis=1)
        rows = np.arange(len(halves))
        halves = halves.copy()
        halves[rows, longest] /= 2
        step = np.zeros_like(halves)
        step[rows, longest] = halves[rows, longest]
        middles = np.concatenate([middles - step, middles + step])
        halves = np.concatenate([halves, halves])
    return middles, halves


def surely_apart(solids: Sequence[Solid], most_boxes: int = 40_000, threads: int = 0,
                 clock: Clock | None = None) -> bool:
    """Whether it is certain that the solids, as closed sets, have no point in common."""
    margin = max(one.rounding_m for one in solids)
    found = deepest(solids, -margin, most_boxes=most_boxes, threads=threads, clock=clock)
    return found.point is None and found.most_m <= -margin


def inner_points(solid: Solid, count: int, rng: np.random.Generator, threads: int = 0) -> Numbers:
    """Up to `count` random points inside, spread over its box. In thin solids fewer are found, or none."""
    tries = rng.uniform(solid.low, solid.high, (8 * count, 3))
    return tries[solid.depths(tries, threads) > 0][:count]
