"""What the engine asks of the system: files of this machine, the time and memory, by the calls of Emscripten's C library."""

from __future__ import annotations

import errno
import os
import re
import stat
import struct
import sys
import tempfile
import time
from collections.abc import Callable
from typing import Any, Protocol

# Emscripten numbers errors as WASI does: their names in alphabetical order, after five that come first.
_NUMBERS = {
    "E2BIG": 1, "EACCES": 2, "EAGAIN": 6, "EBADF": 8, "EBUSY": 10, "EDQUOT": 19, "EEXIST": 20, "EFBIG": 22, "EINTR": 27,
    "EINVAL": 28, "EIO": 29, "EISDIR": 31, "ELOOP": 32, "EMFILE": 33, "EMLINK": 34, "ENAMETOOLONG": 37, "ENFILE": 41,
    "ENODEV": 43, "ENOENT": 44, "ENOMEM": 48, "ENOSPC": 51, "ENOSYS": 52, "ENOTDIR": 54, "ENOTEMPTY": 55, "ENOTSUP": 58,
    "ENOTTY": 59, "ENXIO": 60, "EPERM": 63, "EPIPE": 64, "ERANGE": 68, "EROFS": 69, "ESPIPE": 70, "EXDEV": 75,
}
_HERE = -100
"""The folder that names start from when no other is given (AT_FDCWD)."""
_NOT_FOLLOWED = 0x100
_OF_FILE_ITSELF = 0x1000
_REMOVES_FOLDER = 0x200
_FLAGS = [(0o100, os.O_CREAT), (0o200, os.O_EXCL), (0o1000, os.O_TRUNC), (0o2000, os.O_APPEND),
          (0o4000, getattr(os, "O_NONBLOCK", 0)), (0o200000, getattr(os, "O_DIRECTORY", 0)),
          (0o400000, getattr(os, "O_NOFOLLOW", 0))]
_PAGE = 65536
_ENTRY_BYTES = 280


def to_host(name: str) -> str:
    """A name as the engine has it, for this machine. The engine knows no drives: names with one begin there."""
    drive = re.search(r"(?:^|.*/)([A-Za-z]:[\\/].*)$", name, re.DOTALL) if os.name == "nt" else None
    return drive[1] if drive else name


def to_engine(name: str) -> str:
    """The name of a file of this machine, for the engine."""
    if os.name != "nt":
        return name
    name = name.replace("\\", "/")
    return name if name.startswith("/") else "/" + name


class Memory(Protocol):
    """The memory of the engine."""

    def read(self, at: int, size: int) -> bytearray: ...

    def write(self, at: int, data: bytes) -> None: ...

    def grow_to(self, size: int) -> bool: ...

    def remember(self, error: BaseException) -> None: ...


