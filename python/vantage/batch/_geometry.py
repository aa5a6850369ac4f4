"""From geometries of a table to targets of the scene, and back."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._errors import Error, input_error
from .._extras import require
from .._place import Georeference
from .._requests import Target
from .._scene import Scene
from ._table import KINDS, Row

Corners = npt.NDArray[np.float64]

LONLAT = "OGC:CRS84"


def check_crs(crs: str | None, scene: Scene, has_geometries: bool) -> None:
    """Whether the geometries of a table with that CRS can be brought into the scene.

    Raises:
        Error: it says what to do.
    """
    if not has_geometries or crs == "scene":
        return
    if crs is None and scene.georeference is not None:
        raise input_error("crs-missing", "the targets do not say which CRS they are in", "crs",
                          "call targets.set_crs(...), or pass crs='EPSG:...', or crs='scene' for metres of the scene's frame")
    if crs is not None:
        if scene.georeference is None:
            raise input_error("not-georeferenced", "the targets have a CRS, and the scene does not say where on the earth it lies",
                              "crs", "give the scene an 'origin' or 'crs', or pass crs='scene' for metres of its frame")
        _converter(crs, LONLAT)


def _converter(source: str, to: str) -> Any:
    pyproj = require("pyproj", "geo")
    try:
        return pyproj.Transformer.from_crs(source, to, always_xy=True)
    except pyproj.exceptions.ProjError as error:
        raise input_error("crs-unknown", f"there is no such coordinate reference system: {error}", "crs",
                          "write an EPSG code: 'EPSG:25832'") from None


class CrsTransform:
    """How positions of a table become those of a scene. Corners are moved, one by one; sides stay straight."""

    def __init__(self, scene: Scene, crs: str | None):
        self._scene = scene
        self._lonlat = _converter(crs, LONLAT) if crs is not None and crs != "scene" else None
        self._crs = crs
        self._unit_m: float | None = None

    def heights(self, z: Corners) -> Corners:
        """z of the table's CRS in the frame: metres, upwards. Where there are none, nothing is asked of the CRS."""
        if self._lonlat is None or not z.size:
            return z
        if self._unit_m is None:
            assert self._crs is not None
            self._unit_m = _core.vertical_unit_m(self._crs)
        return z * self._unit_m

    def to_scene(self, corners: Corners) -> Corners:
        """(n, 2) of the table's CRS on the ground of the scene, or (n, 3), into the frame."""
        if self._lonlat is None:
            return corners
        on_earth, heights = self._degrees(corners), self.heights(corners[:, 2:])
        if not heights.size:
            return _core.from_crs_on_ground(self._scene._core, LONLAT, on_earth)
        return _core.from_crs(self._place(), LONLAT, np.column_stack([on_earth, heights]))

    def _place(self) -> Georeference:
        assert self._scene.georeference is not None
        return self._scene.georeference

    def _degrees(self, corners: Corners) -> Corners:
        assert self._lonlat is not None
        longitudes, latitudes = self._lonlat.transform(corners[:, 0], corners[:, 1])
        if not (np.isfinite(longitudes).all() and np.isfinite(latitudes).all()):
            raise input_error("not-on-earth", "the geometry is not on the earth", "geometry", "check its CRS")
        return np.column_stack([longitudes, latitudes])

    def to_output(self, corners: Corners) -> Corners:
        """(n, 2) or (n, 3) of the table's CRS as results have them: longitude and latitude, if the scene is on the earth."""
        if self._lonlat is not None:
            flat = np.column_stack(self._lonlat.transform(corners[:, 0], corners[:, 1]))
            return np.column_stack([flat, self.heights(corners[:, 2:])])
        return self.from_scene(corners)

    def from_scene(self, corners: Corners) -> Corners:
        """(n, 2) or (n, 3) of the frame as results have them. Heights are above the zero of the scene's heights."""
        if self._scene.georeference is None:
            return corners
        move = _core.plan_to_crs if corners.shape[1] == 2 else _core.to_crs
        return move(self._scene.georeference, LONLAT, np.ascontiguousarray(corners))


def targets_of(row: Row, transform: CrsTransform) -> list[Target]:
    """What a row asks for: one target, or several that must all be seen. Beside another column that says where the target is,
    a geometry is only what the results show.

    Raises:
        Error: the row says nothing, or two things at once, or a geometry that is none.
    """
    said = [kind for kind in KINDS if kind in row.keys]
    if not said and row.geometry is not None:
        said = ["geometry"]
    if len(said) != 1:
        raise input_error("missing-key" if not said else "conflicting-keys",
                          "it is not said where the target is" if not said else "the target has " + " and ".join(said),
                          ", ".join(said) or "geometry", "give one of " + ", ".join(KINDS))
    keys = dict(row.keys)
    if name_of(row) is not None:
        keys["name"] = name_of(row)
    if said != ["geometry"]:
        return [Target(**keys)]
    shapely = require("shapely", "geo")
    try:
        geometry = shapely.from_wkb(row.geometry)
    except shapely.errors.ShapelyError as error:
        raise input_error("value-syntax", f"the geometry cannot be read: {error}", "geometry", "write it anew") from None
    return [target for part in _polygons(geometry) for target in _of_part(part, keys, transform)]


