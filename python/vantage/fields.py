"""What can be done with a field of shares: `.vantage` of xarray.DataArrays. Import it to use one that was read from a file.

    import vantage.fields, xarray
    field = xarray.open_dataset("field.nc")["fraction"]
    field.vantage.contour(0.8).save("eighty_percent.ply")
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Collection
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._checks import path as checked_path
from ._core import version
from ._errors import Error, input_error, make
from ._extras import require
from ._folders import BESIDE, Folder
from ._requests import Path
from ._scene import Scene
from ._volume import Volume

_xarray: Any = require("xarray", "fields")

CONVENTIONS = "CF-1.11"
SOURCE = "vantage "
"""What is followed by the version, in the attribute "source" of fields and files."""

AXES = {"x": ("projection_x_coordinate", "east"), "y": ("projection_y_coordinate", "north")}


def data_array(shares: npt.NDArray[Any], x: npt.ArrayLike, y: npt.ArrayLike, z: npt.ArrayLike, scene: Scene,
               told: dict[str, Any]) -> Any:
    """With the names, units and reference system that the CF conventions ask for."""
    coords: dict[str, Any] = {"z": ("z", np.array(z), _height(scene))}
    for name, values in (("y", y), ("x", x)):
        standard, towards = AXES[name]
        attributes = {"units": "m", "axis": name.upper(), "long_name": f"{name} of the scene's frame, {towards}"}
        if scene.crs is not None:
            attributes["standard_name"] = standard
        coords[name] = (name, np.array(values), attributes)
    of_shares = {"long_name": "share of the target that is seen", "units": "1", "valid_min": 0.0, "valid_max": 1.0, **told}
    if scene.crs is not None:
        coords["spatial_ref"] = ((), 0, _grid_mapping(scene))
        of_shares["grid_mapping"] = "spatial_ref"
    return _xarray.DataArray(shares, coords, ("z", "y", "x"), "fraction", of_shares)


def _height(scene: Scene) -> dict[str, str]:
    place = scene.georeference
    datum = f" above {place.vertical}" if place is not None and place.vertical else ""
    return {"units": "m", "axis": "Z", "positive": "up", "long_name": f"z of the scene's frame{datum}"}


def _grid_mapping(scene: Scene) -> dict[str, Any]:
    crs = require("pyproj", "fields").CRS.from_user_input(scene.crs)
    place = scene.georeference
    told: dict[str, Any] = {**crs.to_cf(), "spatial_ref": crs.to_wkt(), "proj4": scene.crs}
    if place is not None:
        told |= {"origin_latitude_deg": place.latitude_deg, "origin_longitude_deg": place.longitude_deg}
    return {key: value for key, value in told.items() if value is not None}


@_xarray.register_dataarray_accessor("vantage")
class FractionField:
    """`field.vantage`: of the DataArray that `vantage.fraction_field` returns, or of one of its dimensions and units."""

    def __init__(self, array: Any):
        self._array = array

    @property
    def step_m(self) -> float:
        """Edge of a voxel, metres."""
        if "step_m" in self._array.attrs:
            return float(self._array.attrs["step_m"])
        steps = [float(np.diff(self._array[name].values[:2])[0]) for name in "xyz" if self._array.sizes.get(name, 0) > 1]
        if not steps:
            raise input_error("missing-key", "the field does not say how large its voxels are", "attrs['step_m']",
                              "set it, in metres")
        return steps[0]

    @property
    def low(self) -> npt.NDArray[np.float64]:
        """(3,): the lowest corner, x, y, z."""
        return np.array([float(self._array[name].values[0]) for name in "xyz"]) - self.step_m / 2

    @property
    def high(self) -> npt.NDArray[np.float64]:
        """(3,): the highest corner, x, y, z."""
        return np.array([float(self._array[name].values[-1]) for name in "xyz"]) + self.step_m / 2

    def contour(self, level: float) -> Volume:
        """The closed surface about the voxels of at least this share, by marching cubes; it ends at the field's box.

        Between the centres of voxels the share is interpolated: it is a picture of the field, not a volume with a guarantee.
        That is `vt.compute` with vt.Sensor(visible=0.8).

        Args:
            level: above 0, up to 1.

        Returns:
            a `Volume`: save it, or take `to_trimesh` and `to_pyvista`.

        Raises:
            Error: a level out of range, one that no voxel has, a field that is not of z, y and x, a missing extra.
        """
        measure: Any = require("skimage.measure", "fields")
        shares = self._values()
        level = _arrays.number(level, "level")
        if not 0 < level <= 1:
            raise input_error("value-out-of-range", f"the level is {level}", "level", "pass a share above 0, up to 1")
        if not (shares >= level).any():
            raise input_error("region-empty", f"no voxel sees {level:g} of the target: the most is {shares.max():g}",
                              "level", "pass a lower level")
        # A surface through a value itself would have facets of no area.
        below = level * (1 - 1e-5)
        corners, faces, _, _ = measure.marching_cubes(_closed(shares, below), below, gradient_direction="descent",
                                                      allow_degenerate=False)
        places = self.low + (corners[:, ::-1].astype(np.float64) - 0.5) * self.step_m
        return Volume.from_arrays(np.clip(places, self.low, self.high), faces, cause=f"share {level:g}")

    def save(self, path: Path) -> None:
        """Writes netCDF (.nc), Zarr (.zarr) or OpenVDB (.vdb), by the path's extension; whole or not at all.

        Of netCDF and Zarr the variable is "fraction", and the data set names its conventions. The grid of OpenVDB has the
        same name, values at the centres of voxels, and x, y, z in metres as its world.

        Raises:
            Error: another extension, a place that cannot be written, a missing extra. OpenVDB's Python module is no package
                of pip: it comes with OpenVDB, as python3-openvdb of Debian.
        """
        file = checked_path(path)
        writers: dict[str, Callable[[str], None]] = {".nc": self._netcdf, ".zarr": self._zarr, ".vdb": self._vdb}
        write = writers.get(os.path.splitext(file)[1].lower())
        if write is None:
            raise make("output", "output-format-unknown", "a field is written as .nc, .zarr or .vdb", file,
                       "name it so", None)
        self._values()
        folder = os.path.dirname(file)
        if not os.path.isdir(folder):
            raise make("output", "output-folder-missing", "the folder does not exist", folder, "make it", None)
        try:
            _written_whole(file, write)
        except (OSError, RuntimeError) as error:
            raise make("output", "output-unwritable", f"the field cannot be written: {error}", file,
                       "choose another place", None) from error

    def _values(self) -> npt.NDArray[np.float32]:
        if tuple(self._array.dims) != ("z", "y", "x") or 0 in self._array.shape:
            raise input_error("array-sizes-differ", f"the field has the dimensions {self._array.dims}", "field",
                              "take a part of it that still has z, y and x, in this order")
        return np.nan_to_num(np.asarray(self._array.values, np.float32))

    def _dataset(self) -> Any:
        dataset = self._array.to_dataset(name="fraction")
        dataset.attrs |= {"Conventions": CONVENTIONS, "source": f"{SOURCE}{version}"}  # by which it may be replaced
        return dataset

    def _netcdf(self, file: str) -> None:
        require("netCDF4", "fields")
        self._dataset().to_netcdf(file, engine="netcdf4", encoding={"fraction": {"zlib": True, "complevel": 4}})

    def _zarr(self, file: str) -> None:
        require("zarr", "fields")
        self._dataset().to_zarr(file, mode="w", zarr_format=2, consolidated=True)  # what most programs read

    def _vdb(self, file: str) -> None:
        vdb = _openvdb()
        step, first = self.step_m, self.low + self.step_m / 2
        grid = vdb.FloatGrid()
        grid.copyFromArray(np.ascontiguousarray(self._values().transpose(2, 1, 0)))
        grid.transform = vdb.createLinearTransform([[step, 0, 0, 0], [0, step, 0, 0], [0, 0, step, 0], [*first.tolist(), 1]])
        grid.name = "fraction"
        grid.gridClass = vdb.GridClass.FOG_VOLUME
        vdb.write(file, grids=[grid])


def _closed(shares: npt.NDArray[np.float32], level: float) -> npt.NDArray[np.float32]:
    """With a layer about it that is below the level, such that the surface ends half a voxel beyond the last centres."""
    padded = np.pad(shares, 1, mode="edge")
    layer = np.ones(padded.shape, bool)
    layer[1:-1, 1:-1, 1:-1] = False
    padded[layer] = np.where(padded[layer] > level, 2 * level - padded[layer], 0)
    return padded


def _openvdb() -> Any:
    for name in ("openvdb", "pyopenvdb"):
        try:
            return require(name, "fields")
        except Error:
            continue
    raise input_error("component-missing", "OpenVDB's Python module is not installed", "openvdb",
                      "install OpenVDB with its Python module (Debian: python3-openvdb), or write .nc or .zarr")


def _written_whole(file: str, write: Callable[[str], None]) -> None:
    """Under another name beside its place, then moved there."""
    with Folder(BESIDE, os.path.dirname(file)) as folder:
        made = os.path.join(folder, os.path.basename(file))
        write(made)
        if os.path.isdir(made):
            _replace_store(made, file, folder)
        else:
            os.replace(made, file)


_ARRAYS = {"fraction", "x", "y", "z", "spatial_ref"}


def _is_own_store(folder: str, names: Collection[str]) -> bool:
    """Whether vantage wrote it, and nothing is in it but what has one of the names."""
    if not os.path.isdir(folder) or not set(os.listdir(folder)) <= set(names):
        return False
    group, field = (_attributes(os.path.join(folder, *inside)) for inside in ((), ("fraction",)))
    return str(group.get("Conventions")).startswith("CF-") and \
        any(str(told.get("source")).startswith(SOURCE) for told in (group, field))  # version 0.1 said it of the field alone


def _attributes(folder: str) -> dict[str, Any]:
    """Of a group or an array of Zarr 2; none where they cannot be read."""
    file = os.path.join(folder, ".zattrs")
    try:
        if not os.path.isfile(file):  # a pipe would be waited for
            return {}
        with open(file, encoding="utf-8") as stream:
            told = json.load(stream)
    except (OSError, ValueError, RecursionError):
        return {}
    return told if isinstance(told, dict) else {}


def _replace_store(made: str, file: str, folder: str) -> None:
    """A folder takes the place of an older field, and of nothing else."""
    if not os.path.lexists(file):
        os.replace(made, file)
        return
    if not _is_own_store(file, {*_ARRAYS, *os.listdir(made)}):
        raise make("output", "folder-in-use", "what stands in the place of the field is none that vantage wrote, or holds "
                   "other things, too", file, "choose another place, or move it away", None)
    aside = folder + "-old"  # not into the folder: that goes with this process, be it killed
    shutil.move(file, aside)
    try:
        os.replace(made, file)
    except BaseException:
        shutil.move(aside, file)
        raise
    shutil.move(aside, os.path.join(folder, "older"))
