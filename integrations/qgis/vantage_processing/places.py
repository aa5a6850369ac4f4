"""Where things lie: between the scene's frame and the coordinate reference systems of layers.

The frame of a scene with a place on the earth is a projected CRS, an azimuthal equidistant projection about the scene's
origin, in metres. Without a place it is a local (engineering) CRS: QGIS takes layers without any for degrees. Horizontal
coordinates are converted by vantage, not by QGIS: between old datums and WGS 84 there are several operations, metres apart,
and layers must go the way that the scene's file went. Heights stay as they are: metres above the zero of the scene.
"""

import numpy as np
from qgis.core import QgsCoordinateReferenceSystem, QgsProcessingException, QgsUnitTypes

from .engine import vt

LOCAL = "Frame of a vantage scene"
_LOCAL_WKT = (f'ENGCRS["{LOCAL}",EDATUM["Origin of the scene"],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],'
              'LENGTHUNIT["metre",1]],AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]]]')


_HALF_GLOBE_M = 20_037_508  # half the equator
_OF_PROJ = ("EPSG", "ESRI", "IAU_2015", "IGNF", "NKG", "NRCAN", "OGC")  # authorities in PROJ's database


class Frame:
    """Of one scene.

    Attributes:
        crs: a QgsCoordinateReferenceSystem.
        is_placed: whether its place on the earth is known.
    """

    def __init__(self, scene):
        self.scene = scene
        self.is_placed = bool(scene.crs)
        read = QgsCoordinateReferenceSystem.fromProj if self.is_placed else QgsCoordinateReferenceSystem.fromWkt
        self.crs = read(scene.crs if self.is_placed else _LOCAL_WKT)
        if not self.crs.isValid():
            raise QgsProcessingException(f"QGIS does not understand the CRS of the scene's frame: {scene.crs or _LOCAL_WKT}")

    def has(self, crs):
        """Whether coordinates in this CRS are those of the frame. A layer without a CRS is taken to be in the frame."""
        return not crs.isValid() or crs == self.crs or (not self.is_placed and crs.description() == LOCAL)

    def into(self, xy, crs, what):
        """(n, 2) positions of a layer, in the frame."""
        return self._moved(xy, crs, self.scene.positions, what)

    def out_of(self, xy, crs, what):
        """(n, 2) positions of the frame, in a CRS. All are of one thing: refused where the edge of the CRS cuts it."""
        moved = self._moved(xy, crs, self.scene.positions_in_crs, what)
        if not self.has(crs) and len(moved):
            in_metres = QgsUnitTypes.fromUnitToUnitFactor(crs.mapUnits(), QgsUnitTypes.DistanceMeters)
            if np.ptp(moved, axis=0).max() * in_metres > _HALF_GLOBE_M:
                raise QgsProcessingException(
                    f"{what} lies across the antimeridian or a pole, where {name_of(crs)} ends: its polygons would reach around "
                    "the globe.\n  what to do: choose no CRS for the results, or one that does not end there, such as that UTM "
                    "zone")
        return moved

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

    def _moved(self, xy, crs, move, what):
        xy = np.asarray(xy, float).reshape(-1, 2)
        if self.has(crs) or not len(xy):
            return xy
        self.check(crs, f"{what} has")
        try:
            return move(xy, text_of(crs))
        except vt.Error as error:
            raise QgsProcessingException(f"{what}, in {name_of(crs)}: {error}") from error


def text_of(crs):
    """A QgsCoordinateReferenceSystem for vantage. Codes of other authorities, such as USER, are known to QGIS alone."""
    is_known = crs.authid().partition(":")[0] in _OF_PROJ
    return crs.authid() if is_known else crs.toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED)


def name_of(crs):
    """For messages."""
    return crs.authid() or crs.toProj() or crs.description()


def degrees_of(x, y, crs, guess):
    """(latitude, longitude) of a position by vantage. `guess`: the same by QGIS, which may be metres off."""
    about = vt.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], georeference=vt.Georeference(*guess))
    longitude, latitude = about.positions_in_crs(about.positions([[x, y]], text_of(crs)), "EPSG:4326")[0].tolist()
    return latitude, longitude
