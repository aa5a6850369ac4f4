"""The targets of a run, whatever they come as: rows with an id, in its order."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, Union

import numpy as np

from .._errors import Error, input_error
from .._extras import require
from .._requests import Target, given
from . import _parquet

Id = Union[int, str]

KINDS = ("geometry", "vertices", "parts", "point", "outline", "osm", "object", "at", "center")
"""Columns of which a row has one: it says where the target is."""

_OF_RECTANGLES = ("width", "length", "heading")  # OpenStreetMap has tags of these names
_KEYS = tuple(field for field in Target.__dataclass_fields__ if field not in KINDS)


class Row(NamedTuple):
    """One target."""

    id: Id
    keys: dict[str, Any]
    """of `Target`"""
    geometry: bytes | None = None
    """WKB, in the table's CRS"""


class Table(NamedTuple):
    """Targets, sorted by their ids: all of them numbers, or all of them texts."""

    rows: list[Row]
    crs: str | None
    """of the geometries, as pyproj takes it; "scene": the scene's frame; None: not known"""

    @property
    def hash(self) -> str:
        """SHA-256 of all that is asked."""
        text = hashlib.sha256(json.dumps(self.crs).encode())
        for row in self.rows:
            shape = None if row.geometry is None else row.geometry.hex()
            text.update(json.dumps([row.id, row.keys, shape], sort_keys=True).encode())
        return text.hexdigest()


def read(targets: Any, *, crs: str | None = None, options: Mapping[str, Any] | None = None) -> Table:
    """Takes what `run` takes as targets.

    Raises:
        Error: no such file; no ids, or ids that are not unique; no column that says where the targets are.
    """
    found = None
    if isinstance(targets, (str, os.PathLike)):
        records, found = _of_file(os.fspath(targets), options or {})
        name = os.fspath(targets)
    else:
        records, found = _of_objects(targets)
        name = "targets"
    rows = [_row(record, number, name) for number, record in enumerate(records)]
    _check(rows, name)
    # CRSs of tables are long texts; a short one that is given is taken as it is.
    return Table(sorted(rows, key=lambda row: row.id), crs if crs is not None else found)


# ---- files


def _of_file(path: str, options: Mapping[str, Any]) -> tuple[Iterable[Mapping[str, Any]], str | None]:
    fsspec = require("fsspec", "batch")
    try:
        with fsspec.open(path, "rb", **(options if "://" in path else {})) as file:
            data = file.read()
    except FileNotFoundError:
        raise input_error("file-not-found", "there is no such file", path, "check the path") from None
    except OSError as error:
        raise input_error("file-unreadable", f"cannot be read: {error}", path, "check the path and the permissions") \
            from None
    if path.lower().endswith((".geojson", ".json")):
        return _of_geojson(data, path)
    if path.lower().endswith((".parquet", ".geoparquet", ".pq")):
        try:
            return _of_arrow(_parquet.read(data))
        except (require("pyarrow", "batch").ArrowInvalid, OSError) as error:
            raise input_error("table-syntax", f"is no Parquet file: {error}", path, "write it anew") from None
    raise input_error("table-syntax", "is no table that can be read, by its name", path,
                      "write .parquet (also GeoParquet) or .geojson, or read it yourself and pass the rows")


def _of_geojson(data: bytes, path: str) -> tuple[Iterable[Mapping[str, Any]], str | None]:
    try:
        collection = json.loads(data)
        records = [_of_feature(feature) for feature in collection["features"]]
        named = collection.get("crs")  # of before RFC 7946
        crs = str(named["properties"]["name"]) if named is not None else "OGC:CRS84"
    except (ValueError, KeyError, TypeError, AttributeError):
        raise input_error("table-syntax", "is no GeoJSON collection of features", path,
                          'write {"type": "FeatureCollection", "features": [...]}') from None
    return records, crs


def _of_feature(feature: Mapping[str, Any]) -> dict[str, Any]:
    record = dict(feature.get("properties") or {})
    if "id" in feature:
        record.setdefault("id", feature["id"])
    if feature.get("geometry") is not None:
        record["geometry"] = feature["geometry"]
    return record


def _of_arrow(table: Any) -> tuple[Iterable[Mapping[str, Any]], str | None]:
    about = json.loads((table.schema.metadata or {}).get(b"geo", b"{}"))
    column = about.get("primary_column")
    crs: str | None = None
    if column in table.column_names:
        described = about["columns"][column]
        crs = "OGC:CRS84" if "crs" not in described else \
            None if described["crs"] is None else json.dumps(described["crs"])
        if described.get("encoding") != "WKB":
            raise input_error("table-syntax", f"the geometries are encoded as {described.get('encoding')}", column,
                              "write GeoParquet with the encoding WKB")
        names = ["geometry" if name == column else name for name in table.column_names]
        table = table.rename_columns(names)
    wanted = [name for name in table.column_names if name == "id" or name in KINDS or name in _KEYS]
    return table.select(wanted).to_pylist() if wanted else [{}] * table.num_rows, crs


# ---- objects


def _of_objects(targets: Any) -> tuple[Iterable[Mapping[str, Any]], str | None]:
    if hasattr(targets, "columns") and hasattr(targets, "to_dict"):  # of pandas or geopandas
        return _of_frame(targets)
    if hasattr(targets, "to_pylist") and hasattr(targets, "schema"):  # of pyarrow
        return _of_arrow(targets)
    if isinstance(targets, Mapping):
        return [_of_one(one, number, id) for number, (id, one) in enumerate(targets.items())], None
    try:
        return [_of_one(one, number) for number, one in enumerate(targets)], None
    except TypeError:
        raise input_error("wrong-type", f"targets are of type {type(targets).__name__}", "targets",
                          "pass a GeoDataFrame, a path, or a list of dictionaries or Targets") from None


