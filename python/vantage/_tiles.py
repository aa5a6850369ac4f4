"""Maps that are larger than memory, in tiles."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Union, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._areas import Area, Face
from ._checks import path as checked_path
from ._errors import input_error
from ._progress import Progress
from ._requests import Path
from ._scene import Scene
from ._text import NAME, Text

Place = Union[Area, Face, npt.ArrayLike]


@dataclasses.dataclass(frozen=True)
class Tile:
    """A square of a map, and how to build what targets in it need."""

    index: int
    square_m: tuple[float, float, float, float]
    """west, south, east, north, in the scene's frame"""
    bbox: tuple[float, float, float, float]
    """west, south, east, north, degrees: what is built"""
    _plan: Tiles = dataclasses.field(repr=False, compare=False)

    def scene(self, progress: Progress = None) -> Scene:
        """Builds it. Outside of the map's buildings it holds the ground alone."""
        return self._plan._scene(self.bbox, progress)


class Tiles(Sequence[Tile]):
    """A map cut into squares, row by row from the south: a sequence of `Tile`.

    A target's volume is the same in its tile as in `whole()`: the same vertices, faces and causes, to the bit, but for
    `Cause.object`, which counts the objects of the scene at hand.
    """

    def __init__(self, path: Path, options: Mapping[str, Any], size_m: float, margin_m: float, progress: Progress):
        self.path = checked_path(path)
        """the map"""
        self.size_m, self.margin_m = _arrays.number(size_m, "size_m"), _arrays.number(margin_m, "margin_m")
        self._options = {key: value for key, value in options.items() if value is not None}
        text = Text()
        text.add("scene", {"osm": self.path, **self._options}, "scene")
        (origin, ground, reach), rows = text.call(
            lambda: _core.plan_tiles(text.text(), NAME, self.size_m, self.margin_m, progress))
        self.frame: dict[str, Any] = {"origin": origin, "ground": ground, "reach": reach}
        """what all tiles share, for `Scene.from_osm(..., frame=)`"""
        self._columns = max(1, math.ceil((ground[2] - ground[0]) / self.size_m))
        self._tiles = [Tile(i, (square[0], square[1], square[2], square[3]), (bbox[0], bbox[1], bbox[2], bbox[3]), self)
                       for i, (square, bbox) in enumerate(rows)]

    def whole(self, progress: Progress = None) -> Scene:
        """The whole map as one scene, prepared like its tiles."""
        return self._scene(None, progress)

    def of(self, place: Place, reach_m: float) -> Tile:
        """The tile of a target: that of the middle of its bounds.

        Args:
            place: an `Area`, a `Face`, or (n, 2) or (n, 3) corners in the frame of the tiles.
            reach_m: its range, and the distance to keep from obstacles, if there is one.

        Raises:
            Error: the target reaches so far beyond the tile's square that `margin_m` is not enough.
        """
        corners = self._corners(place)
        low, high = corners.min(axis=0), corners.max(axis=0)
        tile = self._tiles[self._index((low + high) / 2)]
        west, south, east, north = tile.square_m
        # Beyond the outermost tiles there is nothing to build.
        outer = self._tiles[0].square_m[:2] + self._tiles[-1].square_m[2:]
        beyond = max(float(max(west - low[0], 0)) if west > outer[0] else 0,
                     float(max(south - low[1], 0)) if south > outer[1] else 0,
                     float(max(high[0] - east, 0)) if east < outer[2] else 0,
                     float(max(high[1] - north, 0)) if north < outer[3] else 0)
        needed = math.hypot(beyond, beyond) + _arrays.number(reach_m, "reach_m")
        if not needed <= self.margin_m:
            raise input_error("value-out-of-range", f"the target needs a margin of {needed:.0f} m, and tiles have "
                              f"{self.margin_m:g} m", "margin_m", f"give at least {math.ceil(needed)}")
        return tile

    def position(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Metres east and north in the frame of the tiles, of a place on the earth."""
        return _core.position(self.frame["origin"], _arrays.number(latitude, "latitude"),
                              _arrays.number(longitude, "longitude"))

    def _index(self, at: npt.NDArray[np.float64]) -> int:
        west, south, _, _ = self.frame["ground"]
        rows = len(self._tiles) // self._columns
        column = min(max(math.floor((at[0] - west) / self.size_m), 0), self._columns - 1)
        row = min(max(math.floor((at[1] - south) / self.size_m), 0), rows - 1)
        return row * self._columns + column

    def _corners(self, place: Place) -> npt.NDArray[np.float64]:
        if isinstance(place, Area):
            return np.array([self.position(latitude, longitude) for rings in place.polygons
                             for longitude, latitude in rings[0]])
        if isinstance(place, Face):
            return np.concatenate(place.parts)[:, :2]
        corners = _arrays.numbers(place, "place")
        if corners.ndim != 2 or corners.shape[1] not in (2, 3) or not len(corners) or not np.isfinite(corners).all():
            raise input_error("array-sizes-differ", f"place has the shape {corners.shape}", "place",
                              "pass (n, 2) or (n, 3): finite x, y, z")
        return corners[:, :2]

    def _scene(self, bbox: Sequence[float] | None, progress: Progress) -> Scene:
        return Scene.from_osm(self.path, bbox=bbox, frame=self.frame, progress=progress, **self._options)

    @overload
    def __getitem__(self, index: int) -> Tile: ...
    @overload
    def __getitem__(self, index: slice) -> list[Tile]: ...
    def __getitem__(self, index: int | slice) -> Tile | list[Tile]:
        return self._tiles[index]

    def __len__(self) -> int:
        return len(self._tiles)

    def __iter__(self) -> Iterator[Tile]:
        return iter(self._tiles)

    def __repr__(self) -> str:
        rows = len(self._tiles) // self._columns
        return f"<vantage.Tiles: {self._columns} x {rows} squares of {self.size_m:g} m, margin {self.margin_m:g} m>"


def tiles(path: Path, size_m: float, margin_m: float, *, without: Sequence[str] | None = None,
          defaults: Mapping[str, float] | None = None, progress: Progress = None) -> Tiles:
    """Cuts a map into squares, so that each can be built by itself, and volumes are those of the whole map.

    The map is read once, and nothing is built. Maps with terrain cannot be cut.

    Args:
        path: an OpenStreetMap file.
        size_m: side of the squares, metres.
        margin_m: how far what is built goes on round a square: at least the range of the targets, the distance that
            they keep from obstacles, and how far they reach beyond their square. `Tiles.of` checks it.
        without: what is left out, of "walls", "towers", "bridges", "trees".
        defaults: what is assumed where the map says nothing: {"level": 3.2}.
        progress: called with stage and fraction; False stops.

    Raises:
        Error: the file cannot be read or has nothing to build, or a length is out of range.

    Example:
        >>> tiles = vt.tiles("city.osm.pbf", size_m=1000, margin_m=400)  # doctest: +SKIP
        >>> tile = tiles.of(area, reach_m=300)  # the tile of an area  # doctest: +SKIP
        >>> vt.compute(tile.scene(), area.target(), max_range=300)  # doctest: +SKIP
    """
    return Tiles(path, {"without": without, "defaults": defaults}, size_m, margin_m, progress)
