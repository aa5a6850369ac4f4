"""Scenes: what may hide the target."""

from __future__ import annotations

import json
import os
import re
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._areas import Face, find_faces
from ._checks import instance, items, not_called, path, path as checked_path, shown, text as checked_text
from ._cloud import cloud_of_file, cloud_of_points
from ._errors import Error, input_error, make
from ._extras import require
from ._folders import Folder
from ._ifc import model_of
from ._mesh import Triangles, poly_data
from ._objects import KINDS, SceneObject
from ._place import Georeference, crs_text, no_place
from ._prisms import prisms_of
from ._progress import Progress
from ._render import html
from ._requests import Path, Target, Vector
from ._source import Source
from ._text import NAME, Text

if TYPE_CHECKING:
    import trimesh

_MAPS = (".osm", ".osm.gz", ".osm.bz2", ".pbf")
_RASTERS = (".tif", ".tiff", ".hgt", ".hgt.zip", ".asc", ".vrt", ".img")
_MESHES = (".obj", ".ply", ".stl", ".gltf", ".glb", ".json", ".city.json")


def _reader_of(file: Any) -> str:
    """The function that reads files with such a name; empty where it says nothing."""
    name = os.fspath(file).lower() if isinstance(file, (str, os.PathLike)) else ""
    name = name if isinstance(name, str) else ""
    if os.path.basename(name) == "tileset.json":
        return "from_tiles"
    for reader, endings in (("from_osm", _MAPS), ("from_raster", _RASTERS)):
        if name.endswith(endings):
            return reader
    return "from_mesh" if name.removesuffix(".gz").endswith(_MESHES) else ""


def _how_to_read(file: Any) -> str:
    reader = _reader_of(file)
    if reader:
        return f"read the file with vt.Scene.{reader}({os.fspath(file)!r})"
    return "read a file with vt.Scene.from_mesh, from_osm or from_raster, or make one with vt.Scene.from_arrays"


def checked_scene(scene: Any, name: str = "scene") -> Scene:
    """A scene, and not the name of its file."""
    return instance(scene, Scene, name, _how_to_read(scene))


