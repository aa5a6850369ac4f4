"""Where things lie on the earth."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._errors import Error, input_error
from ._extras import require

WGS84 = "OGC:CRS84"
"""Longitude and latitude in degrees, in this order."""


class Georeference(NamedTuple):
    """Where the scene's frame lies: x east, y north, z up, in metres from an origin in WGS 84."""

    latitude_deg: float
    longitude_deg: float
    vertical: str = ""
    """what z is measured from: "flat ground", "EGM96 geoid", ..."""
    source_crs: str = ""
    """of the file it came from"""


class FrameMap(NamedTuple):
    """The map about a scene's origin: the scene's frame, but for scenes of 3D Tiles, whose frame is no map."""

    crs: str
    """in PROJ's words"""
    place: Georeference

    def on_map(self, geometries: list[Any]) -> list[Any]:
        """Shapes of shapely with z in the scene's frame where the map has them; in scenes of 3D Tiles z becomes the height above
        the WGS 84 ellipsoid."""
        if not geometries or _core.is_map(self.place):
            return geometries
        transform = require("shapely", "geo").transform
        return [transform(one, lambda points: _core.to_crs(self.place, self.crs, np.ascontiguousarray(points)), include_z=True)
                for one in geometries]


def crs_of(frame: FrameMap | None) -> str | None:
    """In PROJ's words; None where the place is not known."""
    return None if frame is None else frame.crs


def crs_text(crs: Any) -> str:
    """What PROJ calls a CRS that is given as 32618, "EPSG:32618", a PROJ or WKT text, or a pyproj.CRS."""
    if isinstance(crs, (int, np.integer)) and not isinstance(crs, bool):
        return f"EPSG:{crs}"
    if isinstance(crs, str) and crs:
        return crs
    if hasattr(crs, "to_authority") and hasattr(crs, "to_wkt"):
        code = crs.to_authority()
        return ":".join(code) if code else crs.to_wkt()
    raise input_error("wrong-type", f"{crs!r} is no coordinate reference system", "crs",
                      "give an EPSG code (32618 or 'EPSG:32618'), a PROJ or WKT text, or a pyproj.CRS")


def no_place(where: str, fix: str) -> Error:
    """The error of what has no place on the earth."""
    return input_error("not-georeferenced", "it is not known where on the earth the scene's frame lies", where, fix)
