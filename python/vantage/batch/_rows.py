"""Rows of results: their columns, and what is in them."""

from __future__ import annotations

import io
import json
import math
from typing import Any

import numpy as np

from .. import _arrays
from .._errors import Error
from .._extras import require
from .._result import Result
from . import _parquet
from ._table import Id

CAUSES = 5
"""How many causes a row names, those of the largest area."""

TIME_COLUMNS = ("seconds",)
"""Columns that differ from run to run. All others are the same to the bit."""


def sky_share(result: Result) -> float:
    """How much of the upper half ball about the target's lowest point, as far as the sensor reaches, the volume takes.

    Each position of a volume is within the range of every point of the target, so that the share is at most 1. What a
    volume holds below the target's lowest point does not count.
    """
    radius = result.mission.range_m
    if result.empty or not 0 < radius < math.inf:
        return 0.0
    lowest = min(float(part[:, 2].min()) for part in result.mission.target_parts)
    return volume_above(result.vertices, result.faces, lowest) / (2 / 3 * math.pi * radius ** 3)


def volume_above(vertices: _arrays.Points, faces: _arrays.Faces, z: float) -> float:
    """Of a closed mesh, the volume above a level: the integral of each facet's height above it over its shadow."""
    if not len(faces):
        return 0.0
    corners = vertices[faces.astype(np.int64)]
    corners = corners - [*corners[0, 0, :2], z]
    a, b = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    shadow = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2  # positive where the facet looks up
    heights = np.sort(corners[:, :, 2], axis=1)
    low, middle, high = heights.T
    mean = heights.mean(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        tip = np.where(high > 0, high ** 3 / (3 * (high - low) * (high - middle)), 0)  # only the highest is above
        lack = low ** 3 / (3 * (low - middle) * (low - high))  # only the lowest is below
    above = np.where(low >= 0, mean, np.where(middle >= 0, mean - lack, tip))
    return float(max(0.0, (shadow * above).sum()))


def of_result(id: Id, result: Result, seconds: float) -> dict[str, Any]:
    """The row of a target that was computed; without `geometry` and `volume_file`."""
    volume = result.volume
    area = sum(cause.area_m2 for cause in volume.causes)
    largest = sorted(volume.causes, key=lambda cause: (-cause.area_m2, cause.name))[:CAUSES]
    return {
        "id": id, "name": result.mission.target_name, "outcome": result.outcome, "reason": result.reason or None,
        "volume_m3": result.volume_m3 if not result.empty else 0.0,
        "area_m2": result.area_m2 if not result.empty else 0.0,
        "sky_share": sky_share(result), "facets": len(result.faces),
        "causes": [{"kind": one.kind, "name": one.name, "source_id": one.source_id, "area_m2": one.area_m2,
                    "share": one.area_m2 / area if area > 0 else 0.0} for one in largest],
        "notes": [note.code for note in result.notes],
        "mission_hash": result.mission.hash, "volume_hash": volume.hash,
        "seconds": seconds,
    }


def of_error(id: Id, name: str | None, error: Error, seconds: float) -> dict[str, Any]:
    """The row of a target that failed."""
    return {"id": id, "name": name, "outcome": "error", "seconds": seconds, "error_kind": error.kind,
            "error_code": error.code, "error_problem": error.problem, "error_where": error.where,
            "error_fix": error.fix}


def schema(is_number: bool, metadata: dict[str, str], crs_is_known: bool) -> Any:
    """Of the Parquet files. `metadata`: what the rows are of. Geometries are WKB, longitude and latitude or the frame."""
    arrow = require("pyarrow", "batch")
    text, number = arrow.string(), arrow.float64()
    cause = arrow.struct([("kind", text), ("name", text), ("source_id", text), ("area_m2", number), ("share", number)])
    columns = [
        ("id", arrow.int64() if is_number else text), ("name", text), ("outcome", text), ("reason", text),
        ("volume_m3", number), ("area_m2", number), ("sky_share", number), ("facets", arrow.int64()),
        ("causes", arrow.list_(cause)), ("notes", arrow.list_(text)), ("mission_hash", text), ("volume_hash", text),
        ("volume_file", text), ("seconds", number), ("error_kind", text), ("error_code", text),
        ("error_problem", text), ("error_where", text), ("error_fix", text), ("geometry", arrow.binary()),
    ]
    described: dict[str, Any] = {"encoding": "WKB", "geometry_types": []}
    if not crs_is_known:
        described["crs"] = None  # else the default: longitude and latitude, OGC:CRS84
    geo = {"version": "1.1.0", "primary_column": "geometry", "columns": {"geometry": described}}
    return arrow.schema(columns, metadata={**metadata, "geo": json.dumps(geo)})


def to_bytes(rows: list[dict[str, Any]], columns: Any) -> bytes:
    """Rows as one Parquet file, with that schema. The same rows give the same bytes."""
    arrow, parquet = require("pyarrow", "batch"), require("pyarrow.parquet", "batch")
    out = io.BytesIO()
    parquet.write_table(arrow.Table.from_pylist(rows, schema=columns), out, compression="zstd")
    return out.getvalue()


def of_bytes(data: bytes) -> Any:
    """A file of rows, as a table of pyarrow; None where it is not whole."""
    try:
        return _parquet.read(data)
    except (require("pyarrow", "batch").ArrowInvalid, OSError):
        return None
