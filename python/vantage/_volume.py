"""Volumes: closed meshes of every position from which the whole target can be seen."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import choice, flag, items, not_called, path as checked_path, shown, text, thread_count, whole
from ._errors import input_error
from ._folders import Folder
from ._mesh import Solid
from ._progress import Progress
from ._render import html
from ._requests import Path
from ._scene import Scene, checked_scene


class Volume(Solid):
    """A closed, oriented mesh in the scene's frame. Volumes do not change; their arrays are read-only views that outlive them.

    Example:
        >>> import vantage as vt
        >>> box = vt.Volume.from_arrays(
        ...     [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
        ...     [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        ...      [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
        >>> box
        <vantage.Volume: 1.0 m3, 12 facets>
    """

    def __init__(self, core: _core.Volume):
        not_called(core, _core.Volume, "vt.Volume", "read a file with vt.Volume.read, or make one with vt.Volume.from_arrays")
        self._core = core
        self._index: _core.SolidIndex | None = None

    @classmethod
    def read(cls, path: Path, *, scene: Scene | None = None, up: str = "z", scale: float = 1.0,
             progress: Progress = None) -> Volume:
        """Reads a volume, or any other closed mesh: PLY, OBJ, GLB or STL.

        Args:
            path: the file.
            scene: OBJ is in the axes and the unit of this scene's file, and a mesh that says where on the earth it lies is
                moved into its frame.
            up, scale: of an OBJ, without a scene.
            progress: called with stage and fraction; False stops.
        """
        core = checked_scene(scene)._core if scene is not None else None
        return cls(_core.read_volume(checked_path(path), choice(up, "up", ("y", "z")), _arrays.number(scale, "scale"), core,
                                     progress))

    @classmethod
    def from_arrays(cls, vertices: npt.ArrayLike, faces: npt.ArrayLike, *, cause: str = "mesh") -> Volume:
        """A mesh that is to be judged or cut as a volume: (n, 3) metres and (m, 3) indices, counter-clockwise from outside."""
        points = _arrays.points(vertices, "vertices")
        return cls(_core.volume_from_arrays(points, _arrays.faces(faces, len(points)), text(cause, "cause")))

    # ---- what is known of it, besides what `Solid` tells

    @property
    def _solid(self) -> _core.Volume:
        return self._core

    @property
    def hint(self) -> str:
        """What to try next, where it is empty."""
        return self._core.hint

    @property
    def tolerance_m(self) -> float:
        """How far range facets may lie inside the true range."""
        return self._core.tolerance_m

    @property
    def lift_m(self) -> list[float]:
        """How far each part of the target was raised to clear the surface that it lies on."""
        return self._core.lift_m

    @property
    def rounding_m(self) -> float:
        """How far the numbers of the file that it was read from had moved the surface."""
        return self._core.rounding_m

    @property
    def hash(self) -> str:
        """SHA-256 of the facets, 64 hexadecimal digits: docs/hashes.md."""
        return self._core.hash

    @property
    def provenance(self) -> dict[str, Any] | None:
        """What it was computed for: version, method, target, scene_hash, mission_hash."""
        return self._core.provenance

    # ---- what can be done with it

    def contains(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.bool_]:
        """Whether each point is in the volume, or on its surface: (n,) bool. Decided by the coordinates as they are, without
        rounding. `Result.contains` asks the scene instead: it knows what facets of the range leave out.

        Args:
            points: (n, 3), metres.
            threads: 0: as many as there are.
            progress: called with stage and fraction; False stops.

        Raises:
            Error: the mesh is not closed, or its triangles turn different ways.

        Example:
            >>> import vantage as vt
            >>> tetrahedron = vt.Volume.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
            ...                                     [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
            >>> tetrahedron.contains([[0.2, 0.2, 0.2], [0.25, 0.25, 0.5], [1, 1, 1]]).tolist()
            [True, True, False]
        """
        places, count = _arrays.points(points), thread_count(threads)
        if self._index is None:
            self._index = _core.SolidIndex(self._core)
        return self._index.contains(places, count, progress).view(np.bool_)

    def prove(self, scene: Scene, *, maximal: bool = False, shrink: float = 1e-6, threads: int = 0,
              progress: Progress = None) -> dict[str, Any]:
        """Proves or refutes that every position sees the whole target, within range.

        The volume must say what it was computed for, as files of `Result.save` do. Limits of navigation it does not say: they
        are judged by `Result.prove`.

        Args:
            scene: the scene that it was computed in; its hash is compared.
            maximal: also look for what is missing.
            shrink: the proof is of the volume shrunk by this part of the distance towards the target.
            threads: 0: as many as there are.
            progress: called with stage and fraction; False stops.

        Returns:
            what `vantage prove --json` prints; ["verdict"] is "proved", "not proved" or "wrong".
        """
        return json.loads(_core.prove_by_provenance(self._core, checked_scene(scene)._core, _arrays.number(shrink, "shrink"),
                                                    flag(maximal, "maximal"), thread_count(threads), progress))

    def simplify(self, *, facets: int | None = None, error_m: float | None = None, progress: Progress = None) -> Volume:
        """Fewer facets, and no position that it did not have.

        Args:
            facets: stop at so many.
            error_m: instead: nothing that is lost may be farther than this from the result.
            progress: called with stage and fraction; False stops.
        """
        if facets is not None and error_m is None:
            return Volume(self._core.simplify_to(whole(facets, "facets", 1), progress)[0])
        if error_m is not None and facets is None:
            return Volume(self._core.simplify_within(_arrays.number(error_m, "error_m"), progress)[0])
        raise input_error("nothing-given", "it is not said how far to simplify", "facets, error_m",
                          "give one of the two")

    def compare(self, other: Solid, *, names: tuple[str, str] = ("A", "B"), progress: Progress = None) -> dict[str, Any]:
        """How two volumes differ: what `vantage compare --json` prints, and under "only_a" and "only_b" the differences as
        volumes."""
        if not isinstance(names, Sequence) or len(names) != 2:
            raise input_error("wrong-type", f"names is {shown(names)}", "names", "pass two texts")
        first, second = text(names[0], "names[0]"), text(names[1], "names[1]")
        told, only_a, only_b = self._core.compare(volume_of(other, "other"), first, second, progress)
        return {**json.loads(told), "only_a": Volume(only_a), "only_b": Volume(only_b)}

    def __and__(self, other: Solid) -> Volume:
        return intersect([self, other])

    def __or__(self, other: Solid) -> Volume:
        return unite([self, other])

    # ---- elsewhere

    def save(self, path: Path, *, up: str = "z", scale: float = 1.0, sea_level_m: float | None = None) -> None:
        """Writes one of `vantage.output_formats()`, by the path's extension; whole or not at all.

        "volume.tiles" is a folder with 3D Tiles, for the globe (docs/tilesets.md): of a scene with a georeference.

        Args:
            path: the file.
            up, scale: of an OBJ: its axis upwards, and the metres in one of its units.
            sea_level_m: of KML and KMZ: z of the mean sea level, where heights of the scene are not above a geoid.
        """
        level = None if sea_level_m is None else _arrays.number(sea_level_m, "sea_level_m")
        self._core.save(checked_path(path), choice(up, "up", ("y", "z")), _arrays.number(scale, "scale"), level)

    def __reduce__(self) -> tuple[Any, ...]:
        if self.empty:
            return _empty, (self.outcome, self.reason)
        with Folder() as folder:
            file = os.path.join(folder, "volume.ply")
            self.save(file)
            with open(file, "rb") as saved:
                return _restored, (saved.read(),)

    def _repr_html_(self) -> str:
        return html(self)

    def __repr__(self) -> str:
        if self.empty:
            return f"<vantage.Volume: empty, {self.outcome}>"
        return f"<vantage.Volume: {self.volume_m3:,.1f} m3, {len(self.faces):,} facets>"


def volume_of(value: Any, name: str) -> _core.Volume:
    """Of a volume, or of the result that holds one."""
    if not isinstance(value, Solid):
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass a vt.Volume or a vt.Result")
    return value._solid


def _cores(volumes: Any) -> list[_core.Volume]:
    return [volume_of(one, f"volumes[{number}]") for number, one in enumerate(items(volumes, "volumes", "volumes"))]


def _restored(data: bytes) -> Volume:
    with Folder() as folder:
        file = os.path.join(folder, "volume.ply")
        with open(file, "wb") as out:
            out.write(data)
        return Volume.read(file)


def _empty(outcome: str, reason: str) -> Volume:
    return Volume(_core.empty_volume(outcome, reason))


def intersect(volumes: Iterable[Solid], progress: Progress = None) -> Volume:
    """The positions that all of the volumes hold; a & b for two.

    Example:
        >>> import vantage as vt
        >>> corners = [[x, y, z] for x in (0, 2) for y in (0, 1) for z in (0, 1)]
        >>> sides = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        ...          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        >>> a = vt.Volume.from_arrays(corners, sides)
        >>> b = vt.Volume.from_arrays([[x + 1, y, z] for x, y, z in corners], sides)
        >>> vt.intersect([a, b]).volume_m3
        1.0
    """
    return Volume(_core.intersect_volumes(_cores(volumes), progress))


def unite(volumes: Iterable[Solid], progress: Progress = None) -> Volume:
    """The positions that one of the volumes holds, or more; a | b for two.

    Example:
        >>> import vantage as vt
        >>> corners = [[x, y, z] for x in (0, 2) for y in (0, 1) for z in (0, 1)]
        >>> sides = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
        ...          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        >>> a = vt.Volume.from_arrays(corners, sides)
        >>> b = vt.Volume.from_arrays([[x + 1, y, z] for x, y, z in corners], sides)
        >>> vt.unite([a, b]).volume_m3
        3.0
    """
    return Volume(_core.unite_volumes(_cores(volumes), progress))
