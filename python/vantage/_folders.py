"""Folders for a while: they go with their object, or with the process; those of killed processes with the next one."""

from __future__ import annotations

import errno
import os
import sys
import tempfile
import weakref
from collections.abc import Callable
from typing import Any

from ._errors import make
from ._folders_mark import MARK as MARK
from ._requests import Path

if sys.platform == "win32":
    from . import _folders_windows as _system
else:
    from . import _folders_posix as _system

BESIDE = ".vantage-part-"
"""How the name begins of a folder in which a file is written that then takes the place of another beside it."""

_RANDOM = 8  # characters of tempfile.mkdtemp
_ATTEMPTS = 10


class Folder:
    """A new folder that only this user may read; for `with`, or until the process ends. Whoever has one holds a lock on it
    (flock; on Windows its mark is open), which ends with the process: what nobody holds was left by a process that was
    killed, and the next folder of the same `prefix` in the same `parent` (default: the folder for temporary files) removes
    it, if it has the mark.

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
            held = _system.mark_and_hold(path)
            if held is not None:
                break
        else:
            raise OSError(errno.EBUSY, "other processes remove each temporary folder that is made", where)
        self.path = path
        self._end = weakref.finalize(self, _system.end, path, held, os.getpid())

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
        _system.remove_if_abandoned(path)


def remove_all(prefix: str, parent: Path) -> None:
    """The same, whoever holds them: other machines may have locks that cannot be seen."""
    for path in _named_so(prefix, os.path.abspath(parent)):
        _system.remove_own(path)


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
