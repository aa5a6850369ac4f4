"""What is asked: targets, sensors and limits, by the names of the mission file (docs/mission-file.md)."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy.typing as npt

from ._checks import shown
from ._errors import input_error
from ._geometry import target_keys
from ._render import html

Path = Union[str, os.PathLike[str]]
Degrees = float
Vector = Union[Sequence[float], npt.NDArray[Any]]


def _given(request: Any) -> dict[str, Any]:
    """The fields that were given, in order."""
    return {name: value for name, value in vars(request).items() if value is not None}


def keys_of(request: Any, kind: type, name: str) -> dict[str, Any]:
    """Of a request, or of a dictionary of its keys: the mission file's reader knows which there are."""
    if isinstance(request, Mapping):
        return {key: value for key, value in request.items() if value is not None}
    if not isinstance(request, kind):
        raise input_error("wrong-type", f"{name} is {shown(request)}", name,
                          f"pass a vt.{kind.__name__}, or a dictionary of its keys")
    return _given(request)


class Request:
    """Printed with what was given, no more."""

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={shown(value)}" for name, value in _given(self).items())
        return f"{type(self).__name__}({given})"

    def _repr_html_(self) -> str:
        return html(self)


@dataclasses.dataclass(repr=False, kw_only=True)
class Target(Request):
    """What must be seen whole: a convex polygon, several of them, or a point. Coordinates are metres in the scene's frame.

    One of `vertices`, `parts`, `point`, `outline`, `osm`, `file`, `object`, `at`, `center` and `volume` says which it is.

    Attributes:
        name: for messages and reports.
        vertices: (n, 3), 3 to 64 points in order around a convex, planar polygon.
        parts: several such polygons; all of them must be seen.
        point: (x, y, z), instead of a polygon.
        outline: (n, 2) x and y of a polygon that is laid on the ground, or (n, 3) of one that lies there; it need not be
            convex. Or several of these.
        holes: of the outline, likewise.
        osm: an area of the scene's map, "way/123" or its name; with `part` a building of it.
        file: a GeoJSON, KML or KMZ file with the polygon, in longitude and latitude; `feature` is its name, id or number
            there, where the file has several.
        volume: the file of a closed mesh to fly through, for `vt.tour` and `vt.check` alone; only `name` stands beside it.
        object: an object of the scene, by name or id; with `part`.
        at: (latitude, longitude): the highest object there; with `part`.
        part: "roof" or "facade".
        facing: with `part`, only faces that look that way: "south", or degrees clockwise from north.
        nearest: with `part`, only the face that is nearest to this point.
        center, width, length, heading: a rectangle on the ground, (latitude, longitude), metres, degrees.
        offset: metres along the target's normal, towards the front.
        front: a vector to the side from which the target must be visible.
        sides: "front" or "both".

    Example:
        >>> Target(vertices=[[0, 0, 0], [30, 0, 0], [30, 20, 0]], name="plaza")
        Target(name='plaza', vertices=[[0, 0, 0], [30, 0, 0], [30, 20, 0]])
    """

    name: str | None = None
    vertices: npt.ArrayLike | None = None
    parts: Sequence[npt.ArrayLike] | None = None
    point: Vector | None = None
    outline: npt.ArrayLike | None = None
    holes: Sequence[npt.ArrayLike] | None = None
    osm: str | None = None
    file: Path | None = None
    feature: str | None = None
    volume: Path | None = None
    object: str | None = None
    at: Vector | None = None
    part: str | None = None
    facing: str | Degrees | None = None
    nearest: Vector | None = None
    center: Vector | None = None
    width: float | None = None
    length: float | None = None
    heading: Degrees | None = None
    offset: float | None = None
    front: Vector | None = None
    sides: str | None = None

    @classmethod
    def from_shape(cls, shape: Any, *, z: float | None = None, **keys: Any) -> Target:
        """Of a Polygon, MultiPolygon or Point of shapely, or what else has a `__geo_interface__`.

        Args:
            shape: its coordinates are metres in the scene's frame, or in the `crs` that is passed to `compute`.
            z: the height of all corners, metres, in the place of their own. Default: their own; without any it is laid on the
                ground.
            keys: more of the target's keys: name, front, offset.

        Raises:
            Error: it is something else, or empty.

        Example:
            >>> class Shape:  # as shapely's polygons
            ...     __geo_interface__ = {"type": "Polygon", "coordinates": [[(0, 0), (9, 0), (9, 9), (0, 0)]]}
            >>> Target.from_shape(Shape(), z=12, name="deck").vertices.tolist()
            [[0.0, 0.0, 12.0], [9.0, 0.0, 12.0], [9.0, 9.0, 12.0]]
        """
        return cls(**target_keys(getattr(shape, "__geo_interface__", shape), "shape", z=z), **keys)