class Scene(Triangles):
    """Triangles that may hide the target, each with the object it belongs to. Scenes do not change.

    The frame is right-handed with z up, in metres. Preparing a scene takes much longer than most volumes in it: it is done
    once, by the first call that needs it.

    Example:
        >>> import vantage as vt
        >>> scene = vt.Scene.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])
        >>> scene
        <vantage.Scene: 1 triangles, 1 objects, 9 m x 9 m x 0 m>
    """

    def __init__(self, core: _core.Scene, source: Source | None = None):
        not_called(core, _core.Scene, "vt.Scene", _how_to_read(core))
        self._core = core
        self._source = source  # of a map

    # ---- where scenes come from

    @classmethod
    def from_mesh(cls, path: Path, *, up: str | None = None, scale: float | None = None, lod: str | None = None,
                  crs: str | None = None, origin: Vector | None = None, sea_level: float | None = None,
                  missing: str | None = None, progress: Progress = None) -> Scene:
        """Reads OBJ, PLY, STL, glTF, GLB or CityJSON, also compressed with gzip.

        Args:
            path: the file.
            up: the axis of the file that points up, "y" or "z" (default).
            scale: metres in one unit of the file. Default: 1.
            lod: of CityJSON, the level of detail. Default: the highest.
            crs: the coordinate reference system of the file's x and y: "EPSG:28992".
            origin: (latitude, longitude) of the scene's origin.
            sea_level: z of the mean sea level, for files of zones with heights above it.
            missing: what holds the place of what cannot be built as the file has it: see `from_osm`.
            progress: called with stage and fraction; False stops.

        Raises:
            Error: the file cannot be read, or is no mesh.
        """
        return cls._load({"mesh": path, "up": up, "scale": scale, "lod": lod, "crs": crs, "origin": origin,
                          "sea_level": sea_level, "missing": missing}, progress)

    @classmethod
    def from_osm(cls, path: Path, *, center: Vector | None = None, radius: float | None = None,
                 bbox: Vector | None = None, terrain: Path | None = None, error: float | None = None,
                 z_unit: str | None = None, void: float | None = None, partial: bool | None = None,
                 without: Sequence[str] | None = None, defaults: Mapping[str, float] | None = None,
                 frame: Mapping[str, Any] | None = None, sea_level: float | None = None, missing: str | None = None,
                 crs: str | None = None, progress: Progress = None) -> Scene:
        """Builds the scene of an OpenStreetMap file (.osm, .osm.gz, .osm.bz2, .osm.pbf, JSON of Overpass).

        Args:
            path: the file.
            center: (latitude, longitude) of the part that is built, with `radius` in metres.
            bbox: (west, south, east, north) in degrees, instead of these. Default: all of the file.
            terrain: a raster of the ground's heights. Default: a plane at z = 0.
            error: how far the ground's triangles may be above that raster, metres.
            z_unit: what its heights are in: "m", "ft" or "us-ft". Default: what it says.
            void: height of its posts that have none, metres. Default: of their rim, or of their neighbours.
            partial: whether to read a file that says that it is not complete. Default: such a file is refused.
            without: what is left out: "walls", "towers", "bridges", "trees", and of stand-ins "woods", "stadiums", "masts",
                "turbines", "cranes", "tanks", "monuments", "others".
            defaults: what is assumed where the map says nothing: {"level": 3.2}.
            frame: `Tiles.frame`, to build a part as what it is of the whole map: see `vt.tiles`.
            sea_level: z of the mean sea level.
            missing: what holds the place of what cannot be built as the map has it (`ledger`): "block", a stand-in, which is
                the default; "warn", nothing; "refuse", it is an error.
            crs: the coordinate reference system of `terrain`: "EPSG:25832". Default: what it says.
            progress: called with stage and fraction; False stops.

        Raises:
            Error: the file cannot be read, or holds nothing to build there.
        """
        return cls._load({"osm": path, "center": center, "radius": radius, "bbox": bbox, "terrain": terrain,
                          "error": error, "z_unit": z_unit, "void": void, "partial": partial, "without": without,
                          "defaults": defaults, "frame": frame,
                          "sea_level": sea_level, "missing": missing, "crs": crs}, progress)

    @classmethod
    def from_raster(cls, path: Path, *, center: Vector | None = None, radius: float | None = None,
                    bbox: Vector | None = None, error: float | None = None, crs: str | None = None,
                    z_unit: str | None = None, void: float | None = None, origin: Vector | None = None,
                    sea_level: float | None = None, missing: str | None = None, progress: Progress = None) -> Scene:
        """Makes the surface of a raster of heights a scene: GeoTIFF, .hgt and what else GDAL reads.

        Args:
            path: the file.
            center: (latitude, longitude) of the part that is used, with `radius` in metres; or
            bbox: (west, south, east, north) in degrees. Default: all of it.
            error: how far the triangles may be above the heights, metres. Default: 0.25.
            crs: its coordinate reference system: "EPSG:28992". Default: what the file says.
            z_unit: what its heights are in: "m", "ft" or "us-ft". Default: what the file says.
            void: height of posts that have none, metres. Default: of their rim, or of their neighbours.
            origin: (latitude, longitude) of the scene's origin.
            sea_level: z of the mean sea level.
            missing: what holds the place of posts without a height: see `from_osm`.
            progress: called with stage and fraction; False stops.
        """
        return cls._load({"raster": path, "center": center, "radius": radius, "bbox": bbox, "error": error,
                          "crs": crs, "z_unit": z_unit, "void": void, "origin": origin, "sea_level": sea_level,
                          "missing": missing}, progress)

    @classmethod
    def from_tiles(cls, path: Path, *, center: Vector | None = None, radius: float | None = None,
                   detail: float | None = None, ground: float | None = None, terrain: Path | None = None,
                   error: float | None = None, z_unit: str | None = None, void: float | None = None,
                   crs: str | None = None, sea_level: float | None = None, missing: str | None = None,
                   progress: Progress = None) -> Scene:
        """Reads a tileset of 3D Tiles: docs/tilesets.md.

        Args:
            path: its tileset.json, or the address of one, "https://...".
            center: (latitude, longitude) of the part that is read, with `radius` in metres. Default: all of it.
            detail: the largest geometric error of a tile that is not refined, metres. Default: 1.
            ground: z of a plane that is the ground. Default: none but what the tileset has.
            terrain: instead, a raster of the ground's heights. Of heights above the sea level, `sea_level` says where that is.
            error: how far the ground's triangles may be above that raster, metres. Default: 0.5.
            z_unit: what its heights are in: "m", "ft" or "us-ft". Default: what it says.
            void: height of its posts that have none, metres. Default: of their rim, or of their neighbours.
            crs: the coordinate reference system of a tileset in projected metres: "EPSG:3946".
            sea_level: z of the mean sea level, metres: on the earth how high the geoid lies above the ellipsoid there.
            missing: what holds the place of tiles that are missing: see `from_osm`.
            progress: called with stage and fraction; False stops.

        Raises:
            Error: the tileset cannot be read, or has nothing there. Files that are missing are in the `ledger`.
        """
        return cls._load({"tiles": path, "center": center, "radius": radius, "detail": detail, "ground": ground,
                          "terrain": terrain, "error": error, "z_unit": z_unit, "void": void, "crs": crs,
                          "sea_level": sea_level, "missing": missing}, progress)

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview, format: str, **options: Any) -> Scene:
        """Reads a file that is in memory. `format`: the end of a name, "obj", "osm.pbf"; `options` are those of from_mesh or
        from_osm."""
        ending = checked_text(format, "format").lstrip(".")
        if not isinstance(data, (bytes, bytearray, memoryview)):
            raise input_error("wrong-type", f"data is {shown(data)}", "data", "pass the bytes of a file")
        if not re.fullmatch(r"[A-Za-z0-9.]{1,20}", ending):
            raise input_error("unknown-choice", f"format is {shown(format)}", "format", "pass the end of a name: 'obj'")
        with Folder() as folder:
            file = os.path.join(folder, "scene." + ending)
            with open(file, "wb") as out:
                out.write(data)
            is_map = ending.lower().split(".")[-1] in ("osm", "pbf") or ".osm." in "." + ending.lower()
            return (cls.from_osm if is_map else cls.from_mesh)(file, **options)

    @classmethod
    def from_arrays(cls, vertices: npt.ArrayLike, faces: npt.ArrayLike, *, object_of: npt.ArrayLike | None = None,
                    objects: Iterable[SceneObject | str] | None = None, georeference: Georeference | None = None,
                    sea_level: float | None = None, attribution: str = "",
                    _whole: Sequence[float] | None = None, _ledger: Sequence[Any] = ()) -> Scene:
        """Makes a scene of triangles; the arrays are copied.

        Args:
            vertices: (n, 3) float64, metres, z up.
            faces: (m, 3) integers, indices into `vertices`. Any triangle soup: open, doubled or crossing ones are fine.
            object_of: (m,) integers, the object of each triangle. Default: all are of one object.
            objects: names, or `SceneObject`s. Default: numbered.
            georeference: where the frame lies on the earth.
            sea_level: z of the mean sea level.
            attribution: whom pictures and files of it have to name: "\u00a9 OpenStreetMap contributors".

        Raises:
            Error: an array of a wrong shape or type, an index out of range, a coordinate that is not finite.
        """
        points = _arrays.points(vertices, "vertices")
        triangles = _arrays.faces(faces, len(points))
        of = np.zeros(len(triangles), np.uint32) if object_of is None else _arrays.labels(object_of, len(triangles),
                                                                                         "object_of")
        count = int(of.max()) + 1 if of.size else 1
        if objects is None:
            named = [SceneObject(f"object {i}" if count > 1 else "scene") for i in range(count)]
        else:
            named = [_object(one, f"objects[{number}]") for number, one in enumerate(items(objects, "objects", "names"))]
        if len(named) < count:
            raise input_error("array-sizes-differ", f"object_of names object {count - 1}, and there are {len(named)}",
                              "objects", "give each object a name")
        rows = []
        for one in named:
            if one.kind not in KINDS:
                raise input_error("unknown-choice", f"{one.kind!r} is not a kind of object", "objects",
                                  "choose one of " + ", ".join(KINDS))
            rows.append((one.name, one.source_id, KINDS.index(one.kind)))
        level = None if sea_level is None else _arrays.number(sea_level, "sea_level")
        return cls(_core.scene_from_arrays(points, triangles, of, rows, _place(georeference), level, _whole,
                                           checked_text(attribution, "attribution"), list(_ledger)))

    @classmethod
    def _load(cls, keys: Mapping[str, Any], progress: Progress) -> Scene:
        text = Text()
        given = {key: value for key, value in keys.items() if value is not None}
        for key in ("mesh", "osm", "raster", "tiles"):
            if key in keys:
                is_web = key == "tiles" and str(keys[key]).startswith(("http://", "https://"))
                given[key] = str(keys[key]) if is_web else path(keys[key])
        if "terrain" in given:
            given["terrain"] = path(given["terrain"], "terrain")
        text.add("scene", given, "scene")
        source = Source.of(text.text(), given["osm"]) if "osm" in given else None
        try:
            core = text.call(lambda: _core.load_scene(text.text(), NAME, progress))
        except Error as error:
            raise _with_reader(error, given) from None
        return cls(core, source)

    @classmethod
    def from_geodataframe(cls, gdf: Any, height: str | float = "height", *, base: str | float | None = None,
                          ground: bool | float = True, name: str | None = None, kind: str = "building",
                          origin: Vector | None = None, default_height: float | None = None,
                          sea_level: float | None = None) -> Scene:
        """Extrudes footprints to closed prisms: an object for each row, and flat ground under them.

        Corners are moved from the table's CRS into the scene's frame as those of `from_mesh` are; sides of more than 50 m are
        cut before, so that none is off by more than 0.1 mm (up to 60 degrees of latitude). Without a CRS, coordinates are
        metres in the frame. Holes stay open. A MultiPolygon is one object.

        Args:
            gdf: a geopandas.GeoDataFrame of Polygons and MultiPolygons.
            height: the column of heights above the base, metres; or one height for all.
            base: the column of z where the prisms begin, metres; or one for all. Default: 0. Polygons that have z need it:
                their own z is not used.
            ground: True: a plane at the lowest base, 1 km beyond the footprints, as object "ground". A number: at that z.
                False: none.
            name: the column of names. Default: "name", if there is one. Ids are "row" and the row's label: "row 0".
            kind: of the objects.
            origin: (latitude, longitude) of the scene's origin. Default: the middle of the data.
            default_height: for rows without a height. Without it they are refused.
            sea_level: z of the mean sea level.

        Raises:
            Error: a geometry is missing, no polygon or not valid; a height is missing or not positive; it names the rows.

        Example:
            >>> import geopandas, shapely, vantage as vt
            >>> houses = geopandas.GeoDataFrame({"height": [9, 12], "name": ["mill", "barn"]}, crs=32631,
            ...                                 geometry=[shapely.box(500000, 5e6, 500010, 5000020),
            ...                                           shapely.box(500030, 5e6, 500040, 5000020)])
            >>> scene = vt.Scene.from_geodataframe(houses)
            >>> [one.name for one in scene.objects]
            ['mill', 'barn', 'ground']
            >>> scene.georeference.source_crs
            'EPSG:32631'
        """
        prisms = prisms_of(gdf, height, base, ground, name, kind, origin, default_height)
        return cls.from_arrays(prisms.vertices, prisms.faces, object_of=prisms.object_of, objects=prisms.objects,
                               georeference=prisms.place, sea_level=sea_level)

    @classmethod
    def from_points(cls, points: npt.ArrayLike, *, cell_m: float = 1.0, georeference: Georeference | None = None,
                    sea_level: float | None = None) -> Scene:
        """Makes a cloud of points a closed solid, in which all of them lie: docs/scene.md.

        The plan is cut into square cells. Over each the solid is at least as high as the highest point of the cell, and its
        sides slope through the cells beside it: it is up to a cell too wide. Cells without points are as high as the highest
        cell beside them. So what has a point in each of its cells hides as much or more; what rises between the points above
        the highest of its cell hides less. It is full down to 1 m under the lowest point: trees, bridges and overhangs have
        no room below them, and targets must lie above it.

        Args:
            points: (n, 3), metres.
            cell_m: side of a cell, metres: some two distances between points. At most 2,000,000 cells.
            georeference: where the frame lies on the earth.
            sea_level: z of the mean sea level.

        Raises:
            Error: there are no points, one is not finite, or they cover too many cells.

        Example:
            >>> import vantage as vt
            >>> vt.Scene.from_points([[0.5, 0.5, 0], [1.5, 0.5, 7]], cell_m=1).bounds.tolist()
            [[0.0, 0.0, -1.0], [2.0, 1.0, 7.0]]
        """
        made = cloud_of_points(points, _arrays.number(cell_m, "cell_m"))
        return cls.from_arrays(made.vertices, made.faces, objects=[SceneObject("points", "", "surface")],
                               georeference=georeference, sea_level=sea_level)

    @classmethod
    def from_laz(cls, path: Path, *, cell_m: float = 1.0, without: Iterable[int] = (), crs: str | None = None,
                 z_unit_m: float | None = None, origin: Vector | None = None, sea_level: float | None = None) -> Scene:
        """Reads a cloud of points, LAS or LAZ, by laspy, the extra `laz`, as `from_points` makes it a solid.

        Args:
            path: the file.
            cell_m: side of a cell, metres.
            without: classes that are left out, and hide nothing: (7, 18) is noise. Default: all points are taken. What is
                left out is in the scene's ledger.
            crs: of the coordinates: "EPSG:25832". Default: what the file says; where it says nothing, they are metres in the
                frame.
            z_unit_m: metres in the unit of z: 0.3048 for feet. Default: that of the CRS's vertical axis, or of the file's
                GeoTIFF keys; without them metres, but where x and y are in another unit the file is refused.
            origin: (latitude, longitude) of the scene's origin. Default: the middle of the file.
            sea_level: z of the mean sea level.

        Raises:
            Error: the file cannot be read, its CRS is not understood, or the units that it states differ; or as from_points.
        """
        made = cloud_of_file(checked_path(path), _arrays.number(cell_m, "cell_m"), without, crs, origin,
                             z_unit_m)
        return cls.from_arrays(made.vertices, made.faces, objects=[SceneObject("points", "", "surface")],
                               georeference=made.place, sea_level=sea_level, _ledger=[one.row() for one in made.ledger])

    @classmethod
    def from_ifc(cls, path: Path, *, deflection_m: float = 0.001, georeference: bool = True, crs: str | None = None,
                 allow_missing: bool = False, missing: str = "block", sea_level: float | None = None) -> Scene:
        """Reads a building model, IFC 2x3, 4 or 4x3 (.ifc), by IfcOpenShell, the extra `ifc`: docs/scene.md.

        Each product with a body is an object: its Name, and its GlobalId as `source_id`. Openings are cut out, doors and
        windows hide; spaces, grids and annotations are left out. Lengths become metres.

        Args:
            path: the file. IfcOpenShell reads it in this process: it may come to grief with files that were made to harm.
            deflection_m: curved surfaces become flat facets, no farther than this from them, on either side. Facets that
                may be of a curved surface are made so much thicker on each side: an object of the kind "stand-in".
            georeference: whether the file's IfcMapConversion says where the scene lies. Its origin then is the middle of the
                model, and z the height of the map. Without one, or with False, the frame is that of the file, with no place.
            crs: of the map, where PROJ does not know the file's name of it: "EPSG:28992".
            allow_missing: products, and parts of them, that no triangles can be made of are left out, and hide nothing,
                instead of refused. They are in the scene's ledger.
            missing: "block", or "warn": curved surfaces are not made thicker; or "refuse": the model is refused where
                anything cannot be built as it stands.
            sea_level: z of the mean sea level.

        Raises:
            Error: the file cannot be read, has no bodies, or products or parts of them that no triangles can be made of; its
                map conversion is not understood, or has another unit than the map's CRS.
        """
        made = model_of(checked_path(path), _arrays.number(deflection_m, "deflection_m"), georeference, crs, allow_missing,
                        missing)
        return cls.from_arrays(made.vertices, made.faces, object_of=made.object_of, objects=made.objects,
                               georeference=made.place, sea_level=sea_level, _ledger=[one.row() for one in made.ledger])

    def _recall(self, needs_map: bool) -> None:
        """Tells a scene that was unpickled its map again, if that is still the same."""
        if self._source is None or self._source.is_known:
            return
        problem = self._source.problem()
        if problem is None:
            self._core.set_source(self._source.text, NAME)
            self._source = Source.of(self._source.text, self._source.file)
        elif needs_map:
            raise problem

    # ---- what they hold

    @property
    def _triangles(self) -> _core.Scene:
        return self._core

    @property
    def object_of(self) -> npt.NDArray[np.uint32]:
        """(m,) uint32, the object of each triangle, an index into `objects`; a read-only view."""
        return self._core.object_of

    @property
    def objects(self) -> list[SceneObject]:
        """The objects; those of a map are its buildings, walls, trees and the ground."""
        return [SceneObject(name, source_id, KINDS[kind]) for name, source_id, kind in self._core.objects]

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """(2, 3): the lowest and the highest coordinates of all vertices, metres."""
        if not len(self.vertices):
            return np.zeros((2, 3))
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @property
    def ledger(self) -> list[dict[str, Any]]:
        """What the file says stands there and that is not built as it stands, each with what stands in for it.

        The keys are those of `vantage inspect --json`: object, name, kind, what, reason, box, outlines, height_m, stand_in (the
        index in `objects` of the blocker that holds its place, or None), instead, may_be_larger, without.
        """
        return json.loads(self._core.ledger())

    @property
    def attribution(self) -> str:
        """Whom pictures and pages of it have to name; empty where nobody is known.

        Of a map it is "© OpenStreetMap contributors", as the licence of its data asks. It is what the file says, what
        `attribution` of `from_arrays` or of a mission file says, or both. `picture` and `plot` draw it; GLB files have it as
        their copyright, and reports as "attribution".
        """
        return self._core.attribution

    @property
    def hash(self) -> str:
        """SHA-256 of the triangles, 64 hexadecimal digits: docs/hashes.md."""
        return self._core.hash

    @property
    def report(self) -> dict[str, Any]:
        """What was read, and what became of it: as `vantage inspect --json` prints it."""
        return json.loads(self._core.report())

    def position(self, latitude: float, longitude: float, z: float = 0.0) -> tuple[float, float]:
        """x and y of a place on the earth (WGS 84, degrees). In scenes of 3D Tiles they depend on `z` of the scene's frame:
        those of the point at this z that lies at, above or below the place.

        Warns of a place outside of the scene that would lie inside with latitude and longitude the other way round.
        """
        north, east = _arrays.number(latitude, "latitude"), _arrays.number(longitude, "longitude")
        at = _core.scene_position(self._core, north, east, _arrays.number(z, "z"))
        if _core.seems_swapped(self._core, north, east):
            warnings.warn(f"latitude {north} and longitude {east} seem to be swapped: the place lies outside of the scene, and "
                          "inside with them the other way round", stacklevel=2)
        return at

    def positions(self, points: npt.ArrayLike, crs: Any) -> npt.NDArray[np.float64]:
        """x and y of places in any CRS: converted as a mesh in this CRS is, by the same operation of PROJ.

        Args:
            points: (n, 2), in the CRS's unit: east and north, or longitude and latitude in degrees, in this order; or (n, 3)
                with heights above the zero of the scene's heights, in metres or the unit of the CRS's vertical axis. In scenes
                of 3D Tiles heights are above the WGS 84 ellipsoid, and points without are at z = 0.
            crs: 32618, "EPSG:32618", a PROJ or WKT text, or a pyproj.CRS.

        Returns:
            (n, 2) or (n, 3) float64, metres in the scene's frame, read-only.

        Raises:
            Error: there is no such CRS, a place is more than 100 km from the scene's origin, or it is not known where on the
                earth the scene lies.

        Example:
            >>> import vantage as vt
            >>> scene = vt.Scene.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]],
            ...                              georeference=vt.Georeference(48.0, 11.0))
            >>> north_m = scene.positions([[11.0, 48.001]], "EPSG:4326")[0, 1]
            >>> round(float(north_m), 2)
            111.19
        """
        place = self._placed()
        given = _arrays.plan_or_points(points)
        return (_core.plan_from_crs if given.shape[1] == 2 else _core.from_crs)(place, crs_text(crs), given)

    def positions_in_crs(self, points: npt.ArrayLike, crs: Any) -> npt.NDArray[np.float64]:
        """The other way round: x and y of the scene's frame, (n, 2) metres, or (n, 3) with z, in a CRS. As `Slice.to_crs` does.
        Heights are metres above the zero of the scene's heights."""
        place = self._placed()
        given = _arrays.plan_or_points(points)
        return (_core.plan_to_crs if given.shape[1] == 2 else _core.to_crs)(place, crs_text(crs), given)

    def _placed(self) -> Georeference:
        if self.georeference is None:
            raise no_place("crs", "take a scene with a place: a map, a file with a CRS, or from_arrays with a Georeference")
        return self.georeference

    def prepare(self, progress: Progress = None) -> Scene:
        """Prepares the scene now, and not with the first volume."""
        self._core.prepare(progress)
        return self

    def target(self, **keys: Any) -> Target:
        """A `Target` of these keys: scene.target(osm="way/265517"), scene.target(vertices=...)."""
        return Target(**keys)

    def find_faces(self, kind: str = "roof", *, min_area_m2: float = 1.0,
                   objects: Iterable[str | int] | None = None, progress: Progress = None) -> list[Face]:
        """Roofs or facades of objects, each of which can be a target: every roof of more than 200 m2.

        Args:
            kind: "roof" (faces upward by more than 15 degrees out of the vertical) or "facade" (a wall).
            min_area_m2: none smaller is listed. What is not more than 1 m2 is never.
            objects: names, ids or numbers of objects. Default: buildings, their parts, and objects of no known kind.
            progress: called with stage and fraction; False stops.

        Returns:
            the faces in the order of the objects; each has `area_m2`, `normal`, `parts` and `target()`.

        Raises:
            Error: the scene has no such object, or there is no such kind.

        Example:
            roofs = scene.find_faces("roof", min_area_m2=200)
            results = vt.compute_many(scene, [roof.target() for roof in roofs], max_range=300)
        """
        return find_faces(self._core, self.objects, kind, min_area_m2, objects, progress)

    # ---- elsewhere

    def save(self, path: Path) -> float:
        """Writes one of `vantage.output_formats(scenes=True)`, by the path's extension, in the scene's frame.

        Returns:
            how far a vertex has moved at most, metres. OBJ and PLY keep all digits: 0. GLB and STL have single precision: of
            GLB about 3e-6 m for an object that is 100 m wide, and 5e-5 m for one of 2 km; of STL about 6e-8 of the distance
            from the origin. A scene that was moved has another `hash` when it is read again.
        """
        return self._core.save(checked_path(path))

    def to_trimesh(self) -> trimesh.Trimesh:
        """The triangles as they are, for trimesh."""
        return require("trimesh", "geo").Trimesh(np.array(self.vertices), np.array(self.faces, np.int64), process=False)

    def to_pyvista(self) -> Any:
        """The triangles with an array "object", for pyvista."""
        return poly_data(self.vertices, self.faces, object=self.object_of)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (np.array(self.vertices), np.array(self.faces), np.array(self.object_of), self.objects,
                           self.georeference, self._core.sea_level_m, self._core.whole,
                           None if self._source is None else self._source.kept(), self.attribution,
                           self._core.ledger_rows)

    def _repr_html_(self) -> str:
        return html(self)

    def __repr__(self) -> str:
        size = self.bounds[1] - self.bounds[0]
        across = " x ".join(f"{length:.0f} m" for length in size)
        return f"<vantage.Scene: {len(self.faces)} triangles, {len(self._core.objects)} objects, {across}>"


