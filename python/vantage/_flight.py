"""Flights along straight legs, and the plans of ground stations that they come from."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Protocol, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import choice, flag, not_called, path as checked_path, shown, text
from ._errors import input_error, not_pickled
from ._extras import require
from ._mesh import Note
from ._place import FrameMap, crs_of
from ._progress import Progress
from ._requests import Path
from ._result import Mission, Result

Numbers = npt.NDArray[np.float64]
AnyMission = Union[Mission, Result, Path]
"""A mission, a result, whose mission is meant, or the path of a mission file."""

HEIGHTS = ("sea", "ellipsoid", "ground", "home", "scene")


class Flight:
    """A flight along straight legs, in the scene's frame.

    Example:
        >>> import vantage as vt
        >>> flight = vt.Flight.of([[-40, -30, 45], [40, -30, 45], [40, 30, 45]], speed_m_s=5)
        >>> flight
        <vantage.Flight: 3 points, 140.0 m>
        >>> flight.at(100)
        array([ 40., -10.,  45.])
    """

    def __init__(self, core: _core.Flight, frame: FrameMap | None = None):
        not_called(core, _core.Flight, "vt.Flight", "make one with vt.Flight.of, or read a plan with vt.Flight.read")
        self._core = core
        self._map = frame
        self.crs = crs_of(frame)
        """of x and y: the scene's frame in PROJ's words; None where its place is not known"""

    @classmethod
    def of(cls, positions: npt.ArrayLike, *, speed_m_s: npt.ArrayLike | None = None, hold_s: npt.ArrayLike = 0.0) -> Flight:
        """Of positions in the scene's frame.

        Args:
            positions: (n, 3), metres.
            speed_m_s: of the leg that ends at each position, (n,), or one number for all. Default: not stated.
            hold_s: for so long it stays at each position, (n,), or one number for all.
        """
        points = _arrays.points(positions, "positions")
        speeds = np.full(len(points), np.nan) if speed_m_s is None else _one_for_each(speed_m_s, len(points), "speed_m_s")
        return cls(_core.flight_from_arrays(points, _one_for_each(hold_s, len(points), "hold_s"), speeds))

    @classmethod
    def read(cls, mission: AnyMission, path: Path, *, track: str = "", home: npt.ArrayLike | None = None,
             home_z_m: float | None = None, undulation_m: float | None = None, heights: str | None = None,
             height_m: float | None = None, return_height_m: float | None = None, loiter_radius_m: float | None = None,
             ground_legs: bool = False, progress: Progress = None) -> Flight:
        """Reads a plan of a ground station into the scene of a mission (docs/flight-plans.md). The arguments are what plans may
        leave open.

        Args:
            mission: a mission, a result, or the path of a mission file.
            path: .plan of QGroundControl, .waypoints, KML, KMZ (of DJI, too), GPX, GeoJSON or CSV.
            track: of several tracks, lines or routes the name or the number of the one that is meant.
            home: (latitude, longitude) of the place of takeoff, where the plan does not say; (x, y) of a plan in the scene's
                frame.
            home_z_m: its z in the scene. Default: that of the ground there.
            undulation_m: how high the mean sea level lies above the ellipsoid there.
            heights: what heights of an unknown level are measured from: "sea", "ellipsoid", "ground", "home" or "scene".
            height_m: of all positions that have none, above `heights`.
            return_height_m: of the way back to the home, above it.
            loiter_radius_m: of circles for which the plan leaves it to the vehicle.
            ground_legs: with the climb from the home and the descent to it.
            progress: called with stage and fraction; False stops.

        Raises:
            Error: the file is no plan, or leaves something open: it says what to give.
        """
        of = mission_of(mission)
        place = None if home is None else _arrays.numbers(home, "home")
        if place is not None and (place.shape != (2,) or not np.isfinite(place).all()):
            raise input_error("value-syntax", "home must be 2 numbers", "home", "pass (latitude, longitude)")
        core = of._call(lambda: _core.read_plan(
            of._core, checked_path(path), text(track, "track"), None if place is None else place.tolist(),
            _number(home_z_m, "home_z_m"), _number(undulation_m, "undulation_m"),
            None if heights is None else choice(heights, "heights", HEIGHTS), _number(height_m, "height_m"),
            _number(return_height_m, "return_height_m"), _number(loiter_radius_m, "loiter_radius_m"),
            flag(ground_legs, "ground_legs"), progress))
        return cls(core, of.scene._map)

    @property
    def positions(self) -> _arrays.Points:
        """(n, 3) float64, metres, in the scene's frame: where legs meet. Read-only."""
        return self._core.positions

    @property
    def hold_s(self) -> Numbers:
        """(n,): for so long it stays there."""
        return self._core.hold_s

    @property
    def speed_m_s(self) -> Numbers:
        """(n,): of the leg that ends there; NaN where it is not stated."""
        return self._core.speed_m_s

    @property
    def at_m(self) -> Numbers:
        """(n,): how far along the flight each position is."""
        steps = np.linalg.norm(np.diff(self.positions, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)]) if len(self) else np.zeros(0)

    @property
    def length_m(self) -> float:
        """Of all legs."""
        return self._core.length_m

    @property
    def chord_error_m(self) -> float:
        """The legs lie at most so far from the curves that they stand for."""
        return self._core.chord_error_m

    @property
    def notes(self) -> list[Note]:
        """What was left out of the plan, joined or taken for granted."""
        return [Note(*row) for row in self._core.notes]

    def at(self, distance_m: npt.ArrayLike) -> Numbers:
        """The position so far along the flight: (3,), or (k, 3) for (k,) distances."""
        distances = _arrays.numbers(distance_m, "distance_m")
        flat = distances if np.ndim(distance_m) else distances.reshape(-1)[:1]
        columns = [np.interp(flat, self.at_m, self.positions[:, axis]) for axis in range(3)]
        places = np.column_stack(columns)
        return places if np.ndim(distance_m) else places[0]

    def between(self, begin_m: float, end_m: float) -> Numbers:
        """The corners of the part from one distance to another: (k, 3); a single one where they are the same."""
        along = self.at_m
        corners = self.positions[(along > begin_m) & (along < end_m)]
        ends = self.at([begin_m, end_m])
        return ends[:1] if begin_m >= end_m else np.concatenate([ends[:1], corners, ends[1:]])

    def to_geodataframe(self) -> Any:
        """A row for each leg, for geopandas: lines with z in the scene's frame, its CRS where its place is known, and leg,
        begin_m, end_m, speed_m_s, hold_s (at its end)."""
        along, holds, speeds = self.at_m, self.hold_s, self.speed_m_s
        rows = [{"leg": i, "begin_m": along[i], "end_m": along[i + 1], "speed_m_s": speeds[i + 1], "hold_s": holds[i + 1]}
                for i in range(len(self) - 1)]
        lines = [line_of(self.positions[i:i + 2]) for i in range(len(self) - 1)]
        return table_of(rows, lines, self._map, ("leg", "begin_m", "end_m", "speed_m_s", "hold_s"))

    def __len__(self) -> int:
        return len(self.positions)

    def __reduce__(self) -> Any:
        raise not_pickled("a flight", "pickle its positions, hold_s and speed_m_s, and make it again with vt.Flight.of")

    def __repr__(self) -> str:
        count = len(self)
        return f"<vantage.Flight: {count} point{'' if count == 1 else 's'}, {self.length_m:,.1f} m>"


