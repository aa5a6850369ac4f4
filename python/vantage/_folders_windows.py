"""How _folders.py marks, holds and removes folders on Windows: as long as the mark is open, nobody else can rename or remove it."""

from __future__ import annotations

import os
import shutil

from ._folders_mark import MARK, MARK_TEXT


_NEW = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOINHERIT", 0)
_LEADS_ELSEWHERE = 0x400  # FILE_ATTRIBUTE_REPARSE_POINT: links and junctions


def mark_and_hold(path: str) -> int | None:
    """The mark of a new folder, open."""
    file = os.open(os.path.join(path, MARK), _NEW, 0o600)
    try:
        os.write(file, MARK_TEXT)
    except OSError:
        os.close(file)
        _remove(path)
        raise
    return file


def remove_if_abandoned(path: str) -> None:
    """Where nobody has the mark open. What cannot be removed stays."""
    mark = os.path.join(path, MARK)
    try:
        os.rename(mark, mark + "-left")
        os.rename(mark + "-left", mark)
    except OSError:  # held, or there is none
        return
    remove_own(path)


def remove_own(path: str) -> None:
    """A folder with the mark that nobody has open; no link to one."""
    try:
        with open(os.path.join(path, MARK), "rb") as file:
            is_own = file.read(len(MARK_TEXT) + 1) == MARK_TEXT
        is_link = getattr(os.lstat(path), "st_file_attributes", 0) & _LEADS_ELSEWHERE
    except OSError:
        return
    if is_own and not is_link:
        _remove(path)


def end(path: str, held: int, process: int) -> None:
    os.close(held)
    for _ in range(3):  # another thread may still be writing
        _remove(path)
        if not os.path.lexists(path):
            break


def _remove(path: str) -> None:
    """The mark last: what a killed process leaves of it is still marked."""
    try:
        with os.scandir(path) as entries:
            others = [entry for entry in entries if entry.name != MARK]
    except OSError:
        return
    for entry in others:
        if entry.is_dir(follow_symlinks=False):
            shutil.rmtree(entry.path, ignore_errors=True)
        else:
            try:
                os.unlink(entry.path)
            except OSError:
                pass
    shutil.rmtree(path, ignore_errors=True)