@dataclasses.dataclass(repr=False, kw_only=True)
class Sensor(Request):
    """What the sensor can do. Each limit holds for the whole target; what is not given does not limit.

    Attributes:
        max_range: metres to every point of the target.
        min_range: metres to every point of the target.
        incidence: degrees, the largest angle between the target's normal and the line to the viewpoint.
        camera: a name of `vt.cameras()`, {"model": name}, or a dictionary of width, height (pixels), focal_length and
            sensor_width (mm).
        fov: degrees, horizontal and vertical.
        mount: "gimbal", or {"yaw": , "pitch": , "roll": } in degrees.
        gimbal: {"pitch": (lowest, highest), "roll": , "yaw": } in degrees.
        pixel: {"size": metres, "kind": "worst" or "perpendicular"}.
        dori: "detection", "observation", "recognition" or "identification".
        sun: {"time": ISO 8601, "exclude": degrees}, or {"azimuth": , "elevation": , "exclude": }.
        vlos: a pilot's sight: {"aircraft_size": , "kind": , "visibility": , "eye_height": }.
        link: a radio link: {"frequency": GHz, "clear": share of the first Fresnel zone's radius}.
        visible: the share of the target's area that must be seen.
        cells: into how many pieces the target is cut for `visible`.

    Example:
        >>> Sensor(max_range=300, incidence=60)
        Sensor(max_range=300, incidence=60)
    """

    max_range: float | None = None
    min_range: float | None = None
    incidence: Degrees | None = None
    camera: str | Mapping[str, Any] | None = None
    fov: Vector | None = None
    mount: str | Mapping[str, Any] | None = None
    gimbal: Mapping[str, Any] | None = None
    pixel: Mapping[str, Any] | None = None
    dori: str | None = None
    sun: Mapping[str, Any] | None = None
    vlos: Mapping[str, Any] | None = None
    link: Mapping[str, Any] | None = None
    visible: float | None = None
    cells: int | None = None


@dataclasses.dataclass(repr=False, kw_only=True)
class Navigation(Request):
    """Where the vehicle may fly: the intersection of all that is given.

    Attributes:
        altitude: (lowest, highest) z in metres, or {"agl": (lowest, highest), "z": (lowest, highest)}.
        ground: what heights above the ground are measured from: z in metres, or the name of an object.
        clearance: metres to stay from everything that is not ground.
        keep_in: zones to stay in, dictionaries: {"min": , "max": }, {"polygon": , "z": or "agl": or "heights": "any"},
            or {"file": path}. The volume is cut to their union.
        keep_out: zones to stay out of, likewise.
        meshes: closed meshes to stay inside of: paths, `vt.Volume`s, or anything with `vertices` and `faces`.

    Example:
        >>> Navigation(altitude={"agl": (30, 120)}, clearance=5)
        Navigation(altitude={'agl': (30, 120)}, clearance=5)
    """

    altitude: Vector | Mapping[str, Any] | None = None
    ground: float | str | None = None
    clearance: float | None = None
    keep_in: Sequence[Mapping[str, Any]] | None = None
    keep_out: Sequence[Mapping[str, Any]] | None = None
    meshes: Sequence[Any] | None = None


@dataclasses.dataclass(repr=False, kw_only=True)
class TourSettings(Request):
    """What a flight that sees every target is asked for: the keys of `tour` in a mission file.

    Attributes:
        vehicle: {"kind": "multirotor", "speed": 8, "acceleration": 2}, or {"kind": "fixed_wing", "speed": , "turn_radius": ,
            "climb": (-15, 20)}; m/s, m/s2, metres, degrees.
        home: (latitude, longitude) of a place on the ground, or (x, y, z). Default: the flight begins anywhere.
        closed: whether it ends where it began. Default: True.
        view: {"dwell": 2, "margin": 1, "simultaneous": False}: for so many seconds each target is in view without a break, from
            so many metres inside its volume; whether several may be viewed at once.
        gimbal: {"rate": 30}: the camera turns at most so fast, degrees per second.
        clearance: metres of the whole flight from the scene, but for its ground. Default: 5.
        gap: the search ends when (length - bound) / length is no larger. Default: 0.01.
        time_limit: or after so many seconds. Default: 60.

    Example:
        >>> TourSettings(home=(48.137, 11.575), clearance=8)
        TourSettings(home=(48.137, 11.575), clearance=8)
    """

    vehicle: Mapping[str, Any] | None = None
    home: Vector | None = None
    closed: bool | None = None
    view: Mapping[str, Any] | None = None
    gimbal: Mapping[str, Any] | None = None
    clearance: float | None = None
    gap: float | None = None
    time_limit: float | None = None


given = _given
