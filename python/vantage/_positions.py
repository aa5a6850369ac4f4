"""The fewest positions that see all of many targets, and how many are necessary (the extra `positions`)."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._checks import thread_count
from ._common_points import Numbers, deepest
from ._cover import Clock, cp_model, least_cover, most_apart
from ._errors import Error, input_error
from ._extras import require
from ._flight import table_of
from ._place import FrameMap, crs_of
from ._position_search import PositionSearch, ProgressReporter, Region
from ._progress import Progress, listener
from ._render import html
from ._result import Mission, Result
from ._views import View, described, names_of_view
from ._volume import Volume

Cost = Union[npt.ArrayLike, Callable[[_arrays.Points], npt.ArrayLike]]

_COSTS = 1e6
"""The solver counts in whole numbers: the largest cost becomes this."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class PositionView(View):
    """One target seen from one of the positions. Besides what a `View` has:

    Attributes:
        position: index of the position.
        target: index of the target.
        depth_m: how far the position lies from the boundary of the target's volume.
    """

    position: int
    target: int
    depth_m: float


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
        unseen: targets that no position sees: there is an error in the place of their result, their volume is empty, or too
            thin, or no candidate is in it.
        total_cost: of the positions, where there are costs; else their number.
        optimal: whether it is proved that no fewer do (with `cost`: none that cost less, among `candidates`).
        notes: what was cut short, and what bounds do not take into account.
        views: for each position, and each target that is seen from it, where the position lies on the earth, how to aim, and how
            well the target is seen: a `PositionView`. Of a mere `Volume` only x, y, z and the depth are known.
        crs: of x and y: the scene's frame in PROJ's words; None where its place is not known.
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
    views: list[PositionView] = dataclasses.field(default_factory=list)
    crs: str | None = None
    _map: FrameMap | None = dataclasses.field(repr=False, default=None)

    def to_dict(self) -> dict[str, Any]:
        """The answer in plain lists and numbers, with the `views` by their names."""
        return {"positions": self.positions.tolist(), "sees": self.sees, "assigned": self.assigned.tolist(),
                "depth_m": self.depth_m.tolist(), "lower_bound": self.lower_bound, "necessary": self.necessary,
                "greatest_depth": self.greatest_depth, "unseen": self.unseen, "total_cost": self.total_cost,
                "optimal": self.optimal, "notes": self.notes, "views": [_row(view) for view in self.views]}

    def to_geodataframe(self) -> Any:
        """A row for each of `views`, for geopandas: points with z in the scene's frame, its CRS where its place is known, and
        position, target, x, y, z, longitude_deg, latitude_deg, above_ground_m, above_sea_m, yaw_deg, pitch_deg, is_centred,
        distance_m, pixel_m, incidence_deg, obstacle_distance_m, obstacle, depth_m."""
        rows = [{name: float("nan") if value is None and name not in ("obstacle", "is_centred") else value
                 for name, value in _row(view).items()} for view in self.views]
        points = [require("shapely", "geo").Point(view.x, view.y, view.z) for view in self.views]
        return table_of(rows, points, self._map, _COLUMNS)

    def __len__(self) -> int:
        return len(self.positions)

    def _repr_html_(self) -> str:
        return html(self)

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


_COLUMNS = ("position", "target", *names_of_view(), "depth_m")


def _row(view: PositionView) -> dict[str, Any]:
    return {name: getattr(view, name) for name in _COLUMNS}


def _plural(word: str, count: int) -> str:
    return word if count == 1 else word + "s"


