"""Where results lie: a folder, or an object store by fsspec. Files are written whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import threading
from collections.abc import Callable, Mapping
from typing import Any

from .._errors import Error, input_error, make
from .._extras import require
from .._folders import Folder, remove_all
from .._requests import Path

_PUT_IS_WHOLE = {"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "memory"}
"""Protocols whose files appear when all of them was sent."""


UNFINISHED = ".unfinished-"
"""How the names of folders begin that `Store.scratch` makes."""


_PART = re.compile(r"\..+\.vantage-\d+-\d+\.part")
"""The names of unfinished files, as `_beside` makes them."""

_WITH_PARTS = ("", "rows", "volumes")
"""The folders in which such files are made."""


class Store:
    """A folder that may be remote: "results/", "s3://bucket/results". Any number of processes may write to it."""

    def __init__(self, url: Path, options: Mapping[str, Any] | None = None):
        self.url = os.fspath(url)
        self.options = dict(options or {})
        fsspec = require("fsspec", "batch")
        try:
            self.files, root = fsspec.core.url_to_fs(self.url, **self.options)
        except ValueError as error:
            raise input_error("value-unsupported", str(error), self.url,
                              "name a folder, or an object store that fsspec knows: s3://bucket/folder") from None
        except ImportError as error:
            raise input_error("component-missing", str(error), self.url, "install that package with pip") from None
        self.root = str(root).rstrip("/")
        protocol = self.files.protocol
        self.protocol = protocol if isinstance(protocol, str) else protocol[0]
        self.is_local = self.protocol in ("file", "local")
        if self.is_local:
            self.url = self.root  # workers may have another working folder

    def path(self, name: str) -> str:
        """Of a file in it, for `files`."""
        return f"{self.root}/{name}"

    def where(self, name: str = "") -> str:
        """For messages."""
        return f"{self.url.rstrip('/')}/{name}" if name else self.url

    def read(self, name: str) -> bytes | None:
        """None where there is no such file."""
        self.files.invalidate_cache()  # other processes write files
        try:
            return bytes(self.files.cat_file(self.path(name)))
        except FileNotFoundError:
            return None
        except OSError as error:
            raise make("input", "file-unreadable", f"cannot be read: {error}", self.where(name),
                       "check the permissions and the connection", None) from error

    def size(self, name: str) -> int | None:
        """Of a file, in bytes; None where there is no such file."""
        self.files.invalidate_cache()
        try:
            return int(self.files.size(self.path(name)))
        except FileNotFoundError:
            return None
        except OSError as error:
            raise make("input", "file-unreadable", f"cannot be read: {error}", self.where(name),
                       "check the permissions and the connection", None) from error

    def names(self, folder: str) -> list[str]:
        """The files of a folder, sorted; none where there is no such folder."""
        self.files.invalidate_cache()
        try:
            found = self.files.ls(self.path(folder), detail=False)
        except FileNotFoundError:
            return []
        return sorted(str(path).rstrip("/").rsplit("/", 1)[-1] for path in found)

    def put(self, name: str, content: bytes) -> None:
        """Writes a file, whole or not at all.

        Raises:
            Error: it cannot be written, as when the disk is full.
        """
        with self.writing(name):
            if self.is_local:
                self._put_local(name, content)
            elif self.protocol in _PUT_IS_WHOLE:
                self.files.pipe_file(self.path(name), content)
            else:
                self._put_beside(name, lambda beside: self.files.pipe_file(beside, content))

    def put_file(self, name: str, local: Path) -> None:
        """Moves a finished local file to it, whole or not at all."""
        if self.is_local:
            with self.writing(name):
                target = self.path(name)
                os.makedirs(os.path.dirname(target), exist_ok=True)
                with open(local, "rb") as file:
                    os.fsync(file.fileno())
                os.replace(local, target)
                _sync_folder(os.path.dirname(target))
            return
        with self.writing(name):
            if self.protocol in _PUT_IS_WHOLE:
                self.files.put_file(os.fspath(local), self.path(name))
            else:
                self._put_beside(name, lambda beside: self.files.put_file(os.fspath(local), beside))

    def scratch(self) -> Folder:
        """A local folder for files that `put_file` will move, on the same disk where the store is local; for `with`.

        `remove_unfinished` removes those that others left there: workers of the same run may be on machines whose locks are
        not seen here.
        """
        with self.writing(""):
            if self.is_local:
                os.makedirs(self.root, exist_ok=True)
            return Folder(UNFINISHED, self.root if self.is_local else None, removes_others=not self.is_local)

    def remove_unfinished(self) -> None:
        """Removes what killed processes left unfinished, and nothing that only looks like it. Call it while nobody else
        writes: with the folder's lock, and before work begins or after all is done."""
        if not self.is_local:
            return
        for folder in _WITH_PARTS:
            _remove_parts(os.path.join(self.root, folder))
        remove_all(UNFINISHED, self.root)

    def _put_beside(self, name: str, send: Callable[[str], Any]) -> None:
        """To a name beside it, and then moved: where the connection is lost, no half of a file has its name."""
        beside = self.path(_beside(name))
        self.files.makedirs(beside.rsplit("/", 1)[0], exist_ok=True)
        try:
            send(beside)
            self.files.mv(beside, self.path(name))
        except BaseException:
            with contextlib.suppress(Exception):  # what went wrong first is what counts
                self.files.rm_file(beside)
            raise

    def _put_local(self, name: str, content: bytes) -> None:
        target, beside = self.path(name), self.path(_beside(name))
        os.makedirs(os.path.dirname(target), exist_ok=True)
        try:
            with open(beside, "wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(beside, target)
            _sync_folder(os.path.dirname(target))
        except BaseException:
            if os.path.exists(beside):
                os.unlink(beside)
            raise

    def writing(self, name: str) -> _WriteErrors:
        """For `with`: what the system says of writing that file is raised as an Error."""
        return _WriteErrors(self.where(name))

    def __reduce__(self) -> tuple[Any, ...]:
        return Store, (self.url, self.options)


class _WriteErrors:
    """For `with`: an exception of the system becomes an Error."""

    def __init__(self, where: str):
        self._where = where

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> None:
        if error is None or isinstance(error, Error) or not isinstance(error, Exception):
            return
        raise unwritable(error, self._where) from error


def unwritable(error: Exception, where: str) -> Error:
    """For what could not be written."""
    full = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    said = error.problem if isinstance(error, Error) else error
    fix = "make room and run it again: it goes on where it was" if full else \
        "check the permissions and the connection, and run it again: it goes on where it was"
    return make("output", "output-unwritable", f"the results cannot be written: {said}", where, fix, None)


def _sync_folder(folder: str) -> None:
    """Brings a new name to the disk. Not every file system lets a folder be synchronised; the file is whole either way."""
    try:
        opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    except OSError:
        return
    try:
        os.fsync(opened)
    except OSError:
        pass
    finally:
        os.close(opened)


def _remove_parts(folder: str) -> None:
    try:
        with os.scandir(folder) as entries:
            parts = [entry.path for entry in entries
                     if _PART.fullmatch(entry.name) and entry.is_file(follow_symlinks=False)]
    except (FileNotFoundError, NotADirectoryError):
        return
    for part in parts:
        os.unlink(part)


def _beside(name: str) -> str:
    """A name for the unfinished file, which no other process uses."""
    folder, _, last = name.rpartition("/")
    hidden = f".{last}.vantage-{os.getpid()}-{threading.get_ident()}.part"
    return f"{folder}/{hidden}" if folder else hidden
