"""Where to hover and where to circle while a target stays in view, and what such places are worth."""

from __future__ import annotations

import dataclasses
import itertools
import json
from collections.abc import Sequence
from typing import Any, Union

import numpy as np

from . import _arrays, _core
from ._checks import choice, flag, shown, thread_count, whole
from ._errors import Error, input_error
from ._extras import require
from ._flight import AnyMission, Flight, Numbers, mission_of, table_of
from ._place import FrameMap, crs_of
from ._progress import Progress
from ._result import Mission, Result

Wanted = Union[AnyMission, Sequence[Union[Result, Error]]]
"""What places are looked for in: a mission, a result, the path of a mission file, or the list of `compute_many`."""

CENTRES = ("around_target", "over_target", "anywhere")

_MOST_COUNT = 2**31 - 1


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """A position and the view from it. What is not known is None.

    Attributes:
        x, y, z: metres, scene frame.
        longitude_deg, latitude_deg: WGS 84.
        above_ground_m: over the highest ground straight above or below.
        above_sea_m: over mean sea level.
        yaw_deg: of the camera: clockwise from +y of the scene (north), in [0, 360).
        pitch_deg: 0 is level, -90 straight down.
        is_centred: whether they are those to the target's centre. Else all of the target is in the picture with these.
        distance_m: to the target's centre.
        pixel_m: on the target, the largest.
        incidence_deg: between a normal of the target and the line to the position, the largest.
        obstacle_distance_m: to the nearest obstacle of the scene, `obstacle`.
    """

    x: float
    y: float
    z: float
    longitude_deg: float | None
    latitude_deg: float | None
    above_ground_m: float | None
    above_sea_m: float | None
    yaw_deg: float | None
    pitch_deg: float | None
    is_centred: bool | None
    distance_m: float | None
    pixel_m: float | None
    incidence_deg: float | None
    obstacle_distance_m: float | None
    obstacle: str | None

    def to_dict(self) -> dict[str, Any]:
        """All of it, by its names."""
        return dataclasses.asdict(self)


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Standpoint(View):
    """A place to hover at. Besides what a `View` has:

    Attributes:
        target: the name of the target.
        kind: what it is the best at: "deepest", "nearest", "finest_pixel", "best_incidence" or "farthest" from obstacles.
        value: of that: metres, or degrees.
        bound: no position of the volume that keeps the margin has a better value.
        margin_m: how far it is from the volume's boundary, at least.
    """

    target: str
    kind: str
    value: float
    bound: float
    margin_m: float

    @property
    def position(self) -> Numbers:
        """(3,), metres, scene frame."""
        return np.array([self.x, self.y, self.z])


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Orbit:
    """A level closed curve: a circle, or a racetrack of two half circles and two straights. What is not known is None.

    Attributes:
        target: the name of the target.
        kind: what it is the best at: "widest", "deepest" or "finest_pixel".
        shape: "circle" or "racetrack".
        value, bound: of what it is the best at; no orbit that keeps the margin has a better value than `bound`.
        centre: (3,), metres, scene frame; z is the height of the orbit.
        longitude_deg, latitude_deg, above_ground_m, above_sea_m: of the centre.
        radius_m: of the turns.
        straight_m, heading_deg: of a racetrack's straights: the length of each, and clockwise from north.
        clockwise: seen from above.
        length_m: once round.
        margin_m: every point of it is at least so deep inside the volume.
        min_distance_m, max_distance_m, min_pitch_deg, max_pitch_deg: to the target's centre, all round.
        pixel_m, incidence_deg: the largest all round.
        obstacle_distance_m, obstacle: the nearest one all round.
    """

    target: str
    kind: str
    shape: str
    value: float
    bound: float
    centre: Numbers
    longitude_deg: float | None
    latitude_deg: float | None
    above_ground_m: float | None
    above_sea_m: float | None
    radius_m: float
    straight_m: float
    heading_deg: float
    clockwise: bool
    length_m: float
    margin_m: float
    min_distance_m: float
    max_distance_m: float
    min_pitch_deg: float
    max_pitch_deg: float
    pixel_m: float | None
    incidence_deg: float | None
    obstacle_distance_m: float | None
    obstacle: str | None
    _core: _core.Orbit = dataclasses.field(repr=False)
    _map: FrameMap | None = dataclasses.field(repr=False, default=None)

    def flight(self, chord_error_m: float = 0.1) -> Flight:
        """Once round, along chords whose corners lie on the orbit, inside it and at most so far from it."""
        return Flight(self._core.flight(_arrays.number(chord_error_m, "chord_error_m")), self._map)

    def to_dict(self) -> dict[str, Any]:
        """All of it, by its names; the centre as a list."""
        row = {field.name: getattr(self, field.name) for field in dataclasses.fields(self) if not field.name.startswith("_")}
        return {**row, "centre": self.centre.tolist()}


