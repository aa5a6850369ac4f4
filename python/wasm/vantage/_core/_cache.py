"""The engine, compiled for this machine once and kept.

Wasmtime loads compiled code without checking it: who can write such a file can run anything as its reader. So it is kept in a
folder that only its user may write to, in a file of the user's, and none other is loaded. A hash in front of the code tells
what is damaged or of another engine: that is compiled anew. The hash keeps no attacker out, the folder does.
"""

from __future__ import annotations

import hashlib
import os
import pathlib
import platform
import stat
import sys
import tempfile
from typing import Any

import wasmtime

_MARK = b"vantage engine 1\n"
FOLDER_KEY = "VANTAGE_CACHE_DIR"
"""Where the compiled engine is kept; empty: nowhere, and each process compiles it."""


def cache_folder() -> pathlib.Path | None:
    """The user's folder of caches, as the system has it, or what VANTAGE_CACHE_DIR names."""
    given = os.environ.get(FOLDER_KEY)
    if given is not None:
        return pathlib.Path(given) if given else None
    try:
        home = pathlib.Path.home()
    except RuntimeError:
        return None
    if sys.platform == "win32":
        return pathlib.Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local") / "vantage" / "cache"
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "vantage"
    return pathlib.Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache") / "vantage"


def _is_private(found: os.stat_result, kind: int) -> bool:
    """Of that kind, this user's, and no one else may write to it."""
    if stat.S_IFMT(found.st_mode) != kind:
        return False
    if os.name == "nt":  # there the user's folder is private by its list of access
        return True
    return found.st_uid == os.geteuid() and not found.st_mode & 0o022


def _own_folder() -> pathlib.Path | None:
    """The folder, made with no access for others; None where others may write to it, or it cannot be made."""
    folder = cache_folder()
    if folder is None:
        return None
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        try:
            folder.mkdir(mode=0o700)
        except FileExistsError:
            pass
        found = os.lstat(folder)
        if not _is_private(found, stat.S_IFDIR) or (os.name != "nt" and found.st_mode & 0o077):
            return None
        return folder if _is_under_private(folder) else None
    except OSError:
        return None


def _is_under_private(folder: pathlib.Path) -> bool:
    """Whether no other user can put another folder in its place: those above it are this user's or root's, and not open to
    others but where the sticky bit keeps them from renaming."""
    if os.name == "nt":
        return True
    for above in folder.resolve().parents:
        found = os.stat(above)
        is_open = found.st_mode & 0o022 and not found.st_mode & stat.S_ISVTX
        if found.st_uid not in (0, os.geteuid()) or is_open:
            return False
    return True


def _read(file: pathlib.Path) -> bytes | None:
    """The compiled code, if it is whole and this user's. What was checked is what is read: the file is opened once."""
    try:
        number = os.open(file, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0))
        with open(number, "rb") as opened:
            if not _is_private(os.fstat(number), stat.S_IFREG):
                return None
            data = opened.read()
    except OSError:
        return None
    head = len(_MARK) + 32
    if data[:len(_MARK)] != _MARK or data[len(_MARK):head] != hashlib.sha256(data[head:]).digest():
        return None
    return data[head:]


def _write(file: pathlib.Path, code: bytes) -> None:
    """Whole or not at all; where it cannot be written, the next process compiles again."""
    try:
        number, name = tempfile.mkstemp(dir=file.parent, prefix=".engine-")
        try:
            with open(number, "wb") as out:
                out.write(_MARK + hashlib.sha256(code).digest() + code)
            os.replace(name, file)
        except BaseException:
            os.unlink(name)
            raise
    except OSError:
        pass


def compiled(engine: wasmtime.Engine, code: bytes) -> Any:
    """The module of that WebAssembly, compiled by `engine`, or as it was kept."""
    version = getattr(wasmtime, "__version__", "")
    of = f"{version} {platform.system()} {platform.machine()} ".encode()
    folder = _own_folder()
    file = folder / f"engine-{hashlib.sha256(of + code).hexdigest()}.cwasm" if folder is not None else None
    kept = _read(file) if file is not None else None
    if kept is not None:
        try:
            return wasmtime.Module.deserialize(engine, kept)
        except wasmtime.WasmtimeError:  # of another processor, or other settings
            pass
    module = wasmtime.Module(engine, code)
    if file is not None:
        _write(file, bytes(module.serialize()))
    return module
