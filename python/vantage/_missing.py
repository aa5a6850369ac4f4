"""What packages of the engine alone lack: that in WebAssembly, and native ones for Windows and macOS. Names of
python/vantage/_core.pyi, and what they are. A native one has some of them.
"""

from __future__ import annotations

from typing import Any

from ._errors import NotInBuildError

_FLIGHTS = "flights and tours"
_FIELDS = "fields of the share that is seen"
_PLACES = "coordinate reference systems (PROJ)"

NAMES: dict[str, str] = {
    "areas": "maps (OpenStreetMap)",
    "faces": "search for roofs and facades",
    "plan_tiles": "maps (OpenStreetMap)",
    "position": "tiles of maps",
    "to_crs": _PLACES,
    "from_crs": _PLACES,
    "plan_to_crs": _PLACES,
    "plan_from_crs": _PLACES,
    "from_crs_on_ground": _PLACES,
    "vertical_unit_m": _PLACES,
    "footprint_of_volume": "footprints",
    "verify": "check by rays",
    "visibility_sphere": "spheres method",
    "devices": "spheres method",
    "fraction_field": _FIELDS,
    "sampled_field": _FIELDS,
    "target_samples": _FIELDS,
    "render": "pictures",
    "save_png": "pictures",
    "viewer_page": "page with a volume",
    "Flight": _FLIGHTS,
    "FlightCheck": _FLIGHTS,
    "Orbit": _FLIGHTS,
    "Tour": _FLIGHTS,
    "flight_from_arrays": _FLIGHTS,
    "read_plan": _FLIGHTS,
    "for_flights": _FLIGHTS,
    "ground_under": _FLIGHTS,
    "check_flight": _FLIGHTS,
    "describe_views": _FLIGHTS,
    "find_standpoints": _FLIGHTS,
    "find_orbits": _FLIGHTS,
    "plan_tour": _FLIGHTS,
    "run_program": "command line",
    "set_resource_folder": "files of PROJ and fonts",
    "warn_of_leaks": "extension module",
}


def missing(name: str) -> Any:
    """`__getattr__` of a native `vantage._core` of the engine alone (python/src/libraries_none.cpp)."""
    what = NAMES.get(name)
    if what is None:
        raise AttributeError(f"module 'vantage._core' has no attribute {name!r}")
    raise NotInBuildError("input", "component-missing", f"this package of vantage has no {what}", name,
                          "the package for Linux has it")
