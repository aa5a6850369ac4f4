"""The objects of scenes, and their kinds."""

from __future__ import annotations

from typing import Any, NamedTuple

from . import _core

KINDS: tuple[str, ...] = tuple(_core.object_kinds())
"""What an object can be: "other", "ground", "building", ..."""


class SceneObject(NamedTuple):
    """Who an object of a scene is."""

    name: str
    source_id: str = ""
    kind: str = "other"


class Missing(NamedTuple):
    """What a reader saw and did not build as it stands: an entry of the scene's ledger."""

    object: SceneObject
    what: str
    reason: str
    box: list[float] | None = None
    """x, y, z of the lowest and of the highest corner, metres"""
    stand_in: int | None = None
    """the object that holds its place"""
    instead: str = ""

    def row(self) -> tuple[Any, ...]:
        """As `_core.scene_from_arrays` takes it."""
        name, source_id, kind = self.object
        return ((name, source_id, KINDS.index(kind)), self.what, self.reason, self.box, None, self.stand_in, self.instead,
                False, [])
