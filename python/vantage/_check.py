"""What a flight sees, how near to what it comes, and which limits it breaks."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import path as checked_path, thread_count
from ._errors import make, not_pickled
from ._flight import AnyFlight, AnyMission, Flight, Numbers, flight_of, line_of, mission_of, table_of
from ._folders import replace_file, write_text
from ._progress import Progress
from ._render import html, plot
from ._requests import Path
from ._result import Mission
from ._text import NAME


class Span(NamedTuple):
    """A stretch of a flight."""

    begin_m: float
    """along the flight, from its first point"""
    end_m: float
    begin_s: float
    """since its beginning, with what it stays at the points; NaN where a speed is missing"""
    end_s: float
    begin: Numbers
    """(3,), metres, scene frame"""
    end: Numbers

    @property
    def length_m(self) -> float:
        """Along the flight."""
        return self.end_m - self.begin_m

    @property
    def duration_s(self) -> float:
        """NaN where a speed is missing."""
        return self.end_s - self.begin_s


class NotSeen(NamedTuple):
    """Why all of a target is not seen, and where."""

    kind: str
    """"hidden" by an object of the scene, "out_of_range", "behind" the target, a "limit" of the sensor, or "outside" a
    volume to fly through"""
    name: str
    """of the object, or of the limit; else empty"""
    spans: list[Span]
    """sorted; apart"""

    @property
    def length_m(self) -> float:
        """Of all spans."""
        return float(sum(span.length_m for span in self.spans))


class GimbalUse(NamedTuple):
    """How the camera must look to keep a target's centre along one stretch. Pitch: 0 level, -90 straight down."""

    min_pitch_deg: float
    max_pitch_deg: float
    begin_yaw_deg: float
    """clockwise from north"""
    end_yaw_deg: float
    rate_deg_s: float
    """the fastest turn of the line of sight; NaN where a speed is missing"""


class TargetCheck(NamedTuple):
    """One target along the flight."""

    name: str
    is_volume: bool
    """it is a volume to fly through: then `seen` is where the flight is inside it, and there is no gimbal"""
    centre: Numbers
    """(3,), metres, scene frame"""
    seen: list[Span]
    """all of it is seen, within all limits of the sensor; sorted, apart"""
    longest: Span | None
    """of `seen`: the longest in time, or in length where times are not known"""
    not_seen: list[NotSeen]
    """the longest first"""
    gimbal: GimbalUse | None
    """along the longest stretch"""
    followed: Span | None
    """where a rate of the gimbal is asked: the longest stretch in time on which all is seen and the line of sight to the centre
    turns no faster"""

    @property
    def seen_m(self) -> Numbers:
        """(k, 2): where the stretches begin and end along the flight."""
        return np.array([(span.begin_m, span.end_m) for span in self.seen]).reshape(-1, 2)

    @property
    def seen_s(self) -> Numbers:
        """(k, 2): when they begin and end; NaN where a speed is missing."""
        return np.array([(span.begin_s, span.end_s) for span in self.seen]).reshape(-1, 2)


class LinkCheck(NamedTuple):
    """A link of the mission along the flight: the line of sight from its point to the vehicle, and the zone of a radio link where
    the mission asks for one."""

    name: str
    point: Numbers
    """(3,), metres, scene frame: where it begins"""
    max_range_m: float | None
    """None: as far as it is free"""
    frequency_ghz: float | None
    """of the radio link, whose zone is kept free; None: the line of sight alone"""
    clear: float | None
    """the share of the radius of the first Fresnel zone that is kept free; None: the line of sight alone"""
    linked: list[Span]
    """in range, and nothing is in the way; sorted, apart"""
    lost: list[Span]
    """all else; sorted, apart"""
    reasons: list[NotSeen]
    """why it is lost: "hidden" by an object, or "out_of_range"; the longest first"""
    farthest_m: float
    """from the point, of any position of the tube"""
    farthest_at_m: float
    """along the flight"""
    farthest_at: Numbers
    """(3,), of the flight"""

    @property
    def holds(self) -> bool:
        """Whether it is lost nowhere."""
        return not self.lost

    @property
    def linked_m(self) -> Numbers:
        """(k, 2): where the stretches begin and end along the flight."""
        return np.array([(span.begin_m, span.end_m) for span in self.linked]).reshape(-1, 2)


class BrokenLimit(NamedTuple):
    """A limit of navigation that the flight breaks."""

    name: str
    spans: list[Span]
    """sorted; apart"""
    worst: float
    """by how much, at worst; infinite where no number tells it"""
    unit: str
    """of `worst`: "m" or "degrees"."""
    worst_at_m: float
    """along the flight"""
    worst_at: Numbers
    """(3,), metres, scene frame"""


class NearestPass(NamedTuple):
    """Where the flight is nearest to the scene, but for its ground."""

    distance_m: float
    """less the tube's radius; not below 0"""
    at_m: float
    """along the flight"""
    position: Numbers
    """(3,), of the flight"""
    point: Numbers
    """(3,), of the scene"""
    object: str


