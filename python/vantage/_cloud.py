"""Clouds of points as closed solids; LAS and LAZ files by laspy (the extra `laz`)."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import items, whole
from ._errors import Error, input_error
from ._extras import require
from ._las_crs import file_crs, keys_of, z_unit_m as z_unit
from ._objects import Missing, SceneObject
from ._place import WGS84, Georeference, crs_text

Numbers = npt.NDArray[np.float64]

MOST_CELLS = 2_000_000
"""Of the grid: the solid has somewhat more than two triangles for each."""
_CHUNK_BYTES = 1 << 26
"""Of the points that are read at once."""
_HEADER, _VLR, _EVLR = 227, 54, 60
"""The least bytes of a header, and of what says how long a record of variable length is: LAS 1.4, 2.4 to 2.8."""
_BELOW_M = 1.0
"""How far the base is under the lowest point."""


class Cloud(NamedTuple):
    """What `Scene.from_arrays` takes."""

    vertices: Numbers
    faces: npt.NDArray[np.int64]
    place: Georeference | None
    ledger: Sequence[Missing] = ()


class _LeftOut:
    """Points that are left out by their classes."""

    def __init__(self, classes: list[int]):
        self.classes = classes
        self.count, self.low, self.high = 0, np.full(3, np.inf), np.full(3, -np.inf)

    def add(self, points: Numbers) -> None:
        if len(points):
            self.count += len(points)
            self.low, self.high = np.minimum(self.low, points.min(axis=0)), np.maximum(self.high, points.max(axis=0))

    def ledger(self, moved: Callable[[Numbers], Numbers] = lambda points: points) -> list[Missing]:
        """`moved`: into the scene's frame."""
        if not self.count:
            return []
        corners = moved(np.array([[x, y, z] for x in (self.low[0], self.high[0]) for y in (self.low[1], self.high[1])
                                  for z in (self.low[2], self.high[2])]))
        return [Missing(SceneObject("points", "", "surface"),
                        f"points of the classes {', '.join(map(str, self.classes))}: {self.count:,}",
                        "they are left out by choice (without)", [*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist()])]


def _too_many(cell_m: float) -> Error:
    return input_error("mesh-too-large", f"the points cover more than {MOST_CELLS:,} cells of {cell_m:g} m", "cell_m",
                       "choose larger cells, or a part of the points")


def _highest(parts: Iterable[Numbers], cell_m: float) -> tuple[Numbers, tuple[int, int], float]:
    """The highest point of each cell, NaN where there is none, (rows of y, columns of x); the cell of the first; the lowest z
    of all points."""
    kept: list[Numbers] = []
    for points in parts:
        if not np.isfinite(points).all():
            raise input_error("coordinate-not-finite", "a point has a coordinate that is no number", "points", "leave it out")
        if np.abs(points).max(initial=0) > 1e9:
            raise input_error("coordinate-too-large", "a point lies more than 1e9 m from the origin", "points",
                              "move the points near the origin")
        kept.append(_merged(np.column_stack([np.floor(points[:, :2] / cell_m), points[:, 2], points[:, 2]])))
        if sum(map(len, kept)) > 2 * MOST_CELLS:
            kept = [_merged(np.concatenate(kept))]
            if len(kept[0]) > MOST_CELLS:
                raise _too_many(cell_m)
    cells = _merged(np.concatenate(kept)) if kept else np.zeros((0, 4))
    if not len(cells):
        raise input_error("nothing-given", "there are no points", "points", "give one or more; see without=")
    low, high = cells[:, :2].min(axis=0), cells[:, :2].max(axis=0)
    columns, rows = (high - low + 1).astype(np.int64).tolist()
    if columns * rows > MOST_CELLS:
        raise _too_many(cell_m)
    grid = np.full((rows, columns), np.nan)
    at = (cells[:, :2] - low).astype(np.int64)
    grid[at[:, 1], at[:, 0]] = cells[:, 2]
    return grid, (int(low[0]), int(low[1])), float(cells[:, 3].min())


def _merged(rows: Numbers) -> Numbers:
    """Of rows (column, row, highest z, lowest z) one for each cell."""
    if not len(rows):
        return rows
    rows = rows[np.lexsort((rows[:, 0], rows[:, 1]))]
    starts = np.flatnonzero(np.r_[True, (np.diff(rows[:, :2], axis=0) != 0).any(axis=1)])
    return np.column_stack([rows[starts, :2], np.maximum.reduceat(rows[:, 2], starts),
                            np.minimum.reduceat(rows[:, 3], starts)])


