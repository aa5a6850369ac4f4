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
        name: for messages and reports. Default: `target`; for `osm` the object's name in the map, with its id; for a `part`
            the object and the part; for `file` the name in the file, or else the file's; for `volume` the file's.
        vertices: metres; 3 to 64 points in order around a convex, planar polygon, in either direction.
        edges: the polygon's edges as pairs of vertex numbers, counted from 0; they must agree with the order of `vertices`.
            Default: from `vertices`.
        parts: metres; several convex polygons, each a list of points like `vertices`; all of them must be seen. `offset` and
            `front` apply to each.
        point: metres; a single point instead of a polygon, `[x, y, z]`.
        outline: metres; 3 or more points `[x, y]` in order around a simple polygon, which is laid on the ground, or points
            `[x, y, z]` in one plane, where it lies. It need not be convex. Or a list of several such polygons, all of which
            must be seen.
        holes: metres; polygons inside of the outline that are not of the target.
        osm: an area of the scene's map, by its id, `way/123` or `relation/123`, or by its name. With `part`, a building of the
            map.
        object: with `part`, an object of the scene, by its name or its id.
        at: [latitude, longitude], with `part`: the highest object that lies there, but for the ground.
        part: `roof` or `facade` of that object. Default: none; `osm` is then an area on the ground.
        facing: with `part`, only faces that look that way, within 45 degrees: `north`, `northeast`, `east`, ... or degrees
            clockwise from north. North is y where the scene has no place on the earth. Default: all.
        nearest: metres; with `part`, only the face that is nearest to this point, `[x, y, z]`. Default: all.
        center: [latitude, longitude] of the centre of a rectangle on the ground, with `width` and `length`.
        file: a file that has the target: GeoJSON, KML or KMZ.
        feature: the name, the id or the number of what counts of the file, where it has several areas.
        volume: a closed mesh to fly through, for `tour` and `check`. No other key but `name` stands beside it.
        width: metres; of the rectangle.
        length: metres; of the rectangle, along the heading.
        heading: degrees; clockwise from north: where the rectangle's length points. Default: 0.
        offset: metres; moves the target this far along its normal, towards the front; a point only with `front`. Default: 0.
        front: a vector that points to the side from which the target must be visible. It may have any length, and must not be
            in the polygon's plane. Default: up; for a vertical polygon the side from which the vertices are counter-clockwise;
            for a point all sides.
        sides: `front`, or `both`: a position must see the target from one side or the other. Not of a point. Default: `front`.

    Example:
        >>> Target(vertices=[[0, 0, 0], [30, 0, 0], [30, 20, 0]], name="plaza")
        Target(name='plaza', vertices=[[0, 0, 0], [30, 0, 0], [30, 20, 0]])
    """

    name: str | None = None
    vertices: npt.ArrayLike | None = None
    edges: npt.ArrayLike | None = None
    parts: Sequence[npt.ArrayLike] | None = None
    point: Vector | None = None
    outline: npt.ArrayLike | None = None
    holes: npt.ArrayLike | None = None
    osm: str | None = None
    object: str | None = None
    at: Vector | None = None
    part: str | None = None
    facing: str | float | None = None
    nearest: Vector | None = None
    center: Vector | None = None
    file: Path | None = None
    feature: str | None = None
    volume: Path | None = None
    width: float | None = None
    length: float | None = None
    heading: float | None = None
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
        max_range: metres; from the viewpoint to every point of the target, > 0. Default: none; required without `vlos`,
            `pixel` and `dori`.
        vlos: instead of `max_range`, how far a pilot on the ground may be from the aircraft. The target is a point, the
            pilot's eyes; with `eye_height` the place where the pilot stands. `aircraft_size` (metres): the largest dimension
            of the aircraft, > 0. Required in `vlos`. `kind`: `multirotor` (also helicopters) or `fixed_wing`. Required in
            `vlos`. `visibility` (metres): the ground visibility, > 0. Required in `vlos`. `eye_height` (metres): of the pilot
            above the target, > 0.
        min_range: metres; to every point of the target, less than the range, > 0. Default: none.
        incidence: degrees; largest angle between the target's normal and the line to the viewpoint, > 0 and < 90.
        camera: the whole target, all parts, must be in one picture of it. Either a model, or numbers: where width and height
            give two focal lengths in pixels, the smaller one counts. `model`: a name that `vantage cameras` lists. `width`:
            pixels of the whole picture. `height`: pixels of the whole picture. `focal_length` (mm): of the lens itself; not
            beside `fov`. `sensor_width` (mm): of the part of the sensor that makes the picture; not beside `fov`. Or a name of
            `vt.cameras()` alone.
        fov: degrees; the angles of view, horizontal and vertical, with or without a `camera` that gives the pixels.
        mount: `gimbal`, or a map of angles of a camera that does not turn. Default: `gimbal`. `yaw` (degrees): clockwise from
            north, or `any`: the vehicle can turn. Required in `mount`. `pitch` (degrees): 0 is level, -90 straight down.
            Required in `mount`. `roll` (degrees): a positive one lowers the right edge of the picture. Default: 0.
        gimbal: instead of `mount`: the ways that the camera may look. `yaw` (degrees): as of `mount`. Default: `any`. `pitch`
            (degrees): the lowest and the highest. Default: what the gimbal of the model reaches; [-90, 90] where that is not
            known. `roll` (degrees): as of `mount`. Default: 0.
        pixel: how much of the target one pixel may cover. Needs the camera's pixels. `size` (metres): how much of the target
            one pixel may cover, > 0. Required in `pixel`. `kind`: `worst`, which counts the slant of the view, or
            `perpendicular`, which does not. Default: `worst`.
        dori: instead of `pixel`, a level of EN 62676-4: `detection`, `observation`, `recognition` or `identification`: 25, 62,
            125 or 250 pixels per metre, `perpendicular`.
        sun: no point of the target may be seen too near to the sun. `exclude` (degrees): > 0, at most 90: not nearer than
            this. Required in `sun`. `time`: ISO 8601 with a zone: `2026-06-21T16:00Z`. It needs a scene that says where on the
            earth it lies. `azimuth` (degrees): instead of the time: clockwise from north. `elevation` (degrees): with the
            azimuth: above the horizon, 0 to 90.
        link: a radio link between the target, a point where an antenna is, and the vehicle. Nothing of the scene may enter the
            first Fresnel zone about the straight way between them. Not with `method: spheres`. `frequency` (GHz): of the radio
            waves, > 0, at most 3000. Required in `link`. `clear`: the share of the first zone's radius that must be free, > 0,
            at most 1. Default: 0.6.
        visible: the part of the target's area that must be seen, > 0 and at most 1. All other limits hold for all of the
            target: it must be in range, in the picture and looked at from the front as a whole. Not for a point, not with
            `method: spheres`. Default: 1.
        cells: into how many pieces of the same area the target is cut for `visible`, 1 to 1024. A piece counts where it is
            seen whole. With more of them the volume is larger, up to what is right, and takes longer. `vantage query` and
            `vantage verify` count exactly what is seen, without cells. Default: 16.

    Example:
        >>> Sensor(max_range=300, incidence=60)
        Sensor(max_range=300, incidence=60)
    """

    max_range: float | None = None
    vlos: Mapping[str, Any] | None = None
    min_range: float | None = None
    incidence: float | None = None
    camera: str | Mapping[str, Any] | None = None
    fov: Vector | None = None
    mount: str | Mapping[str, Any] | None = None
    gimbal: Mapping[str, Any] | None = None
    pixel: Mapping[str, Any] | None = None
    dori: str | None = None
    sun: Mapping[str, Any] | None = None
    link: Mapping[str, Any] | None = None
    visible: float | None = None
    cells: int | None = None


