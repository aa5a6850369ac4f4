"""The objects of scenes, and their kinds."""

from __future__ import annotations

from typing import NamedTuple

from . import _core

KINDS: tuple[str, ...] = tuple(_core.object_kinds())
"""What an object can be: "other", "ground", "building", ..."""


class SceneObject(NamedTuple):
    """Who an object of a scene is."""

    name: str
    source_id: str = ""
    kind: str = "other"
