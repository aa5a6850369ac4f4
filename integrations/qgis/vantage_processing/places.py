"""Where things lie: between the scene's frame and the coordinate reference systems of layers.

The frame of a scene with a place on the earth is a projected CRS, an azimuthal equidistant projection about the scene's
origin, in metres. Without a place it is a local (engineering) CRS: QGIS takes layers without any for degrees. Horizontal
coordinates are converted by QGIS, that is by PROJ; heights stay as they are: metres above the zero of the scene.
"""

import numpy as np
from qgis.core import (QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsLineString,
                       QgsProcessingException)

LOCAL = "Frame of a vantage scene"
_LOCAL_WKT = (f'ENGCRS["{LOCAL}",EDATUM["Origin of the scene"],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],'
              'LENGTHUNIT["metre",1]],AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]]]')


class Frame:
    """Of one scene.

    Attributes:
        crs: a QgsCoordinateReferenceSystem.
        is_placed: whether its place on the earth is known.
    """

    def __init__(self, scene, context):
        self.is_placed = bool(scene.crs)
        read = QgsCoordinateReferenceSystem.fromProj if self.is_placed else QgsCoordinateReferenceSystem.fromWkt
        self.crs = read(scene.crs if self.is_placed else _LOCAL_WKT)
        self.context = context
        if not self.crs.isValid():
            raise QgsProcessingException(f"QGIS does not understand the CRS of the scene's frame: {scene.crs or _LOCAL_WKT}")

    def has(self, crs):
        """Whether coordinates in this CRS are those of the frame. A layer without a CRS is taken to be in the frame."""
        return not crs.isValid() or crs == self.crs or (not self.is_placed and crs.description() == LOCAL)

    def into(self, xy, crs, what):
        """(n, 2) positions of a layer, in the frame."""
        return self._moved(xy, crs, self.crs, what)

    def out_of(self, xy, crs, what):
        """(n, 2) positions of the frame, in a CRS."""
        return self._moved(xy, self.crs, crs, what)

    def chosen(self, crs):
        """The CRS of what is written: the one that was chosen, or else the frame's."""
        self.check(crs, "the results are to have")
        return crs if crs.isValid() else self.crs

    def check(self, crs, what):
        """Refuses CRSs on the earth for scenes without a place. `what` has this CRS: "the layer has"."""
        if not self.is_placed and not self.has(crs):
            raise QgsProcessingException(
                f"It is not known where on the earth the scene lies, and {what} the CRS {name_of(crs)}.\n"
                "  what to do: give the scene's ORIGIN or SCENE_CRS, or work in the scene's metres, without a CRS")

    def _moved(self, xy, source, destination, what):
        xy = np.asarray(xy, float).reshape(-1, 2)
        if self.has(source) and self.has(destination) or not len(xy):
            return xy
        self.check(source, f"{what} has")
        return transformed(xy, QgsCoordinateTransform(source, destination, self.context.transformContext()), what)


def name_of(crs):
    """For messages."""
    return crs.authid() or crs.toProj() or crs.description()


def transformed(xy, transform, what):
    """(n, 2) positions by a QgsCoordinateTransform, all at once."""
    if not transform.isValid():
        raise QgsProcessingException(f"{what}: there is no way from the CRS {name_of(transform.sourceCrs())} to "
                                     f"{name_of(transform.destinationCrs())}.\n  what to do: take another CRS")
    line = QgsLineString(xy[:, 0].tolist(), xy[:, 1].tolist())
    try:
        line.transform(transform)
    except QgsCsException as error:
        raise QgsProcessingException(f"{what}: positions cannot be converted: {error}") from error
    moved = np.frombuffer(bytes(line.asWkb()), "<f8", offset=9).reshape(-1, 2)
    if moved.shape != xy.shape or not np.isfinite(moved).all():
        raise QgsProcessingException(
            f"{what}: some positions cannot be converted from {name_of(transform.sourceCrs())} to "
            f"{name_of(transform.destinationCrs())}.\n  what to do: take a CRS that is made for that place")
    return moved