@dataclasses.dataclass(repr=False, kw_only=True)
class Navigation(Request):
    """Where the vehicle may fly: the intersection of all that is given.

    Attributes:
        altitude: metres; lowest and highest z, `[20, 120]`; or a map with `agl`, `z` or both. `agl` (metres): lowest and
            highest height above the ground. `z` (metres): lowest and highest z.
        ground: what heights above the ground are measured from, also of zones: the z of flat ground (m), the name of an object
            of the scene, which then is not an obstacle for `clearance`, or `all` for a scene that is terrain alone. Default:
            what a map or a raster has as its ground.
        clearance: metres; > 0: how far the vehicle must stay from everything that is not ground.
        keep_in: metres; zones to stay in. The volume is cut to their union.
        keep_out: metres; zones to stay out of.
        meshes: closed meshes; the vehicle must stay inside all of them. An entry is the path of a file, from the mission file,
            or `{mesh, up, scale}` as under `scene`. Or a `vt.Volume`, or anything with `vertices` and `faces`.

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
        vehicle: a dictionary: `kind`: `multirotor`: flies straight legs, stops and hovers; `fixed_wing`: neither stops nor
            turns on the spot. Required in `vehicle`. Default: `multirotor`, without `vehicle`. `speed` (m/s): along the path,
            0.01 to 1000. Default: 8. `acceleration` (m/s²): of a multirotor, along the path, 0.001 to 1000. Default: 2.
            `turn_radius` (metres): of a fixed wing, the smallest radius in plan, 0.01 to 100,000. Default: 40. `climb`
            (degrees): of a fixed wing, the steepest descent and the steepest climb, each 0.1 or steeper. Default: [-15, 20].
        home: where the flight begins. Two numbers are latitude and longitude (WGS 84) of a place on the ground, as in
            `center`; three are x, y, z, as `crs` says. Default: none; the flight begins anywhere.
        closed: whether the flight ends where it began. Without a home it then is flown round and round: a fixed wing ends in
            the direction in which it began. With `false` it ends at the last target: its plan returns to no home, and the
            vehicle stays in the air there until the pilot acts. Default: true.
        view: a dictionary: `dwell` (s): for so long each target is in view without a break, 0 to 86,400, a day. Default: 2.
            `margin` (metres): meanwhile the vehicle is at least so deep inside the target's volume, 0 to 10,000. Default: 1.
            `simultaneous`: whether several targets may be viewed at the same time. Default: false.
        gimbal: a dictionary: `rate` (degrees/s): the camera turns at most so fast, 0.001 to 36,000. Default: 30.
        clearance: metres; of the whole flight from the scene, but for its ground, 0 to 10,000. Default: 5.
        tube: metres; all this holds for every position so near to the flight, 0 to 100. That is what `vantage check --tube`
            asks for: for wind, errors of position, and the radius at which an autopilot accepts a waypoint. Default: 1.
        gap: the search for a shorter flight ends when (length − bound) / length is no larger, 0 or more and < 1. Where it is
            given, a larger one ends in exit code 4. Default: 0.01.
        time_limit: s; or after so long, > 0, at most 604,800, a week. The search for the bound may take as long again.
            Preparing the scene and the volumes is not counted, and a first flight is found all the same. Default: 60.

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
    tube: float | None = None
    gap: float | None = None
    time_limit: float | None = None


given = _given
