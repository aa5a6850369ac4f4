"""Volumes of a shard as one Zarr store in a ZIP file."""

from __future__ import annotations

import io
import zipfile
from typing import Any

import numpy as np

from .._extras import require
from .._result import Result

_EPOCH = (1980, 1, 1, 0, 0, 0)  # the same volumes give the same bytes


def to_zarr(volumes: list[tuple[str, Result]], about: dict[str, str]) -> bytes:
    """One group with the arrays of all volumes, end to end.

    `vertices` (n, 3) float64, `faces` (m, 3) uint32 and `cause_of` (m,) uint32, of which volume i has the rows
    first_vertex[i] to first_vertex[i + 1] and first_face[i] to first_face[i + 1]; indices count from the volume's own
    first vertex. Attributes: `ids`, `causes` (a list of names for each volume), `mission_hash`, `volume_hash`.
    """
    zarr = require("zarr", "batch")
    held_by_key: dict[str, Any] = {}
    group = zarr.open_group(zarr.storage.MemoryStore(held_by_key), mode="w", zarr_format=2)
    held = [result for _, result in volumes]
    arrays: dict[str, np.ndarray[Any, Any]] = {
        "vertices": _joined([result.vertices for result in held], (0, 3), np.float64),
        "faces": _joined([result.faces for result in held], (0, 3), np.uint32),
        "cause_of": _joined([result.cause_of for result in held], (0,), np.uint32),
        "first_vertex": np.cumsum([0] + [len(result.vertices) for result in held], dtype=np.int64),
        "first_face": np.cumsum([0] + [len(result.faces) for result in held], dtype=np.int64),
    }
    for name, values in arrays.items():
        group.create_array(name, data=values, chunks=(max(1, min(len(values), 1 << 16)), *values.shape[1:]))
    group.attrs.update({
        **about, "ids": [id for id, _ in volumes],
        "causes": [[cause.name for cause in result.causes] for result in held],
        "mission_hash": [result.mission.hash for result in held],
        "volume_hash": [result.volume.hash for result in held],
    })
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as file:
        for key, value in sorted(held_by_key.items()):
            file.writestr(zipfile.ZipInfo(key, _EPOCH), value.to_bytes())
    return out.getvalue()


def _joined(arrays: list[Any], empty: tuple[int, ...], dtype: Any) -> np.ndarray[Any, Any]:
    return np.concatenate(arrays).astype(dtype) if arrays else np.zeros(empty, dtype)
