"""How much of the target is seen from each voxel of a box."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import choice, shown, text, thread_count, whole
from ._errors import input_error
from ._progress import Progress
from ._requests import Vector
from ._result import MEASURES, Mission
from ._scene import Scene, checked_scene
from ._shapes import AnyTarget

if TYPE_CHECKING:
    import xarray


def _counts(box: Any, step: float) -> tuple[list[float], list[int]]:
    """The lowest corner, and the number of voxels along x, y and z."""
    corners = _arrays.points(box, "box")
    if corners.shape != (2, 3):
        raise input_error("array-sizes-differ", f"box has the shape {np.shape(box)}", "box",
                          "pass ((x, y, z), (x, y, z)): the lowest and the highest corner")
    if not (math.isfinite(step) and step > 0):
        raise input_error("value-out-of-range", f"step is {step}", "step", "pass a positive number of metres")
    size = corners[1] - corners[0]
    if not (size > 0).all():
        raise input_error("limits-reversed", f"box goes from {corners[0].tolist()} to {corners[1].tolist()}", "box",
                          "pass the lowest corner first, and a box with an inside")
    # A box of 30 m has 100 voxels of 0.3 m, whatever 30 / 0.3 rounds to.
    counts = np.ceil(size / step * (1 - 1e-12))
    if counts.prod() > 2**31:
        raise input_error("value-out-of-range", f"the box has {counts.prod():.0f} voxels of {step:g} m", "step",
                          "take a smaller box or a larger step: at most 2,147,483,648 voxels")
    return corners[0].tolist(), [max(1, int(n)) for n in counts]


def _farthest(scene: Scene, target: Any, low: list[float], step: float, counts: list[int]) -> float:
    """A range that no voxel is beyond, wherever the target is in the scene."""
    box = np.array([low, np.array(low) + step * np.array(counts)])
    all_of_it = np.concatenate([box, scene.bounds])
    return float(np.linalg.norm(all_of_it.max(axis=0) - all_of_it.min(axis=0))) + 20


def fraction_field(scene: Scene, target: AnyTarget, box: Sequence[Vector] | npt.ArrayLike, step: float, *,
                   measure: str = "area", samples: int | None = None, cubemap: int = 512, device: str = "auto",
                   max_range: float | None = None, crs: str | None = None, dtype: npt.DTypeLike = np.float64,
                   threads: int = 0, progress: Progress = None) -> xarray.DataArray:
    """The share of the target that is seen from each voxel of a box, by line of sight (docs/python-fields.md).

    By default each value is what `Mission.fraction` says of the voxel's centre: not sampled. Boxes of voxels from which all
    or nothing is seen are proved to be so, and not looked from; nothing else is skipped, so no region is missed.

    Args:
        scene: what may hide.
        target: one, as `compute` takes it.
        box: the lowest and the highest corner, metres. Its last voxels may reach beyond it.
        step: edge of a voxel, metres.
        measure: "area" of the target, "solid_angle" or "pixels".
        samples: estimate from depth images of so many points of the target, instead; by "area".
        cubemap: texels along the side of a depth image.
        device: for `samples`: "auto", "cpu", "opengl", "gpu" or a number of `devices()`.
        max_range: metres; the share is 0 from where a point of the target is farther. Default: no limit.
        crs: of the target's coordinates. Default: the scene's frame.
        dtype: float64, or float32 to save memory; that rounds a share below 1 to one below 1.
        threads: 0: as many as there are. The field does not depend on it.
        progress: called with stage and fraction; False stops.

    Returns:
        an xarray.DataArray of the dimensions z, y, x, with the centres of the voxels as coordinates in metres, and with
        `.vantage`: see `vantage.fields.FractionField`. Memory: 9 bytes for each voxel, with `samples` 16.

    Raises:
        Error: a bad box or step, several targets, an option out of range, a device that is not there, a missing extra.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> square = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
        >>> field = vt.fraction_field(ground, square, box=((-20, -20, -10), (20, 20, 10)), step=5)
        >>> field.sel(x=10, y=10, z=5, method="nearest").item()
        1.0
        >>> half = field.vantage.contour(0.5)  # a vt.Volume
    """
    from . import fields

    checked_scene(scene)
    edge = _arrays.number(step, "step")
    low, counts = _counts(box, edge)
    choice(measure, "measure", MEASURES)
    count = thread_count(threads)
    try:
        kind = np.dtype(dtype)
    except TypeError:
        raise input_error("unknown-choice", f"dtype is {shown(dtype)}", "dtype", "choose float64 or float32") from None
    if kind not in (np.float32, np.float64):
        raise input_error("unknown-choice", f"dtype is {kind}", "dtype", "choose float64 or float32")
    if samples is not None and measure != "area":
        raise input_error("not-applicable", f"samples count by area, and measure is {measure!r}", "measure",
                          "leave out the samples, or measure by area")
    reach = _arrays.number(max_range, "max_range") if max_range is not None else _farthest(scene, target, low, edge, counts)
    mission = Mission.of(scene, target, max_range=reach, crs=crs, progress=progress)
    limit = math.inf if max_range is None else reach
    if samples is None:
        columns = _core.fraction_field(mission._core, low, edge, counts, measure, limit, count, progress)
    else:
        columns = _core.sampled_field(mission._core, low, edge, counts, whole(samples, "samples", 1),
                                      whole(cubemap, "cubemap", 1, 2**31 - 1), text(device, "device"), limit, count, progress)
    told = {
        "measure": measure, "target": mission.target_name, "step_m": edge, "scene_hash": scene.hash,
        "voxels_evaluated": int(columns["evaluated"]), "mission_hash": mission.hash, "source": f"vantage {_core.version}",
    }
    if max_range is not None:
        told["max_range_m"] = reach
    if samples is not None:
        told |= {"samples": int(samples), "cubemap": int(cubemap), "device": columns["device"]}
    shares = columns["shares"].reshape(counts[::-1])
    return fields.data_array(_rounded(shares, kind), columns["x"], columns["y"], columns["z"], scene, told)


def _rounded(shares: npt.NDArray[np.float64], kind: np.dtype[Any]) -> npt.NDArray[Any]:
    """Only what is seen whole is 1, and only what is not seen at all is 0, as in float64."""
    if kind == np.float64:
        return shares
    rounded = shares.astype(np.float32)
    rounded[(rounded == 1) & (shares < 1)] = np.nextafter(np.float32(1), np.float32(0))
    rounded[(rounded == 0) & (shares > 0)] = np.nextafter(np.float32(0), np.float32(1))
    return rounded


