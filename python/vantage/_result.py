"""Missions and their results."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._checks import (choice, flag, instance, not_called, path as checked_path, shown, text as checked_text, thread_count,
                      whole)
from ._errors import Error, input_error, not_pickled
from ._mesh import Note, Solid
from ._progress import Progress
from ._render import html, plot
from ._requests import Navigation, Path, Sensor, Target, TourSettings, given, keys_of
from ._scene import Scene, checked_scene
from ._shapes import AnyTarget, is_several, targets_of
from ._text import NAME, Text
from ._viewer import MOST_BYTES, Viewer, viewer
from ._volume import Volume, volume_of

T = TypeVar("T")
Meshes = list[tuple[_arrays.Points, _arrays.Faces, str]]


MEASURES = ("area", "solid_angle", "pixels")


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
        return html(self)


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
        not_called(core, _core.Mission, "vt.Mission", "read a mission file with vt.Mission.read, or make one with vt.Mission.of")
        self._core = core
        self._scene = scene
        self._text = text
        self._query: _core.Query | None = None

    @classmethod
    def read(cls, path: Path, progress: Progress = None) -> Mission:
        """Reads a mission file (docs/mission-file.md) and its scene."""
        return cls(_core.read_mission(checked_path(path), progress))

    @classmethod
    def of(cls, scene: Scene, target: AnyTarget | Sequence[AnyTarget], *, max_range: float | None = None,
           sensor: Sensor | Mapping[str, Any] | None = None, navigation: Navigation | Mapping[str, Any] | None = None,
           combine: str = "all", crs: str | None = None, method: str = "exact", tolerance: float | None = None,
           spheres: Mapping[str, Any] | None = None, work_limit: float | None = None,
           tour: TourSettings | Mapping[str, Any] | None = None, links: Sequence[Mapping[str, Any]] | None = None,
           progress: Progress = None) -> Mission:
        """Of the arguments that `compute` takes, and for flights `tour`: a `TourSettings`, or a dictionary of its keys; and
        `links`: what they must stay in sight or in reach of, a dictionary of keys of a mission file's `links` for each."""
        checked_scene(scene)
        is_one = not is_several(target)
        targets = targets_of(target, scene, crs)
        names = ["target"] if is_one else [f"target[{number}]" for number in range(len(targets))]
        return resolved(scene, targets, names, is_one=is_one, max_range=max_range, sensor=sensor, navigation=navigation,
                        combine=combine, crs=crs, method=method, tolerance=tolerance, spheres=spheres, work_limit=work_limit,
                        tour=tour, links=links, progress=progress)

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
        count = thread_count(threads)
        return [Result(core, self._scene) for core in self._call(lambda: self._core.run(count, progress))]

    def _try_each(self, threads: int, progress: Progress) -> list[Result | Error]:
        """The same, with an error in the place of the result of a target that is wrong."""
        made = self._call(lambda: self._core.try_each(threads, progress))
        rename = self._text.renamed if self._text is not None else (lambda error: error)
        return [rename(one) if isinstance(one, Error) else Result(one, self._scene) for one in made]

    def query(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> Answers:
        """What points see of the target: exact, without the mesh. `points`: (n, 3), metres."""
        places, count = _arrays.points(points), thread_count(threads)
        columns = self._asked(progress).answer(places, count, progress)
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
        places, count = _arrays.points(points), thread_count(threads)
        choice(measure, "measure", MEASURES)
        return self._asked(progress).fractions(places, measure, False, count, progress)[0]

    def prove(self, volume: Volume, *, maximal: bool = False, shrink: float = 1e-6, threads: int = 0,
              progress: Progress = None) -> dict[str, Any]:
        """Proves or refutes that all of a volume may be used for this mission, whoever made it: docs/proof.md.

        Returns:
            what `vantage prove --json` prints; ["verdict"] is "proved", "not proved" or "wrong".
        """
        return json.loads(_core.prove(self._core, volume_of(volume, "volume"), _arrays.number(shrink, "shrink"),
                                      flag(maximal, "maximal"), thread_count(threads), progress))

    def verify(self, volume: Volume, *, points: int = 20000, seed: int = 1, threads: int = 0,
               progress: Progress = None) -> dict[str, Any]:
        """Checks a volume by rays from random points: what `vantage verify --json` prints."""
        return json.loads(_core.verify(self._core, volume_of(volume, "volume"), whole(points, "points", 1), whole(seed, "seed"),
                                       thread_count(threads), progress))

    def certify(self, volume_file: Path, certificate: Path, *, maximal: bool = False, shrink: float = 1e-6,
                threads: int = 0, progress: Progress = None) -> dict[str, Any]:
        """Proves a volume's PLY file and writes the certificate that tools/check_certificate.py checks, with its scene."""
        return json.loads(_core.certify(self._core, checked_path(volume_file, "volume_file"), checked_path(certificate, "certificate"),
                                        _arrays.number(shrink, "shrink"), flag(maximal, "maximal"), thread_count(threads),
                                        progress))

    def view(self, volume: Solid, *, size: tuple[int, int] = (1000, 650), proof: bool = False, page: Path | None = None,
             most_bytes: int = MOST_BYTES, progress: Progress = None) -> Viewer:
        """A volume of this mission, whoever made it, in the page: for notebooks. The last value of a cell is shown.

        Args:
            volume: closed.
            size: pixels, width and height. A narrower notebook makes it narrower.
            proof: whether it has the verdict of the proof, which takes longer than to compute the volume.
            page: `report.html` of `make web`, where it is not installed.
            most_bytes: how large a cell may become; beyond it the cell says so, in the place of the page. The page without
                meshes takes 0.3 MB, each triangle of the scene and the volume 8 to 14 bytes.
            progress: called with stage and fraction; False stops.

        Raises:
            Error: the page is not there (`page-missing`), the volume is open, or the mission has several volumes.
        """
        if self._core.count != 1:
            raise input_error("not-applicable", "the mission asks for a volume for each of its targets", "combine",
                              "view the results of run_each one by one")
        return viewer(self._core, volume_of(volume, "volume"), size, proof, page, most_bytes, progress)

    def text(self, folder: Path = ".") -> str:
        """The mission as the text of a mission file in `folder`."""
        return self._core.text(checked_path(folder, "folder"))

    def _asked(self, progress: Progress) -> _core.Query:
        if self._query is None:
            self._query = self._call(lambda: _core.query(self._core, progress))
        return self._query

    def _call(self, work: Callable[[], T]) -> T:
        """What `work` returns. Errors in what was asked by arguments name these."""
        return work() if self._text is None else self._text.call(work)

    def _repr_html_(self) -> str:
        return html(self)

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
        not_called(core, _core.Result, "vt.Result", "results come from vt.compute; read a volume's file with vt.Volume.read")
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
        """Writes the volume to each path (`vantage.output_formats()`), and a report beside it; all or none. Returns the reports.

        "volume.tiles" is a folder with 3D Tiles, for the globe (docs/tilesets.md): of a scene with a georeference.
        The report of "a.ply" is "a.report.json". So "a.ply" and "a.glb" share one, which names the first: give volumes names
        of their own where each is to have its report.
        """
        if not paths:
            raise input_error("nothing-given", "it is not said where to write", "paths", "pass a path, or several")
        return self._core.save([checked_path(one) for one in paths], progress)

    def plot(self, path: Path | None = None, **options: Any) -> Any:
        """Scene, target and volume by pyvista: in a notebook to turn, or as a PNG at `path`."""
        return plot(self, path, **options)

    def view(self, *, size: tuple[int, int] = (1000, 650), proof: bool = False, page: Path | None = None,
             most_bytes: int = MOST_BYTES, progress: Progress = None) -> Viewer:
        """Scene, target and volume in the page, to turn and to cut in a notebook: see `Mission.view`."""
        return self.mission.view(self.volume, size=size, proof=proof, page=page, most_bytes=most_bytes, progress=progress)

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
        kind, place = (view, []) if isinstance(view, str) else ("from", _arrays.vector(view, "view").tolist())
        if not isinstance(size, Sequence) or len(size) != 2:
            raise input_error("wrong-type", f"size is {shown(size)}", "size", "pass width and height: (1600, 1200)")
        width, height = whole(size[0], "size[0]", 1, 2**31 - 1), whole(size[1], "size[1]", 1, 2**31 - 1)
        turned = None if azimuth is None else _arrays.number(azimuth, "azimuth")
        heading = self.mission.target_name if title is None else checked_text(title, "title")
        file = None if path is None else checked_path(path)
        pixels = _core.render(self.mission._core, self.volume._core, kind, turned, _arrays.number(elevation, "elevation"), place,
                              width, height, heading, checked_text(subtitle, "subtitle"), progress)
        if file is not None:
            _core.save_png(pixels, file)
        return pixels

    def _row(self) -> dict[str, Any]:
        return {**super()._row(), "target": self.mission.target_name}

    def __reduce__(self) -> Any:
        raise not_pickled("a result", "pickle result.volume, and result.scene where it is needed")

    def __repr__(self) -> str:
        return f"<vantage.Result: {self.mission.target_name}, {repr(self.volume)[len('<vantage.Volume: '):]}"

    def _repr_html_(self) -> str:
        return html(self)


def compute(scene: Scene, target: AnyTarget | Sequence[AnyTarget], *, max_range: float | None = None,
            sensor: Sensor | Mapping[str, Any] | None = None, navigation: Navigation | Mapping[str, Any] | None = None,
            combine: str = "all", crs: str | None = None, method: str = "exact", tolerance: float | None = None,
            spheres: Mapping[str, Any] | None = None, work_limit: float | None = None, threads: int = 0,
            progress: Progress = None) -> Result:
    """The volume of every position from which the whole target can be seen, within the limits.

    Args:
        scene: what may hide the target.
        target: a `Target`, or a dictionary of its keys; (n, 3) vertices of a convex polygon; an `Area` or a `Face`; a Polygon or
            MultiPolygon of shapely, or what else has a `__geo_interface__`: without z it is laid on the ground, with z it lies
            there. Or several: a list of these, or a GeoSeries or GeoDataFrame. Coordinates are metres in the scene's frame,
            but with `crs`, and those of a table with a CRS.
        max_range: metres; short for sensor=Sensor(max_range=...).
        sensor: what the sensor can do: a `Sensor`, or a dictionary of its keys.
        navigation: where the vehicle may fly: a `Navigation`, or a dictionary of its keys.
        combine: of several targets: "all" must be seen, or "any" one of them.
        crs: of the target's and the limits' coordinates: "EPSG:4326", longitude before latitude. Default: the scene's frame.
        method: "exact", or "spheres" for the method of the paper.
        tolerance: metres that range facets may lie inside the true range. Default: 0.01.
        spheres: options of that method, as in the mission file.
        work_limit: how much work the boolean operations may be, as in the mission file. More is refused with the code
            "work-too-large". Default: 1e7.
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
    thread_count(threads)
    mission = Mission.of(scene, target, max_range=max_range, sensor=sensor, navigation=navigation, combine=combine,
                         crs=crs, method=method, tolerance=tolerance, spheres=spheres, work_limit=work_limit,
                         progress=progress)
    return mission.run(threads=threads, progress=progress)


def resolved(scene: Scene, targets: Sequence[Target], names: Sequence[str], *, is_one: bool, progress: Progress = None,
             **request: Any) -> Mission:
    """The mission of some targets. `names`: what errors call each of them."""
    text, meshes = asked(scene, targets, names, is_one=is_one, **request)
    return Mission(text.call(lambda: _core.resolve(scene._core, text.text(), NAME, meshes, progress)), scene, text)


def asked(scene: Scene, targets: Sequence[Target], names: Sequence[str], *, is_one: bool, max_range: float | None = None,
          sensor: Sensor | Mapping[str, Any] | None = None, navigation: Navigation | Mapping[str, Any] | None = None,
          combine: str = "all", crs: str | None = None, method: str = "exact", tolerance: float | None = None,
          spheres: Mapping[str, Any] | None = None, work_limit: float | None = None,
          tour: TourSettings | Mapping[str, Any] | None = None,
          links: Sequence[Mapping[str, Any]] | None = None) -> tuple[Text, Meshes]:
    """The text of a mission without its scene, and the meshes to stay in that are in memory."""
    checked_text(combine, "combine"), checked_text(method, "method")
    text = Text()
    if any(getattr(one, key) is not None for one in targets for key in ("osm", "file", "center", "outline")):
        scene._recall(needs_map=any(one.osm is not None for one in targets))
    if method != "exact":
        text.add("method", method)
    if crs is not None:
        text.add("crs", crs)
    keys = [_with_true_path(given(one), name) for one, name in zip(targets, names)]
    if is_one:
        text.add("target", keys[0], names[0])
    else:
        text.add_items("targets", keys, names)
    if combine != "all":
        text.add("combine", combine)
    is_sensed = any(one.volume is None for one in targets)  # what is only flown through needs no sensor
    if is_sensed or sensor is not None or max_range is not None:
        limits = sensor_keys(sensor, max_range)
        if isinstance(limits.get("camera"), str):
            limits["camera"] = {"model": limits["camera"]}
        text.add("sensor", limits)
    meshes: Meshes = []
    if navigation is not None:
        keys_of_limits, meshes = _navigation(navigation)
        text.add("navigation", keys_of_limits)
    if tolerance is not None:
        text.add("exact", {"tolerance": tolerance}, "tolerance")
    if spheres is not None:
        text.add("spheres", instance(spheres, Mapping, "spheres", "pass a dictionary"))  # type: ignore[type-abstract]
    if work_limit is not None:
        text.add("work_limit", work_limit)
    if tour is not None:
        text.add("tour", keys_of(tour, TourSettings, "tour"))
    if links is not None:
        entries = [instance(link, Mapping, f"links[{i}]", "pass a dictionary") for i, link in enumerate(links)]  # type: ignore[type-abstract]
        text.add_items("links", entries, [f"links[{i}]" for i in range(len(entries))])
    return text, meshes


def _with_true_path(keys: dict[str, Any], name: str) -> dict[str, Any]:
    paths: dict[str, Any] = {key: checked_path(keys[key], f"{name}['{key}']") for key in ("file", "volume") if key in keys}
    return {**keys, **paths}


def sensor_keys(sensor: Sensor | Mapping[str, Any] | None, max_range: float | None) -> dict[str, Any]:
    if sensor is not None and max_range is not None:
        raise input_error("conflicting-keys", "both max_range and sensor are given", "max_range",
                          "write sensor=vt.Sensor(max_range=...)")
    if sensor is None and max_range is None:
        raise input_error("missing-key", "it is not said how far the sensor reaches", "max_range",
                          "give max_range in metres, or a sensor")
    if sensor is None:
        return {"max_range": max_range}
    return keys_of(sensor, Sensor, "sensor")


def _navigation(navigation: Navigation | Mapping[str, Any]) -> tuple[dict[str, Any], Meshes]:
    """The keys, and the meshes that are in memory."""
    keys = keys_of(navigation, Navigation, "navigation")
    files: list[Any] = []
    meshes: Meshes = []
    for number, mesh in enumerate(_items(keys.pop("meshes", ()), "navigation.meshes")):
        name = f"navigation.meshes[{number}]"
        if isinstance(mesh, (str, os.PathLike)):
            files.append(checked_path(mesh, name))
        elif isinstance(mesh, Mapping):
            files.append({**mesh, "mesh": checked_path(mesh.get("mesh"), f"{name}['mesh']")})
        else:
            source = mesh.volume if isinstance(mesh, Result) else mesh
            if not (hasattr(source, "vertices") and hasattr(source, "faces")):
                raise input_error("wrong-type", f"{name} is {shown(mesh)}", name,
                                  "pass a path, a vt.Volume, or anything with vertices and faces")
            points = _arrays.points(source.vertices, name)
            meshes.append((points, _arrays.faces(source.faces, len(points), name), name))
    if files:
        keys["meshes"] = files
    for key in ("keep_in", "keep_out", "boxes"):
        if key in keys:
            name = f"navigation[{key!r}]"
            keys[key] = [_zone(zone, f"{name}[{number}]") for number, zone in enumerate(_items(keys[key], name))]
    return keys, meshes


def _items(value: Any, name: str) -> Sequence[Any]:
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Sequence):
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass a list")
    return value


def _zone(zone: Any, name: str) -> dict[str, Any]:
    keys = instance(zone, Mapping, name, 'pass a dictionary: {"polygon": ..., "z": ...} or {"file": ...}')  # type: ignore[type-abstract]
    return {**keys, "file": checked_path(keys["file"], f"{name}['file']")} if "file" in keys else dict(keys)


