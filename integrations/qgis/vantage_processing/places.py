"""Where things lie: between the scene's frame and the coordinate reference systems of layers.

The frame of a scene with a place on the earth is a projected CRS, an azimuthal equidistant projection about the scene's
origin, in metres. Horizontal coordinates are converted by QGIS, that is by PROJ; heights stay as they are: metres above
the zero of the scene.
"""

import numpy as np
from qgis.core import (QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsLineString,
                       QgsProcessingException)


class Frame:
    """Of one scene. `crs` is not valid where its place on the earth is not known."""

    def __init__(self, scene, context):
        self.crs = QgsCoordinateReferenceSystem.fromProj(scene.crs) if scene.crs else QgsCoordinateReferenceSystem()
        self.context = context
        if scene.crs and not self.crs.isValid():
            raise QgsProcessingException(f"QGIS does not understand the CRS of the scene's frame: {scene.crs}")

    def into(self, xy, crs, what):
        """(n, 2) positions of a layer, in the frame. A layer without a CRS is taken to be in the frame."""
        return self._moved(xy, crs, self.crs, what)

    def out_of(self, xy, crs, what):
        """(n, 2) positions of the frame, in a CRS."""
        return self._moved(xy, self.crs, crs, what)

    def chosen(self, crs):
        """The CRS of what is written: the one that was chosen, or else the frame's."""
        if crs.isValid() and not self.crs.isValid():
            raise QgsProcessingException(
                "It is not known where on the earth the scene lies, and a CRS of the results is chosen.\n"
                "  what to do: give the scene's origin or CRS, or leave the CRS of the results empty")
        return crs if crs.isValid() else self.crs

    def _moved(self, xy, source, destination, what):
        xy = np.asarray(xy, float).reshape(-1, 2)
        if not source.isValid() and not destination.isValid() or source == destination or not len(xy):
            return xy
        if not source.isValid() and destination == self.crs:
            return xy
        if not destination.isValid():
            raise QgsProcessingException(
                f"It is not known where on the earth the scene lies, and {what} has the CRS {source.userFriendlyIdentifier()}.\n"
                "  what to do: give the scene's origin or CRS, or take a layer without a CRS, in the scene's metres")
        return transformed(xy, QgsCoordinateTransform(source, destination, self.context.transformContext()), what)


def transformed(xy, transform, what):
    """(n, 2) positions by a QgsCoordinateTransform, all at once."""
    line = QgsLineString(xy[:, 0].tolist(), xy[:, 1].tolist())
    try:
        line.transform(transform)
    except QgsCsException as error:
        raise QgsProcessingException(f"{what}: positions cannot be converted: {error}") from error
    moved = np.frombuffer(bytes(line.asWkb()), "<f8", offset=9).reshape(-1, 2)
    if moved.shape != xy.shape or not np.isfinite(moved).all():
        raise QgsProcessingException(
            f"{what}: some positions cannot be converted from {transform.sourceCrs().userFriendlyIdentifier()} to "
            f"{transform.destinationCrs().userFriendlyIdentifier()}.\n  what to do: take a CRS that is made for that place")
    return moved
