"""Which share of the target is seen from the cells of a raster at one height."""

import math
import os
import tempfile
import zlib

import numpy as np
from osgeo import gdal
from qgis.core import (Qgis, QgsProcessingException, QgsProcessingParameterBoolean, QgsProcessingParameterExtent,
                       QgsProcessingParameterNumber, QgsProcessingParameterRasterDestination, QgsRasterBlock,
                       QgsRasterFileWriter, QgsRectangle, QgsUnitTypes)

from ..engine import Progress, stop_if_canceled, tell_notes
from ..places import name_of
from .base import VantageAlgorithm, is_given
from .request import add_request, read_request
from .volume import add_crs, tell_scene

_MOST_CELLS = 100_000_000
_CELLS_AT_ONCE = 50_000


class ShareAlgorithm(VantageAlgorithm):
    NAME = "share"
    TITLE = "Share of the target that is seen"
    SUMMARY = "A raster: which share of the target's area is seen from the middle of each cell, at one height"
    HELP = ("Exact for the middle of each cell, not sampled, by line of sight alone: neither range nor limits count, unless "
            "that is asked for.")

    def initAlgorithm(self, configuration=None):  # noqa: N802
        add_request(self, combine=("all",))
        number = QgsProcessingParameterNumber
        self.add(number("Z", "Height of the viewpoints (m)", number.Double),
                 "Metres above the zero of the scene's heights.")
        self.add(number("CELL", "Size of a cell (m)", number.Double, defaultValue=2.0, minValue=0.001),
                 "Metres, in the CRS of the results.")
        self.add(QgsProcessingParameterExtent("EXTENT", "Extent", optional=True),
                 "Empty: the targets and the range about them. Cells are counted from its north-west corner; the last ones may "
                 "reach beyond it.")
        self.add(QgsProcessingParameterBoolean("LIMITS", "0 where the range or a limit is broken", defaultValue=False),
                 "The share is 0 where a point of the target is farther than the range, the viewpoint behind the target, or "
                 "outside of where the vehicle may fly.")
        add_crs(self)
        self.add(QgsProcessingParameterRasterDestination("OUTPUT", "Share that is seen"),
                 "One band of float64, 0 to 1.")

    def run_in_vantage(self, parameters, context, feedback):
        progress = Progress(feedback)
        mission, frame = read_request(self, parameters, context, progress)
        crs = frame.chosen(self.parameterAsCrs(parameters, "CRS", context))
        if crs.mapUnits() != QgsUnitTypes.DistanceMeters:
            raise QgsProcessingException(f"CRS: {name_of(crs)} is not in metres, and cells are.\n  what to do: "
                                         "choose a projected CRS in metres, or none")
        z, cell = (self.parameterAsDouble(parameters, name, context) for name in ("Z", "CELL"))
        grid = Grid(self._extent(parameters, context, mission, frame, crs), cell)
        tell_notes(feedback, mission.notes)
        tell_scene(feedback, mission.scene, crs)
        limits = self.parameterAsBool(parameters, "LIMITS", context)

        def shares_of(centres, part):
            places = np.column_stack([frame.into(centres, crs, "the raster"), np.full(len(centres), z)])
            shares = np.array(mission.fraction(places, progress=part))
            if limits:
                answers = mission.query(places, progress=part)
                outside = np.array([bool(broken) for broken in answers.outside_of])
                shares[answers.out_of_range | answers.behind_target | outside] = 0
            return shares

        file = self.parameterAsOutputLayer(parameters, "OUTPUT", context)
        _write(file, grid, crs, lambda write: _fill(grid, shares_of, write, progress))
        return {"OUTPUT": file}

    def _extent(self, parameters, context, mission, frame, crs):
        if not is_given(parameters, "EXTENT"):
            return _about(mission, frame, crs)
        text = parameters["EXTENT"]
        if not (isinstance(text, str) and "[" not in text):  # four numbers alone are in the CRS of the results
            frame.check(self.parameterAsExtentCrs(parameters, "EXTENT", context), "the extent has")
        return self.parameterAsExtent(parameters, "EXTENT", context, crs)


