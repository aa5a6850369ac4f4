"""Tables for notebooks, registered with `_render`."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from ._areas import Area, Face
from ._check import FlightCheck
from ._many import Results
from ._mesh import Note, Solid
from ._positions import Positions
from ._render import html
from ._requests import Request
from ._result import Answers, Mission, Result
from ._scene import Scene
from ._slice import Slice
from ._tour import Tour
from ._volume import Volume

Rows = list[tuple[str, str]]
_MOST = 5
"""Names that are listed."""
_MOST_ROWS = 10


def table(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """A title and two columns, of plain texts."""
    body = "".join(f"<tr><th style='text-align:left'>{escape(name)}</th><td style='text-align:left'>{escape(value)}</td></tr>"
                   for name, value in rows)
    return f"<table><caption style='text-align:left'><b>{escape(title)}</b></caption>{body}</table>"


def _size(bounds: Any) -> str:
    return " x ".join(f"{length:,.0f}" for length in bounds[1] - bounds[0]) + " m"


def _noted(notes: Iterable[Note]) -> Rows:
    return [("note", note.text) for note in notes]


def _numbers_of(solid: Solid) -> Rows:
    return [("volume", f"{solid.volume_m3:,.0f} m³"), ("surface", f"{solid.area_m2:,.0f} m²"),
            ("facets", f"{len(solid.faces):,}")]


def _bounded_by(solid: Solid) -> Rows:
    total = sum(cause.area_m2 for cause in solid.causes) or 1
    largest = sorted(solid.causes, key=lambda cause: -cause.area_m2)[:_MOST]
    return [("bounded by", ", ".join(f"{c.name} {100 * c.area_m2 / total:.0f} %" for c in largest))] if largest else []


def _solid(title: str, solid: Solid, more: Rows) -> str:
    if solid.empty:
        return table(title, [("outcome", solid.outcome), ("reason", solid.reason), *_noted(solid.notes)])
    return table(title, [*_numbers_of(solid), *more, *_bounded_by(solid), *_noted(solid.notes)])


@html.register(Result)
def _result(result: Result) -> str:
    """The numbers of a result, and its largest causes."""
    return _solid(result.mission.target_name, result, [("range", f"{result.mission.range_m:g} m")])


@html.register(Volume)
def _volume(volume: Volume) -> str:
    """Its numbers, and what it was computed for."""
    made = volume.provenance
    more = [("target", made["target"]), ("method", made["method"])] if made else []
    if volume.bounds is not None:
        more.append(("size", _size(volume.bounds)))
    return _solid("volume", volume, more)


@html.register(Scene)
def _scene(scene: Scene) -> str:
    """How much is in it, and where it lies."""
    kinds = Counter(one.kind for one in scene.objects)
    rows = [("size", _size(scene.bounds)), ("triangles", f"{len(scene.faces):,}"),
            ("objects", f"{sum(kinds.values()):,}: " + ", ".join(f"{n:,} {kind}" for kind, n in kinds.most_common()))]
    place = scene.georeference
    if place is not None:
        rows.append(("origin", f"{place.latitude_deg:.6f}, {place.longitude_deg:.6f}"))
        rows += [("heights from", place.vertical)] if place.vertical else []
        rows += [("CRS of the source", place.source_crs)] if place.source_crs else []
    return table("scene", rows)


@html.register(Mission)
def _mission(mission: Mission) -> str:
    """What is asked."""
    corners = ", ".join(str(len(part)) for part in mission.target_parts)
    return table(mission.target_name, [("range", f"{mission.range_m:g} m"), ("method", mission._core.method),
                                       ("corners", corners), *_noted(mission.notes)])


@html.register(Request)
def _request(request: Any) -> str:
    """What was given of a Target, Sensor or Navigation."""
    def shown(value: Any) -> str:
        text = repr(value.tolist() if isinstance(value, np.ndarray) else value)
        return text if len(text) <= 200 else text[:197] + "..."

    fields = ((field.name, getattr(request, field.name)) for field in dataclasses.fields(request))
    return table(type(request).__name__, [(name, shown(value)) for name, value in fields if value is not None])


@html.register(Slice)
def _slice(one: Slice) -> str:
    """Its numbers, and a drawing."""
    rows = [("area", f"{one.area_m2:,.1f} m²"), ("polygons", f"{len(one.polygons):,}"),
            ("CRS", one.crs or "the scene's frame")]
    drawing = _drawing((one._frame or one).polygons)  # degrees would be stretched
    if one.z_m is None:
        return table("footprint", rows) + drawing
    return table("slice", [("height", f"{one.z_m:g} m"), *rows]) + drawing


@html.register(Area)
def _area(area: Area) -> str:
    """What the map tells, and a drawing about its middle, in metres."""
    latitude, longitude = area.center
    rows = [("id", area.source_id), ("area", f"{area.area_m2:,.0f} m²"), ("middle", f"{latitude:.6f}, {longitude:.6f}"),
            *((key, value) for key, value in area.tags.items() if key != "name")]
    shrink = np.array([np.cos(np.radians(latitude)), 1.0])
    drawn = [[(np.array(ring) - [longitude, latitude]) * shrink for ring in rings] for rings in area.polygons]
    return table(area.name or "area", rows) + _drawing(drawn)


@html.register(Face)
def _face(face: Face) -> str:
    """How large it is, and where it looks."""
    return table(face.name, [("area", f"{face.area_m2:,.1f} m²"), ("of", f"{face.object.kind} {face.object.name}".strip()),
                             ("normal", ", ".join(f"{value:.3f}" for value in face.normal)),
                             ("parts", f"{len(face.parts):,}")])


@html.register(Positions)
def _positions(found: Positions) -> str:
    """The answer, and a row for each position."""
    rows = [(f"{number}: " + ", ".join(f"{value:,.1f}" for value in place) + " m",
             f"sees {len(sees)}: {_listed(sees)}; {depth:,.2f} m deep")
            for number, (place, sees, depth) in enumerate(zip(found.positions, found.sees, found.depth_m))]
    more = [("", f"and {len(rows) - _MOST_ROWS} more")] if len(rows) > _MOST_ROWS else []
    return table(str(found), [*rows[:_MOST_ROWS], *more, *(("note", note) for note in found.notes)])


@html.register(FlightCheck)
def _check(check: FlightCheck) -> str:
    """A row for each target, and what fails."""
    rows = []
    for target in check.targets:
        reached = "inside" if target.is_volume else "seen whole"
        spans = _listed(f"{span.begin_m:,.1f} to {span.end_m:,.1f} m" for span in target.seen)
        rows.append((target.name, f"{reached} {spans}" if target.seen else f"nowhere {reached}"))
    more = [("", f"and {len(rows) - _MOST_ROWS:,} more")] if len(rows) > _MOST_ROWS else []
    near = check.nearest
    ends = [("nearest", f"{near.distance_m:,.2f} m: {near.object or 'the scene'}")] if near is not None else []
    return table(repr(check)[len("<vantage.FlightCheck: "):-1],
                 [*rows[:_MOST_ROWS], *more, *ends, *(("not judged", what) for what in check.not_judged),
                  *(("fails", failure) for failure in check.failures)])


@html.register(Tour)
def _tour(tour: Tour) -> str:
    """A row for each visit, and what is left out."""
    rows = [(visit.name, f"in view {visit.begin_m:,.1f} to {visit.end_m:,.1f} m along the flight, {visit.dwell_s:,.1f} s")
            for visit in tour.visits]
    more = [("", f"and {len(rows) - _MOST_ROWS:,} more")] if len(rows) > _MOST_ROWS else []
    left = [("left out", one.name + (f"; in the way: {one.obstacle}" if one.obstacle else "")) for one in tour.left_out]
    return table(repr(tour)[len("<vantage.Tour: "):-1],
                 [("time", f"{tour.time_s:,.1f} s"), *rows[:_MOST_ROWS], *more, *left, *(("note", note) for note in tour.notes)])


@html.register(Results)
def _results(results: Results) -> str:
    """How many there are of each, and the first errors."""
    rows = [(f"{number}", f"{error.code}: {error.problem}") for number, error in results.errors.items()]
    more = [("", f"and {len(rows) - _MOST_ROWS:,} more")] if len(rows) > _MOST_ROWS else []
    return table(repr(results)[len("<vantage.Results: "):-1], [*rows[:_MOST_ROWS], *more])


@html.register(Answers)
def _answers(answers: Answers) -> str:
    """A row for each point, of the first ones."""
    def why(row: int) -> str:
        reasons = [*answers.blocked_by[row], *(["range"] if answers.out_of_range[row] else []),
                   *(["behind the target"] if answers.behind_target[row] else []), *answers.outside_of[row]]
        return "sees it" if answers.inside[row] else f"does not: {_listed(reasons)}"

    count = len(answers.inside)
    rows = [(f"{row}", f"{why(row)} ({answers.margin_m[row]:+.3g} m)") for row in range(min(count, _MOST_ROWS))]
    more = [("", f"and {count - _MOST_ROWS:,} more")] if count > _MOST_ROWS else []
    return table(f"{int(np.sum(answers.inside)):,} of {count:,} points see the target", rows + more)


def _listed(names: Iterable[Any]) -> str:
    texts = [str(name) for name in names]
    return ", ".join(texts[:_MOST]) + (", ..." if len(texts) > _MOST else "")


def _drawing(polygons: Sequence[Sequence[Any]]) -> str:
    """North is up; 200 pixels across."""
    if not polygons:
        return ""
    corners = np.concatenate([ring for rings in polygons for ring in rings])
    low, size = corners.min(axis=0), float(np.ptp(corners, axis=0).max()) or 1.0
    width, height = np.ptp(corners, axis=0) / size * 200
    paths = []
    for rings in polygons:
        for ring in rings:
            places = (ring - low) / size * 200
            paths.append("M" + "L".join(f"{x:.2f},{height - y:.2f}" for x, y in places) + "Z")
    return (f"<svg width='{width + 4:.0f}' height='{height + 4:.0f}' viewBox='-2 -2 {width + 4:.2f} {height + 4:.2f}'>"
            f"<path d='{''.join(paths)}' fill='#e0b84c' stroke='#555' stroke-width='1' fill-rule='evenodd'/></svg>")
