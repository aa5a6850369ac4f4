"""Arrays from callers: checked here, with an error that says what is wrong, and passed on without another copy."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._checks import shown
from ._errors import input_error

Points = npt.NDArray[np.float64]
Faces = npt.NDArray[np.uint32]


def _as_array(values: Any, name: str) -> np.ndarray:
    if isinstance(values, np.ma.MaskedArray):
        masked = int(np.count_nonzero(np.ma.getmaskarray(values)))
        if masked:
            raise input_error("wrong-type", f"{name} has {masked} masked numbers", name,
                              "leave them out, or fill them in: array.filled(...)")
        values = values.data
    try:
        return np.asarray(values)
    except (ValueError, TypeError, OverflowError, RecursionError) as error:
        raise input_error("wrong-type", f"{name} is not an array: {error}", name,
                          "pass numbers in rows of equal length") from None


def numbers(values: Any, name: str) -> npt.NDArray[np.float64]:
    """As float64 in C order. Integers and float32 become float64, which loses nothing; all else is refused."""
    array = _as_array(values, name)
    if array.dtype.kind == "O" and array.size and all(type(one) is int for one in array.flat):
        raise input_error("value-out-of-range", f"{name} has integers that float64 cannot hold", name, "pass float64")
    if array.dtype.kind not in "iuf" or array.dtype.itemsize not in (4, 8) and array.dtype.kind == "f":
        what = "an array" if array.ndim else "a number"
        raise input_error("wrong-type", f"{name} is {what} of {array.dtype}", name, "pass float64, float32 or integers")
    if array.dtype.kind in "iu" and array.size and (int(array.max()) > 2**53 or int(array.min()) < -(2**53)):
        raise input_error("value-out-of-range", f"{name} has integers that float64 cannot hold", name, "pass float64")
    return np.ascontiguousarray(array, dtype=np.float64)


def number(value: Any, name: str) -> float:
    """One finite number, of the kinds that `numbers` takes. True and texts are none."""
    array = _as_array(value, name)
    is_large = array.dtype.kind == "O" and type(value) is int  # beyond 64 bits
    if array.shape != () or not (array.dtype.kind in "iuf" or is_large):
        raise input_error("wrong-type", f"{shown(value)} is not a number", name, "pass one number")
    one = float(numbers(array, name)[0])
    if not np.isfinite(one):
        raise input_error("value-out-of-range", f"{name} is {one}", name, "pass a finite number")
    return one


def vector(values: Any, name: str) -> npt.NDArray[np.float64]:
    """(3,) finite numbers."""
    array = points(values, name)
    if len(array) != 1:
        raise input_error("array-sizes-differ", f"{name} is {len(array)} points", name, "pass (x, y, z)")
    return array[0]


def points(values: Any, name: str = "points") -> Points:
    """An (n, 3) float64 array of finite coordinates; a single point becomes one row."""
    array = numbers(values, name)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim == 1 and array.shape[0] == 3:
        array = array.reshape(1, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise input_error("array-sizes-differ", f"{name} has the shape {array.shape}", name, "pass (n, 3): x, y, z")
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if bad.size:
        raise input_error("coordinate-not-finite", f"{name}[{bad[0]}] is {array[bad[0]].tolist()}", name,
                          "pass finite coordinates")
    return array


def plan_or_points(values: Any, name: str = "points") -> Points:
    """An (n, 2) or (n, 3) float64 array of finite coordinates; a single point becomes one row."""
    array = numbers(values, name)
    if array.size == 0:
        array = array.reshape(0, array.shape[1] if array.ndim == 2 and array.shape[1] == 3 else 2)
    array = np.atleast_2d(array)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise input_error("array-sizes-differ", f"{name} has the shape {array.shape}", name, "pass (n, 2): x, y; or (n, 3)")
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if bad.size:
        raise input_error("coordinate-not-finite", f"{name}[{bad[0]}] is {array[bad[0]].tolist()}", name,
                          "pass finite coordinates")
    return array


def _indices(values: Any, name: str) -> npt.NDArray[np.uint32]:
    array = _as_array(values, name)
    if array.dtype.kind not in "iu":
        raise input_error("wrong-type", f"{name} is an array of {array.dtype}", name, "pass integers")
    if array.size and (int(array.min()) < 0 or int(array.max()) >= 2**32):
        raise input_error("index-out-of-range", f"{name} has an index that is negative or too large", name,
                          "pass indices from 0")
    return np.ascontiguousarray(array, dtype=np.uint32)


def faces(values: Any, vertex_count: int, name: str = "faces") -> Faces:
    """An (n, 3) uint32 array of indices below `vertex_count`."""
    array = _indices(values, name)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise input_error("array-sizes-differ", f"{name} has the shape {array.shape}", name,
                          "pass (n, 3): triangles by the numbers of their corners")
    if array.size and int(array.max()) >= vertex_count:
        row = int(np.flatnonzero((array >= vertex_count).any(axis=1))[0])
        raise input_error("index-out-of-range", f"{name}[{row}] is {array[row].tolist()}, and there are "
                          f"{vertex_count} vertices", name, "pass indices from 0 to the number of vertices less one")
    return array


def labels(values: Any, count: int, name: str) -> npt.NDArray[np.uint32]:
    """A (count,) uint32 array."""
    array = _indices(values, name)
    if array.shape != (count,):
        raise input_error("array-sizes-differ", f"{name} has the shape {array.shape}", name, f"pass ({count},)")
    return array
