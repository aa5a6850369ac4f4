"""Visibility volumes: every position from which the whole of a convex polygon can be seen, as a closed 3D mesh.

    import vantage as vt
    scene  = vt.Scene.from_osm("city.osm.pbf", center=(40.7484, -73.9857), radius=600)
    target = scene.target(center=(40.7484, -73.9857), width=20, length=30)
    result = vt.compute(scene, target, max_range=300, navigation=vt.Navigation(altitude={"agl": (30, 120)}))
    result.volume_m3, result.vertices, result.faces
    result.save("volume.ply")

Lengths are metres, angles degrees; the scene's frame is right-handed with z up.
"""

from __future__ import annotations

import json as _json
import pathlib as _pathlib
from typing import Any as _Any

from . import _core

if _refusal := getattr(_core, "refusal", None):  # in a subinterpreter
    raise ImportError(_refusal)

from . import _arrays, _checks, _html, _plot, _profile
from ._areas import Area, Face, areas
from ._check import BrokenLimit, FlightCheck, GimbalUse, LinkCheck, NearestPass, NotSeen, Span, TargetCheck, check
from ._core import version as __version__
from ._errors import CancelledError, Error, InputError, InternalError, NotInBuildError, OutputError
from ._field import fraction_field
from ._flight import Flight
from ._mesh import Cause, Note
from ._objects import SceneObject
from ._place import Georeference
from ._positions import Positions, PositionView, fewest_positions
from ._progress import Progress
from ._requests import Navigation, Sensor, Target, TourSettings, Vector
from ._many import Results, compute_many
from ._result import Answers, Mission, Result, compute
from ._scene import Scene, checked_scene
from ._slice import Slice, write_slices
from ._tiles import Tile, Tiles, tiles
from ._tour import LeftOut, Tour, TourBound, Visit, tour
from ._views import Found, Orbit, Orbits, Standpoint, Standpoints, View, orbits, standpoints
from ._viewer import Viewer
from ._volume import Volume, intersect, unite

__all__ = [
    "Answers", "Area", "BrokenLimit", "CancelledError", "Cause", "Error", "Face", "Flight", "FlightCheck", "Found",
    "Georeference", "GimbalUse", "InputError", "InternalError", "LeftOut", "LinkCheck", "Mission", "Navigation",
    "NearestPass", "Note", "NotInBuildError", "NotSeen", "Orbit", "Orbits", "OutputError", "Positions", "PositionView", "Result", "Results", "Scene",
    "SceneObject", "Sensor", "Slice", "Span", "Standpoint", "Standpoints", "Target", "TargetCheck", "Tile", "Tiles",
    "Tour", "TourBound", "TourSettings", "View", "Viewer", "Visit", "Volume", "__version__", "areas", "cameras", "check",
    "compute", "compute_many", "devices", "error_codes", "fewest_positions", "fraction_field", "intersect",
    "orbits", "output_formats", "standpoints", "tiles", "tour", "unite", "visibility_sphere",
    "write_slices",
]

if (_share := _pathlib.Path(__file__).parent / "share").is_dir():  # a wheel brings PROJ's database and fonts along
    _core.set_resource_folder(str(_share))


def cameras() -> list[dict[str, _Any]]:
    """The cameras that vantage knows, a dictionary for each: `Sensor(camera=...)` takes its "name". "carrier" has the range of its
    gimbal, which limits the view where nothing is said of pitch, and the numbers of its aircraft, as far as they are known.

    Example:
        >>> vt.cameras()[0]["name"]
        'autel_evo_ii'
    """
    cameras: list[dict[str, _Any]] = _json.loads(_core.cameras())["cameras"]
    return cameras


def devices(choice: str = "auto") -> dict[str, _Any]:
    """What can render depth images on this machine: what `vantage devices --json` prints.

    Example:
        >>> vt.devices()["devices"][0]["kind"]
        'cpu'
    """
    return _json.loads(_core.devices(_checks.text(choice, "choice")))


def error_codes() -> list[str]:
    """All values that `Error.code` can have.

    Example:
        >>> "file-not-found" in vt.error_codes()
        True
    """
    return _core.error_codes()


def output_formats(*, scenes: bool = False) -> list[str]:
    """The formats that volumes are saved in, as the ends of names; docs/command-line.md says what each holds.

    Args:
        scenes: those that scenes are saved in, too, and that are read back: without KML and KMZ.

    Volumes are also saved as "tiles", a folder for the globe: docs/tilesets.md.

    Example:
        >>> "ply" in vt.output_formats()
        True
    """
    return _core.output_formats(_checks.flag(scenes, "scenes"))


def visibility_sphere(scene: Scene, viewpoint: Vector, radius_m: float, *, cubemap: int = 200, conservative: bool = True,
                      merge: float = 2.5e-4, device: str = "auto", threads: int = 0, progress: Progress = None) -> Volume:
    """What one viewpoint sees within a radius, from depth images (docs/spheres.md): closed, and star-shaped about it.

    Args:
        scene: what may hide.
        viewpoint: (x, y, z), metres.
        radius_m: how far it sees.
        cubemap: texels along the side of a depth image.
        conservative: inside of what is seen; else texel centres are joined, as in the paper.
        merge: facets are joined where that moves them by no more than this part of their distance.
        device: "auto", "cpu", "opengl", "gpu" or a number of `devices()`.
        threads: 0: as many as there are.
        progress: called with stage and fraction; False stops.

    Example:
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> sphere = vt.visibility_sphere(ground, (0, 0, 10), 5, cubemap=50, device="cpu")
        >>> 0.95 < sphere.volume_m3 / (4 / 3 * 3.14159 * 5 ** 3) <= 1
        True
    """
    at = _arrays.vector(viewpoint, "viewpoint").tolist()
    return Volume(_core.visibility_sphere(checked_scene(scene)._core, at, _arrays.number(radius_m, "radius_m"),
                                          _checks.whole(cubemap, "cubemap", 1, 2**31 - 1),
                                          _checks.flag(conservative, "conservative"),
                                          _arrays.number(merge, "merge"), _checks.text(device, "device"),
                                          _checks.thread_count(threads), progress))
