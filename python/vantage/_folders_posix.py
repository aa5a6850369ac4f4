"""How _folders.py marks, holds and removes folders where the system has flock."""

from __future__ import annotations

import fcntl
import os
import shutil
import stat

from ._folders_mark import MARK, MARK_TEXT


def _put_mark(path: str) -> None:
    """Raises OSError where it cannot be put there, or something has its name."""
    mark = os.path.join(path, MARK)
    file = os.open(mark, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    try:
        with open(file, "wb") as stream:
            stream.write(MARK_TEXT)
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
        return os.read(file, len(MARK_TEXT) + 1) if is_own_file else None
    except OSError:
        return None
    finally:
        os.close(file)


def _is_own(path: str, folder: int) -> bool:
    return os.fstat(folder).st_uid == os.geteuid() and _mark_in(folder) == MARK_TEXT and _leads_to(path, folder)


def remove_own(path: str) -> None:
    """Whoever holds it."""
    try:
        folder = _open(path)
    except OSError:
        return
    try:
        _remove_own(path, folder)
    except OSError:  # it stays
        pass
    finally:
        os.close(folder)


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
    if about.st_uid != os.geteuid() or stat.S_IMODE(about.st_mode) != 0o700 or not MARK_TEXT.startswith(mark or b"") or \
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


def mark_and_hold(path: str) -> int | None:
    """Open, locked and marked; None where another process took it for an abandoned one before it was."""
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
        _mark_new(path, folder)
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


def remove_if_abandoned(path: str) -> None:
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


def end(path: str, held: int, process: int) -> None:
    if os.getpid() == process:  # a forked process has the objects of its parent, but not their folders
        for _ in range(3):  # another thread may still be writing
            _remove(path)
            if not os.path.lexists(path):
                break
    os.close(held)