def _filled(grid: Numbers) -> Numbers:
    """Cells without points get the highest of the nearest cells that have some, as far as the first of these are in steps to
    the eight neighbours: the highest in the smallest square about the cell that holds any. Takes no longer where that is far."""
    rows, columns = grid.shape
    empty = np.isnan(grid)
    y, x = np.nonzero(empty)
    counts = np.zeros((rows + 1, columns + 1), np.int64)  # of cells with points above and to the left
    counts[1:, 1:] = np.cumsum(np.cumsum(~empty, axis=0), axis=1)

    def square(steps: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], ...]:
        """First and behind the last of its rows, then of its columns."""
        return (np.maximum(y - steps, 0), np.minimum(y + steps + 1, rows),
                np.maximum(x - steps, 0), np.minimum(x + steps + 1, columns))

    steps, most = np.zeros(len(y), np.int64), np.full(len(y), max(rows, columns) - 1)
    while (steps < most).any():  # bisection
        middle = (steps + most) // 2
        top, bottom, left, right = square(middle)
        holds = counts[bottom, right] - counts[top, right] - counts[bottom, left] + counts[top, left] > 0
        steps, most = np.where(holds, steps, middle + 1), np.where(holds, middle, most)
    return _highest_within(grid, (y, x), square(steps))


def _highest_within(grid: Numbers, at: tuple[npt.NDArray[np.int64], ...], boxes: tuple[npt.NDArray[np.int64], ...]) -> Numbers:
    """The grid with the highest of a box at each of these cells: that of four boxes that overlap, with sides of powers of 2."""
    top, bottom, left, right = boxes
    result = grid.copy()
    tall, wide = np.frexp(bottom - top)[1] - 1, np.frexp(right - left)[1] - 1  # exponents of 2
    columns_of = np.where(np.isnan(grid), -np.inf, grid)  # the highest of 2^i rows from here, then of 2^j columns
    for i in range(int(tall.max(initial=-1)) + 1):
        if i > 0:
            columns_of = np.maximum(columns_of[:-(1 << i - 1)], columns_of[1 << i - 1:])
        boxes_of = columns_of
        for j in range(int(wide[tall == i].max(initial=-1)) + 1):
            if j > 0:
                boxes_of = np.maximum(boxes_of[:, :-(1 << j - 1)], boxes_of[:, 1 << j - 1:])
            one = np.flatnonzero((tall == i) & (wide == j))
            t, b, l, r = top[one], bottom[one] - (1 << i), left[one], right[one] - (1 << j)
            result[at[0][one], at[1][one]] = np.maximum.reduce([boxes_of[t, l], boxes_of[b, l], boxes_of[t, r], boxes_of[b, r]])
    return result


