"""The map that a scene was built of, for scenes that are kept elsewhere and come back."""

from __future__ import annotations

import dataclasses
import hashlib
import os

from ._errors import Error, input_error


@dataclasses.dataclass
class Source:
    """The file, and what was asked of it."""

    text: str
    """the `scene` of a mission file"""
    file: str
    hash: str = ""
    """SHA-256 of the file; empty: it was not there any more, or another one, when the scene was pickled"""
    state: tuple[int, int] | None = None
    """bytes and time of the file when it was read"""
    is_known: bool = True
    """whether the scene itself knows it"""

    @classmethod
    def of(cls, text: str, file: str) -> Source:
        """To be called before the file is read."""
        return cls(text, file, state=_state_of(file))

    def kept(self) -> Source:
        """For a scene that is pickled: with the hash of the file, if that is still what was read."""
        if not self.is_known:
            return self
        is_same = self.state is not None and self.state == _state_of(self.file)
        return Source(self.text, self.file, _hash_of(self.file) if is_same else "", is_known=False)

    def problem(self) -> Error | None:
        """Why areas of the map cannot be looked up in a scene that was unpickled."""
        if not os.path.exists(self.file):
            return input_error("file-not-found", "the scene was unpickled, and its map is not there", self.file,
                               "put the map there, or build the scene anew")
        if not self.hash or _hash_of(self.file) != self.hash:
            return input_error("file-changed", "the scene was unpickled, and its map has changed since it was built", self.file,
                               "build the scene anew")
        return None


def _state_of(file: str) -> tuple[int, int] | None:
    try:
        state = os.stat(file)
    except OSError:
        return None
    return state.st_size, state.st_mtime_ns


def _hash_of(file: str) -> str:
    digest = hashlib.sha256()
    with open(file, "rb") as data:
        while block := data.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