def _of_frame(frame: Any) -> tuple[Iterable[Mapping[str, Any]], str | None]:
    crs: str | None = None
    names = [name for name in frame.columns if name == "id" or name in KINDS or name in _KEYS]
    columns = {name: list(frame[name]) for name in names}
    active = getattr(frame, "_geometry_column_name", None)
    if active is not None and active in frame.columns:
        columns["geometry"] = list(frame[active])
        crs = None if frame.crs is None else frame.crs.to_json()
    if "id" not in columns and frame.index.name == "id":
        columns["id"] = list(frame.index)
    return [{name: values[i] for name, values in columns.items()} for i in range(len(frame))], crs


def _of_one(one: Any, number: int, id: Any = None) -> Mapping[str, Any]:
    if isinstance(one, Target):
        record: dict[str, Any] = {"id": number, **given(one)}
    elif isinstance(one, Mapping):
        record = dict(one)
    elif hasattr(one, "target"):  # an area of a map, or a face of a scene
        record = {"id": getattr(one, "source_id", None) or one.name, **given(one.target())}
    else:
        raise input_error("wrong-type", f"targets[{number}] is of type {type(one).__name__}", f"targets[{number}]",
                          "pass dictionaries, Targets, areas of a map, or faces of a scene")
    if id is not None:
        record["id"] = id
    return record


# ---- rows


def _row(record: Mapping[str, Any], number: int, name: str) -> Row:
    id = _plain(record.get("id", record.get("osm")))
    if isinstance(id, float) and id.is_integer():
        id = int(id)  # pandas makes floats of whole numbers where some are missing
    if id is None or id == "":
        raise input_error("missing-key", f"row {number} has no id", name, "give each target an 'id', a number or a text")
    if isinstance(id, bool) or not isinstance(id, (int, str)):
        raise input_error("wrong-type", f"row {number} has an id of type {type(id).__name__}", name,
                          "ids are whole numbers, or texts")
    shape = record.get("geometry")
    keys = {}
    for key in (*KINDS[1:], *_KEYS):
        value = _real(_plain(record.get(key)))
        if value is not None and value != "":
            keys[key] = value
    if "center" not in keys:
        for key in _OF_RECTANGLES:
            keys.pop(key, None)
    return Row(id, keys, _wkb(shape, f"{name}, id {id!r}"))


def _check(rows: list[Row], name: str) -> None:
    if not rows:
        raise input_error("nothing-given", "there are no targets", name, "pass one or more")
    if not any(row.geometry is not None or any(kind in row.keys for kind in KINDS) for row in rows):
        raise input_error("missing-key", "no column says where the targets are", name,
                          "give one of the columns " + ", ".join(KINDS))
    if len({type(row.id) for row in rows}) > 1:
        raise input_error("wrong-type", "some ids are numbers, and others are texts", name, "make all of them texts")
    seen: dict[Id, int] = {}
    for row in rows:
        seen[row.id] = seen.get(row.id, 0) + 1
    twice = [id for id, count in seen.items() if count > 1]
    if twice:
        named = ", ".join(repr(id) for id in twice[:5]) + (f" and {len(twice) - 5} more" if len(twice) > 5 else "")
        raise input_error("duplicate-key", f"ids are not unique: {named}", name, "give each target an id of its own")


def _plain(value: Any) -> Any:
    """As lists, numbers and texts; None for what is missing."""
    if isinstance(value, np.ndarray):
        return [_plain(item) for item in value] if value.dtype == object else value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and value != value:
        return None
    if value is None or type(value).__name__ in ("NAType", "NaTType"):
        return None
    if isinstance(value, (bool, int, float, str)):
        return value
    raise Error("input", "wrong-type", f"a target has a value of type {type(value).__name__}", "targets",
                "pass numbers, texts and lists")


def _real(value: Any) -> Any:
    """Numbers as float64, so that 3 and 3.0 are the same."""
    if isinstance(value, list):
        return [_real(item) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _wkb(shape: Any, where: str) -> bytes | None:
    """Of a geometry of shapely, of WKB, of GeoJSON, or of what has `__geo_interface__`."""
    if shape is None or (isinstance(shape, float) and shape != shape):
        return None
    if isinstance(shape, (bytes, bytearray, memoryview)):
        return bytes(shape)
    shapely = require("shapely", "geo")
    geometry = require("shapely.geometry", "geo")
    try:
        made = shape if isinstance(shape, shapely.Geometry) else geometry.shape(shape)
        return bytes(shapely.to_wkb(made))
    except (ValueError, TypeError, AttributeError, KeyError, IndexError, shapely.errors.ShapelyError):
        raise input_error("wrong-type", f"a geometry of type {type(shape).__name__} cannot be read", where,
                          "pass geometries of shapely, WKB, or GeoJSON") from None


def shards(rows: list[Row], size: int) -> Iterator[tuple[int, list[Row]]]:
    """Numbered runs of rows; which rows are together depends on nothing else."""
    for number, start in enumerate(range(0, len(rows), size)):
        yield number, rows[start:start + size]