@dataclasses.dataclass(frozen=True)
class Found:
    """What the search in one volume came to.

    Attributes:
        target: its name.
        count: how many were found; they follow those of the searches before.
        margin_m: that all of them keep.
        reason: why there is nothing; else empty.
        notes: of kinds without an answer, and of searches that were cut short.
    """

    target: str
    count: int
    margin_m: float | None
    reason: str
    notes: list[str]


class Standpoints(list[Standpoint]):
    """The standpoints of all targets, in their order.

    Attributes:
        searches: for each target what the search came to, also where nothing was found.
        crs: of x and y: the scene's frame in PROJ's words; None where its place is not known.
    """

    def __init__(self, found: Sequence[Standpoint], searches: list[Found], frame: FrameMap | None):
        super().__init__(found)
        self.searches = searches
        self._map = frame
        self.crs = crs_of(frame)

    @property
    def positions(self) -> _arrays.Points:
        """(n, 3), metres, scene frame."""
        return np.array([one.position for one in self]).reshape(-1, 3)

    def to_dict(self) -> dict[str, Any]:
        """The searches, each with its standpoints."""
        return _as_dict(self, self.searches, "standpoints")

    def to_geodataframe(self) -> Any:
        """A row for each, for geopandas: points with z in the scene's frame, its CRS where its place is known, and the
        attributes of `Standpoint`."""
        columns = ("target", "kind", "value", "bound", "margin_m", *names_of_view())
        rows = [{name: _number_or_nan(name, getattr(one, name)) for name in columns} for one in self]
        points = [require("shapely", "geo").Point(one.x, one.y, one.z) for one in self]
        return table_of(rows, points, self._map, columns)

    def __repr__(self) -> str:
        return f"<vantage.Standpoints: {_counted(self, self.searches)}>"


class Orbits(list[Orbit]):
    """The orbits of all targets, in their order.

    Attributes:
        searches: for each target what the search came to, also where nothing was found.
        crs: of x and y: the scene's frame in PROJ's words; None where its place is not known.
    """

    def __init__(self, found: Sequence[Orbit], searches: list[Found], frame: FrameMap | None):
        super().__init__(found)
        self.searches = searches
        self._map = frame
        self.crs = crs_of(frame)

    def to_dict(self) -> dict[str, Any]:
        """The searches, each with its orbits."""
        return _as_dict(self, self.searches, "orbits")

    def to_geodataframe(self, chord_error_m: float = 0.1) -> Any:
        """A row for each, for geopandas: closed lines with z in the scene's frame, its CRS where its place is known, and the
        attributes of `Orbit`. `chord_error_m`: how far the lines are from the orbits, at most."""
        columns = tuple(field.name for field in dataclasses.fields(Orbit) if field.name[0] != "_" and field.name != "centre")
        rows = [{name: _number_or_nan(name, getattr(one, name)) for name in columns} for one in self]
        lines = [require("shapely", "geo").LineString(one.flight(chord_error_m).positions) for one in self]
        return table_of(rows, lines, self._map, columns)

    def __repr__(self) -> str:
        return f"<vantage.Orbits: {_counted(self, self.searches)}>"


