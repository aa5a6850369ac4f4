"""The search for few positions: what is known of candidates, and which targets have none in common."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._common_points import Numbers, Solid, deepest, inner_points, surely_apart
from ._cover import Clock, groups, least_cover, most_together
from ._errors import CancelledError, Error, input_error, make
from ._progress import Listener
from ._result import Result
from ._volume import Volume

_LEAST_DEPTH = 1e-6
"""Of the size of a volume: what lies less deep in it is no position. So much its surface may be off: docs/theory.md."""

_SAMPLES = 48
"""Random points in each volume, the first candidates."""

_LAST_TRIES = 4
"""Points of a volume that are asked for when time is over, and none is known."""


class ProgressReporter:
    """Calls back with the progress, and stops when the callback returns False."""

    def __init__(self, progress: Listener):
        self.progress = progress
        self._last = ("candidates", 0.0)

    def __call__(self, stage: str, fraction: float) -> None:
        self._last = (stage, fraction)
        if self.progress is not None and self.progress(stage, fraction) is False:
            raise make("cancelled", "cancelled", f"cancelled while {stage}", "", "", None)

    def again(self) -> None:
        """The same once more, while something takes long."""
        self(*self._last)


class Region:
    """The positions of one target: `inner` of them that are sure, and `outer`, all of them and more."""

    def __init__(self, of: Result | Volume | Error, name: str):
        if not isinstance(of, (Result, Volume, Error)):
            raise input_error("wrong-type", f"{name} is a {type(of).__name__}", name, "pass vt.Result or vt.Volume")
        self.mission = of.mission if isinstance(of, Result) else None
        self.frame = None if isinstance(of, Error) else of._map
        self.inner = Solid(_core_of(of))
        size = 0.0 if self.inner.is_empty else float(np.linalg.norm(self.inner.high - self.inner.low))
        self.least_depth_m = max(_LEAST_DEPTH * size, self.inner.rounding_m)
        self.outer: Solid | None = self.inner if self.mission is None or self.inner.is_empty else None
        """None: it is not made, and may hold any position"""
        self.ignored: list[str] = []

    def surround(self, threads: int, clock: Clock) -> bool:
        """Makes `outer` of what the result was computed for. A mere volume is taken for all that there is. False: there was
        no time."""
        if self.outer is not None or self.mission is None:
            return True
        mission = self.mission._core
        made = _in_time(clock, lambda goes_on: _core.outer_volume(mission, 0.0, 0.01, threads, goes_on))
        if made is None:
            return False
        volume, _, _, self.ignored = made
        self.outer = Solid(volume)
        return True

    def holds(self, points: _arrays.Points, threads: int) -> npt.NDArray[np.bool_]:
        """Whether each point is a position: deep enough in the mesh, and by the exact query if there is a mission."""
        found = self.inner.depths(points, threads) > self.least_depth_m
        if self.mission is not None and found.any():
            found[found] = self.mission.query(points[found], threads=threads).inside
        return found


def _core_of(of: Result | Volume | Error) -> _core.Volume:
    if isinstance(of, Error):
        return _core.empty_volume("no_common_view", "")
    return (of.volume if isinstance(of, Result) else of)._core


def _in_time(clock: Clock, work: Any) -> Any:
    """What `work` returns, which is given a callback that stops it; None: time is over."""
    stopped = False

    def goes_on(stage: str, fraction: float) -> bool:
        nonlocal stopped
        clock.check()
        stopped = clock.is_over
        return not stopped

    if clock.is_over:
        return None
    try:
        return work(goes_on)
    except CancelledError:
        if stopped:
            return None
        raise


class PositionSearch:
    """Candidates and conflicts, as far as they are known. Regions are those that are not empty."""

    def __init__(self, regions: list[Region], clock: Clock, threads: int, report: ProgressReporter):
        self.regions, self.clock, self.threads, self.report = regions, clock, threads, report
        self.points: list[Numbers] = []
        self.seen: list[frozenset[int]] = []  # by each of the points
        self.conflicts: set[frozenset[int]] = set()  # no position is in all of them
        self.outer_conflicts: set[frozenset[int]] = set()  # no position can be
        self.is_cut = False

    def all(self) -> range:
        return range(len(self.regions))

    def of(self, numbers: list[int]) -> PositionSearch:
        """The same search of some of the regions, with what is known of their candidates."""
        less = PositionSearch([self.regions[number] for number in numbers], self.clock, self.threads, self.report)
        place = {number: i for i, number in enumerate(numbers)}
        less.points = self.points
        less.seen = [frozenset(place[number] for number in one if number in place) for one in self.seen]
        less.is_cut = self.is_cut
        return less

    # ---- candidates

    def add(self, points: _arrays.Points) -> None:
        """Candidates, with all that each sees."""
        points = np.ascontiguousarray(points).reshape(-1, 3)
        held = self._held(points, "candidates")
        for number, point in enumerate(points):
            self.points.append(point)
            self.seen.append(frozenset(np.flatnonzero(held[:, number]).tolist()))

    def _held(self, points: _arrays.Points, stage: str | None) -> npt.NDArray[np.bool_]:
        held = np.zeros((len(self.regions), len(points)), bool)
        for number, region in enumerate(self.regions):
            if stage is not None and len(points) > 1:
                self.report(stage, number / len(self.regions))
            held[number] = region.holds(points, self.threads)
        return held

    def sample(self) -> None:
        """Random points in each volume, and its deepest one. When time is over, each has one point of its own."""
        rng = np.random.default_rng(1)
        found: list[Numbers] = []
        for number, region in enumerate(self.regions):
            self.report("candidates", number / (2 * len(self.regions)))
            if self.clock.is_over:
                break
            found.append(inner_points(region.inner, _SAMPLES, rng, self.threads))
        points = np.concatenate(found) if found else np.zeros((0, 3))
        held = np.zeros((len(self.regions), len(points)), bool)
        for number, region in enumerate(self.regions):
            self.report("candidates", 0.5 + number / (2 * len(self.regions)))
            if self.clock.is_over:
                break
            held[number] = region.holds(points, self.threads)
        sets = {frozenset(np.flatnonzero(column).tolist()): row for row, column in enumerate(held.T)}
        largest: list[frozenset[int]] = []
        for one in sorted(sets, key=lambda one: (-len(one), sorted(one))):
            if one and not any(one <= other for other in largest):
                largest.append(one)
        for one in largest:
            self.points.append(points[sets[one]])
            self.seen.append(one)
        for number in self.all():
            if any(number in one for one in self.seen):
                continue
            if self.clock.is_over:
                self.report("candidates", number / len(self.regions))
                self._add_own(number, found[number] if number < len(found) else None)
            else:
                self.common({number})
        self.is_cut = self.is_cut or self.clock.is_over

    def _add_own(self, number: int, points: Numbers | None) -> None:
        """One candidate in a region, of which it is not asked what else it sees."""
        region = self.regions[number]
        if points is None:
            points = inner_points(region.inner, _SAMPLES, np.random.default_rng(1), self.threads)
        depths = region.inner.depths(points, self.threads)
        tried = np.ascontiguousarray(points[np.argsort(-depths, kind="stable")[:_LAST_TRIES]])
        good = np.flatnonzero(region.holds(tried, self.threads))
        if len(good):
            self.points.append(tried[good[0]])
            self.seen.append(frozenset({number}))

    def known(self, group: frozenset[int]) -> int | None:
        """A candidate that sees all of the group."""
        return next((number for number, one in enumerate(self.seen) if group <= one), None)

    def common(self, members: set[int] | frozenset[int]) -> bool | None:
        """Whether some position is in all of the regions; None where it is not known. New ones become candidates."""
        group = frozenset(members)
        if self.known(group) is not None:
            return True
        if any(one <= group for one in self.conflicts):
            return False
        regions = [self.regions[number] for number in sorted(group)]
        least = max(region.least_depth_m for region in regions)
        self.report.again()
        found = deepest([region.inner for region in regions], least, share=0.5, most_boxes=20_000, threads=self.threads,
                        clock=self.clock)
        if found.point is not None:
            self.add(found.point)
            return True if group <= self.seen[-1] else None
        if found.most_m <= least or self._is_empty_as_meshes([region.inner for region in regions]):
            self.conflicts.add(group)
            return False
        return None

    def _is_empty_as_meshes(self, solids: list[Solid]) -> bool:
        """By booleans, where distances have not decided."""
        cores = [one.core for one in solids]
        common = _in_time(self.clock, lambda goes_on: _core.intersect_volumes(cores, goes_on))
        return common is not None and common.outcome == "no_common_view"

    # ---- conflicts

    def surround(self) -> None:
        """Makes the outer meshes, as long as there is time."""
        for number, region in enumerate(self.regions):
            self.report("outer", number / len(self.regions))
            if not region.surround(self.threads, self.clock):
                self.is_cut = True

    def compare_pairs(self) -> None:
        """Which outer meshes do not meet."""
        pairs = list(itertools.combinations(self.all(), 2))
        for number, (a, b) in enumerate(pairs):
            if number % 50 == 0:
                self.report("pairs", number / len(pairs))
            if self.clock.is_over:
                self.is_cut = True
                break
            one, other = self.regions[a].outer, self.regions[b].outer
            if one is None or other is None or self.known(frozenset((a, b))) is not None:
                continue
            if not one.meets(other):
                self.outer_conflicts.add(frozenset((a, b)))
        self.conflicts |= self.outer_conflicts

    def smallest_conflict(self, group: list[int]) -> frozenset[int]:
        """Of a group without a common position: what is left when all that can be is taken out."""
        kept = list(group)
        for member in group:
            less = [one for one in kept if one != member]
            if len(less) > 1 and self.common(set(less)) is False:
                kept = less
        conflict = frozenset(kept)
        self.conflicts.add(conflict)
        if conflict not in self.outer_conflicts:
            self.try_outer(conflict)
        return conflict

    def try_outer(self, conflict: frozenset[int]) -> bool:
        """Whether it is certain that the outer meshes have no common point; it is kept then."""
        if any(one <= conflict for one in self.outer_conflicts):
            return True
        outer = [self.regions[i].outer for i in sorted(conflict)]
        solids = [one for one in outer if one is not None]
        if self.known(conflict) is not None or len(solids) < len(outer):
            return False
        if surely_apart(solids, threads=self.threads, clock=self.clock):
            self.outer_conflicts.add(conflict)
            return True
        return False

    # ---- from above

    def cover(self) -> list[list[int]]:
        """The fewest candidates, each as the group that it sees."""
        found = least_cover(len(self.regions), self.seen, [1] * len(self.seen), self.clock)
        return [sorted(self.seen[number]) for number in found.chosen]

    def improve(self, best: list[list[int]], least: int, apart: list[int]) -> tuple[list[list[int]], bool]:
        """Fewer groups, until there are no fewer; whether that is certain for the inner meshes."""
        while len(best) > least:
            self.report("fewer", least / len(best))
            if self.clock.is_over:
                self.is_cut = True
                return best, False
            tried = groups(len(self.regions), len(best) - 1, self.conflicts, apart, self.clock)
            if tried is False:
                return best, True
            if not isinstance(tried, list):
                self.is_cut = True
                return best, False
            answers = [self.common(set(group)) if group else True for group in tried]
            if all(answers):
                best = [group for group in tried if group]
                continue
            if not any(answer is False for answer in answers):
                return best, False  # of some groups it is not known
            for group, answer in zip(tried, answers):
                if answer is False:
                    self.smallest_conflict(group)
            covered = self.cover()  # the candidates that came on the way may do
            best = min(best, covered, key=len)
        return best, True

    # ---- from below

    def raise_bound(self, bound: int, most: int, apart: list[int]) -> int:
        """How many groups the outer meshes need, from `bound` on."""
        while bound < most and not self.clock.is_over:
            self.report("bound", bound / most)
            tried = groups(len(self.regions), bound, self.outer_conflicts, apart, self.clock)
            if tried is False:
                bound += 1
            elif not isinstance(tried, list) or not any([self._outer_conflict_in(group) for group in tried]):
                return bound
        return bound

    def _outer_conflict_in(self, group: list[int]) -> bool:
        """Whether a group is found to have none in common; the smallest part of it that shows it is kept."""
        if len(group) < 2 or not self.try_outer(frozenset(group)):
            return False
        kept = list(group)
        for member in group:
            less = [one for one in kept if one != member]
            if len(less) > 1 and self.try_outer(frozenset(less)):
                kept = less
        return True

    def most_seen(self) -> int:
        """No position is in more of the regions than this."""
        most = len(self.regions)
        while not self.clock.is_over:
            found, is_most = most_together(len(self.regions), self.outer_conflicts, self.clock)
            if not is_most:
                return most
            most = len(found)
            if not self._outer_conflict_in(found):
                return most
        return most
