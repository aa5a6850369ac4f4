"""Folders for a while: they go with their object, or with the process; those of killed processes with the next one."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
import stat
import tempfile
import weakref
from collections.abc import Callable
from typing import Any

from ._errors import make
from ._requests import Path

BESIDE = ".vantage-part-"
"""How the name begins of a folder in which a file is written that then takes the place of another beside it."""

MARK = ".vantage-temporary"
"""The file by which such a folder says that vantage made it; src/core/temporary_mark.cpp writes the same one."""

_MARK_TEXT = b"vantage made this folder for a short time. It removes the folder with all that is in it.\n"
_RANDOM = 8  # characters of tempfile.mkdtemp
_ATTEMPTS = 10


class Folder:
    """A new folder that only this user may read; for `with`, or until the process ends. Whoever has one holds a lock on it
    (flock), which ends with the process: what nobody holds was left by a process that was killed, and the next folder of
    the same `prefix` in the same `parent` (default: the folder for temporary files) removes it, if it has the mark.

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
                _mark_new(path, held)
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
    """Removes the folders of that kind that no process holds. A name shows nothing, since others may give it too: the mark
    does. What cannot be removed stays."""
    for path in _named_so(prefix, os.path.abspath(parent or tempfile.gettempdir())):
        _remove_if_abandoned(path)


def remove_all(prefix: str, parent: Path) -> None:
    """The same, whoever holds them: other machines may have locks that cannot be seen."""
    for path in _named_so(prefix, os.path.abspath(parent)):
        try:
            folder = _open(path)
        except OSError:
            continue
        try:
            _remove_own(path, folder)
        except OSError:  # it stays
            pass
        finally:
            os.close(folder)


def write_text(file: str, text: str) -> None:
    """A new file, in UTF-8."""
    with open(file, "w", encoding="utf-8") as out:
        out.write(text)


def replace_file(file: str, write: Callable[[str], None]) -> None:
    """A file that is written whole beside it takes its place."""
    try:
        with Folder(BESIDE, os.path.dirname(file)) as folder:
            draft = os.path.join(folder, os.path.basename(file))
            write(draft)
            os.replace(draft, file)
    except OSError as error:
        raise make("output", "output-unwritable", f"the file cannot be written: {error.strerror or error}", file,
                   "free some room, or choose another place", None) from None


def _named_so(prefix: str, parent: str) -> list[str]:
    """What has a name as `Folder` gives it."""
    try:
        with os.scandir(parent) as entries:
            return [entry.path for entry in entries
                    if entry.name.startswith(prefix) and len(entry.name) == len(prefix) + _RANDOM]
    except OSError:
        return []


def _put_mark(path: str) -> None:
    """Raises OSError where it cannot be put there, or something has its name."""
    mark = os.path.join(path, MARK)
    file = os.open(mark, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    try:
        with open(file, "wb") as stream:
            stream.write(_MARK_TEXT)
    except OSError:
        os.unlink(mark)
        raise


def _mark_in(folder: int) -> bytes | None:
    """What is in the mark, and no more than a byte beyond its text; None where it is no file of this user, or a link."""
    try:
        file = os.open(MARK, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, dir_fd=folder)
    except OSError:
        return None
    try:
        about = os.fstat(file)
        is_own_file = stat.S_ISREG(about.st_mode) and about.st_uid == os.geteuid()
        return os.read(file, len(_MARK_TEXT) + 1) if is_own_file else None
    except OSError:
        return None
    finally:
        os.close(file)


def _is_own(path: str, folder: int) -> bool:
    return os.fstat(folder).st_uid == os.geteuid() and _mark_in(folder) == _MARK_TEXT and _leads_to(path, folder)


def _remove_own(path: str, folder: int) -> None:
    if _is_own(path, folder):
        _remove(path)
    else:
        _remove_unmarked(path, folder)


def _remove_unmarked(path: str, folder: int) -> None:
    """Removes a folder whose process was killed before the mark was whole, or after it was removed: only this user may read
    it, as mkdtemp makes it, and nothing is in it but for the beginning of the mark. What others put there at the same moment
    stays: the folder goes while it is empty or not at all."""
    about = os.fstat(folder)
    mark = _mark_in(folder)
    if about.st_uid != os.geteuid() or stat.S_IMODE(about.st_mode) != 0o700 or not _MARK_TEXT.startswith(mark or b"") or \
            not _leads_to(path, folder) or set(os.listdir(folder)) - {MARK}:
        return
    if mark is not None:
        os.unlink(MARK, dir_fd=folder)
    os.rmdir(path)


def _remove(path: str) -> None:
    """The mark last: what a killed process leaves of it is still marked. What cannot be removed stays."""
    try:
        folder = _open(path)
    except OSError:
        return
    try:
        for name in os.listdir(folder):
            if name == MARK:
                continue
            try:
                os.unlink(name, dir_fd=folder)
            except OSError:  # a folder
                shutil.rmtree(name, ignore_errors=True, dir_fd=folder)
    except OSError:
        pass
    finally:
        os.close(folder)
    shutil.rmtree(path, ignore_errors=True)


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


def _mark_new(path: str, held: int) -> None:
    """Before anything else is in it."""
    try:
        _put_mark(path)
    except OSError:
        os.close(held)
        os.rmdir(path)
        raise


def _remove_if_abandoned(path: str) -> None:
    try:
        folder = _open(path)
    except OSError:
        return
    try:
        fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        _remove_own(path, folder)
    except OSError:
        pass
    finally:
        os.close(folder)


def _end(path: str, held: int, process: int) -> None:
    if os.getpid() == process:  # a forked process has the objects of its parent, but not their folders
        for _ in range(3):  # another thread may still be writing
            _remove(path)
            if not os.path.lexists(path):
                break
    os.close(held)