class Grid:
    """Cells from the north-west corner of a rectangle."""

    def __init__(self, extent, cell):
        if extent.isEmpty() or not extent.isFinite():
            raise QgsProcessingException("EXTENT is empty.\n  what to do: give an extent with an inside")
        self.cell = cell
        # An extent of 30 m has 100 cells of 0.3 m, whatever 30 / 0.3 rounds to.
        self.columns, self.rows = (max(1, math.ceil(side / cell * (1 - 1e-12))) for side in (extent.width(), extent.height()))
        if self.columns * self.rows > _MOST_CELLS:
            raise QgsProcessingException(f"CELL: the raster would have {self.columns} x {self.rows} cells, more than "
                                         f"{_MOST_CELLS}.\n  what to do: take larger cells or a smaller extent")
        self.west, self.north = extent.xMinimum(), extent.yMaximum()
        self.extent = QgsRectangle(self.west, self.north - self.rows * cell, self.west + self.columns * cell, self.north)

    def centres(self, first, count):
        """(count * columns, 2): of `count` rows from row `first`, from north to south."""
        x = self.west + (np.arange(self.columns) + 0.5) * self.cell
        y = self.north - (np.arange(first, first + count) + 0.5) * self.cell
        return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def _about(mission, frame, crs):
    """The targets and the range about them, in a CRS."""
    corners = np.concatenate(list(mission.target_parts))[:, :2]
    low, high = corners.min(axis=0) - mission.range_m, corners.max(axis=0) + mission.range_m
    along = np.linspace(0, 1, 33)
    sides = np.concatenate([np.column_stack([along, np.full(33, end)]) for end in (0, 1)])
    border = low + np.concatenate([sides, sides[:, ::-1]]) * (high - low)
    moved = frame.out_of(border, crs, "the extent")
    return QgsRectangle(*moved.min(axis=0).tolist(), *moved.max(axis=0).tolist())


def _fill(grid, shares_of, write, progress):
    """Some rows at a time."""
    at_once = max(1, _CELLS_AT_ONCE // grid.columns)
    for first in range(0, grid.rows, at_once):
        count = min(at_once, grid.rows - first)
        stop_if_canceled(progress.feedback)
        part = progress.part(first / grid.rows, (first + count) / grid.rows)
        write(first, count, shares_of(grid.centres(first, count), part))


def _write(file, grid, crs, fill):
    """Writes a raster whole or not at all. `fill` is called with a function of the first row, their number, and values."""
    folder, ending = os.path.dirname(os.path.abspath(file)), os.path.splitext(file)[1]
    driver = QgsRasterFileWriter.driverForExtension(ending.lstrip("."))
    if not driver:
        raise QgsProcessingException(f"{file}: rasters are not written as '{ending}'.\n  what to do: name the file .tif")
    if not os.path.isdir(folder):
        raise QgsProcessingException(f"{file}: the folder does not exist.\n  what to do: make it first")
    with tempfile.TemporaryDirectory(dir=folder, prefix=".vantage-") as scratch:
        draft = os.path.join(scratch, "draft" + ending)
        written = _fill_draft(draft, driver, grid, crs, fill)
        if not all(_reads_as(draft, grid, *piece) for piece in written):
            raise QgsProcessingException(f"{file}: cannot be written: what was written reads otherwise.\n  what to do: look "
                                         "whether the disk is full")
        os.replace(draft, file)


def _fill_draft(draft, driver, grid, crs, fill):
    """Returns first row, number of rows and a checksum of each piece that was written."""
    writer = QgsRasterFileWriter(draft)
    writer.setOutputFormat(driver)
    if driver == "GTiff":
        writer.setCreateOptions(["COMPRESS=DEFLATE"])
    provider = writer.createOneBandRaster(Qgis.Float64, grid.columns, grid.rows, grid.extent, crs)
    if provider is None or not provider.isValid():
        raise QgsProcessingException(f"{draft}: cannot be made: {provider.error().summary() if provider else driver}")
    provider.setEditable(True)
    written = []

    def write(first, count, shares):
        block = QgsRasterBlock(Qgis.Float64, grid.columns, count)
        data = shares.astype("<f8").tobytes()
        block.setData(data)
        if not provider.writeBlock(block, 1, 0, first):
            raise QgsProcessingException(f"{draft}: cannot be written: {provider.error().summary()}")
        written.append((first, count, zlib.crc32(data)))

    try:
        fill(write)
    finally:
        provider.setEditable(False)
        provider = None  # closes the file
    return written


def _reads_as(draft, grid, first, count, known):
    """Whether some rows are what was written: a full disk shows when a file is closed, or not at all."""
    try:
        read = gdal.Open(draft)
        data = None if read is None else read.ReadRaster(0, first, grid.columns, count)
    except RuntimeError:  # some programs have GDAL raise errors
        return False
    return data is not None and zlib.crc32(data) == known
