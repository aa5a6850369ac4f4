"""Geometries as `__geo_interface__` tells them, as the keys of a target."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._checks import shown
from ._errors import input_error

Corners = npt.NDArray[np.float64]
Keys = dict[str, Any]

FIX = ("pass a vt.Target, (n, 3) vertices of a convex polygon, a dictionary of a target's keys, a polygon of shapely, "
       "or an area or a face of vantage")

_MOST_CORNERS = 64
"""Of one convex polygon."""


def target_keys(geometry: Any, where: str, *, z: float | None = None) -> Keys:
    """The keys of a GeoJSON-like geometry: Polygon, MultiPolygon, or a Point with z.

    Args:
        geometry: a mapping with "type" and "coordinates".
        where: what errors call it.
        z: the height of all corners, in the place of their own.

    Raises:
        Error: it is something else, is empty, or has a coordinate that is not finite.
    """
    if not isinstance(geometry, Mapping) or not isinstance(geometry.get("type"), str):
        raise input_error("wrong-type", f"{where} is no geometry: {shown(geometry)}", where, FIX)
    kind = geometry["type"]
    if kind in ("Feature", "FeatureCollection"):
        raise input_error("value-unsupported", f"{where} is a GeoJSON {kind}, in longitude and latitude", where,
                          "save it to a file and pass vt.Target(file=...), or pass its geometry, with crs='EPSG:4326'")
    if kind == "Point":
        return _of_point(geometry.get("coordinates"), where, z)
    if kind not in ("Polygon", "MultiPolygon"):
        raise input_error("value-unsupported", f"{where} is a {kind}", where, "targets are polygons, or points with a z")
    given = geometry.get("coordinates")
    polygons: Any = given if kind == "MultiPolygon" else [given]
    if not isinstance(polygons, Sequence) or not all(isinstance(rings, Sequence) for rings in polygons):
        raise input_error("wrong-type", f"{where} has no coordinates: {shown(given)}", where, FIX)
    if not polygons or not all(polygons):
        raise input_error("nothing-given", f"{where} is an empty {kind}", where, "leave it out")
    return _of_polygons([[_ring(ring, where, z) for ring in rings] for rings in polygons], where)


def _of_point(place: Any, where: str, z: float | None) -> Keys:
    at = _arrays.numbers(place, where)
    if z is not None and at.shape in ((2,), (3,)):
        at = np.array([*at[:2], _arrays.number(z, "z")])
    if at.shape != (3,):
        raise input_error("missing-key", f"{where} is a point without a height", where, "give it a z")
    return {"point": at.tolist()}


def _ring(ring: Any, where: str, z: float | None) -> Corners:
    """Open, without corners that stand twice in a row."""
    corners = _arrays.numbers(ring, where)
    if corners.ndim != 2 or corners.shape[1] not in (2, 3) or not len(corners):
        raise input_error("array-sizes-differ", f"{where} has a ring of the shape {corners.shape}", where,
                          "pass rings of (x, y) or (x, y, z)")
    if not np.isfinite(corners).all():
        raise input_error("coordinate-not-finite", f"{where} has a coordinate that is not finite", where,
                          "pass finite coordinates")
    if z is not None:
        corners = np.column_stack([corners[:, :2], np.full(len(corners), _arrays.number(z, "z"))])
    kept = (corners != np.roll(corners, -1, axis=0)).any(axis=1)  # the first one is also the last one
    return corners[kept] if kept.any() else corners[:1]


def _of_polygons(polygons: list[list[Corners]], where: str) -> Keys:
    dimensions = {ring.shape[1] for rings in polygons for ring in rings}
    if len(dimensions) > 1:
        raise input_error("array-sizes-differ", f"{where} has rings with heights and rings without", where,
                          "give all of them heights, or none: then they lie on the ground")
    first = polygons[0]
    if dimensions == {3} and len(polygons) == 1 and len(first) == 1 and _stays_as_it_is(first[0]):
        return {"vertices": first[0]}
    outlines = [rings[0].tolist() for rings in polygons]
    holes = [ring.tolist() for rings in polygons for ring in rings[1:]]
    return {"outline": outlines[0] if len(outlines) == 1 else outlines, "holes": holes or None}


def _stays_as_it_is(ring: Corners) -> bool:
    """Whether it is one convex polygon, seen from above; also if it stands upright: then the engine judges."""
    if len(ring) > _MOST_CORNERS:
        return False
    sides = np.roll(ring[:, :2], -1, axis=0) - ring[:, :2]
    turns = sides[:, 0] * np.roll(sides[:, 1], -1) - sides[:, 1] * np.roll(sides[:, 0], -1)
    slack = 1e-12 * float(np.abs(sides).max()) ** 2
    return bool((turns >= -slack).all() or (turns <= slack).all())
