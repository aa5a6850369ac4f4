"""Polygons of shapely and tables of geopandas as targets: whatever tells its geometry by `__geo_interface__`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Protocol, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._areas import Area, Face
from ._checks import items, shown
from ._errors import Error, input_error
from ._geometry import FIX, target_keys
from ._place import crs_text, no_place
from ._requests import Target
from ._scene import Scene


class Shape(Protocol):
    """Polygons of shapely, and others."""

    @property
    def __geo_interface__(self) -> Mapping[str, Any]: ...


AnyTarget = Union[Target, Mapping[str, Any], Area, Face, Shape, npt.ArrayLike]
"""What can be a target: see `vantage.compute`."""


def is_table(value: Any) -> bool:
    """Whether it is a GeoSeries or a GeoDataFrame."""
    return hasattr(value, "geometry") and hasattr(value, "crs") and hasattr(value, "iloc")


def is_several(target: Any) -> bool:
    """Whether it is a list of targets, or a table: not an array of vertices, which also is a list."""
    if is_table(target):
        return True
    if isinstance(target, np.ndarray):
        return target.ndim == 3 and len(target) > 0
    if isinstance(target, (str, bytes, Mapping)) or not isinstance(target, Sequence):
        return False
    return any(_is_one_by_itself(one) or _is_polygon(one) for one in target)


def _is_polygon(value: Any) -> bool:
    """Whether it is an array of vertices itself, and no vertex."""
    try:
        return np.ndim(value) == 2
    except (ValueError, TypeError, RecursionError):
        return False


def _is_one_by_itself(value: Any) -> bool:
    return isinstance(value, (Target, Area, Face, Mapping)) or hasattr(value, "__geo_interface__")


def targets_of(target: Any, scene: Scene | None, crs: str | None, name: str = "target") -> list[Target]:
    """The targets that an argument means: one, or those of a list or a table."""
    if is_table(target):
        return _of_table(target, scene, crs, name)
    if is_several(target):
        return [target_of(one, f"{name}[{number}]") for number, one in enumerate(target)]
    return [target_of(target, name)]


def listed(targets: Any, scene: Scene | None, crs: str | None) -> list[Target | Error]:
    """One for each of many, or why it is none."""
    if is_table(targets):
        return list(_each_of_table(targets, scene, crs, "targets"))
    found: list[Target | Error] = []
    for number, one in enumerate(items(targets, "targets", "targets")):
        try:
            found.append(target_of(one, f"targets[{number}]"))
        except Error as error:
            found.append(error)
    return found


def target_of(value: Any, name: str) -> Target:
    """One target."""
    if isinstance(value, Target):
        return value
    if isinstance(value, (Area, Face)):
        return value.target()
    if isinstance(value, Mapping):
        return _of_keys(value, name)
    if hasattr(value, "__geo_interface__"):
        return Target(**target_keys(value.__geo_interface__, name))
    if isinstance(value, (str, bytes)) or value is None:
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, FIX)
    return Target(vertices=_arrays.points(value, name))


def _of_keys(value: Mapping[str, Any], name: str) -> Target:
    """The reader of mission files knows which keys there are, and says the nearest."""
    if "type" in value:
        return Target(**target_keys(value, name))
    target = Target()
    vars(target).update(value)
    return target


# ---- tables


def _of_table(table: Any, scene: Scene | None, crs: str | None, name: str) -> list[Target]:
    targets = []
    for one in _each_of_table(table, scene, crs, name):
        if isinstance(one, Error):
            raise one
        targets.append(one)
    if not targets:
        raise input_error("nothing-given", f"{name} is a table without rows", name, "pass one row at least")
    return targets


def _each_of_table(table: Any, scene: Scene | None, crs: str | None, name: str) -> Iterable[Target | Error]:
    """Named by the column "name", or else by the row's label."""
    move = _mover(table.crs, scene, crs, name)
    columns = getattr(table, "columns", ())
    names = table["name"] if "name" in columns else [None] * len(table)
    for label, geometry, called in zip(table.index, table.geometry, names):
        where = f"{name}.loc[{label!r}]"
        try:
            if geometry is None:
                raise input_error("nothing-given", f"{where} has no geometry", where, "leave the row out")
            target = Target(**target_keys(geometry.__geo_interface__, where),
                            name=called if isinstance(called, str) and called else f"row {label}")
            yield move(target)
        except Error as error:
            yield error


def _mover(of_table: Any, scene: Scene | None, crs: str | None, name: str) -> Callable[[Target], Target]:
    """Corners of the table's CRS in the scene's frame: each is moved, and sides stay straight between them."""
    if of_table is None:
        return lambda target: target
    if crs is not None:
        raise input_error("conflicting-keys", "the table has a CRS, and another one is given", "crs",
                          f"leave crs out, or take that of the table away: {name}.set_crs(None, allow_override=True)")
    place = scene.georeference if scene is not None else None
    if place is None:
        raise no_place(name, "give the scene an origin or a crs; or, for metres of its frame, take the CRS of the table "
                             f"away: {name}.set_crs(None, allow_override=True)")
    text = crs_text(of_table)
    assert scene is not None
    core = scene._core

    def moved(corners: Any) -> list[list[float]]:
        given = np.ascontiguousarray(corners, np.float64)
        placed = _core.from_crs_on_ground(core, text, given) if given.shape[1] == 2 else _core.from_crs(place, text, given)
        return placed.tolist()

    def move(target: Target) -> Target:
        if target.vertices is not None:
            target.vertices = moved(target.vertices)
        if target.point is not None:
            target.point = moved([target.point])[0]
        if target.outline is not None:
            is_one = np.ndim(target.outline[0]) == 1  # type: ignore[index]
            target.outline = moved(target.outline) if is_one else [moved(ring) for ring in target.outline]  # type: ignore[union-attr]
        if target.holes is not None:
            target.holes = [moved(ring) for ring in target.holes]  # type: ignore[union-attr]
        return target

    return move
