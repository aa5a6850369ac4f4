"""One flight that sees every target of a mission, and a bound that none is shorter."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._check import FlightCheck, check
from ._checks import flag, items, path as checked_path, shown, text as checked_text, thread_count, whole
from ._errors import input_error, not_pickled
from ._flight import AnyMission, Flight, Numbers, line_of, mission_of, table_of
from ._positions import Positions
from ._progress import Progress
from ._render import html
from ._requests import Path, TourSettings, keys_of
from ._result import Mission
from ._text import NAME, Text


class Visit(NamedTuple):
    """When a target is in view: in its volume, by the margin at least."""

    target: int
    """index in `Tour.targets`"""
    name: str
    """of the target"""
    first_point: int
    """index in `Tour.positions`: from this point to the last one; hovering there where they are the same"""
    last_point: int
    begin_m: float
    """along the flight"""
    end_m: float
    dwell_s: float
    """so long at least"""


class LeftOut(NamedTuple):
    """A target that cannot be visited, and why."""

    target: int
    """index in `Tour.targets`"""
    name: str
    kind: str
    """"no_place": no position of its volume may be flown to; "no_way": no way to it was found"""
    neighbour: int | None
    """no way from or to this target; None: the home"""
    obstacle: str
    """what stands there; may be empty"""


class TourBound(NamedTuple):
    """What no tour can be shorter than. Where there is a home: no tour that begins where this one does, straight above it."""

    length_m: float
    gap: float
    """(length - bound) / length of the tour that was found"""
    kind: str
    """"insertion" or "pairs": docs/theory.md"""
    ignored: list[str]
    """what makes tours longer, and the bound does not know"""
    time_s: float
    """no tour takes less time: the length at full speed or, where targets are viewed one after the other, all dwells, whichever
    is more; speeding up and hovering besides are ignored"""


class Tour:
    """A flight that sees the targets of a mission, each from inside its volume.

    Attributes:
        mission: with each of its targets by itself.
        flight: a `Flight`.
        length_m, time_s: of the flight.
        targets: names, in the order of the mission.
        order: indices of targets, as they are visited, without those that are left out.
        visits: when which target is in view, a `Visit` each, in the order of their beginning.
        left_out: targets that cannot be visited, a `LeftOut` each.
        bound: a `TourBound`; None where it was not asked for, or nothing can be visited.
        home: (3,), on the ground, scene frame; None: the tour begins anywhere.
        vehicle: "multirotor" or "fixed_wing".
        end: how the search ended: "done", or "time_limit": the best that was found until then.
        notes: what to know before relying on it.
    """

    def __init__(self, core: _core.Tour, scene_of: Mission):
        self._core = core
        self.mission = scene_of
        self.flight = Flight(core.flight, scene_of.scene._map)
        self.length_m: float = core.length_m
        self.time_s: float = core.time_s
        self.targets: list[str] = core.targets
        self.order: list[int] = core.order
        self.visits = [Visit(row[0], self.targets[row[0]], *row[1:]) for row in core.visits]
        self.left_out = [LeftOut(row[0], self.targets[row[0]], *row[1:]) for row in core.problems]
        bound = core.bound
        self.bound: TourBound | None = None if bound is None else TourBound(*bound)
        home = core.home
        self.home: Numbers | None = None if home is None else np.array(home)
        self.vehicle: str = core.vehicle
        self.end: str = core.end
        self.notes: list[str] = core.notes

    @property
    def positions(self) -> _arrays.Points:
        """(n, 3), metres, scene frame: where the legs of the flight meet."""
        return self.flight.positions

    @property
    def is_complete(self) -> bool:
        """Whether all targets are visited."""
        return not self.left_out

    @property
    def reaches_gap(self) -> bool:
        """Whether the gap that the settings ask for, or 0.01, was reached."""
        return self.bound is not None and self.bound.gap <= self._core.asked_gap

    def write(self, path: Path, *, aircraft: Sequence[int] | None = None, undulation_m: float | None = None,
              start: str | None = None) -> list[str]:
        """Writes a plan for ground stations, by the path's extension: .plan, .waypoints, .kml, .kmz (DJI's), .gpx, .geojson or
        .csv; or .czml, which Cesium shows; whole or not at all. With a photo where each target is seen, yaw and gimbal pitch.

        Args:
            path: the file.
            aircraft: for .kmz: type, subtype and camera, as DJI numbers them: (77, 0, 66) is the Mavic 3E. Without it that of
                the mission's camera, where `vt.cameras()` knows it.
            undulation_m: how high the mean sea level lies above the ellipsoid there: GeoJSON and CZML have heights
                above the ellipsoid.
            start: for .czml: when the flight begins, "2026-06-21T16:00Z"; without it "2026-01-01T00:00Z".

        Returns:
            What to know before relying on it: what the format does not hold, and which ways are not of the tour.

        Raises:
            Error: the scene has no place on the earth, and the file is no .csv; the format needs a home; it cannot be written.
        """
        undulation = None if undulation_m is None else _arrays.number(undulation_m, "undulation_m")
        return self._core.write(checked_path(path), None if aircraft is None else _aircraft(aircraft), undulation,
                                None if start is None else checked_text(start, "start"))

    def write_certificate(self, path: Path) -> None:
        """Writes what proves the bound, for tools/check_tour.py, and the outer volumes beside it. Raises Error without a bound."""
        self._core.write_certificate(checked_path(path))

    def check(self, *, tube_m: float = 0.0, threads: int = 0, progress: Progress = None) -> FlightCheck:
        """What `vt.check` says of the flight, by what the settings of the tour ask for."""
        return check(self.mission, self.flight, tube_m=tube_m, threads=threads, progress=progress)

    def to_dict(self) -> dict[str, Any]:
        """What `vantage tour --json` prints."""
        return json.loads(self._core.json())

    def to_geodataframe(self) -> Any:
        """A row for each leg, for geopandas: lines with z in the scene's frame, its CRS where its place is known, and leg, begin_m,
        end_m, hold_s (at its end), sees: the names of the targets that are in view on all of it or at its end."""
        along, holds = self.flight.at_m, self.flight.hold_s
        rows, lines = [], []
        for i in range(len(self.flight) - 1):
            sees = [visit.name for visit in self.visits if visit.first_point <= i + 1 <= visit.last_point]
            rows.append({"leg": i, "begin_m": along[i], "end_m": along[i + 1], "hold_s": holds[i + 1], "sees": ", ".join(sees)})
            lines.append(line_of(self.positions[i:i + 2]))
        return table_of(rows, lines, self.flight._map, ("leg", "begin_m", "end_m", "hold_s", "sees"))

    def __reduce__(self) -> Any:
        raise not_pickled("a tour", "pickle what to_dict returns, or write a plan")

    def __repr__(self) -> str:
        text = f"{len(self.order)} of {len(self.targets)} targets, {self.length_m:,.1f} m"
        if self.bound is not None:
            text += f", none is shorter than {self.bound.length_m:,.1f} m"
        return f"<vantage.Tour: {text}>"

    def _repr_html_(self) -> str:
        return html(self)


def _aircraft(numbers: Sequence[int]) -> list[int]:
    """Type, subtype and, where it is given, camera."""
    each = [whole(number, "aircraft", most=2**31 - 1) for number in items(numbers, "aircraft", "numbers")]
    if len(each) not in (2, 3):
        raise input_error("value-syntax", f"{shown(numbers)} is not an aircraft of DJI", "aircraft",
                          "give the numbers of its type and subtype, and of its camera: (77, 0, 66) is the Mavic 3E")
    return each


def _given(positions: Positions | npt.ArrayLike | None) -> _arrays.Points | None:
    """Of each target the position that it is viewed from."""
    if positions is None:
        return None
    if not isinstance(positions, Positions):
        return _arrays.points(positions, "positions")
    if positions.unseen:
        raise input_error("not-applicable", f"no position sees the targets {', '.join(map(str, positions.unseen))}", "positions",
                          "leave them out of the mission")
    return np.ascontiguousarray(positions.positions[positions.assigned])


def tour(mission: AnyMission, settings: TourSettings | Mapping[str, Any] | None = None, *,
         positions: Positions | npt.ArrayLike | None = None, bound: bool = True, threads: int = 0,
         progress: Progress = None) -> Tour:
    """The shortest flight that is found through the volumes of all targets, and a bound: no flight that sees them is shorter.

    Every leg keeps the clearance and the limits of navigation, and every visit is checked against the volume itself. The bound
    is over outer volumes, which hold every position from which a target is seen (docs/flight.md).

    Args:
        mission: a mission, a result, or the path of a mission file. Each of its targets is visited, whatever `combine` says.
        settings: a `TourSettings`, or a dictionary of its keys, instead of what the mission says itself.
        positions: from where each target is viewed: what `fewest_positions` found for the same targets in the same order, or
            (n, 3), metres, one for each. They lie in the volumes by 1 cm at least, and visits within 1 cm of them; the margin of
            the settings is not looked at, and a note says where the tube is not kept. Default: the tour finds them itself, and is
            shorter.
        bound: whether to compute the bound, which takes longer than the tour.
        threads: 0: as many as there are.
        progress: called with stage and fraction; False stops.

    Returns:
        the tour. A target that cannot be visited is no error: see `Tour.left_out`.

    Raises:
        Error: a setting is out of range; a target can be seen from nowhere; above the home nothing may be flown to.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]],
        ...                               objects=[vt.SceneObject("lawn", kind="ground")])
        >>> squares = [[[x, 0, 0], [x + 4, 0, 0], [x + 4, 4, 0], [x, 4, 0]] for x in (-60, 0, 60)]
        >>> mission = vt.Mission.of(ground, squares, max_range=20, navigation=vt.Navigation(altitude=(5, 15)))
        >>> flight = vt.tour(mission, {"view": {"dwell": 1}, "gap": 0.05})
        >>> sorted(flight.order), flight.left_out, flight.bound.length_m <= flight.length_m
        ([0, 1, 2], [], True)
    """
    count, with_bound, views = thread_count(threads), flag(bound, "bound"), _given(positions)
    of = mission_of(mission, progress)
    text = Text()
    text.add("target", {"point": [0, 0, 0]})  # a mission's text has these, too
    text.add("sensor", {"max_range": 1})
    if settings is not None:
        text.add("tour", keys_of(settings, TourSettings, "settings"), "settings")
    given = None if settings is None else text.text()

    def work() -> tuple[_core.Mission, _core.Tour]:
        each = _core.for_flights(of._core, given, NAME, progress)
        return each, _core.plan_tour(each, with_bound, views, count, progress)

    each, core = of._call(work) if settings is None else text.call(work)
    return Tour(core, Mission(each, of._scene, of._text))
