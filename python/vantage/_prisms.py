"""Triangles of footprints with heights, from geopandas (the extra `geo`)."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._errors import Error, input_error, make
from ._extras import require
from ._objects import KINDS, SceneObject
from ._place import WGS84, Georeference, crs_text

Numbers = npt.NDArray[np.float64]
Column = Union[str, float]

_SIDE_M = 50.0
"""Longer sides are cut: a straight line of the CRS curves in the scene's frame, over 50 m by less than 0.1 mm up to 60 degrees
of latitude."""

_LEAST_AREA_M2 = 1e-6
"""Of a footprint; with less the units are wrong, or corners fall together."""

_GROUND_MARGIN_M = 1000.0
"""How far the ground goes beyond the footprints."""

_METRES_PER_DEGREE = 111_320.0


class Prism(NamedTuple):
    """Triangles of one solid, or of the ground."""

    vertices: Numbers
    faces: npt.NDArray[np.int64]


class Prisms(NamedTuple):
    """What `Scene.from_arrays` takes."""

    vertices: Numbers
    faces: npt.NDArray[np.int64]
    object_of: npt.NDArray[np.int64]
    objects: list[SceneObject]
    place: Georeference | None


def _named(labels: Sequence[Hashable]) -> str:
    shown = ", ".join(str(label) for label in labels[:5])
    return f"row {shown}" if len(labels) == 1 else f"rows {shown}{', ...' if len(labels) > 5 else ''}"


def _refused(code: str, problem: str, labels: Sequence[Hashable], fix: str, column: str = "geometry") -> Error:
    return input_error(code, f"{_named(labels)}: {problem}", f"gdf[{column!r}]", fix)


def _column(gdf: Any, column: Column, name: str, default: float | None) -> Numbers:
    """A number for each row: of the column, or for all."""
    if not isinstance(column, str):
        return np.full(len(gdf), _arrays.number(column, name))
    if list(gdf.columns).count(column) != 1:
        raise input_error("missing-key", f"the table has {'several columns' if column in gdf.columns else 'no column'} "
                          f"{column!r}", name,
                          f"choose one of {', '.join(map(str, gdf.columns))}, or give a number for all rows")
    try:
        values = np.array([np.nan if is_missing else float(value)
                           for value, is_missing in zip(gdf[column], gdf[column].isna())])
    except (TypeError, ValueError) as error:
        raise input_error("not-a-number", f"the column {column!r} holds something else than numbers: {error}", name,
                          "convert it: gdf[...] = pandas.to_numeric(gdf[...], errors='coerce')") from None
    missing = np.isnan(values)
    if missing.any() and default is not None:
        values[missing] = default
    elif missing.any():
        raise _refused("value-out-of-range", f"there is no {name}", list(gdf.index[missing]),
                       f"fill it in, leave the rows out, or give default_{name}" if name == "height" else "fill it in",
                       str(column))
    if not np.isfinite(values).all():
        raise _refused("value-out-of-range", f"the {name} is infinite", list(gdf.index[~np.isfinite(values)]),
                       "give metres", str(column))
    return values


def _check_geometries(gdf: Any, base: Column | None) -> None:
    shapely = require("shapely", "geo")
    geometries = np.asarray(gdf.geometry.array, dtype=object)

    def refuse(bad: npt.NDArray[np.bool_], code: str, problem: str, fix: str) -> None:
        if bad.any():
            raise _refused(code, problem, list(gdf.index[bad]), fix)

    refuse(shapely.is_missing(geometries) | shapely.is_empty(geometries), "nothing-given", "there is no geometry",
           "leave the rows out: gdf[gdf.geometry.notna() & ~gdf.geometry.is_empty]")
    refuse(~np.isin(shapely.get_type_id(geometries), (3, 6)), "wrong-type", "the geometry is no polygon",
           "give Polygons and MultiPolygons")
    invalid = ~shapely.is_valid(geometries)
    if invalid.any():
        first = shapely.is_valid_reason(geometries[invalid][0])
        refuse(invalid, "zone-not-simple", f"the geometry is not valid: {first}", "mend it: gdf.geometry.make_valid()")
    if base is None:
        refuse(shapely.has_z(geometries), "not-applicable", "the geometry has heights of its own, which are not used",
               "say where the prisms begin with base=, or drop the heights: gdf.geometry.force_2d()")


def _checked_origin(origin: Any) -> tuple[float, float]:
    fix = "give (latitude, longitude) in degrees"
    values = _arrays.numbers(origin, "origin")
    if values.shape != (2,):
        raise input_error("array-sizes-differ", f"origin has the shape {values.shape}", "origin", fix)
    latitude, longitude = values.tolist()
    if not (abs(latitude) <= 90 and abs(longitude) <= 180):
        raise input_error("not-on-earth", f"latitude {latitude:g}, longitude {longitude:g} is not a place on the earth",
                          "origin", fix)
    return latitude, longitude


def _place_of(gdf: Any, origin: Any, vertical: str) -> Georeference | None:
    """The origin that is given, or the centre of the data, as meshes with a CRS have it."""
    crs = gdf.crs
    name = "" if crs is None else crs_text(crs)
    short = name if len(name) <= 40 else "WKT"
    if origin is not None:
        return Georeference(*_checked_origin(origin), vertical, short)
    if crs is None:
        return None
    geopandas, shapely = require("geopandas", "geo"), require("shapely", "geo")
    west, south, east, north = gdf.total_bounds
    middle = geopandas.GeoSeries([shapely.Point((west + east) / 2, (south + north) / 2)], crs=crs).to_crs(WGS84).iloc[0]
    return Georeference(float(middle.y), float(middle.x), vertical, short)


def _in_frame(polygons: Any, crs: Any, place: Georeference | None) -> Any:
    """With their long sides cut, each corner moved as `Scene.from_mesh` moves vertices."""
    if crs is None or place is None:
        return polygons
    shapely = require("shapely", "geo")
    unit = 1 / _METRES_PER_DEGREE if crs.is_geographic else 1 / crs.axis_info[0].unit_conversion_factor
    polygons = shapely.segmentize(polygons, _SIDE_M * unit)
    text = crs_text(crs)
    return shapely.transform(polygons, lambda corners: _core.plan_from_crs(place, text, np.ascontiguousarray(corners)))


def _triangles(polygon: Any) -> tuple[Numbers, npt.NDArray[np.int64]]:
    """Corners, each place once, and triangles that turn left."""
    shapely = require("shapely", "geo")
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(shapely.force_2d(polygon)))
    if abs(shapely.area(parts).sum() - polygon.area) > 1e-9 * polygon.area:
        raise make("internal", "internal-defect", "a footprint could not be triangulated", "gdf['geometry']",
                   "please report this with the footprint", None)
    corners = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    turned = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
    corners[turned] = corners[turned][:, ::-1]
    places, number = np.unique(corners.reshape(-1, 2), axis=0, return_inverse=True)
    return places, number.reshape(-1, 3)


def _prism(polygon: Any, low: float, high: float) -> Prism:
    """Bottom, top, and two triangles for each side of one triangle alone: so it is closed, whatever the footprint."""
    corners, top = _triangles(polygon)
    count = len(corners)
    sides = np.concatenate([top[:, [k, (k + 1) % 3]] for k in range(3)])
    keys, back = sides[:, 0] * count + sides[:, 1], sides[:, 1] * count + sides[:, 0]
    here, there = sides[~np.isin(keys, back)].T
    walls = [np.column_stack([here, there, there + count]), np.column_stack([here, there + count, here + count])]
    vertices = np.concatenate([np.column_stack([corners, np.full(count, z)]) for z in (low, high)])
    return Prism(vertices, np.concatenate([top[:, ::-1], top + count, *walls]))


def _ground(bounds: Sequence[float], z: float) -> Prism:
    west, south, east, north = bounds
    west, south, east, north = (west - _GROUND_MARGIN_M, south - _GROUND_MARGIN_M, east + _GROUND_MARGIN_M,
                                north + _GROUND_MARGIN_M)
    vertices = np.array([[west, south, z], [east, south, z], [east, north, z], [west, north, z]])
    return Prism(vertices, np.array([[0, 1, 2], [0, 2, 3]]))


def _labels(gdf: Any, name: str | None) -> list[str]:
    column = "name" if name is None and "name" in gdf.columns else name
    if column is None:
        return [""] * len(gdf)
    if column not in gdf.columns:
        raise input_error("missing-key", f"the table has no column {column!r}", "name",
                          f"choose one of {', '.join(map(str, gdf.columns))}")
    return [str(value) if isinstance(value, (str, int)) else "" for value in gdf[column]]


def prisms_of(gdf: Any, height: Column, base: Column | None, ground: bool | float, name: str | None, kind: str,
              origin: Any, default_height: float | None) -> Prisms:
    """A prism for each polygon of a table, and the ground: see `Scene.from_geodataframe`."""
    shapely = require("shapely", "geo")
    if not isinstance(gdf, require("geopandas", "geo").GeoDataFrame):
        raise input_error("wrong-type", f"{type(gdf).__name__} is no GeoDataFrame", "gdf",
                          "make one: geopandas.read_file(...), or GeoDataFrame(table, geometry=..., crs=...)")
    if kind not in KINDS:
        raise input_error("unknown-choice", f"{kind!r} is not a kind of object", "kind", "choose one of " + ", ".join(KINDS))
    if not len(gdf):
        raise input_error("nothing-given", "the table has no rows", "gdf", "give footprints")
    if gdf.active_geometry_name is None:
        raise input_error("nothing-given", "the table has no column of geometries", "gdf", "choose one: gdf.set_geometry(...)")
    _check_geometries(gdf, base)
    if default_height is not None:
        default_height = _arrays.number(default_height, "default_height")
    heights = _column(gdf, height, "height", default_height)
    bases = np.zeros(len(gdf)) if base is None else _column(gdf, base, "base", None)
    if (heights <= 0).any():
        raise _refused("value-out-of-range", "the height is not positive", list(gdf.index[heights <= 0]),
                       "give metres above the base, or leave the rows out", str(height))
    place = _place_of(gdf, origin, "flat ground" if base is None else "")
    footprints = _in_frame(np.asarray(gdf.geometry.array, dtype=object), gdf.crs, place)
    flat = shapely.area(footprints) < _LEAST_AREA_M2
    if flat.any():
        raise _refused("nothing-given", "the geometry has no area", list(gdf.index[flat]),
                       "leave the rows out" if gdf.crs else
                       "without a CRS coordinates are metres: for degrees gdf.set_crs(4326)")
    solids, objects, of = [], [], []
    for row, (footprint, low, tall, label) in enumerate(zip(footprints, bases, heights, _labels(gdf, name))):
        objects.append(SceneObject(label, f"row {gdf.index[row]}", kind))
        for polygon in shapely.get_parts(footprint):
            solids.append(_prism(polygon, low, low + tall))
            of.append(row)
    if ground is not False:
        level = float(bases.min()) if ground is True else _arrays.number(ground, "ground")
        solids.append(_ground(shapely.total_bounds(footprints), level))
        of.append(len(objects))
        objects.append(SceneObject("ground", "", "ground"))
    starts = np.cumsum([0] + [len(solid.vertices) for solid in solids[:-1]])
    faces = np.concatenate([solid.faces + start for solid, start in zip(solids, starts)])
    object_of = np.concatenate([np.full(len(solid.faces), which) for solid, which in zip(solids, of)])
    return Prisms(np.concatenate([solid.vertices for solid in solids]), faces, object_of, objects, place)