class FlightCheck:
    """What `check` found. It is exact along straight legs, and holds for every position within `tube_m` of the flight.

    Attributes:
        mission: the mission, each of its targets by itself.
        flight: what was judged: its positions are (n, 3) metres in the scene's frame.
        targets: a `TargetCheck` for each target.
        links: a `LinkCheck` for each of the mission's `links`.
        broken: limits of navigation that are broken, a `BrokenLimit` each.
        nearest: where it comes nearest to the scene, but for its ground; None where there is nothing to come near to.
        failures: what is required and does not hold, a sentence each.
        not_judged: what the plan holds that moves the vehicle and could not be followed, a sentence each: then nothing passes.
        notes: what to know before relying on it, a sentence each.
        length_m, duration_s: of the flight; the duration is NaN where a speed is missing.
        tube_m: all is said for every position so near to the flight; with `Flight.chord_error_m`.
        at_m, arrival_s: (n,), how far along the flight each of its points is, and when it is reached.
    """

    def __init__(self, core: _core.FlightCheck, mission: Mission, flight: Flight):
        self._core = core
        self.mission = mission
        self.flight = flight
        self.targets: list[TargetCheck] = [_target(row) for row in core.targets]
        self.links: list[LinkCheck] = [
            LinkCheck(name, np.array(point), most, frequency, clear, _spans(linked), _spans(lost), _reasons(reasons), farthest, at_m,
                      np.array(at))
            for name, point, most, frequency, clear, linked, lost, reasons, farthest, at_m, at in core.links]
        self.broken: list[BrokenLimit] = [
            BrokenLimit(name, _spans(spans), worst, unit, at_m, np.array(at))
            for name, spans, worst, unit, at_m, at in core.broken]
        near = core.nearest
        self.nearest: NearestPass | None = None if near is None else NearestPass(
            near[0], near[1], np.array(near[2]), np.array(near[3]), near[4])
        self.failures: list[str] = core.failures
        self.not_judged: list[str] = core.not_judged
        self.notes: list[str] = core.notes
        self.length_m: float = core.length_m
        self.duration_s: float = core.duration_s
        self.tube_m: float = core.tube_radius_m
        self.at_m: Numbers = core.point_at_m
        self.arrival_s: Numbers = core.arrival_s

    @property
    def passes(self) -> bool:
        """Whether all that is required holds, of all that the plan flies."""
        return not self.failures and not self.not_judged

    def to_dict(self) -> dict[str, Any]:
        """What `vantage check --json` prints."""
        return json.loads(self._core.json())

    def save(self, path: Path) -> None:
        """Writes .json, what `to_dict` returns, or .csv, a row for each stretch; whole or not at all."""
        file = checked_path(path)
        if not file.endswith((".json", ".csv")):
            raise make("output", "output-format-unknown", "a check is written as .json or .csv", file,
                       "give a name that ends so", None)
        told = self._core.json() if file.endswith(".json") else self._core.csv()
        replace_file(file, lambda draft: write_text(draft, told))

    def to_geodataframe(self) -> Any:
        """A row for each stretch, for geopandas: lines with z in the scene's frame (points where it hovers), its CRS where its
        place is known, and target, state ("seen", "hidden", "out_of_range", "behind", "limit", "outside"; of a link, whose name
        stands for the target, "linked", "link_hidden", "link_out_of_range"; "broken"), what (the object or the limit), begin_m,
        end_m, begin_s, end_s."""
        rows: list[dict[str, Any]] = []
        lines: list[Any] = []
        for target, state, what, span in self._stretches():
            rows.append({"target": target, "state": state, "what": what, "begin_m": span.begin_m, "end_m": span.end_m,
                         "begin_s": span.begin_s, "end_s": span.end_s})
            lines.append(line_of(self.flight.between(span.begin_m, span.end_m)))
        return table_of(rows, lines, self.mission.scene._map,
                        ("target", "state", "what", "begin_m", "end_m", "begin_s", "end_s"))

    def _stretches(self) -> list[tuple[str, str, str, Span]]:
        rows = []
        for target in self.targets:
            rows += [(target.name, "seen", "", span) for span in target.seen]
            rows += [(target.name, reason.kind, reason.name, span) for reason in target.not_seen for span in reason.spans]
        for link in self.links:
            rows += [(link.name, "linked", "", span) for span in link.linked]
            rows += [(link.name, f"link_{reason.kind}", reason.name, span) for reason in link.reasons for span in reason.spans]
        return rows + [("", "broken", limit.name, span) for limit in self.broken for span in limit.spans]

    def plot(self, path: Path | None = None, *, size: tuple[int, int] = (1200, 800)) -> Any:
        """The flight's profile by matplotlib (the extra `plot`): its height over the distance, the ground below it where the
        scene has some, and for each target a strip that tells when it is seen, and why not elsewhere.

        Args:
            path: where to write it, as PNG, SVG or PDF. Without it the figure is one of matplotlib.pyplot: a notebook shows it.
            size: pixels, width and height.

        Returns:
            the matplotlib.figure.Figure.
        """
        return plot(self, path, size=size)

    def __reduce__(self) -> Any:
        raise not_pickled("a check", "pickle what to_dict returns")

    def __repr__(self) -> str:
        seen = sum(bool(target.seen) for target in self.targets)
        text = "not judged as a whole" if self.not_judged else "passes" if self.passes else (
            f"{len(self.failures)} failure{'' if len(self.failures) == 1 else 's'}")
        reached = "seen whole or flown through" if any(target.is_volume for target in self.targets) else "seen whole"
        return f"<vantage.FlightCheck: {self.length_m:,.1f} m, {seen} of {len(self.targets)} targets {reached}, {text}>"

    def _repr_html_(self) -> str:
        return html(self)