def names_of_view() -> tuple[str, ...]:
    """The names of what a view has, in order."""
    return tuple(field.name for field in dataclasses.fields(View))


def _number_or_nan(name: str, value: Any) -> Any:
    return float("nan") if value is None and name not in ("obstacle", "is_centred") else value


def _counted(found: Sequence[Any], searches: Sequence[Found]) -> str:
    count, targets = len(found), len(searches)
    return f"{count} for {targets} target{'' if targets == 1 else 's'}"


def _as_dict(found: Sequence[Any], searches: Sequence[Found], name: str) -> dict[str, Any]:
    """As --json of the program has it."""
    left = iter(found)
    return {"targets": [{**dataclasses.asdict(search), name: [one.to_dict() for one in itertools.islice(left, search.count)]}
                        for search in searches]}


def _volumes(wanted: Any, threads: int, progress: Progress) -> tuple[list[Result | Error], list[str]]:
    """The results that are meant, and the names of their targets. Those of a mission are computed."""
    if isinstance(wanted, Result):
        return [wanted], [wanted.mission.target_name]
    if isinstance(wanted, list):
        names = []
        for number, one in enumerate(wanted):
            if not isinstance(one, (Result, Error)):
                raise input_error("wrong-type", f"mission[{number}] is {shown(one)}", f"mission[{number}]",
                                  "pass a vt.Mission, a vt.Result, or the list of vt.compute_many")
            names.append(one.mission.target_name if isinstance(one, Result) else f"target[{number}]")
        return list(wanted), names
    mission = mission_of(wanted, progress)
    count = mission._core.count
    names = [mission._core.one(index).target_name for index in range(count)]
    return [mission.run(threads=threads, progress=progress)] if count == 1 else mission._try_each(threads, progress), names


def _searched(results: Sequence[Result | Error], names: Sequence[str], told: list[dict[str, Any]],
              kind: str) -> tuple[list[tuple[str, dict[str, Any]]], list[Found]]:
    """What was found, each with its target; and how each search ended, with the errors of targets in their places."""
    left = iter(told)
    rows: list[tuple[str, dict[str, Any]]] = []
    searches: list[Found] = []
    for one, name in zip(results, names):
        if isinstance(one, Error):
            searches.append(Found(name, 0, None, one.problem, []))
            continue
        row = next(left)
        found = row.get(kind, [])
        searches.append(Found(row["target"], len(found), row["margin_m"], row["reason"], row["notes"]))
        rows += [(row["target"], each) for each in found]
    return rows, searches


def standpoints(mission: Wanted, *, margin_m: float | None = None, tolerance_m: float | None = None,
                most_boxes: int = 200_000, threads: int = 0, progress: Progress = None) -> Standpoints:
    """The best places of volumes to hover at and look at the target: what `vantage stand` finds.

    Each is the best of all positions that keep the margin, to the tolerance, and inside by the exact query too.

    Args:
        mission: a mission, a result, the path of a mission file, or the list of `compute_many`.
        margin_m: how deep inside the volume they are at least. Default: 1 m, less in small volumes.
        tolerance_m: how far values may be from the best. Default: 0.1 m, less in small volumes.
        most_boxes: a search that looks at more ends with a looser `bound`.
        threads: 0: as many as there are. The result does not depend on it.
        progress: called with stage and fraction; False stops.

    Returns:
        a list of `Standpoint`, at most one of each kind for each target, with `searches`.

    Raises:
        Error: a number is out of range.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> result = vt.compute(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> [(one.kind, round(one.value, 1)) for one in vt.standpoints(result, margin_m=2)][:2]
        [('deepest', 24.6), ('nearest', 2.0)]
    """
    count = thread_count(threads)
    options = (_nan_or(margin_m, "margin_m"), _nan_or(tolerance_m, "tolerance_m"), whole(most_boxes, "most_boxes", 1, _MOST_COUNT))
    results, names = _volumes(mission, count, progress)
    good = [one for one in results if isinstance(one, Result)]
    told = json.loads(_core.find_standpoints([one.mission._core for one in good], [one.volume._core for one in good],
                                             *options, count, progress))["targets"]
    rows, searches = _searched(results, names, told, "standpoints")
    found = []
    for target, one in rows:
        x, y, z = one.pop("position")
        found.append(Standpoint(target=target, x=x, y=y, z=z, **one))
    return Standpoints(found, searches, _map_of(good))