class HasFlight(Protocol):
    """A tour, and whatever else has a flight."""

    @property
    def flight(self) -> Flight: ...


class MakesFlight(Protocol):
    """An orbit, and whatever else can be flown."""

    def flight(self) -> Flight: ...


AnyFlight = Union[Flight, HasFlight, MakesFlight, Path, npt.ArrayLike]
"""A flight, what has one, the path of a plan, or (n, 3) positions."""


def _number(value: float | None, name: str) -> float | None:
    return None if value is None else _arrays.number(value, name)


def _one_for_each(values: npt.ArrayLike, count: int, name: str) -> Numbers:
    array = _arrays.numbers(values, name)
    if np.ndim(values) == 0:
        return np.full(count, array.reshape(-1)[0])
    if array.shape != (count,):
        raise input_error("array-sizes-differ", f"{name} has the shape {array.shape}", name, f"pass ({count},), or one number")
    return array


def mission_of(mission: Any, progress: Progress = None) -> Mission:
    """What is meant by a mission, a result, or the path of a mission file."""
    if isinstance(mission, Mission):
        return mission
    if isinstance(mission, Result):
        return mission.mission
    if isinstance(mission, (str, os.PathLike)):
        return Mission.read(mission, progress)
    raise input_error("wrong-type", f"mission is {shown(mission)}", "mission",
                      "pass a vt.Mission, a vt.Result, or the path of a mission file")


def flight_of(mission: Mission, plan: Any, options: Mapping[str, Any], progress: Progress = None) -> Flight:
    """The flight that is meant. `options`: of `Flight.read`, for a path alone."""
    given = {key: value for key, value in options.items()
             if not (value is None or value is False or isinstance(value, str) and value == "")}
    if isinstance(plan, (str, os.PathLike)):
        return Flight.read(mission, plan, **given, progress=progress)
    if given:
        key = next(iter(given))
        raise input_error("not-applicable", f"{key} is of the file of a plan, and none is given", key, "leave it out")
    if isinstance(plan, Flight):
        return plan
    found = getattr(plan, "flight", None)
    if isinstance(found, Flight):
        return found
    if callable(found):
        made = found()
        if isinstance(made, Flight):
            return made
    return Flight.of(plan)


def line_of(points: Numbers) -> Any:
    """A LineString with z of shapely, or the Point that all of it is."""
    shapely = require("shapely", "geo")
    return shapely.Point(points[0]) if len(points) == 1 or not np.any(np.ptp(points, axis=0)) else shapely.LineString(points)


def table_of(rows: list[dict[str, Any]], geometry: list[Any], frame: FrameMap | None, columns: tuple[str, ...]) -> Any:
    """A GeoDataFrame, also of no rows, of geometries of a scene's frame on its map."""
    crs = crs_of(frame)
    if frame is not None:
        geometry = frame.on_map(geometry)
    return require("geopandas", "geo").GeoDataFrame(rows, columns=[*columns], geometry=geometry, crs=crs)