def _spans(rows: Any) -> list[Span]:
    return [Span(row[0], row[1], row[2], row[3], np.array(row[4]), np.array(row[5])) for row in rows]


def _reasons(rows: Any) -> list[NotSeen]:
    return [NotSeen(kind, what, _spans(where)) for kind, what, where in rows]


def _target(row: Any) -> TargetCheck:
    name, is_volume, centre, seen, longest, not_seen, gimbal, followed = row
    spans = _spans(seen)
    return TargetCheck(name, is_volume, np.array(centre), spans, None if longest is None else spans[longest],
                       _reasons(not_seen),
                       None if gimbal is None else GimbalUse(*gimbal), next(iter(_spans(followed)), None))


def check(mission: AnyMission, plan: AnyFlight, *, tube_m: float = 0.0, speed_m_s: float | None = None,
          dwell_s: float | None = None, clearance_m: float | None = None, gimbal_rate_deg_s: float | None = None,
          track: str = "", home: npt.ArrayLike | None = None, home_z_m: float | None = None,
          undulation_m: float | None = None, heights: str | None = None, height_m: float | None = None,
          return_height_m: float | None = None, loiter_radius_m: float | None = None, ground_legs: bool = False,
          threads: int = 0, progress: Progress = None) -> FlightCheck:
    """Judges a flight by what a mission asks: when is all of each target seen, which limits are broken, how near is what.

    Exact along straight legs; rounding errs on the safe side. With several targets each is judged by itself. Whatever is
    asked, a flight fails that meets an object, lies inside a solid or is below the ground.

    Args:
        mission: a mission, a result, or the path of a mission file. What its `tour` says counts where nothing is given here.
        plan: the path of a plan (docs/flight-plans.md), (n, 3) positions in the scene's frame, a `Flight`, a `Tour` or an
            `Orbit`.
        tube_m: all must hold for every position so near to the flight: acceptance radius, wind, position error.
        speed_m_s: of legs for which the plan states none.
        dwell_s: each target must be seen for so long without a break.
        clearance_m: the smallest distance from the scene, but for its ground.
        gimbal_rate_deg_s: the camera turns at most so fast; it must be able to follow each target for the dwell.
        track, home, home_z_m, undulation_m, heights, height_m, return_height_m, loiter_radius_m, ground_legs: of the file of
            a plan: see `Flight.read`.
        threads: 0: as many as there are. The result does not depend on it.
        progress: called with stage and fraction; False stops.

    Returns:
        what was found. A flight that fails is no error: see `FlightCheck.passes`.

    Raises:
        Error: the plan cannot be read, or leaves something open; a number is out of range; a dwell is asked of a flight
            without speeds.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> mission = vt.Mission.of(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> found = vt.check(mission, [[-80, 4, 20], [80, 4, 20]], speed_m_s=5)
        >>> found
        <vantage.FlightCheck: 160.0 m, 1 of 1 targets seen whole, passes>
        >>> found.targets[0].seen_m.round(1).tolist()
        [[43.4, 125.6]]
        >>> [(reason.kind, round(reason.length_m, 1)) for reason in found.targets[0].not_seen]
        [('out_of_range', 77.9)]
    """
    count = thread_count(threads)
    speed, dwell, clearance, rate = [None if value is None else _arrays.number(value, name) for name, value in (
        ("speed_m_s", speed_m_s), ("dwell_s", dwell_s), ("clearance_m", clearance_m),
        ("gimbal_rate_deg_s", gimbal_rate_deg_s))]
    tube = _arrays.number(tube_m, "tube_m")
    of = mission_of(mission, progress)
    flight = flight_of(of, plan, {
        "track": track, "home": home, "home_z_m": home_z_m, "undulation_m": undulation_m, "heights": heights,
        "height_m": height_m, "return_height_m": return_height_m, "loiter_radius_m": loiter_radius_m,
        "ground_legs": ground_legs}, progress)
    each = for_flights(of, progress=progress)
    core = of._call(lambda: _core.check_flight(each._core, flight._core, tube, speed, dwell, clearance, rate, count,
                                               progress))
    return FlightCheck(core, each, flight)


def for_flights(mission: Mission, progress: Progress = None) -> Mission:
    """The mission with each of its targets by itself."""
    return Mission(mission._call(lambda: _core.for_flights(mission._core, None, NAME, progress)), mission._scene, mission._text)