class System:
    """The functions that the engine imports, by their names. Each answers as the C library expects it."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._files: dict[int, str] = {}
        self._entries: dict[int, list[os.DirEntry[str]]] = {}
        self._environment = [f"TMPDIR={to_engine(tempfile.gettempdir())}".encode() + b"\0", b"LANG=C.UTF-8\0"]

    def functions(self) -> dict[str, Callable[..., Any]]:
        """All of them; of those that answer a number, an OSError becomes the number of the error."""
        numbered = {name[4:]: self._numbered(name) for name in dir(self) if name.startswith("_on_")}
        return {**numbered, "emscripten_get_now": lambda: time.perf_counter() * 1e3, "abort": _abort,
                "_tzset_js": lambda *_: None, "setTempRet0": lambda _: None}

    def _numbered(self, name: str) -> Callable[..., int]:
        work = getattr(self, name)
        sign = 1 if name.startswith("_on_fd_") else -1  # WASI's own calls answer it as it is

        def call(*arguments: int) -> int:
            try:
                return int(work(*arguments) or 0)
            except OSError as error:
                return sign * _NUMBERS.get(errno.errorcode.get(error.errno or 0, ""), _NUMBERS["EIO"])
            except BaseException as error:  # Ctrl-C, say: it must not fly through the engine
                self._memory.remember(error)
                return sign * _NUMBERS["EIO"]

        return call

    # ---- memory

    def text(self, at: int) -> str:
        """The text that ends with a zero. Names of files may be any bytes."""
        found, size = b"", 128
        while b"\0" not in found:
            found += bytes(self._memory.read(at + len(found), size))
        return os.fsdecode(found[:found.index(b"\0")])

    def _path(self, at: int, folder: int = _HERE) -> str:
        name = to_host(self.text(at))
        return name if folder == _HERE or os.path.isabs(name) else os.path.join(self._files[folder], name)

    def _put(self, at: int, layout: str, *values: float) -> int:
        self._memory.write(at, struct.pack("<" + layout, *values))
        return 0

    def _vectors(self, at: int, count: int) -> list[tuple[int, int]]:
        return list(struct.iter_unpack("<II", bytes(self._memory.read(at, 8 * count))))

    def _on_emscripten_resize_heap(self, size: int) -> int:
        return self._memory.grow_to(size & 0xFFFFFFFF)

    def _on_emscripten_get_heap_max(self) -> int:
        return -_PAGE  # 4 GiB less a page, as a signed number

    def _on_emscripten_memcpy_big(self, to: int, source: int, size: int) -> int:
        self._memory.write(to, bytes(self._memory.read(source, size & 0xFFFFFFFF)))
        return to

    # ---- files

    def _on___syscall_open(self, name: int, flags: int, more: int) -> int:
        return self._on___syscall_openat(_HERE, name, flags, more)

    def _on___syscall_openat(self, folder: int, name: int, flags: int, more: int) -> int:
        path = self._path(name, folder)
        mode = struct.unpack("<I", bytes(self._memory.read(more, 4)))[0] if more and flags & 0o100 else 0o666
        asked = (flags & 3) | sum(own for bit, own in _FLAGS if flags & bit) | getattr(os, "O_BINARY", 0)
        if os.name == "nt" and os.path.isdir(path):  # there folders have no numbers: one of nothing stands for it
            number = os.open(os.devnull, os.O_RDONLY)
        else:
            number = os.open(path, asked, mode)
        self._files[number] = path
        return number

    def _open_file(self, number: int) -> int:
        """None but what the engine has opened, and the standard streams."""
        if number not in self._files and number not in (1, 2):
            raise OSError(errno.EBADF, "not open")
        return number

    def _on_fd_close(self, number: int) -> int:
        self._open_file(number)
        self._entries.pop(number, None)
        if self._files.pop(number, None) is not None:
            os.close(number)
        return 0

    def _on_fd_read(self, number: int, vectors: int, count: int, told: int) -> int:
        self._open_file(number)
        done = 0
        for at, size in self._vectors(vectors, count):
            data = os.read(number, size)
            self._memory.write(at, data)
            done += len(data)
            if len(data) < size:
                break
        return self._put(told, "I", done)

    def _on_fd_pread(self, number: int, vectors: int, count: int, low: int, high: int, told: int) -> int:
        before = os.lseek(self._open_file(number), 0, os.SEEK_CUR)
        os.lseek(number, (low & 0xFFFFFFFF) + (high << 32), os.SEEK_SET)
        try:
            return self._on_fd_read(number, vectors, count, told)
        finally:
            os.lseek(number, before, os.SEEK_SET)

    def _on_fd_write(self, number: int, vectors: int, count: int, told: int) -> int:
        self._open_file(number)
        done = 0
        for at, size in self._vectors(vectors, count):
            data = bytes(self._memory.read(at, size))
            if number in (1, 2):
                sys.stderr.write(data.decode(errors="replace"))
            else:
                while data:
                    data = data[os.write(number, data):]
            done += size
        return self._put(told, "I", done)

    def _on_fd_seek(self, number: int, low: int, high: int, whence: int, told: int) -> int:
        return self._put(told, "q", os.lseek(self._open_file(number), (low & 0xFFFFFFFF) + (high << 32), whence))

    def _on_fd_sync(self, number: int) -> None:
        os.fsync(self._open_file(number))

    def _on_fd_fdstat_get(self, number: int, at: int) -> int:
        mode = os.fstat(self._open_file(number)).st_mode
        kind = 3 if stat.S_ISDIR(mode) else 4 if stat.S_ISREG(mode) else 2
        return self._put(at, "BxHxxxxQQ", kind, 0, 0, 0)

    def _put_stat(self, found: os.stat_result, at: int) -> int:
        number = found.st_ino & 0xFFFFFFFF
        times = [(ns // 10**9 & 0x7FFFFFFF, ns % 10**9) for ns in (found.st_atime_ns, found.st_mtime_ns, found.st_ctime_ns)]
        return self._put(at, "IIIIIIIIIxxxxqIIiiiiiiQ", found.st_dev & 0xFFFFFFFF, 0, number, found.st_mode, found.st_nlink & 0xFFFFFFFF,
                         found.st_uid, found.st_gid, 0, 0, found.st_size, 4096, (found.st_size + 511) // 512 & 0xFFFFFFFF,
                         *times[0], *times[1], *times[2], found.st_ino & 0xFFFFFFFFFFFFFFFF)

    def _on___syscall_stat64(self, name: int, at: int) -> int:
        return self._put_stat(os.stat(self._path(name)), at)

    def _on___syscall_lstat64(self, name: int, at: int) -> int:
        return self._put_stat(os.lstat(self._path(name)), at)

    def _on___syscall_fstat64(self, number: int, at: int) -> int:
        path = self._files.get(number, "")
        if os.name == "nt" and os.path.isdir(path):
            return self._put_stat(os.stat(path), at)
        return self._put_stat(os.fstat(self._open_file(number)), at)

    def _on___syscall_fstatat64(self, folder: int, name: int, at: int, flags: int) -> int:
        if flags & _OF_FILE_ITSELF and not self.text(name):
            return self._on___syscall_fstat64(folder, at)
        path = self._path(name, folder)
        return self._put_stat(os.lstat(path) if flags & _NOT_FOLLOWED else os.stat(path), at)

    def _on___syscall_faccessat(self, folder: int, name: int, mode: int, _flags: int) -> int:
        path = self._path(name, folder)
        os.stat(path)
        if not os.access(path, mode & 7):
            raise OSError(errno.EACCES, "no access")
        return 0

    def _on___syscall_getdents64(self, number: int, at: int, size: int) -> int:
        self._open_file(number)
        if number not in self._entries:
            with os.scandir(self._files[number]) as entries:
                self._entries[number] = sorted(entries, key=lambda entry: entry.name)
        left, done = self._entries[number], 0
        while left and done + _ENTRY_BYTES <= size:
            entry = left.pop(0)
            name = os.fsencode(entry.name)
            kind = 10 if entry.is_symlink() else 4 if entry.is_dir() else 8
            self._memory.write(at + done, struct.pack("<QqHB", entry.inode() & (2**64 - 1), 1, _ENTRY_BYTES, kind) +
                               name[:256].ljust(261, b"\0"))
            done += _ENTRY_BYTES
        return done

    def _on___syscall_readlink(self, name: int, at: int, size: int) -> int:
        target = os.fsencode(os.readlink(self._path(name)))[:size]
        self._memory.write(at, target)
        return len(target)

    def _on___syscall_mkdir(self, name: int, mode: int) -> None:
        os.mkdir(self._path(name), mode)

    def _on___syscall_rmdir(self, name: int) -> None:
        os.rmdir(self._path(name))

    def _on___syscall_unlink(self, name: int) -> None:
        os.unlink(self._path(name))

    def _on___syscall_unlinkat(self, folder: int, name: int, flags: int) -> None:
        (os.rmdir if flags & _REMOVES_FOLDER else os.unlink)(self._path(name, folder))

    def _on___syscall_rename(self, name: int, new: int) -> None:
        os.replace(self._path(name), self._path(new))

    def _on___syscall_linkat(self, folder: int, name: int, new_folder: int, new: int, _flags: int) -> None:
        os.link(self._path(name, folder), self._path(new, new_folder))

    def _on___syscall_chmod(self, name: int, mode: int) -> None:
        os.chmod(self._path(name), mode)

    def _on___syscall_fchmod(self, number: int, mode: int) -> None:
        self._open_file(number)
        if hasattr(os, "fchmod"):
            os.fchmod(number, mode)

    def _on___syscall_getcwd(self, at: int, size: int) -> int:
        folder = os.fsencode(to_engine(os.getcwd())) + b"\0"
        if len(folder) > size:
            raise OSError(errno.ERANGE, "too long")
        self._memory.write(at, folder)
        return at

    def _on___syscall_geteuid32(self) -> int:
        return os.geteuid() if hasattr(os, "geteuid") else 0

    def _on___syscall_getegid32(self) -> int:
        return os.getegid() if hasattr(os, "getegid") else 0

    def _on___syscall_fcntl64(self, number: int, _command: int, _more: int) -> None:
        self._open_file(number)

    def _on___syscall_ioctl(self, number: int, _command: int, _more: int) -> None:
        self._open_file(number)
        raise OSError(errno.ENOTTY, "no terminal")

    # ---- time and environment

    def _on_clock_gettime(self, clock: int, at: int) -> int:
        now = time.time_ns() if clock == 0 else time.monotonic_ns()
        return self._put(at, "ii", now // 10**9 & 0x7FFFFFFF, now % 10**9)

    def _on___clock_gettime(self, clock: int, at: int) -> int:
        return self._on_clock_gettime(clock, at)

    def _on_environ_sizes_get(self, count: int, size: int) -> int:
        self._put(count, "I", len(self._environment))
        return self._put(size, "I", sum(map(len, self._environment)))

    def _on_environ_get(self, places: int, at: int) -> int:
        for number, text in enumerate(self._environment):
            self._put(places + 4 * number, "I", at)
            self._memory.write(at, text)
            at += len(text)
        return 0


def _abort(*_: Any) -> None:
    raise RuntimeError("the engine gave up")
