"""The scene that all targets of a run lie in: how it is named, and the copies that workers keep."""

from __future__ import annotations

import io
import json
import os
import threading
import zipfile
import zlib
from collections.abc import Callable, Mapping
from typing import Any, Union

import numpy as np

from .._errors import input_error, make, without_secrets
from .._extras import require
from .._folders import Folder
from .._objects import SceneObject
from .._requests import Path
from .._place import Georeference
from .._progress import Progress
from .._scene import Scene
from ._store import Store

AnyScene = Union[Scene, str, "os.PathLike[str]", Mapping[str, Any]]

_SCENES = ("mesh", "osm", "raster", "tiles")
_FILES = (*_SCENES, "terrain")
ARRAYS = "scene.npz"

_kept: dict[str, Scene] = {}
_lock = threading.Lock()

PREFIX = "vantage-scene-"
"""How the names of folders with copies of remote files begin."""

_folders: list[Folder] = []
_is_over = False  # no copy may be made any more
_folders_lock = threading.Lock()
"""Of the two above. It is never held while a file is copied."""


def request_of(scene: AnyScene) -> dict[str, Any]:
    """The scene as keys of a mission file's `scene`; of a `Scene` {"arrays": its hash}."""
    if isinstance(scene, Scene):
        return {"arrays": scene.hash}
    if isinstance(scene, Mapping):
        request = {key: value for key, value in scene.items() if value is not None}
        if sum(key in request for key in _SCENES) != 1:
            raise input_error("missing-key", "the scene does not name one file", "scene",
                              'write scene={"osm": "city.osm.pbf"}, with mesh, osm, raster or tiles')
    else:
        path = os.fspath(scene)
        name = path.lower()
        kind = "osm" if name.endswith((".osm", ".osm.gz", ".osm.bz2", ".pbf")) else \
            "raster" if name.endswith((".tif", ".tiff", ".hgt", ".hgt.zip")) else \
            "tiles" if os.path.basename(name.split("?")[0]) == "tileset.json" else "mesh"
        request = {kind: path}
    for key in _FILES:
        if key in request and "://" not in os.fspath(request[key]):
            request[key] = os.path.abspath(os.fspath(request[key]))
    return request


def shown_request(request: Mapping[str, Any]) -> dict[str, Any]:
    """The same with addresses as others may read them: keys and passwords are not written into results."""
    return {key: without_secrets(os.fspath(value), True) if key in _FILES else value for key, value in request.items()}


def load(request: Mapping[str, Any], store: Store, progress: Progress = None) -> Scene:
    """Reads the scene that `request_of` named; `store`: of the results, where arrays lie."""
    if "arrays" in request:
        data = store.read(ARRAYS)
        if data is None:
            raise input_error("file-not-found", "the scene of the run is gone", store.where(ARRAYS),
                              "start the run again, with the scene")
        return _of_bytes(data, store.where(ARRAYS))
    keys = dict(request)
    for key in _FILES:
        if key in keys:
            keys[key] = _here(os.fspath(keys[key]), store.options) if key != "tiles" else _tileset(os.fspath(keys[key]))
    kind = next(key for key in _SCENES if key in keys)
    read: Callable[..., Scene] = getattr(Scene, f"from_{kind}")
    path = keys.pop(kind)
    try:
        return read(path, progress=progress, **keys)
    except TypeError as error:
        raise input_error("unknown-key", str(error).split("() ")[-1], "scene",
                          f"use the keys of Scene.from_{kind}") from None


def kept(request: Mapping[str, Any], scene_hash: str, store: Store) -> Scene:
    """The scene, read once in a process, and checked to be that of the run."""
    key = json.dumps([request, scene_hash], sort_keys=True, default=str)
    with _lock:
        if key not in _kept:
            scene = load(request, store)
            if scene.hash != scene_hash:
                raise input_error("file-changed", "the scene is not the one that the run was started with",
                                  "scene", "give all workers the same files, and do not change them")
            while len(_kept) > 1:  # other runs of a long-lived worker
                _kept.pop(next(iter(_kept)))
            _kept[key] = scene.prepare()
        return _kept[key]


def to_bytes(scene: Scene) -> bytes:
    """All that Scene.__reduce__ keeps but where it was loaded from, as a file of numpy."""
    place = scene.georeference
    about = {"objects": [list(one) for one in scene.objects], "georeference": None if place is None else list(place),
             "sea_level": scene._core.sea_level_m, "whole": scene._core.whole, "attribution": scene.attribution,
             "ledger": scene._core.ledger_rows}
    out = io.BytesIO()
    np.savez(out, vertices=scene.vertices, faces=scene.faces, object_of=scene.object_of,
             about=np.frombuffer(json.dumps(about).encode(), np.uint8))
    return out.getvalue()


def save(scene: Scene, store: Store) -> None:
    """Writes what `load` reads for {"arrays": ...}."""
    store.put(ARRAYS, to_bytes(scene))


def _of_bytes(data: bytes, where: str) -> Scene:
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            about = json.loads(arrays["about"].tobytes())
            place = about["georeference"]
            return Scene.from_arrays(arrays["vertices"], arrays["faces"], object_of=arrays["object_of"],
                                     objects=[SceneObject(*one) for one in about["objects"]],
                                     georeference=None if place is None else Georeference(*place),
                                     sea_level=about["sea_level"], attribution=about["attribution"],
                                     _whole=about["whole"], _ledger=about["ledger"])
    except (ValueError, KeyError, TypeError, OSError, EOFError, NotImplementedError, zlib.error, zipfile.BadZipFile) as error:
        raise input_error("file-changed", f"the scene of the run is damaged: {error}", where,
                          "start the run again, with the scene") from error


def forget() -> None:
    """Removes the copies of remote files; none is made after it. For a process that is about to end, in any thread."""
    global _is_over
    with _folders_lock:
        _is_over = True
        while _folders:
            _folders.pop().close()


def _new_folder() -> str:
    """Made and registered in one step, so that `forget` misses none."""
    with _folders_lock:
        if _is_over:
            raise RuntimeError("this process is about to end")
        try:
            _folders.append(Folder(PREFIX))
        except OSError as error:
            raise make("output", "output-unwritable", f"no temporary folder can be made: {error.strerror or error}",
                       error.filename or "", "make room there, or set TMPDIR to a folder that can be written",
                       None) from error
        return _folders[-1].path


def _tileset(path: str) -> str:
    """Its other files are found from where it lies: it is not copied."""
    if "://" in path and not path.startswith(("http://", "https://")):
        raise input_error("not-applicable", "a tileset is read from a folder or by HTTP", path,
                          "copy the whole tileset into a folder that all workers see")
    return path


def _here(path: str, options: Mapping[str, Any]) -> str:
    """A remote file as a local one of the same name, for as long as the process lives: areas of a map are read later."""
    if "://" not in path:
        return path
    local = os.path.join(_new_folder(), path.rstrip("/").rsplit("/", 1)[-1])
    try:
        files, remote = require("fsspec", "batch").core.url_to_fs(path, **options)
        files.get_file(remote, local)
    except FileNotFoundError:
        raise input_error("file-not-found", "there is no such file", path, "check the path") from None
    except OSError as error:
        raise input_error("file-unreadable", f"cannot be read: {error}", path,
                          "check the permissions and the connection") from error
    return local