def name_of(row: Row) -> str | None:
    """Its own, or else its id; None for what has a name in the scene."""
    is_of_scene = any(kind in row.keys for kind in ("osm", "object", "at"))  # a name of its own
    name = row.keys.get("name", None if is_of_scene else row.id)
    return None if name is None else str(name)


def _polygons(geometry: Any) -> list[Any]:
    kind = geometry.geom_type
    if geometry.is_empty:
        raise input_error("nothing-given", f"the geometry is an empty {kind}", "geometry", "leave the row out")
    if kind in ("Polygon", "Point"):
        return [geometry]
    if kind == "MultiPolygon":
        return list(geometry.geoms)
    raise input_error("value-unsupported", f"the geometry is a {kind}", "geometry",
                      "targets are polygons, or points with a z")


def _of_part(part: Any, keys: dict[str, Any], transform: CrsTransform) -> list[Target]:
    if part.geom_type == "Point":
        if not part.has_z:
            raise input_error("missing-key", "the point has no height", "geometry", "give it a z")
        return [Target(**keys, point=transform.to_scene(np.array([[part.x, part.y, part.z]]))[0].tolist())]
    rings = [_ring(ring, transform) for ring in (part.exterior, *part.interiors)]
    if not part.has_z:
        holes = [ring.tolist() for ring in rings[1:]] or None
        return [Target(**keys, outline=rings[0].tolist(), holes=holes)]
    if len(rings) == 1 and len(rings[0]) <= 64 and _turns_one_way(rings[0]):
        return [Target(**keys, vertices=rings[0].tolist())]
    return [Target(**keys, parts=_triangles(rings))]


def _ring(ring: Any, transform: CrsTransform) -> Corners:
    """Open, without corners that stand twice in a row, in the frame."""
    corners = np.array(ring.coords, float)[:-1]
    if not np.isfinite(corners).all():
        raise input_error("coordinate-not-finite", "the geometry has a coordinate that is not finite", "geometry",
                          "write finite numbers")
    kept = (corners != np.roll(corners, 1, axis=0)).any(axis=1)
    corners = corners[kept] if kept.any() else corners[:1]
    return transform.to_scene(corners)


def _turns_one_way(ring: Corners) -> bool:
    """Whether it is convex seen from above; also where it has no area from there: then the engine judges."""
    sides = np.roll(ring[:, :2], -1, axis=0) - ring[:, :2]
    turns = sides[:, 0] * np.roll(sides[:, 1], -1) - sides[:, 1] * np.roll(sides[:, 0], -1)
    scale = np.abs(sides).max() ** 2 * 1e-12
    return bool((turns >= -scale).all() or (turns <= scale).all())


def _triangles(rings: list[Corners]) -> list[list[list[float]]]:
    """Covers a polygon that is not convex by triangles between its corners: not smaller than it, nor larger."""
    shapely = require("shapely", "geo")
    heights = {tuple(corner[:2]): corner[2] for ring in rings for corner in ring}
    flat = shapely.Polygon(rings[0][:, :2], [ring[:, :2] for ring in rings[1:]])
    if not flat.is_valid:
        raise input_error("zone-not-simple", f"the geometry is no simple polygon: {shapely.is_valid_reason(flat)}",
                          "geometry", "mend it, with shapely.make_valid for instance")
    pieces = shapely.constrained_delaunay_triangles(flat).geoms
    return [[[x, y, heights[(x, y)]] for x, y in list(piece.exterior.coords)[:3]] for piece in pieces]


# ---- for the results


def footprint(row: Row, parts: list[Corners] | None, transform: CrsTransform) -> bytes | None:
    """The geometry of a row's result, as WKB: the table's own, or else the target that was found."""
    if row.geometry is None and not parts:
        return None
    shapely = require("shapely", "geo")
    if row.geometry is not None:
        try:
            return bytes(shapely.to_wkb(_moved(shapely.from_wkb(row.geometry), transform)))
        except (Error, shapely.errors.ShapelyError):
            return None
    assert parts is not None
    shapes = []
    for part in parts:
        corners = transform.from_scene(part)
        shapes.append(shapely.Point(corners[0]) if len(corners) == 1 else shapely.Polygon(corners))
    return bytes(shapely.to_wkb(shapes[0] if len(shapes) == 1 else shapely.MultiPolygon(shapes)))


def _moved(geometry: Any, transform: CrsTransform) -> Any:
    return require("shapely", "geo").transform(geometry, transform.to_output, include_z=geometry.has_z)
