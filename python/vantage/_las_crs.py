"""What a LAS or LAZ file says of its coordinates: its CRS, and the units in its GeoTIFF keys, which laspy does not look at."""

from __future__ import annotations

from typing import Any, NamedTuple

from . import _arrays, _core
from ._errors import input_error
from ._extras import require
from ._place import crs_text

# GeoTIFF 1.1, 7.2 and 7.3.
_MODEL, _PROJECTED = 1024, 3072
_UNIT, _UNIT_SIZE = 3076, 3077
_VERTICAL, _VERTICAL_UNIT = 4096, 4099
_SAY_NOTHING = (0, 1025)
"""No key, and that of what a pixel is."""
_USER_DEFINED = 32767
_DOUBLES = 34736
_DIRECTORY, _WKT = 34735, 2112
_SAME_UNIT = 5e-7
"""Share by which units may differ: feet and US survey feet differ by 2e-6."""


class GeoKeys(NamedTuple):
    """The GeoTIFF keys of a file."""

    values: dict[int, int]
    doubles: dict[int, float]
    """of keys whose values are numbers"""
    is_stated: bool
    """whether the file says anything of a CRS, also what cannot be read"""


def keys_of(header: Any) -> GeoKeys:
    """The keys in the records of a file."""
    records = list(header.vlrs.get_by_id("LASF_Projection"))
    if header.evlrs is not None:
        records += header.evlrs.get_by_id("LASF_Projection")
    by_number = {record.record_id: record for record in records}
    directory, wkt = by_number.get(_DIRECTORY), by_number.get(_WKT)
    numbers = [number.value for number in getattr(by_number.get(_DOUBLES), "doubles", [])]
    values, doubles = {}, {}
    for key in getattr(directory, "geo_keys", []):
        if key.tiff_tag_location == 0:
            values[key.id] = key.value_offset
        elif key.tiff_tag_location == _DOUBLES and key.value_offset < len(numbers):
            doubles[key.id] = numbers[key.value_offset]
    is_garbled = any(record is not None and not hasattr(record, "parse_crs") for record in (directory, wkt))
    is_stated = (is_garbled or bool(doubles) or bool(getattr(wkt, "string", "").strip()) or
                 any(value != 0 and key not in _SAY_NOTHING for key, value in values.items()))
    return GeoKeys(values, doubles, is_stated)


def file_crs(header: Any, keys: GeoKeys, file: str) -> str | None:
    """The CRS that the file states, as PROJ calls it; None where it states none."""
    if not keys.is_stated:
        return None
    pyproj = require("pyproj", "laz")
    fix = "pass crs='EPSG:...'"
    try:
        crs = header.parse_crs()
    except pyproj.exceptions.ProjError as error:
        raise input_error("crs-unknown", f"PROJ does not know the file's CRS: {str(error)[:200]}", file, fix) from None
    if crs is None:
        raise input_error("crs-missing", "the file has records of a CRS, and it cannot be read from them", file, fix)
    is_projected = keys.values.get(_MODEL) == 1 or keys.values.get(_PROJECTED, 0) > 0
    if is_projected and not crs.is_projected:
        raise input_error("crs-missing", "the file's coordinates are of a projection that it does not name, based on "
                          f"{crs.name!r}", file, fix)
    stated_m = _unit_m(keys, _UNIT, _UNIT_SIZE)
    if stated_m is not None and crs.is_projected and not _is_same(stated_m, crs.axis_info[0].unit_conversion_factor):
        raise input_error("crs-missing", f"the file's x and y are in units of {stated_m:.10g} m by its GeoTIFF keys, and of "
                          f"{crs.axis_info[0].unit_conversion_factor:.10g} m by its CRS, {crs.name!r}", file, fix)
    return crs_text(crs)


def z_unit_m(crs: str, given: Any, keys: GeoKeys, is_crs_given: bool) -> float:
    """Metres in the unit of z: what is given, or that of the CRS's vertical axis, or what the file's keys say."""
    if given is not None:
        unit_m = _arrays.number(given, "z_unit_m")
        if not 1e-6 <= unit_m <= 1e6:
            raise input_error("value-out-of-range", f"z_unit_m is {unit_m:g}", "z_unit_m", "give metres: 0.3048 for feet")
        return unit_m
    axes = require("pyproj", "laz").CRS(crs).axis_info
    known = [float(_core.vertical_unit_m(crs))] if len(axes) == 3 else []
    if not (known and is_crs_given):
        known += [unit_m for unit_m in (_vertical_crs_unit_m(keys), _unit_m(keys, _VERTICAL_UNIT)) if unit_m is not None]
    if not all(_is_same(abs(unit_m), abs(known[0])) for unit_m in known):
        units = " and ".join(f"{abs(unit_m):.10g} m" for unit_m in known)
        raise input_error("height-unknown", f"the file states different units of z: {units}", "z_unit_m",
                          "pass z_unit_m: 0.3048 where it is feet, 1 for metres")
    if known:
        return known[0]
    if axes[0].unit_name not in ("metre", "degree"):
        raise input_error("height-unknown", f"x and y are in the unit '{axes[0].unit_name}', and nothing says what z is in",
                          "z_unit_m", "pass z_unit_m: 0.3048 where it is feet, 1 for metres")
    return 1.0


def _is_same(a: float, b: float) -> bool:
    return abs(a / b - 1) <= _SAME_UNIT


def _unit_m(keys: GeoKeys, unit: int, size: int | None = None) -> float | None:
    """Metres in the unit that a key names by its number in EPSG's table; None where there is none."""
    code = keys.values.get(unit, 0)
    if code == 0:
        return None
    if code == _USER_DEFINED and size is not None and keys.doubles.get(size, 0) > 0:
        return keys.doubles[size]
    units = require("pyproj.database", "laz").get_units_map(auth_name="EPSG", category="linear", allow_deprecated=True)
    for one in units.values():
        if one.code == str(code):
            return float(one.conv_factor)
    raise input_error("value-unsupported", f"the file's GeoTIFF key {unit} names the unit {code}, which is not known",
                      "z_unit_m" if unit == _VERTICAL_UNIT else "crs",
                      "pass z_unit_m" if unit == _VERTICAL_UNIT else "pass crs='EPSG:...'")


def _vertical_crs_unit_m(keys: GeoKeys) -> float | None:
    """Metres in the unit of the vertical CRS that a key names, less than 0 for depths; None where it names none that PROJ knows,
    as with the numbers of GeoTIFF 1.0."""
    pyproj = require("pyproj", "laz")
    try:
        crs = pyproj.CRS.from_epsg(keys.values.get(_VERTICAL, 0))
    except pyproj.exceptions.ProjError:
        return None
    if not crs.is_vertical:
        return None
    axis, = crs.axis_info
    return float(axis.unit_conversion_factor) * (-1 if axis.direction == "down" else 1)