def _solid(grid: Numbers, first: tuple[int, int], base: float, cell_m: float) -> tuple[Numbers, npt.NDArray[np.int64]]:
    """A closed solid over the grid: at the corner of cells it is as high as the highest of these."""
    rows, columns = grid.shape
    wide = np.pad(grid, 1, constant_values=-np.inf)
    tops = np.maximum.reduce([wide[i:i + rows + 1, j:j + columns + 1] for i in range(2) for j in range(2)])
    x, y = np.meshgrid((np.arange(columns + 1) + first[0]) * cell_m, (np.arange(rows + 1) + first[1]) * cell_m)
    upper = np.column_stack([x.ravel(), y.ravel(), tops.ravel()])
    index = np.arange(upper.shape[0]).reshape(rows + 1, columns + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = [np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
    rim = np.concatenate([index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0]])  # counter-clockwise
    lower = upper[rim]
    lower[:, 2] = base
    under = np.arange(len(rim)) + len(upper)
    following, under_following = np.roll(rim, -1), np.roll(under, -1)
    faces += [np.column_stack([rim, under, under_following]), np.column_stack([rim, under_following, following])]
    middle = len(upper) + len(lower)
    centre = np.append(lower[:, :2].mean(axis=0), base)
    faces.append(np.column_stack([np.full(len(rim), middle), under_following, under]))
    return np.concatenate([upper, lower, centre[None]]), np.concatenate(faces)


def solid_of(parts: Iterable[Numbers], cell_m: float) -> tuple[Numbers, npt.NDArray[np.int64]]:
    """The solid of points, (n, 3) each: see `Scene.from_points`."""
    if not 1e-3 <= cell_m <= 1e5:
        raise input_error("value-out-of-range", f"cell_m is {cell_m:g}", "cell_m", "give metres, 0.001 to 100000")
    grid, first, lowest = _highest(parts, cell_m)
    return _solid(_filled(grid), first, lowest - _BELOW_M, cell_m)


def cloud_of_points(points: npt.ArrayLike, cell_m: float) -> Cloud:
    """Of points in memory."""
    vertices, faces = solid_of([_arrays.points(points)], cell_m)
    return Cloud(vertices, faces, None)


def _place_of(header: Any, crs: str, origin: Any) -> tuple[float, float]:
    if origin is not None:
        latitude, longitude = _arrays.numbers(origin, "origin").tolist()
        return latitude, longitude
    pyproj = require("pyproj", "laz")
    middle = (np.array(header.mins) + np.array(header.maxs)) / 2
    try:
        longitude, latitude = pyproj.Transformer.from_crs(crs, WGS84, always_xy=True).transform(*middle[:2], errcheck=True)
    except pyproj.exceptions.ProjError as error:
        raise input_error("crs-unknown", f"PROJ cannot place the points: {str(error)[:200]}", "crs",
                          "pass crs='EPSG:...'") from None
    return float(latitude), float(longitude)


def _check_header(file: str) -> None:
    """Refuses more records of variable length than the file has bytes for: laspy would go through all of them."""
    size = os.path.getsize(file)
    with open(file, "rb") as stream:
        header = stream.read(375)
    fix = "give a whole LAS or LAZ file"
    if len(header) < _HEADER or header[:4] != b"LASF":
        raise input_error("record-garbled", "this is no LAS or LAZ file, or it is cut short", file, fix)
    records, = struct.unpack_from("<I", header, 100)
    needed = records * _VLR
    if header[25] >= 4 and len(header) == 375:
        needed += struct.unpack_from("<I", header, 243)[0] * _EVLR
    if needed > size:
        raise input_error("record-garbled", f"the header states more records than the file's {size:,} bytes can hold", file, fix)


def _chunks(reader: Any, left_out: _LeftOut) -> Iterator[Numbers]:
    for chunk in reader.chunk_iterator(max(1, _CHUNK_BYTES // reader.header.point_format.size)):
        taken = ~np.isin(np.array(chunk.classification), left_out.classes)
        points = np.column_stack([np.array(chunk.x), np.array(chunk.y), np.array(chunk.z)])
        left_out.add(points[~taken])
        yield points[taken]


def cloud_of_file(file: str, cell_m: float, without: Any, crs: Any, origin: Any, z_unit_m: Any) -> Cloud:
    """Of a LAS or LAZ file: see `Scene.from_laz`."""
    laspy = require("laspy", "laz")
    if file.lower().endswith(".laz"):
        require("lazrs", "laz")
    left_out = _LeftOut([whole(one, f"without[{i}]", 0, 255) for i, one in enumerate(items(without, "without", "classes"))])
    if not os.path.isfile(file):
        raise input_error("file-not-found", "there is no such file", file, "check the name")
    _check_header(file)
    try:
        with laspy.open(file) as reader:
            keys = keys_of(reader.header)
            named = crs if crs is not None else file_crs(reader.header, keys, file)
            if named is None:
                if z_unit_m is not None or origin is not None:
                    raise input_error("crs-missing", "the file does not say what its coordinates are", "crs", "pass crs='EPSG:...'")
                vertices, faces = solid_of(_chunks(reader, left_out), cell_m)
                return Cloud(vertices, faces, None, left_out.ledger())
            text = crs_text(named)
            latitude, longitude = _place_of(reader.header, text, origin)
            unit_m = z_unit(text, z_unit_m, keys, crs is not None)

            def moved(points: Numbers) -> Numbers:
                flat = _core.plan_from_crs(Georeference(latitude, longitude), text, np.ascontiguousarray(points[:, :2]))
                return np.column_stack([flat, points[:, 2] * unit_m])

            vertices, faces = solid_of(map(moved, _chunks(reader, left_out)), cell_m)
            return Cloud(vertices, faces, Georeference(latitude, longitude, "", text if len(text) <= 40 else "WKT"),
                         left_out.ledger(moved))
    except Error:
        raise
    except (laspy.errors.LaspyException, OSError, ValueError, RuntimeError, EOFError) as error:
        raise input_error("record-garbled", f"laspy cannot read the file: {str(error)[:300] or type(error).__name__}", file,
                          "give a whole LAS or LAZ file") from None