def orbits(mission: Wanted, *, least_radius_m: float = 40.0, most_radius_m: float | None = None,
           centre: str = "around_target", margin_m: float | None = None, tolerance_m: float | None = None,
           racetracks: bool = True, clockwise: bool = True, most_boxes: int = 20_000, threads: int = 0,
           progress: Progress = None) -> Orbits:
    """Level circles wholly inside volumes, to fly on while the target stays in view: what `vantage orbit` finds.

    Each is the best of all heights, centres and radii that keep the margin, to the tolerance.

    Args:
        mission: a mission, a result, the path of a mission file, or the list of `compute_many`.
        least_radius_m: the smallest that the vehicle can turn with.
        most_radius_m: the largest to look for. Default: any.
        centre: "around_target": the target's centre lies within; "over_target"; "anywhere".
        margin_m: how deep inside the volume all of an orbit is at least. Default: 1 m, less in small volumes.
        tolerance_m: how far radii and margins may be from the best. Default: 1 m, less in small volumes.
        racetracks: look for one where no circle fits.
        clockwise: which way round, seen from above.
        most_boxes: a search that looks at more ends with a looser `bound`.
        threads: 0: as many as there are. The result does not depend on it.
        progress: called with stage and fraction; False stops.

    Returns:
        a list of `Orbit`, at most one of each kind for each target, with `searches`.

    Raises:
        Error: a number is out of range.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> result = vt.compute(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> found = vt.orbits(result, least_radius_m=10)
        >>> [one.kind for one in found], found[0].shape
        (['widest', 'deepest'], 'circle')
    """
    count = thread_count(threads)
    most = np.inf if most_radius_m is None else _arrays.number(most_radius_m, "most_radius_m")
    options = (_arrays.number(least_radius_m, "least_radius_m"), most, choice(centre, "centre", CENTRES),
               _nan_or(margin_m, "margin_m"), _nan_or(tolerance_m, "tolerance_m"), flag(racetracks, "racetracks"),
               flag(clockwise, "clockwise"), whole(most_boxes, "most_boxes", 1, _MOST_COUNT))
    results, names = _volumes(mission, count, progress)
    good = [one for one in results if isinstance(one, Result)]
    text, cores = _core.find_orbits([one.mission._core for one in good], [one.volume._core for one in good], *options, count,
                                    progress)
    left, frame = iter(cores), _map_of(good)
    rows, searches = _searched(results, names, json.loads(text)["targets"], "orbits")
    found = []
    for target, one in rows:
        place = np.array(one.pop("centre"))
        found.append(Orbit(target=target, centre=place, _core=next(left), _map=frame, **one))
    return Orbits(found, searches, frame)


def _nan_or(value: float | None, name: str) -> float:
    return float("nan") if value is None else _arrays.number(value, name)


def _map_of(results: Sequence[Result]) -> FrameMap | None:
    """Of all of them; None where they are of different places."""
    known = {one.scene._map for one in results}
    return known.pop() if len(known) == 1 else None


def described(missions: Sequence[Mission], positions: Sequence[_arrays.Points], progress: Progress = None) -> list[View]:
    """Of each mission the views from its positions, in the order of the missions."""
    columns = _core.describe_views([one._core for one in missions], list(positions), progress)
    places = np.concatenate([np.zeros((0, 3)), *positions])
    views = []
    for row, (x, y, z) in enumerate(places.tolist()):
        values = {name: _plain(name, column[row]) for name, column in columns.items()}
        views.append(View(x=x, y=y, z=z, **values))
    return views


def _plain(name: str, value: Any) -> Any:
    if name == "obstacle":
        return value
    if name == "is_centred":
        return bool(value)
    return None if np.isnan(value) else float(value)