def _object(value: Any, name: str) -> SceneObject:
    if isinstance(value, str):
        return SceneObject(checked_text(value, name))
    if not isinstance(value, tuple) or not 1 <= len(value) <= 3:
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass a name, or a vt.SceneObject")
    return SceneObject(*(checked_text(one, name) for one in value))


def _place(value: Any) -> Georeference | None:
    if value is None:
        return None
    if not isinstance(value, tuple) or not 2 <= len(value) <= 4:
        raise input_error("wrong-type", f"georeference is {shown(value)}", "georeference", "pass a vt.Georeference")
    place = Georeference(*value)
    latitude, longitude = _arrays.number(place.latitude_deg, "georeference"), _arrays.number(place.longitude_deg, "georeference")
    if not (abs(latitude) <= 90 and abs(longitude) <= 180):
        raise input_error("not-on-earth", f"latitude {latitude:g}, longitude {longitude:g} is not a place on the earth",
                          "georeference", "pass vt.Georeference(latitude, longitude), in degrees")
    return Georeference(latitude, longitude, checked_text(place.vertical, "georeference"),
                        checked_text(place.source_crs, "georeference"))


def _with_reader(error: Error, given: Mapping[str, Any]) -> Error:
    """Which function reads a file that another one was called with."""
    asked = next(key for key in ("mesh", "osm", "raster", "tiles") if key in given)
    reader = _reader_of(given[asked])
    is_told = error.kind == "input" and error.code not in ("file-not-found", "file-unreadable")
    if not is_told or reader in ("", f"from_{asked}"):
        return error
    kind = {"from_osm": "a map", "from_raster": "a raster of heights", "from_tiles": "a tileset of 3D Tiles",
            "from_mesh": "a mesh"}[reader]
    return make(error.kind, error.code, error.problem, error.where,
                f"by its name it is {kind}: call vt.Scene.{reader}", error.object)


def _restored(vertices: npt.ArrayLike, faces: npt.ArrayLike, object_of: npt.ArrayLike, objects: list[SceneObject],
              georeference: Georeference | None, sea_level: float | None, whole: Sequence[float] | None = None,
              source: Source | None = None, attribution: str = "", ledger: Sequence[Any] = ()) -> Scene:
    scene = Scene.from_arrays(vertices, faces, object_of=object_of, objects=objects, georeference=georeference,
                              sea_level=sea_level, attribution=attribution, _whole=whole, _ledger=ledger)
    scene._source = source
    return scene
