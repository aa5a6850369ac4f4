"""Missions and their results."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._errors import input_error, not_pickled
from ._mesh import Note, Solid
from ._progress import Progress
from ._requests import Navigation, Path, Sensor, Target, given
from ._scene import Scene
from ._text import NAME, Text
from ._volume import Volume

T = TypeVar("T")
AnyTarget = Union[Target, npt.ArrayLike]


class Answers(NamedTuple):
    """What points see; a row for each point."""

    inside: npt.NDArray[np.bool_]
    """the whole target is visible, in range, and the point is within the limits"""
    margin_m: npt.NDArray[np.float64]
    """signed distance to the boundary along the line to the target's centre, positive inside"""
    blocked_by: list[list[str]]
    """objects that hide some of the target"""
    out_of_range: npt.NDArray[np.bool_]
    """farther than the range from some of the target"""
    behind_target: npt.NDArray[np.bool_]
    """behind the plane of the target, which is seen from its front"""
    outside_of: list[list[str]]
    """limits that the point breaks"""

    def _repr_html_(self) -> str:
        from ._html import of_answers

        return of_answers(self)


class Mission:
    """What is asked, in its scene. `compute` makes one of its arguments; `Mission.read` one of a mission file.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> mission = vt.Mission.of(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> mission
        <vantage.Mission: target, 50 m, exact>
        >>> mission.query([[4, 4, 30], [4, 4, 60]]).inside.tolist()
        [True, False]
    """

    def __init__(self, core: _core.Mission, scene: Scene | None = None, text: Text | None = None):
        self._core = core
        self._scene = scene
        self._text = text
        self._query: _core.Query | None = None

    @classmethod
    def read(cls, path: Path, progress: Progress = None) -> Mission:
        """Reads a mission file (docs/mission-file.md) and its scene."""
        return cls(_core.read_mission(os.path.abspath(os.fspath(path)), progress))

    @classmethod
    def of(cls, scene: Scene, target: AnyTarget | Sequence[Target], *, max_range: float | None = None,
           sensor: Sensor | None = None, navigation: Navigation | None = None, combine: str = "all",
           crs: str | None = None, method: str = "exact", tolerance: float | None = None,
           spheres: Mapping[str, Any] | None = None, progress: Progress = None) -> Mission:
        """Of the arguments that `compute` takes."""
        text = Text()
        several = _targets(target)
        if any(one.osm or one.center is not None or one.outline is not None for one in several):
            scene._recall(needs_map=any(one.osm for one in several))
        if method != "exact":
            text.add("method", method)
        if crs is not None:
            text.add("crs", crs)
        if len(several) == 1 and not _is_targets(target):
            text.add("target", given(several[0]))
        else:
            text.add("targets", [given(one) for one in several], "target")
        if combine != "all":
            text.add("combine", combine)
        limits = given(_sensor(sensor, max_range))
        if isinstance(limits.get("camera"), str):
            limits["camera"] = {"model": limits["camera"]}
        text.add("sensor", limits)
        meshes: list[tuple[_arrays.Points, _arrays.Faces, str]] = []
        if navigation is not None:
            keys, meshes = _navigation(navigation)
            text.add("navigation", keys)
        if tolerance is not None:
            text.add("exact", {"tolerance": tolerance}, "tolerance")
        if spheres is not None:
            text.add("spheres", spheres)
        return cls(text.told(lambda: _core.resolve(scene._core, text.text(), NAME, meshes, progress)), scene, text)

    @property
    def scene(self) -> Scene:
        """The scene that it was resolved in."""
        if self._scene is None:
            self._scene = Scene(self._core.scene)
        return self._scene

    @property
    def target_name(self) -> str:
        """Of the target."""
        return self._core.target_name

    @property
    def target_parts(self) -> list[_arrays.Points]:
        """The target's convex polygons, (n, 3) each, in the scene's frame."""
        return self._core.target_parts

    @property
    def range_m(self) -> float:
        """The farthest that a viewpoint can be."""
        return self._core.range_m

    @property
    def hash(self) -> str:
        """SHA-256 of what is asked: docs/hashes.md."""
        return self._core.hash

    @property
    def notes(self) -> list[Note]:
        """What to know before relying on its results."""
        return [Note(*row) for row in self._core.notes]

    def run(self, *, threads: int = 0, progress: Progress = None) -> Result:
        """Computes the volume. Raises Error for a mission with a volume for each of its targets: that is `run_each`."""
        if self._core.count != 1:
            raise input_error("not-applicable", "the mission asks for a volume for each of its targets", "combine",
                              "call run_each, or combine them with 'all' or 'any'")
        return self.run_each(threads=threads, progress=progress)[0]

    def run_each(self, *, threads: int = 0, progress: Progress = None) -> list[Result]:
        """Computes all of its volumes, several at once: one, but with combine="each" one for each target."""
        return [Result(core, self._scene) for core in self._told(lambda: self._core.run(threads, progress))]

    def query(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> Answers:
        """What points see of the target: exact, without the mesh. `points`: (n, 3), metres."""
        columns = self._asked(progress).answer(_arrays.points(points), threads, progress)
        return Answers(columns["inside"].view(np.bool_), columns["margin_m"], columns["blocked_by"],
                       columns["out_of_range"].view(np.bool_), columns["behind_target"].view(np.bool_),
                       columns["outside_of"])

    def fraction(self, points: npt.ArrayLike, *, measure: str = "area", threads: int = 0,
                 progress: Progress = None) -> npt.NDArray[np.float64]:
        """Which part of the target each point sees, 0 to 1, by line of sight alone; not sampled.

        Args:
            points: (n, 3), metres.
            measure: "area" of the target, "solid_angle" or "pixels".
            threads: 0: as many as there are.
            progress: called with stage and fraction; False stops.
        """
        return self._asked(progress).fractions(_arrays.points(points), measure, False, threads, progress)[0]

    def prove(self, volume: Volume, *, maximal: bool = False, shrink: float = 1e-6, threads: int = 0,
              progress: Progress = None) -> dict[str, Any]:
        """Proves or refutes that all of a volume may be used for this mission, whoever made it: docs/proof.md.

        Returns:
            what `vantage prove --json` prints; ["verdict"] is "proved", "not proved" or "wrong".
        """
        return json.loads(_core.prove(self._core, volume._core, shrink, maximal, threads, progress))

    def verify(self, volume: Volume, *, points: int = 20000, seed: int = 1, threads: int = 0,
               progress: Progress = None) -> dict[str, Any]:
        """Checks a volume by rays from random points: what `vantage verify --json` prints."""
        return json.loads(_core.verify(self._core, volume._core, points, seed, threads, progress))

    def certify(self, volume_file: Path, certificate: Path, *, maximal: bool = False, shrink: float = 1e-6,
                threads: int = 0, progress: Progress = None) -> dict[str, Any]:
        """Proves a volume's PLY file and writes the certificate that tools/check_certificate.py checks, with its scene."""
        volume, out = os.path.abspath(os.fspath(volume_file)), os.path.abspath(os.fspath(certificate))
        return json.loads(_core.certify(self._core, volume, out, shrink, maximal, threads, progress))

    def text(self, folder: Path = ".") -> str:
        """The mission as the text of a mission file in `folder`."""
        return self._core.text(os.path.abspath(os.fspath(folder)))

    def _asked(self, progress: Progress) -> _core.Query:
        if self._query is None:
            self._query = self._told(lambda: _core.query(self._core, progress))
        return self._query

    def _told(self, work: Callable[[], T]) -> T:
        """What `work` returns; errors in what was asked by arguments are told of them."""
        return work() if self._text is None else self._text.told(work)

    def _repr_html_(self) -> str:
        from ._html import of_mission

        return of_mission(self)

    def __reduce__(self) -> Any:
        raise not_pickled("a mission", "pickle the scene, and what was asked of `compute`")

    def __repr__(self) -> str:
        return f"<vantage.Mission: {self.target_name}, {self.range_m:g} m, {self._core.method}>"


class Result(Solid):
    """A volume with its mission and its scene.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> result = vt.compute(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> round(result.volume_m3, -3), result.prove()["verdict"]
        (195000.0, 'proved')
        >>> result.contains([[4, 4, 30], [4, 4, 60]]).tolist()
        [True, False]
    """

    def __init__(self, core: _core.Result, scene: Scene | None = None):
        self._core = core
        self.mission = Mission(core.mission, scene)
        """what was asked"""
        self.volume = Volume(core.volume)
        """what came of it"""

    @property
    def scene(self) -> Scene:
        """The scene that it was computed in."""
        return self.mission.scene

    @property
    def _solid(self) -> _core.Volume:
        return self.volume._core

    @property
    def report(self) -> dict[str, Any]:
        """What `vantage compute` writes beside a volume."""
        return json.loads(self._core.report())

    def query(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> Answers:
        """What points see of the target: exact, without the mesh. `points`: (n, 3), metres."""
        return self.mission.query(points, threads=threads, progress=progress)

    def contains(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.bool_]:
        """Whether each point may be used: (n,) bool. Exact, by `query`."""
        return self.query(points, threads=threads, progress=progress).inside

    def fraction(self, points: npt.ArrayLike, *, measure: str = "area", threads: int = 0,
                 progress: Progress = None) -> npt.NDArray[np.float64]:
        """Which part of the target each point sees, 0 to 1."""
        return self.mission.fraction(points, measure=measure, threads=threads, progress=progress)

    def prove(self, *, maximal: bool = False, shrink: float = 1e-6, threads: int = 0,
              progress: Progress = None) -> dict[str, Any]:
        """Proves the volume: ["verdict"] is "proved", "not proved" or "wrong"."""
        return self.mission.prove(self.volume, maximal=maximal, shrink=shrink, threads=threads, progress=progress)

    def verify(self, *, points: int = 20000, seed: int = 1, threads: int = 0, progress: Progress = None) -> dict[str, Any]:
        """Checks the volume by rays from random points."""
        return self.mission.verify(self.volume, points=points, seed=seed, threads=threads, progress=progress)

    def save(self, *paths: Path, progress: Progress = None) -> list[str]:
        """Writes the volume to each path (PLY, OBJ, STL, GLB), and a report beside it; all or none. Returns the reports."""
        return self._core.save([os.path.abspath(os.fspath(path)) for path in paths], progress)

    def plot(self, path: Path | None = None, **options: Any) -> Any:
        """Scene, target and volume by pyvista: in a notebook to turn, or as a PNG at `path`."""
        from ._plot import plot

        return plot(self, path, **options)

    def picture(self, path: Path | None = None, *, view: str | Sequence[float] = "oblique",
                size: tuple[int, int] = (1600, 1200), azimuth: float | None = None, elevation: float = 45,
                title: str | None = None, subtitle: str = "", progress: Progress = None) -> npt.NDArray[np.uint8]:
        """The picture that `vantage render` makes: (height, width, 4) uint8, also written to `path` as PNG.

        Args:
            path: where to write it.
            view: "oblique", "top", or a place (x, y, z) to look from.
            size: pixels, width and height.
            azimuth, elevation: degrees, of an oblique view.
            title, subtitle: over the picture.
            progress: called with stage and fraction; False stops.
        """
        kind, place = (view, []) if isinstance(view, str) else ("from", [float(v) for v in view])
        pixels = _core.render(self.mission._core, self.volume._core, kind, azimuth, float(elevation), place, *size,
                              self.mission.target_name if title is None else title, subtitle, progress)
        if path is not None:
            _core.save_png(pixels, os.path.abspath(os.fspath(path)))
        return pixels

    def _row(self) -> dict[str, Any]:
        return {**super()._row(), "target": self.mission.target_name}

    def __reduce__(self) -> Any:
        raise not_pickled("a result", "pickle result.volume, and result.scene where it is needed")

    def __repr__(self) -> str:
        return f"<vantage.Result: {self.mission.target_name}, {repr(self.volume)[len('<vantage.Volume: '):]}"

    def _repr_html_(self) -> str:
        from ._html import of_result

        return of_result(self)


def compute(scene: Scene, target: AnyTarget | Sequence[Target], *, max_range: float | None = None,
            sensor: Sensor | None = None, navigation: Navigation | None = None, combine: str = "all",
            crs: str | None = None, method: str = "exact", tolerance: float | None = None,
            spheres: Mapping[str, Any] | None = None, threads: int = 0, progress: Progress = None) -> Result:
    """The volume of every position from which the whole target can be seen, within the limits.

    Args:
        scene: what may hide the target.
        target: a `Target`; (n, 3) vertices of a convex polygon; or several `Target`s.
        max_range: metres; short for sensor=Sensor(max_range=...).
        sensor: what the sensor can do.
        navigation: where the vehicle may fly.
        combine: of several targets: "all" must be seen, or "any" one of them.
        crs: of the target's and the limits' coordinates: "EPSG:4326". Default: the scene's frame.
        method: "exact", or "spheres" for the method of the paper.
        tolerance: metres that range facets may lie inside the true range. Default: 0.01.
        spheres: options of that method, as in the mission file.
        threads: 0: as many as there are. The result does not depend on it.
        progress: called with stage and fraction; False stops.

    Returns:
        the result. A volume that is empty for a good reason is no error: see `Result.outcome`.

    Raises:
        Error: an argument is wrong; it says which, and what to do.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> vt.compute(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50).outcome
        'computed'
    """
    mission = Mission.of(scene, target, max_range=max_range, sensor=sensor, navigation=navigation, combine=combine,
                         crs=crs, method=method, tolerance=tolerance, spheres=spheres, progress=progress)
    return mission.run(threads=threads, progress=progress)


def compute_many(scene: Scene, targets: Iterable[AnyTarget], *, max_range: float | None = None,
                 sensor: Sensor | None = None, navigation: Navigation | None = None, crs: str | None = None,
                 method: str = "exact", tolerance: float | None = None, spheres: Mapping[str, Any] | None = None,
                 threads: int = 0, progress: Progress = None) -> list[Result]:
    """A volume for each of many targets in one scene, several at once on all cores. Arguments as of `compute`.

    Raises:
        Error: as `compute`; one target that is wrong stops all.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> square = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
        >>> beside = [[20, 0, 0], [29, 0, 0], [29, 9, 0], [20, 9, 0]]
        >>> [result.outcome for result in vt.compute_many(ground, [square, beside], max_range=50)]
        ['computed', 'computed']
    """
    several = [one if isinstance(one, Target) else Target(vertices=_arrays.points(one, "vertices")) for one in targets]
    if not several:
        return []
    mission = Mission.of(scene, several, max_range=max_range, sensor=sensor, navigation=navigation, combine="each",
                         crs=crs, method=method, tolerance=tolerance, spheres=spheres, progress=progress)
    return mission.run_each(threads=threads, progress=progress)


def _is_targets(target: Any) -> bool:
    return isinstance(target, Sequence) and not isinstance(target, str) and any(isinstance(t, Target) for t in target)


def _targets(target: Any) -> list[Target]:
    if isinstance(target, Target):
        return [target]
    if _is_targets(target):
        return [one if isinstance(one, Target) else Target(vertices=_arrays.points(one, "vertices")) for one in target]
    return [Target(vertices=_arrays.points(target, "target"))]


def _sensor(sensor: Sensor | None, max_range: float | None) -> Sensor:
    if sensor is not None and max_range is not None:
        raise input_error("conflicting-keys", "both max_range and sensor are given", "max_range",
                          "write sensor=vt.Sensor(max_range=...)")
    if sensor is None and max_range is None:
        raise input_error("missing-key", "it is not said how far the sensor reaches", "max_range",
                          "give max_range in metres, or a sensor")
    return sensor if sensor is not None else Sensor(max_range=max_range)


def _navigation(navigation: Navigation) -> tuple[dict[str, Any], list[tuple[_arrays.Points, _arrays.Faces, str]]]:
    """The keys, and the meshes that are in memory."""
    keys = given(navigation)
    files: list[Any] = []
    meshes = []
    for number, mesh in enumerate(keys.pop("meshes", [])):
        if isinstance(mesh, (str, os.PathLike)):
            files.append(os.path.abspath(os.fspath(mesh)))
        elif isinstance(mesh, Mapping):
            files.append({**mesh, "mesh": os.path.abspath(os.fspath(mesh["mesh"]))})
        else:
            name = f"navigation.meshes[{number}]"
            source = mesh.volume if isinstance(mesh, Result) else mesh
            points = _arrays.points(source.vertices, name)
            meshes.append((points, _arrays.faces(source.faces, len(points), name), name))
    if files:
        keys["meshes"] = files
    for key in ("keep_in", "keep_out"):
        if key in keys:
            keys[key] = [_zone(zone) for zone in keys[key]]
    return keys, meshes


def _zone(zone: Mapping[str, Any]) -> dict[str, Any]:
    if "file" not in zone:
        return dict(zone)
    return {**zone, "file": os.path.abspath(os.fspath(zone["file"]))}


