"""Folders for a while: they go with their object, or with the process; those of killed processes with the next one."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
import stat
import tempfile
import weakref
from typing import Any

from ._requests import Path

BESIDE = ".vantage-part-"
"""How the name begins of a folder in which a file is written that then takes the place of another beside it."""

_RANDOM = 8  # characters of tempfile.mkdtemp
_ATTEMPTS = 10


class Folder:
    """A new folder that only this user may read; for `with`, or until the process ends. Whoever has one holds a lock on it
    (flock), which ends with the process: what nobody holds was left by a process that was killed, and the next folder of
    the same `prefix` in the same `parent` (default: the folder for temporary files) removes it.

    `removes_others`: False where others may use the folder from machines whose locks cannot be seen.

    Raises:
        OSError: none can be made.
    """

    def __init__(self, prefix: str = "vantage-py-", parent: Path | None = None, removes_others: bool = True):
        where = os.path.abspath(parent or tempfile.gettempdir())
        if removes_others:
            remove_abandoned(prefix, where)
        for _ in range(_ATTEMPTS):
            path = tempfile.mkdtemp(prefix=prefix, dir=where)
            held = _held(path)
            if held is not None:
                break
        else:
            raise OSError(errno.EBUSY, "other processes remove each temporary folder that is made", where)
        self.path = path
        self._end = weakref.finalize(self, _end, path, held, os.getpid())

    def close(self) -> None:
        """Removes it, with what is in it."""
        self._end()

    def __enter__(self) -> str:
        return self.path

    def __exit__(self, *_: Any) -> None:
        self.close()


def remove_abandoned(prefix: str, parent: Path | None = None) -> None:
    """Removes the folders of that kind that no process holds. What cannot be removed stays."""
    where = os.path.abspath(parent or tempfile.gettempdir())
    try:
        with os.scandir(where) as entries:
            names = [entry.name for entry in entries]
    except OSError:
        return
    for name in names:
        if name.startswith(prefix) and len(name) == len(prefix) + _RANDOM:
            _remove_if_abandoned(os.path.join(where, name))


def _open(path: str) -> int:
    return os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)


def _leads_to(path: str, folder: int) -> bool:
    try:
        return os.path.samestat(os.lstat(path), os.fstat(folder))
    except OSError:
        return False


def _held(path: str) -> int | None:
    """Open and locked; None where another process took it for an abandoned one before it was."""
    try:
        folder = _open(path)
    except FileNotFoundError:
        return None
    except OSError:
        os.rmdir(path)
        raise
    try:
        fcntl.flock(folder, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(folder)
        return None
    except OSError:  # a file system without locks: nobody can have it alone, so nobody removes it
        pass
    if _leads_to(path, folder):
        return folder
    os.close(folder)
    return None


def _remove_if_abandoned(path: str) -> None:
    try:
        folder = _open(path)
    except OSError:
        return
    try:
        fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        about = os.fstat(folder)
        if stat.S_ISDIR(about.st_mode) and about.st_uid == os.geteuid() and _leads_to(path, folder):
            shutil.rmtree(path, ignore_errors=True)
    except OSError:
        pass
    finally:
        os.close(folder)


def _end(path: str, held: int, process: int) -> None:
    if os.getpid() == process:  # a forked process has the objects of its parent, but not their folders
        for _ in range(3):  # another thread may still be writing
            shutil.rmtree(path, ignore_errors=True)
            if not os.path.lexists(path):
                break
    os.close(held)
