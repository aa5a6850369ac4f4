"""Whose results a folder holds: the hashes of scene and mission, of the targets, and the version."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._checks import items, shown
from .._core import version
from .._errors import Error, input_error, make
from .._extras import require
from .._requests import given
from .._result import Result
from .._scene import Scene
from .._volume import Volume
from ._scenes import ARRAYS, shown_request
from ._store import Store
from ._table import Table

MANIFEST = "manifest.json"
RESULTS = "results.parquet"
REPORT = "report.json"

_MEANING = {"version": "another version of vantage", "scene_hash": "another scene", "targets_hash": "other targets",
            "mission_hash": "another sensor, other limits, or a scene with another ledger",
            "volumes": "another choice of volumes"}
"""What differs, by the key."""


def check_packages(volumes: str | None, has_geometries: bool) -> None:
    """Raises Error where something is not installed that the work needs later."""
    require("pyarrow", "batch")
    require("shapely", "geo")
    require("pyproj", "geo")
    if volumes == "zarr":
        require("zarr", "batch")


def keys(table: Table, scene: Scene, asked: Mapping[str, Any], volumes: str | None, shard_rows: int) -> dict[str, str]:
    """What tells the results of one run from those of another; all are texts."""
    place = scene.georeference
    # Besides the triangles, whose hash is the scene's: what results say of the scene.
    frame = [None if place is None else list(place), scene._core.sea_level_m, scene._core.ledger_rows]
    mission = json.dumps([_plain(value) for value in asked.values()] + [frame], sort_keys=True)
    return {"version": version, "scene_hash": scene.hash, "mission_hash": hashlib.sha256(mission.encode()).hexdigest(),
            "targets_hash": table.hash, "volumes": volumes or "none", "shard_rows": str(shard_rows)}


def agree(store: Store, mine: Mapping[str, str], scene: Mapping[str, Any]) -> dict[str, str]:
    """Writes the manifest, or compares with the one that is there: its `shard_rows` hold.

    Raises:
        Error: the folder holds results of something else.
    """
    data = store.read(MANIFEST)
    if data is None:
        for name in ("rows", "volumes", RESULTS, REPORT, ARRAYS):  # they would be replaced
            if store.names(name):
                raise make("output", "folder-in-use", f"there is a {name} already, but no {MANIFEST} of a run",
                           store.where(name), "choose another folder, or move it away", None)
        content = {**mine, "scene": shown_request(scene)}
        store.put(MANIFEST, (json.dumps(content, indent=2, default=os.fspath) + "\n").encode())
        return {}
    try:
        held = {key: str(json.loads(data)[key]) for key in (*_MEANING, "shard_rows")}
    except (ValueError, KeyError, TypeError):
        raise _in_use("the folder holds a manifest.json that is not of a batch", store.where(MANIFEST)) from None
    _compare(held, mine, store.where(MANIFEST))
    return {"shard_rows": held["shard_rows"]}


def check_shard(metadata: Mapping[bytes, bytes], mine: Mapping[str, str], where: str) -> None:
    """Whether a file of rows belongs to the run. Raises Error where it does not."""
    held = {key: metadata.get(key.encode(), b"nothing").decode() for key in _MEANING}
    _compare(held, mine, where)


def _compare(held: Mapping[str, str], mine: Mapping[str, str], where: str) -> None:
    differing = [key for key in _MEANING if held[key] != mine[key]]
    if not differing:
        return
    said = "; ".join(f"{_MEANING[key]} ({key} {held[key][:12]}, now {mine[key][:12]})" for key in differing)
    raise _in_use(f"the folder holds results of {said}", where)


def _in_use(problem: str, where: str) -> Error:
    return make("output", "folder-in-use", problem, where, "choose another folder, or delete this one", None)


def _plain(value: Any) -> Any:
    """What is asked, as JSON; files and meshes by the hash of their content."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return _plain(given(value))
    if isinstance(value, Mapping):
        return {key: _of_key(key, item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, int) and not isinstance(value, bool):
        return float(value)  # 300 and 300.0 are the same
    return value if isinstance(value, (bool, float, str)) or value is None else os.fspath(value)


def _of_key(key: Any, value: Any) -> Any:
    if value is None:
        return None
    if key == "meshes":
        return _meshes(value)
    return _file_hash(value) if key in ("file", "mesh", "volume") else _plain(value)


def _meshes(meshes: Any) -> list[Any]:
    told: list[Any] = []
    for number, mesh in enumerate(items(meshes, "navigation.meshes", "meshes")):
        if isinstance(mesh, Result):
            mesh = mesh.volume
        if isinstance(mesh, (str, os.PathLike)):
            told.append(_file_hash(mesh))
        elif isinstance(mesh, Mapping):
            told.append(_plain(mesh))
        elif isinstance(mesh, Volume):
            told.append(mesh.hash)
        elif not (hasattr(mesh, "vertices") and hasattr(mesh, "faces")):
            name = f"navigation.meshes[{number}]"
            raise input_error("wrong-type", f"{name} is {shown(mesh)}", name,
                              "pass a path, a vt.Volume, or anything with vertices and faces")
        else:
            both = np.ascontiguousarray(mesh.vertices, np.float64), np.ascontiguousarray(mesh.faces, np.int64)
            told.append(hashlib.sha256(both[0].tobytes() + both[1].tobytes()).hexdigest())
    return told


def _file_hash(path: Any) -> str:
    try:
        with open(path, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()
    except OSError as error:
        raise input_error("file-not-found" if isinstance(error, FileNotFoundError) else "file-unreadable",
                          f"cannot be read: {error}", os.fspath(path), "check the path and the permissions") from None
