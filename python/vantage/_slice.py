"""Polygons in plan: slices of volumes, and their footprints."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._checks import instance, items, path as checked_path
from ._errors import input_error, make
from ._extras import require
from ._folders import replace_file, write_text
from ._place import WGS84, Georeference, crs_text, no_place
from ._render import html
from ._requests import Path

Ring = npt.NDArray[np.float64]
Polygon = Sequence[Ring]


class Slice:
    """Polygons with holes in plan: the positions of a volume at one height, or the ground under it.

    Attributes:
        polygons: for each polygon its rings, (n, 2) float64 arrays, read-only: the outer one counter-clockwise, then its
            holes clockwise. The first corner is not repeated. The largest polygon comes first.
        z_m: the height, metres in the scene's frame; None of a footprint.
        crs: of the coordinates: the scene's frame in PROJ's words, or that of `to_crs`. None where it is not known. The frame of
            a scene of 3D Tiles is no map: of its slices it is the map nearest to it, into which tables and files are converted.
        area_m2: square metres in the scene's frame, whatever the CRS.

    Example:
        >>> import vantage as vt
        >>> box = vt.Volume.from_arrays(
        ...     [[x, y, z] for x in (0, 2) for y in (0, 3) for z in (0, 9)],
        ...     [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        ...      [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
        >>> box.slice(z=4)
        <vantage.Slice: 1 polygon, 6.0 m2 at z = 4 m>
        >>> box.slice(z=4).polygons[0][0].tolist()
        [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]]
    """

    def __init__(self, polygons: Sequence[Polygon], z_m: float | None = None, georeference: Georeference | None = None,
                 crs: str | None = None, frame: Slice | None = None, heights: list[list[Ring]] | None = None):
        self.polygons: list[list[Ring]] = [list(rings) for rings in polygons]
        self.z_m = z_m
        self.crs = crs
        self.georeference = georeference
        self._frame = frame  # the slice that this one was moved from
        self._heights = heights  # of the corners, where they differ from z_m
        self.area_m2: float = frame.area_m2 if frame is not None else float(sum(
            _area(ring) for rings in self.polygons for ring in rings))

    @property
    def empty(self) -> bool:
        """Whether there is nothing."""
        return not self.polygons

    def to_crs(self, crs: Any) -> Slice:
        """The same with its corners in another CRS: east and north, or longitude and latitude in degrees, in this order.

        Sides stay straight between their corners: of a side of 300 m at 60 degrees of latitude no point is off by more than
        0.1 mm in UTM, and 4 mm in degrees; four times that for 600 m. Across the antimeridian longitudes go on beyond 180
        degrees. Heights stay those of the scene's frame. In scenes of 3D Tiles each corner is converted with its height
        (`height_range_m`); a footprint, which has none, as if it was at z = 0.

        Args:
            crs: 32618, "EPSG:32618", a PROJ or WKT text, or a pyproj.CRS.

        Raises:
            Error: there is no such CRS, or it is not known where on the earth the scene lies, or the slice crosses the edge of
                the CRS's map, as in EPSG:3857 at the antimeridian.
        """
        text, frame = crs_text(crs), self._frame or self
        place = frame.georeference
        if place is None:
            raise no_place("crs", "take a scene with a place: a map, a file with a CRS, or from_arrays with a Georeference")
        points = [[_core.to_crs(place, text, _at(ring, frame.z_m or 0.0)) for ring in rings] for rings in frame.polygons]
        moved = [[_plan(ring) for ring in rings] for rings in points]
        heights = None if self.z_m is None or _core.is_map(place) else [[ring[:, 2] for ring in rings] for rings in points]
        return Slice(_whole(moved, frame.polygons, place, text), self.z_m, place, text, frame, heights)

    @property
    def height_range_m(self) -> tuple[float, float] | None:
        """The lowest and the highest of its corners above the zero of the scene's heights: `z_m` twice, but in scenes of 3D Tiles
        above the WGS 84 ellipsoid, which curves away from the plane of the slice: by d * d / 2R, 0.3 m at 2 km from the origin.
        None of a footprint, and of what is empty."""
        frame = self._frame or self
        if self.z_m is None or self.empty:
            return None
        if frame.georeference is None or _core.is_map(frame.georeference):
            return self.z_m, self.z_m
        place = frame.georeference
        heights = np.concatenate([_core.to_crs(place, WGS84, _at(rings[0], self.z_m))[:, 2] for rings in frame.polygons])
        return float(heights.min()), float(heights.max())

    def _on_map(self) -> Slice:
        """With its corners where its CRS has them."""
        is_moved = self._frame is not None or self.crs is None
        return self if is_moved or self.georeference is None or _core.is_map(self.georeference) else self.to_crs(self.crs)

    def _numbers(self) -> dict[str, Any]:
        """What tables and files say of it."""
        told = {"z_m": self.z_m, "area_m2": self.area_m2}
        place = (self._frame or self).georeference
        if self.z_m is None or place is None or _core.is_map(place):
            return told
        low, high = self.height_range_m or (None, None)
        return {**told, "height_min_m": low, "height_max_m": high}

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """A GeoJSON geometry, a MultiPolygon, in the slice's own coordinates: for shapely.geometry.shape and others."""
        return {"type": "MultiPolygon", "coordinates": tuple(
            tuple(tuple(map(tuple, [*ring.tolist(), ring[0].tolist()])) for ring in rings) for rings in self.polygons)}

    def to_shapely(self) -> Any:
        """A valid shapely.MultiPolygon: where rounding has made rings cross, they are mended."""
        return self._shape(self.polygons)

    def _with_heights(self) -> Any:
        """Likewise with z: the height above the zero of the scene's heights."""
        if self._heights is None:
            return require("shapely", "geo").force_3d(self.to_shapely(), self.z_m)
        return self._shape([[np.column_stack(pair) for pair in zip(*both)] for both in zip(self.polygons, self._heights)])

    @staticmethod
    def _shape(polygons: Sequence[Polygon]) -> Any:
        shapely = require("shapely", "geo")
        whole = shapely.MultiPolygon([shapely.Polygon(rings[0], rings[1:]) for rings in polygons])
        if not whole.is_valid:
            whole = shapely.make_valid(whole)
        flat = [part for part in shapely.get_parts(shapely.get_parts(whole)) if part.geom_type == "Polygon"]
        return shapely.MultiPolygon(flat)

    def to_geodataframe(self) -> Any:
        """A geopandas.GeoDataFrame with its CRS: one row, with z_m and area_m2; in scenes of 3D Tiles also height_min_m and
        height_max_m (`height_range_m`)."""
        row = {name: float("nan") if value is None else value for name, value in self._numbers().items()}
        return require("geopandas", "geo").GeoDataFrame([row], geometry=[self._on_map().to_shapely()], crs=self.crs)

    def save(self, path: Path) -> None:
        """Writes .geojson, or .gpkg or .parquet (GeoParquet) in the slice's own CRS; whole or not at all.

        GeoJSON is longitude and latitude, WGS 84 (RFC 7946), whatever the slice's CRS. Its properties are the columns of
        `to_geodataframe`.
        Across the antimeridian it is cut there, which takes the extra `geo`; in the other formats longitudes go on beyond 180
        degrees. `write_slices` writes several, with their heights.

        Raises:
            Error: the extension is another one, the place on the earth is not known, a package is missing, or the file cannot
                be written.
        """
        file, extension = _output(path, (".geojson", ".json", ".gpkg", ".parquet"))
        if extension in (".gpkg", ".parquet"):
            frame = self.to_geodataframe()
            replace_file(file, _writer(frame, extension, "slice"))
            return
        text = json.dumps(self._feature_collection(), indent=1) + "\n"
        replace_file(file, lambda draft: write_text(draft, text))

    def _feature_collection(self) -> dict[str, Any]:
        on_earth = self.to_crs(WGS84)
        geometry = on_earth.__geo_interface__
        if any(ring[:, 0].max() > 180 for rings in on_earth.polygons for ring in rings):
            geometry = _cut_at_antimeridian(on_earth)
        feature = {"type": "Feature", "properties": self._numbers(), "geometry": geometry}
        return {"type": "FeatureCollection", "features": [feature]}

    def __repr__(self) -> str:
        count = len(self.polygons)
        height = "of the footprint" if self.z_m is None else f"at z = {self.z_m:g} m"
        return f"<vantage.Slice: {count} polygon{'' if count == 1 else 's'}, {self.area_m2:,.1f} m2 {height}>"

    def _repr_html_(self) -> str:
        return html(self)


def _at(ring: Ring, z_m: float) -> Ring:
    """(n, 3): the corners at that z."""
    return np.column_stack([ring, np.full(len(ring), z_m)])


def _plan(ring: Ring) -> Ring:
    flat = np.ascontiguousarray(ring[:, :2])
    flat.setflags(write=False)
    return flat


def _cut_at_antimeridian(whole: Slice) -> dict[str, Any]:
    """A GeoJSON geometry of a slice in degrees that go on beyond 180: cut there, as RFC 7946 has it in section 3.1.9."""
    shapely = require("shapely", "geo")
    shape, cut = whole.to_shapely(), 180.0
    west = shape.intersection(shapely.box(cut - 90, -90, cut, 90))
    east = shapely.transform(shape.intersection(shapely.box(cut, -90, cut + 90, 90)), lambda places: places - (360, 0))
    parts = [part for side in (west, east) for part in getattr(side, "geoms", [side]) if part.geom_type == "Polygon"]
    geometry: dict[str, Any] = shapely.geometry.mapping(shapely.MultiPolygon([
        shapely.geometry.polygon.orient(part) for part in parts if not part.is_empty]))
    return geometry


def _whole(moved: list[list[Ring]], polygons: list[list[Ring]], place: Georeference, crs: str) -> list[list[Ring]]:
    """Polygons that were moved to a CRS, in one piece where they cross the antimeridian: else they would run around the globe.

    Raises:
        Error: they cross the edge of the CRS's map.
    """
    corners = [ring for rings in moved for ring in rings]
    if not corners or np.ptp(np.concatenate(corners)[:, 0]) <= 180:
        return moved
    x, y = np.concatenate(corners).T
    in_frame = np.concatenate([ring for rings in polygons for ring in rings])
    if np.abs(x).max() <= 180.001 and np.abs(y).max() <= 90:  # they may be degrees
        longitude, latitude = _core.plan_to_crs(place, WGS84, np.ascontiguousarray(in_frame)).T
        shift = x - longitude  # another meridian is zero
        if np.abs(y - latitude).max() < 1 and np.abs((shift - shift[0] + 180) % 360 - 180).max() < 1:
            return [[np.column_stack([ring[:, 0] % 360, ring[:, 1]]) for ring in rings] for rings in moved]
    if np.ptp(x) > 100 * max(np.ptp(in_frame, axis=0)):
        raise input_error("crs-unusable", f"the slice crosses the edge of the map of {crs!r}, and would run around the globe",
                          "crs", "choose a CRS for that region, such as a zone of UTM, or longitude and latitude")
    return moved


def write_slices(path: Path, slices: Iterable[Slice], *, names: Sequence[str] | None = None, crs: Any = None) -> None:
    """Writes slices of one or more volumes, or footprints, as a table: GeoPackage (.gpkg, the layer "slices") or GeoParquet 1.1
    (.parquet), by the path's extension; whole or not at all. Takes the extra `geo`.

    A row has a MultiPolygon, z_m, area_m2 (in the scene's frame, whatever the CRS) and, with `names`, name. The corners of
    slices have z: the height in the scene's frame, and in scenes of 3D Tiles that above the WGS 84 ellipsoid, which differs
    from corner to corner. Footprints have none, and z_m is missing. Empty slices are rows without polygons.

    Args:
        path: the file.
        slices: all slices, or all footprints.
        names: one for each of them.
        crs: what all are converted to, as by `Slice.to_crs`: "EPSG:4326" for WGS 84, with longitudes beyond 180 degrees across
            the antimeridian. Default: the CRS that they all have.

    Raises:
        Error: there are none; slices and footprints are mixed; CRS differ and none is given; a package is missing; the file
            cannot be written, and then an older one stays.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]],
        ...                               georeference=vt.Georeference(48.0, 11.0))
        >>> volume = vt.compute(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> vt.write_slices("heights.gpkg", [volume.slice(z) for z in (10, 20, 30)], crs="EPSG:4326")    # doctest: +SKIP
    """
    file, extension = _output(path, (".gpkg", ".parquet"))
    rows = [instance(one, Slice, f"slices[{i}]", "pass what Volume.slice or footprint returns")
            for i, one in enumerate(items(slices, "slices", "slices"))]
    if not rows:
        raise input_error("nothing-given", "there are no slices", "slices", "pass one or more")
    if len({one.z_m is None for one in rows}) > 1:
        raise input_error("conflicting-keys", "slices, which have a height, and footprints, which have none, are mixed", "slices",
                          "write them to files of their own")
    if crs is not None:
        rows = [one.to_crs(crs) for one in rows]
    elif len({one.crs for one in rows}) > 1:
        raise input_error("conflicting-keys", "the slices have different CRS", "slices", "pass crs, to convert them to one")
    columns: dict[str, list[Any]] = {"z_m": [one.z_m for one in rows], "area_m2": [one.area_m2 for one in rows]}
    if names is not None:
        columns = {"name": items(names, "names", "texts"), **columns}
        if len(columns["name"]) != len(rows) or not all(isinstance(name, str) for name in columns["name"]):
            raise input_error("array-sizes-differ", f"names is not a list of {len(rows)} texts", "names",
                              "pass a name for each slice")
    columns["z_m"] = [float("nan") if z is None else z for z in columns["z_m"]]
    on_map = [one._on_map() for one in rows]
    shapes = [one.to_shapely() if one.z_m is None else one._with_heights() for one in on_map]
    table = require("geopandas", "geo").GeoDataFrame(columns, geometry=shapes, crs=rows[0].crs)
    replace_file(file, _writer(table, extension, "slices"))


def _output(path: Path, extensions: tuple[str, ...]) -> tuple[str, str]:
    """The file and its extension, which must be one of these."""
    file = checked_path(path)
    extension = os.path.splitext(file)[1].lower()
    if extension not in extensions:
        named = ", ".join(extensions[:-1])
        raise make("output", "output-format-unknown", f"slices are not written as '{extension}'", file,
                   f"name the file {named} or {extensions[-1]}", None)
    if not os.path.isdir(os.path.dirname(file)):
        raise make("output", "output-folder-missing", "the folder of the output does not exist", file, "make it first", None)
    return file, extension


def _writer(table: Any, extension: str, layer: str) -> Callable[[str], None]:
    """What writes a GeoDataFrame to a new file."""
    if extension == ".gpkg":
        return lambda draft: table.to_file(draft, driver="GPKG", layer=layer)
    require("pyarrow", "geo")
    return lambda draft: table.to_parquet(draft, index=False, schema_version="1.1.0", compression="zstd")


def _area(ring: Ring) -> float:
    x, y = (ring - ring[0]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2
