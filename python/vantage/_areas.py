"""Areas of a map, and roofs and facades of a scene: many targets at once."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import flag, items, path as checked_path, shown, text
from ._errors import input_error
from ._objects import SceneObject
from ._progress import Progress
from ._render import html
from ._requests import Path, Target, Vector

Ring = Sequence[Sequence[float]]
"""Of (longitude, latitude), degrees, WGS 84; open: the first position is not repeated."""


@dataclasses.dataclass(frozen=True)
class Area:
    """A closed way or a multipolygon of a map."""

    source_id: str
    """in the map: "way/265517", "relation/5"."""
    name: str
    """may be empty"""
    tags: Mapping[str, str] = dataclasses.field(repr=False)
    polygons: Sequence[Sequence[Ring]] = dataclasses.field(repr=False)
    """each a list of rings, the outer one counter-clockwise and then its holes"""
    center: tuple[float, float]
    """(latitude, longitude) of the middle of its bounds"""
    area_m2: float
    """holes taken off"""

    def target(self, **keys: Any) -> Target:
        """A `Target` of it, on the ground of a scene of the same map. `keys`: more of the target's keys."""
        return Target(osm=self.source_id, **keys)

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """A GeoJSON feature, for geopandas and shapely."""
        polygons = [[[*ring, ring[0]] for ring in rings] for rings in self.polygons]
        geometry = ({"type": "Polygon", "coordinates": polygons[0]} if len(polygons) == 1 else
                    {"type": "MultiPolygon", "coordinates": polygons})
        properties = {"osm": self.source_id, "name": self.name, "area_m2": self.area_m2, "tags": dict(self.tags)}
        return {"type": "Feature", "id": self.source_id, "properties": properties, "geometry": geometry}

    def _repr_html_(self) -> str:
        return html(self)


def _numbers(values: Vector | None, count: int, name: str, form: str) -> list[float] | None:
    if values is None:
        return None
    array = _arrays.numbers(values, name)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise input_error("value-syntax", f"{name} must be {count} numbers", name, f"write {form}")
    return array.tolist()


def areas(path: Path, tags: str | Iterable[str] = (), *, named: bool = False, center: Vector | None = None,
          radius: float | None = None, bbox: Vector | None = None, progress: Progress = None) -> list[Area]:
    """The areas of an OpenStreetMap file that have all of some tags, by type and id.

    Args:
        path: the file (.osm, .osm.gz, .osm.bz2, .osm.pbf).
        tags: "amenity=parking", "leisure=*" for any value but "no", or several of these. Default: any tags.
        named: only areas with a name.
        center: (latitude, longitude): only areas some of which lies within `radius` metres; or
        bbox: (west, south, east, north) in degrees: likewise.
        progress: called with stage and fraction; False stops.

    Returns:
        at least one `Area`.

    Raises:
        Error: the file cannot be read, a tag is not one, or no area is wanted ("map-object-missing"): it says which tag
            no area has, and the nearest.

    Example:
        >>> parking = vt.areas("city.osm.pbf", "amenity=parking")  # doctest: +SKIP
        >>> results = vt.compute_many(  # doctest: +SKIP
        ...     scene, [area.target() for area in parking], max_range=300)
        >>> geopandas.GeoDataFrame.from_features(parking, crs="EPSG:4326")  # doctest: +SKIP
    """
    wanted = [tags] if isinstance(tags, str) else items(tags, "tags", "tags")
    for tag in wanted:
        if not isinstance(tag, str):
            raise input_error("wrong-type", f"{shown(tag)} is not a tag", "tags", 'write "key=value"')
    wanted = [text(tag, "tags") for tag in wanted]
    rows = _core.areas(checked_path(path), wanted, flag(named, "named"),
                       _numbers(center, 2, "center", "(latitude, longitude)"),
                       0.0 if radius is None else _arrays.number(radius, "radius"),
                       _numbers(bbox, 4, "bbox", "(west, south, east, north)"), progress)
    return [Area(source_id, name, dict(pairs), polygons, (middle[0], middle[1]), area_m2)
            for source_id, name, pairs, polygons, middle, area_m2 in rows]


@dataclasses.dataclass(frozen=True)
class Face:
    """A roof or a facade: a connected piece of an object's surface in one plane, without what lies on it."""

    object: SceneObject
    index: int
    """of the object, in `Scene.objects`"""
    name: str
    """"way/265517 Empire State Building, roof 2": numbered among all of the object's, also those not wanted"""
    normal: npt.NDArray[np.float64] = dataclasses.field(repr=False)
    """(3,), unit, out of the object"""
    area_m2: float
    """of all parts"""
    parts: list[_arrays.Points] = dataclasses.field(repr=False)
    """convex polygons, (n, 3) each, metres, counter-clockwise seen from outside"""
    front: list[float] | None = dataclasses.field(repr=False)
    """what the target's `front` must be; None: the side that is taken without it"""

    def target(self, **keys: Any) -> Target:
        """A `Target` of it. `keys`: more of the target's keys.

        Where an object has a single roof, this is what Target(object=..., part="roof") looks at: the same parts, to the
        bit. Of several roofs that makes one target, which must be seen whole; faces are targets of their own.
        """
        given = {"name": self.name, "parts": self.parts, **keys}
        if self.front is not None:
            given.setdefault("front", self.front)
        return Target(**given)

    def _repr_html_(self) -> str:
        return html(self)


_WITH_FACES = ("building", "building part", "other")


def _shown(one: SceneObject) -> str:
    return f"{one.source_id} {one.name}".strip()


def _chosen(known: Sequence[SceneObject], objects: Iterable[Union[str, int]] | None) -> list[int]:
    if objects is None:
        return [i for i, one in enumerate(known) if one.kind in _WITH_FACES]
    wanted = [objects] if isinstance(objects, (str, int)) else items(objects, "objects", "names, or numbers, of objects")
    places: dict[str, list[int]] = {}
    for i, one in enumerate(known):
        for name in {one.source_id, one.name, _shown(one)} - {""}:
            places.setdefault(name, []).append(i)
    chosen: list[int] = []
    for key in wanted:
        if isinstance(key, str) and key in places:
            chosen += places[key]
        elif isinstance(key, (int, np.integer)) and not isinstance(key, bool) and 0 <= key < len(known):
            chosen.append(int(key))
        else:
            raise input_error("object-missing", f"the scene has no object {shown(key)}", "objects",
                              "name objects as Scene.objects has them, or count them from 0")
    return list(dict.fromkeys(chosen))


def find_faces(scene: _core.Scene, known: Sequence[SceneObject], kind: str, min_area_m2: float,
               objects: Iterable[Union[str, int]] | None, progress: Progress) -> list[Face]:
    """What `Scene.find_faces` does. `known`: the objects of the scene."""
    least = _arrays.number(min_area_m2, "min_area_m2")
    if least < 0:
        raise input_error("value-out-of-range", f"min_area_m2 is {min_area_m2}", "min_area_m2", "give square metres")
    faces = []
    for index, number, normal, area_m2, parts, front in _core.faces(scene, _chosen(known, objects), text(kind, "kind"), least,
                                                                    progress):
        name = f"{_shown(known[index]) or f'object {index}'}, {kind} {number}"
        faces.append(Face(known[index], index, name, np.array(normal), area_m2, parts, front))
    return faces