def fewest_positions(volumes: Sequence[Result | Volume | Error], candidates: npt.ArrayLike | None = None,
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
        volumes: a result, or a volume, for each target; also the list of `compute_many` with its errors.
        candidates: (n, 3), metres: choose from these points only.
        cost: a cost for each candidate, (n,), or a function that takes (n, 3) points and gives (n,) costs, not negative:
            the sum is made least. Without candidates it is so among the points that were looked at.
        time_limit_s: seconds for the whole search, outer meshes and candidates included. What was found until then counts:
            `notes` say so. Not cut short are reading the volumes, a last try to find a position for each target that has
            none yet, and asking who sees what: about 0.05 s for each target. With `candidates` the limit is for the choice
            among them.
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
    count = thread_count(threads)
    limit = _arrays.number(time_limit_s, "time_limit_s")
    if limit <= 0:
        raise input_error("value-out-of-range", f"time_limit_s is {time_limit_s}", "time_limit_s", "pass seconds")
    report = ProgressReporter(listener(progress))
    clock = Clock(limit, report.again)
    if isinstance(volumes, (Result, Volume)) or not isinstance(volumes, Sequence):
        raise input_error("wrong-type", f"volumes is a {type(volumes).__name__}", "volumes", "pass a list of them")
    if cost is not None and candidates is None and not callable(cost):
        raise input_error("conflicting-keys", "costs are given, and no candidates", "cost",
                          "pass candidates, or a function of points")
    every = []
    for number, one in enumerate(volumes):
        report("volumes", number / len(volumes))
        every.append(Region(one, f"volumes[{number}]"))
    points = None if candidates is None else _arrays.points(candidates, "candidates")
    numbers = [number for number, region in enumerate(every) if not region.inner.is_empty]
    if not numbers:
        raise input_error("nothing-given", "there is no volume that is not empty", "volumes",
                          "pass results that are not empty: Result.reason says why they are")
    search = PositionSearch([every[number] for number in numbers], clock, count, report)
    if points is not None:
        return _among(search, points, cost, numbers, len(every))
    return _anywhere(search, cost, numbers, len(every))


def _costs(cost: Cost | None, points: _arrays.Points) -> Numbers:
    if cost is None:
        return np.ones(len(points))
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


def _among(search: PositionSearch, points: _arrays.Points, cost: Cost | None, numbers: list[int], count: int) -> Positions:
    """The answer from given candidates: exact."""
    values = _costs(cost, points)
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


def _anywhere(search: PositionSearch, cost: Cost | None, numbers: list[int], count: int) -> Positions:
    """The answer from any place."""
    search.sample()
    seen = [i for i in search.all() if search.known(frozenset([i])) is not None]
    more = []
    if len(seen) < len(numbers):
        left = [number for i, number in enumerate(numbers) if i not in set(seen)]
        if not seen and not search.is_cut:
            raise input_error("nothing-given", "no volume has a position that lies deep enough inside", "volumes",
                              "pass volumes that are thicker than a millionth of their size")
        more = [f"no position was found in time in the volumes {left}, which may be thin" if search.is_cut
                else f"volumes {left} are too thin for a position"]
        search, numbers = search.of(seen), [numbers[i] for i in seen]
        if not seen:
            return dataclasses.replace(_answer(search, [], [], count), notes=[*_notes(search, False, False, False), *more])
    search.surround()
    search.compare_pairs()
    apart = most_apart(len(search.regions), _meeting(search), search.clock)
    if cost is None:
        best, is_least = search.improve(search.cover(), len(apart), apart)
        points = [_deep_point(search, group) for group in _shared_out(search, best)]
    else:
        values = _costs(cost, np.array(search.points))
        cheapest = least_cover(len(search.regions), search.seen, _whole(values), search.clock).chosen
        points, is_least = [search.points[i] for i in cheapest], True
    bound = search.raise_bound(len(apart), len(points), apart)
    greatest = search.most_seen()
    bound = max(bound, -(-len(search.regions) // greatest))
    answer = _answer(search, points, numbers, count)
    notes = [*_notes(search, is_least, len(points) > bound, cost is not None), *more]
    total = float(_costs(cost, answer.positions).sum()) if cost is not None else float(len(points))
    return dataclasses.replace(answer, lower_bound=bound, necessary=[numbers[i] for i in apart],
                               greatest_depth=greatest, total_cost=total,
                               optimal=cost is None and len(points) == bound, notes=notes)


def _meeting(search: PositionSearch) -> list[frozenset[int]]:
    """All pairs that meet, as far as it is known that they do not."""
    pairs = (frozenset(pair) for pair in itertools.combinations(search.all(), 2))
    return [pair for pair in pairs if pair not in search.outer_conflicts]


def _notes(search: PositionSearch, is_least: bool, has_gap: bool, has_cost: bool) -> list[str]:
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


def _shared_out(search: PositionSearch, found: list[list[int]]) -> list[list[int]]:
    """Each target to one of the groups that hold it: the one where it is seen from deepest inside."""
    points = np.array([search.points[search.known(frozenset(group)) or 0] for group in found])
    shared: list[list[int]] = [[] for _ in found]
    for number, region in enumerate(search.regions):
        holders = [g for g, group in enumerate(found) if number in group]
        depths = region.inner.depths(np.ascontiguousarray(points[holders]), search.threads)
        shared[holders[int(depths.argmax())]].append(number)
    return [group for group in shared if group]


def _deep_point(search: PositionSearch, group: list[int]) -> Numbers:
    """Of the positions that see the group, one that lies deep inside."""
    regions = [search.regions[i] for i in group]
    known = search.known(frozenset(group))
    assert known is not None
    if search.clock.is_over:
        return search.points[known]
    least = max(region.least_depth_m for region in regions)
    search.report.again()
    found = deepest([region.inner for region in regions], least, threads=search.threads, clock=search.clock)
    if found.point is not None and all(region.holds(found.point[None, :], search.threads)[0] for region in regions):
        return found.point
    return search.points[known]


def _answer(search: PositionSearch, points: list[Numbers], numbers: list[int], count: int) -> Positions:
    """Who sees what, asked for again. Bounds are filled in by the caller."""
    positions = np.array(points, np.float64).reshape(-1, 3)
    shape = len(search.regions), len(positions)
    held = np.array([region.holds(positions, search.threads) for region in search.regions], bool).reshape(shape)
    depths = np.array([region.inner.depths(positions, search.threads) for region in search.regions]).reshape(shape)
    assigned = np.full(count, -1, np.int64)
    for row, number in enumerate(numbers):
        if held[row].any():
            assigned[number] = int(np.where(held[row], depths[row], -np.inf).argmax())
    depth_m = np.full(len(positions), np.inf)
    for row, number in enumerate(numbers):
        if assigned[number] >= 0:
            depth_m[assigned[number]] = min(depth_m[assigned[number]], depths[row][assigned[number]])
    sees = [[numbers[row] for row in np.flatnonzero(held[:, k])] for k in range(len(positions))]
    frame = _map(search)
    return Positions(positions, sees, assigned, depth_m, 0, [], 0, np.flatnonzero(assigned < 0).tolist(),
                     float(len(positions)), False, [], _views(search, positions, held, depths, numbers),
                     crs_of(frame), frame)


def _views(search: PositionSearch, positions: _arrays.Points, held: Any, depths: Numbers,
           numbers: list[int]) -> list[PositionView]:
    """Of each position the targets that it sees. Of a mere volume nothing is known but where the position lies."""
    missions: list[Mission] = []
    places: list[_arrays.Points] = []
    for row, region in enumerate(search.regions):
        if region.mission is not None and held[row].any():
            missions.append(region.mission)
            places.append(np.ascontiguousarray(positions[held[row]]))
    left = iter(described(missions, places, search.report))
    views = []
    for row, region in enumerate(search.regions):
        for k in np.flatnonzero(held[row]).tolist():
            known = next(left).to_dict() if region.mission is not None else dict.fromkeys(names_of_view())
            known.update(zip("xyz", positions[k].tolist()))
            views.append(PositionView(position=k, target=numbers[row], depth_m=float(depths[row, k]), **known))
    return sorted(views, key=lambda view: (view.position, view.target))


def _map(search: PositionSearch) -> FrameMap | None:
    """Of all regions; None where they are of different places."""
    known = {region.frame for region in search.regions}
    return known.pop() if len(known) == 1 else None
