"""The fewest positions that see all of many targets, and how many are necessary (the extra `positions`)."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._common_points import Numbers, Solid, deepest, inner_points, surely_apart
from ._cover import Clock, cp_model, groups, least_cover, most_apart, most_together
from ._errors import input_error, make
from ._result import Result
from ._progress import Listener, Progress, listener
from ._volume import Volume

Cost = Union[npt.ArrayLike, Callable[[_arrays.Points], npt.ArrayLike]]

_LEAST_DEPTH = 1e-6
"""Of the size of a volume: what lies less deep in it is no position. So much its surface may be off: docs/theory.md."""

_SAMPLES = 48
"""Random points in each volume, the first candidates."""

_COSTS = 1e6
"""The solver counts in whole numbers: the largest cost becomes this."""


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class Positions:
    """What `fewest_positions` found. Targets go by their index in `volumes`.

    Attributes:
        positions: (k, 3) float64, metres.
        sees: for each position the targets that are seen whole from it.
        assigned: for each target the index of a position that sees it; -1 for those that no position sees.
        depth_m: for each position how far it lies from the boundary of the volumes of the targets assigned to it.
        lower_bound: at least so many positions are necessary, wherever they are (with `candidates`: among these).
        necessary: targets of which no two can be seen from one position.
        greatest_depth: no position sees more targets than so many, as far as it is known.
        unseen: targets that no position sees: their volume is empty, or no candidate is in it.
        total_cost: of the positions, where there are costs; else their number.
        optimal: whether it is proved that no fewer do (with `cost`: none that cost less, among `candidates`).
        notes: what was cut short, and what bounds do not take into account.
    """

    positions: _arrays.Points
    sees: list[list[int]]
    assigned: npt.NDArray[np.int64]
    depth_m: Numbers
    lower_bound: int
    necessary: list[int]
    greatest_depth: int
    unseen: list[int]
    total_cost: float
    optimal: bool
    notes: list[str]

    def __len__(self) -> int:
        return len(self.positions)

    def _repr_html_(self) -> str:
        from ._html import of_positions

        return of_positions(self)

    def __repr__(self) -> str:
        return f"<vantage.Positions: {self}>"

    def __str__(self) -> str:
        count = len(self)
        text = f"{count} {_plural('position', count)}; "
        least = "at least " if count > self.lower_bound else ""
        text += f"{least}{self.lower_bound} {'is' if self.lower_bound == 1 else 'are'} necessary"
        if 1 < self.lower_bound == len(self.necessary):
            text += f": targets {', '.join(map(str, self.necessary))} do not meet"
        elif self.lower_bound > 1 and self.lower_bound == -(-self._seen_count() // self.greatest_depth):
            text += f": no position sees more than {self.greatest_depth} of {self._seen_count()} targets"
        elif self.lower_bound > 1:
            text += f": {self.lower_bound - 1} would have to see targets together that do not meet"
        if self.unseen:
            text += f"; {len(self.unseen)} {_plural('target', len(self.unseen))} without an answer"
        return text

    def _seen_count(self) -> int:
        return len(self.assigned) - len(self.unseen)


def _plural(word: str, count: int) -> str:
    return word if count == 1 else word + "s"


class _Told:
    """Tells progress, and stops when the callback returns False."""

    def __init__(self, progress: Listener):
        self.progress = progress

    def __call__(self, stage: str, fraction: float) -> None:
        if self.progress is not None and self.progress(stage, fraction) is False:
            raise make("cancelled", "cancelled", "cancelled", "", "", None)


class _Region:
    """The positions of one target: `inner` of them that are sure, and `outer`, all of them and more."""

    def __init__(self, of: Result | Volume, name: str):
        if not isinstance(of, (Result, Volume)):
            raise input_error("wrong-type", f"{name} is a {type(of).__name__}", name, "pass vt.Result or vt.Volume")
        self.mission = of.mission if isinstance(of, Result) else None
        self.inner = Solid((of.volume if isinstance(of, Result) else of)._core)
        size = 0.0 if self.inner.is_empty else float(np.linalg.norm(self.inner.high - self.inner.low))
        self.least_depth_m = max(_LEAST_DEPTH * size, self.inner.rounding_m)
        self.outer = self.inner
        self.ignored: list[str] = []

    def surround(self, threads: int) -> None:
        """Makes `outer` of what the result was computed for. A mere volume is taken for all that there is."""
        if self.mission is not None and not self.inner.is_empty:
            volume, _, _, self.ignored = _core.outer_volume(self.mission._core, 0.0, 0.01, threads, None)
            self.outer = Solid(volume)

    def holds(self, points: _arrays.Points, threads: int) -> npt.NDArray[np.bool_]:
        """Whether each point is a position: deep enough in the mesh, and by the exact query if there is a mission."""
        found = self.inner.depths(points, threads) > self.least_depth_m
        if self.mission is not None and found.any():
            found[found] = self.mission.query(points[found], threads=threads).inside
        return found


class _Search:
    """Candidates and conflicts, as far as they are known. Regions are those that are not empty."""

    def __init__(self, regions: list[_Region], clock: Clock, threads: int, told: _Told):
        self.regions, self.clock, self.threads, self.told = regions, clock, threads, told
        self.points: list[Numbers] = []
        self.seen: list[frozenset[int]] = []  # by each of the points
        self.conflicts: set[frozenset[int]] = set()  # no position is in all of them
        self.outer_conflicts: set[frozenset[int]] = set()  # no position can be
        self.is_cut = False

    def all(self) -> range:
        return range(len(self.regions))

    # ---- candidates

    def add(self, points: _arrays.Points) -> None:
        """Candidates, with all that each sees."""
        points = np.ascontiguousarray(points).reshape(-1, 3)
        held = np.array([region.holds(points, self.threads) for region in self.regions])
        for number, point in enumerate(points):
            self.points.append(point)
            self.seen.append(frozenset(np.flatnonzero(held[:, number]).tolist()))

    def sample(self) -> None:
        """Random points in each volume, and its deepest one."""
        rng = np.random.default_rng(1)
        found = [inner_points(region.inner, _SAMPLES, rng, self.threads) for region in self.regions]
        points, held = np.concatenate(found), []
        for number, region in enumerate(self.regions):
            self.told("candidates", number / len(self.regions))
            held.append(region.holds(points, self.threads))
        sets = {frozenset(np.flatnonzero(column).tolist()): row for row, column in enumerate(np.array(held).T)}
        largest: list[frozenset[int]] = []
        for one in sorted(sets, key=lambda one: (-len(one), sorted(one))):
            if one and not any(one <= other for other in largest):
                largest.append(one)
        for one in largest:
            self.points.append(points[sets[one]])
            self.seen.append(one)
        for number in self.all():
            if not any(number in one for one in self.seen):
                self.common({number})

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
        found = deepest([region.inner for region in regions], least, share=0.5, most_boxes=20_000, threads=self.threads)
        if found.point is not None:
            self.add(found.point)
            return True if group <= self.seen[-1] else None
        if found.most_m <= least or self._is_empty_as_meshes([region.inner for region in regions]):
            self.conflicts.add(group)
            return False
        return None

    @staticmethod
    def _is_empty_as_meshes(solids: list[Solid]) -> bool:
        """By booleans, where distances have not decided."""
        return _core.intersect_volumes([one.core for one in solids], None).outcome == "no_common_view"

    # ---- conflicts

    def compare_pairs(self) -> None:
        """Which outer meshes do not meet."""
        pairs = list(itertools.combinations(self.all(), 2))
        for number, (a, b) in enumerate(pairs):
            if number % 50 == 0:
                self.told("pairs", number / len(pairs))
            if self.clock.is_over:
                self.is_cut = True
                return
            if self.known(frozenset((a, b))) is None and not self.regions[a].outer.meets(self.regions[b].outer):
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
        if self.known(conflict) is not None:
            return False
        if surely_apart([self.regions[i].outer for i in sorted(conflict)], threads=self.threads):
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
            self.told("fewer", least / len(best))
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
            self.told("bound", bound / most)
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

    def greatest_depth(self) -> int:
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


def fewest_positions(volumes: Sequence[Result | Volume], candidates: npt.ArrayLike | None = None,
                     cost: Cost | None = None, *, time_limit_s: float = 60.0, threads: int = 0,
                     progress: Progress = None) -> Positions:
    """The fewest positions from which each of many targets is seen whole by one of them, and how many are necessary.

    Each position lies inside the volumes of its targets, deeper than a millionth of their size, and is asked for by the
    exact query of each result's mission. How deep it lies is within 10 % of what its targets allow.

    The lower bound holds for any method. It rests on outer meshes, which hold all positions of a target: the exact volume
    of sight and range, coarse by a thousandth of the range, with its vertices moved out from the target's centre by at
    least twice that and 2e-6 of their distance. Each of their facets is proved to have no position beyond it
    (docs/proof.md, "Maximal"); those of which it cannot be proved are moved beyond the range. Limits of navigation are
    made 0.01 m wider, or ignored where they cannot be. Left out are positions lower over the plane of a target than a
    millionth of their distance. A mere `Volume` is taken for all that there is: its mesh is its outer mesh.

    Args:
        volumes: a result, or a volume, for each target.
        candidates: (n, 3), metres: choose from these points only.
        cost: a cost for each candidate, (n,), or a function that takes (n, 3) points and gives (n,) costs, not negative:
            the sum is made least. Without candidates it is so among the points that were looked at.
        time_limit_s: seconds; what was found until then counts. `notes` say so.
        threads: 0: as many as there are. The answer does not depend on it, but where time runs out.
        progress: called with stage and fraction; False stops.

    Returns:
        positions, who sees what, the lower bound and its witnesses. A target whose volume is empty is in `unseen`.

    Raises:
        Error: OR-Tools is not installed; an argument is wrong; all volumes are empty.

    Example:
        >>> import vantage as vt
        >>> def box(x):
        ...     return vt.Volume.from_arrays(
        ...         [[x + a, b, c] for a in (0, 2) for b in (0, 1) for c in (0, 1)],
        ...         [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        ...          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
        >>> print(vt.fewest_positions([box(0), box(1), box(5)]))
        2 positions; 2 are necessary: targets 0, 2 do not meet
    """
    cp_model()
    if not time_limit_s > 0:
        raise input_error("value-out-of-range", f"time_limit_s is {time_limit_s}", "time_limit_s", "pass seconds")
    told, clock = _Told(listener(progress)), Clock(time_limit_s)
    if isinstance(volumes, (Result, Volume)) or not isinstance(volumes, Sequence):
        raise input_error("wrong-type", f"volumes is a {type(volumes).__name__}", "volumes", "pass a list of them")
    every = [_Region(one, f"volumes[{number}]") for number, one in enumerate(volumes)]
    points = None if candidates is None else _arrays.points(candidates, "candidates")
    numbers = [number for number, region in enumerate(every) if not region.inner.is_empty]
    if not numbers:
        raise input_error("nothing-given", "there is no volume that is not empty", "volumes",
                          "pass results that are not empty: Result.reason says why they are")
    search = _Search([every[number] for number in numbers], clock, threads, told)
    if points is not None:
        return _among(search, points, cost, numbers, len(every))
    return _anywhere(search, cost, numbers, len(every))


def _costs(cost: Cost | None, points: _arrays.Points, may_be_list: bool) -> Numbers:
    if cost is None:
        return np.ones(len(points))
    if not callable(cost) and not may_be_list:
        raise input_error("conflicting-keys", "costs are given, and no candidates", "cost",
                          "pass candidates, or a function of points")
    values = _arrays.numbers(cost(points) if callable(cost) else cost, "cost")
    if values.shape != (len(points),):
        raise input_error("array-sizes-differ", f"cost has the shape {values.shape}", "cost", f"pass ({len(points)},)")
    if not np.all(np.isfinite(values)) or np.any(values < 0):
        raise input_error("value-out-of-range", "a cost is negative or not finite", "cost", "pass costs of at least 0")
    return values


def _whole(costs: Numbers) -> list[int]:
    """For the solver: the largest is a million, and of equal sums the one with fewer positions is less."""
    top = float(costs.max()) if len(costs) else 0.0
    scaled = np.rint(costs / top * _COSTS) if top > 0 else np.zeros(len(costs))
    return [int(value) * 1000 + 1 for value in scaled]


def _among(search: _Search, points: _arrays.Points, cost: Cost | None, numbers: list[int], count: int) -> Positions:
    """The answer from given candidates: exact."""
    values = _costs(cost, points, True)
    search.add(points)
    seen_at_all = frozenset().union(*search.seen) if search.seen else frozenset()
    kept = sorted(seen_at_all)
    place = {region: i for i, region in enumerate(kept)}
    sets = [[place[i] for i in sorted(one)] for one in search.seen]
    found = least_cover(len(kept), sets, _whole(values) if cost is not None else [1] * len(sets), search.clock)
    apart = most_apart(len(kept), [one for one in sets if len(one) > 1], search.clock)
    exact_count = found.is_least and cost is None
    answer = _answer(search, [search.points[i] for i in found.chosen], numbers, count)
    return dataclasses.replace(
        answer, lower_bound=len(found.chosen) if exact_count else len(apart),
        necessary=sorted(numbers[kept[i]] for i in apart), greatest_depth=max((len(one) for one in sets), default=0),
        total_cost=float(values[found.chosen].sum()), optimal=found.is_least,
        notes=[] if found.is_least else ["time ran out: fewer, or cheaper, candidates may do"])


def _anywhere(search: _Search, cost: Cost | None, numbers: list[int], count: int) -> Positions:
    """The answer from any place."""
    for number, region in enumerate(search.regions):
        search.told("outer", number / len(search.regions))
        region.surround(search.threads)
    search.sample()
    unseen_thin = [i for i in search.all() if search.known(frozenset([i])) is None]
    if unseen_thin:
        rest = [i for i in search.all() if i not in set(unseen_thin)]
        thin = [numbers[i] for i in unseen_thin]
        if not rest:
            raise input_error("nothing-given", "no volume has a position that lies deep enough inside", "volumes",
                              "pass volumes that are thicker than a millionth of their size")
        smaller = _Search([search.regions[i] for i in rest], search.clock, search.threads, search.told)
        answer = _anywhere(smaller, cost, [numbers[i] for i in rest], count)
        return dataclasses.replace(answer, notes=[*answer.notes, f"volumes {thin} are too thin for a position"])
    search.compare_pairs()
    apart = most_apart(len(search.regions), _meeting(search), search.clock)
    if cost is None:
        best, is_least = search.improve(search.cover(), len(apart), apart)
        points = [_deep_point(search, group) for group in _shared_out(search, best)]
    else:
        values = _costs(cost, np.array(search.points), False)
        cheapest = least_cover(len(search.regions), search.seen, _whole(values), search.clock).chosen
        points, is_least = [search.points[i] for i in cheapest], True
    bound = search.raise_bound(len(apart), len(points), apart)
    greatest = search.greatest_depth()
    bound = max(bound, -(-len(search.regions) // greatest))
    answer = _answer(search, points, numbers, count)
    notes = _notes(search, is_least, len(points) > bound, cost is not None)
    total = float(_costs(cost, answer.positions, False).sum()) if cost is not None else float(len(points))
    return dataclasses.replace(answer, lower_bound=bound, necessary=[numbers[i] for i in apart],
                               greatest_depth=greatest, total_cost=total,
                               optimal=cost is None and len(points) == bound, notes=notes)


def _meeting(search: _Search) -> list[frozenset[int]]:
    """All pairs that meet, as far as it is known that they do not."""
    pairs = (frozenset(pair) for pair in itertools.combinations(search.all(), 2))
    return [pair for pair in pairs if pair not in search.outer_conflicts]


def _notes(search: _Search, is_least: bool, has_gap: bool, has_cost: bool) -> list[str]:
    notes = []
    if search.is_cut or search.clock.is_over:
        notes.append("time ran out: the search was cut, and both numbers may be improved")
    if has_cost:
        notes.append("the cost is the least among the points that were looked at")
    elif has_gap and is_least:
        notes.append("no fewer positions lie inside the volumes; the outer meshes, which are larger, do not exclude it")
    elif has_gap:
        notes.append("of some sets of targets it is not known whether one position sees them")
    ignored = sorted({name for region in search.regions for name in region.ignored})
    if ignored:
        notes.append("the lower bound does not take into account: " + ", ".join(ignored))
    return notes


def _shared_out(search: _Search, found: list[list[int]]) -> list[list[int]]:
    """Each target to one of the groups that hold it: the one where it is seen from deepest inside."""
    points = np.array([search.points[search.known(frozenset(group)) or 0] for group in found])
    shared: list[list[int]] = [[] for _ in found]
    for number, region in enumerate(search.regions):
        holders = [g for g, group in enumerate(found) if number in group]
        depths = region.inner.depths(np.ascontiguousarray(points[holders]), search.threads)
        shared[holders[int(depths.argmax())]].append(number)
    return [group for group in shared if group]


def _deep_point(search: _Search, group: list[int]) -> Numbers:
    """Of the positions that see the group, one that lies deep inside."""
    regions = [search.regions[i] for i in group]
    least = max(region.least_depth_m for region in regions)
    found = deepest([region.inner for region in regions], least, threads=search.threads)
    known = search.known(frozenset(group))
    if found.point is not None and all(region.holds(found.point[None, :], search.threads)[0] for region in regions):
        return found.point
    assert known is not None
    return search.points[known]


def _answer(search: _Search, points: list[Numbers], numbers: list[int], count: int) -> Positions:
    """Who sees what, asked for again. Bounds are filled in by the caller."""
    positions = np.array(points).reshape(-1, 3)
    held = np.array([region.holds(positions, search.threads) for region in search.regions]).reshape(-1, len(positions))
    depths = np.array([region.inner.depths(positions, search.threads) for region in search.regions])
    assigned = np.full(count, -1, np.int64)
    for row, number in enumerate(numbers):
        if held[row].any():
            assigned[number] = int(np.where(held[row], depths[row], -np.inf).argmax())
    depth_m = np.full(len(positions), np.inf)
    for row, number in enumerate(numbers):
        if assigned[number] >= 0:
            depth_m[assigned[number]] = min(depth_m[assigned[number]], depths[row][assigned[number]])
    sees = [[numbers[row] for row in np.flatnonzero(held[:, k])] for k in range(len(positions))]
    return Positions(positions, sees, assigned, depth_m, 0, [], 0, np.flatnonzero(assigned < 0).tolist(),
                     float(len(positions)), False, [])
