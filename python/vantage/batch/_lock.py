"""One run at a time in a folder."""

from __future__ import annotations

import errno
import fcntl
import os
import re
import socket
import stat
import warnings
from types import TracebackType

from .._errors import Error, make
from ._store import Store

LOCK = ".vantage-batch.lock"

_WRITTEN = re.compile(rb"(process \d+ of [^\n]*\n)?")
"""What the file may hold."""

_NO_FILE = {errno.ELOOP, errno.EISDIR, errno.ENXIO}
"""What the system says of opening a link, a folder, a socket."""

_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP}
"""What file systems say that have no locks."""


class Lock:
    """For `with`: the folder belongs to this run, until it ends in whatever way: the system gives the lock back with the
    process. An object store has no locks.

    Raises:
        Error: another run works in the folder; something else has the name of the lock.
    """

    def __init__(self, store: Store):
        self._store = store
        self._path = store.path(LOCK)
        self._held: int | None = None

    def __enter__(self) -> None:
        if not self._store.is_local:
            return
        with self._store.writing(LOCK):
            os.makedirs(self._store.root, exist_ok=True)
            while self._held is None:
                self._held = self._try()
            os.ftruncate(self._held, 0)
            os.pwrite(self._held, f"process {os.getpid()} of {socket.gethostname()}\n".encode(), 0)

    def _try(self) -> int | None:
        """The lock; None where the file was removed meanwhile by the run that had it."""
        try:
            file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, 0o666)
        except OSError as error:
            if error.errno in _NO_FILE:
                raise self._of_others() from None
            raise
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.pread(file, 200, 0).decode(errors="replace").strip() or "another process"
            os.close(file)
            raise make("output", "folder-in-use", f"another run works in this folder: {holder}", self._store.where(),
                       "wait until it has ended, or choose another folder", None) from None
        except OSError as error:
            if error.errno not in _NO_LOCKS:
                os.close(file)
                raise
            warnings.warn(f"the file system of {self._store.where()} has no locks: see to it that no other run works in this "
                          "folder", stacklevel=4)
        if not self._leads_to(file):
            os.close(file)
            return None
        if not stat.S_ISREG(os.fstat(file).st_mode) or not _WRITTEN.fullmatch(os.pread(file, 1000, 0)):
            os.close(file)
            raise self._of_others()
        return file

    def _leads_to(self, file: int) -> bool:
        try:
            return os.path.samestat(os.lstat(self._path), os.fstat(file))
        except FileNotFoundError:
            return False

    def _of_others(self) -> Error:
        """It would be emptied, and removed at the end."""
        return make("output", "folder-in-use", "something that no run made has the name of the lock",
                    self._store.where(LOCK), "move it away, or choose another folder", None)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._held is not None:
            try:
                if self._leads_to(self._held):
                    os.unlink(self._path)
            except OSError:
                pass
            os.close(self._held)
            self._held = None
