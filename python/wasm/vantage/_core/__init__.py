"""`vantage._core` over the engine in WebAssembly, for machines without a native package: the classes and functions of
python/vantage/_core.pyi, as far as the engine has them. What it lacks raises `NotInBuildError`. It computes on one thread,
whatever is asked for: the results are the same.
"""

from __future__ import annotations

import functools
import os
import pathlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _missing
from .._errors import Error, NotInBuildError
from .._progress import Progress
from ._engine import Held, engine, error_of
from ._system import to_engine, to_host

Numbers = npt.NDArray[Any]


def __getattr__(name: str) -> Any:
    if name == "version":
        return _version()
    what = _missing.NAMES.get(name)
    if what is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    raise not_in_build(what, name)


def not_in_build(what: str, name: str) -> NotInBuildError:
    """The error of what only the native package has."""
    return NotInBuildError("input", "component-missing", f"this build of vantage runs in WebAssembly and has no {what}", name,
                           "the native package for Linux x86-64 has it")


@functools.cache
def _version() -> str:
    return str(engine().call("version"))


def _file(path: str | os.PathLike[str]) -> str:
    return to_engine(os.fspath(path))


class Scene(Held):
    kind = "scene"

    @functools.cached_property
    def _facts(self) -> dict[str, Any]:
        facts: dict[str, Any] = self._call("scene_facts", scene=self)
        return facts

    @functools.cached_property
    def vertices(self) -> Numbers:
        return self.engine.array(self._facts["vertices"], "f8", 3)

    @functools.cached_property
    def faces(self) -> Numbers:
        return self.engine.array(self._facts["faces"], "u4", 3)

    @functools.cached_property
    def object_of(self) -> Numbers:
        return self.engine.array(self._facts["object_of"], "u4")

    @property
    def objects(self) -> list[tuple[str, str, int]]:
        return [(name, source, kind) for name, source, kind in self._facts["objects"]]

    @property
    def ledger_rows(self) -> list[Any]:
        return list(self._facts["ledger_rows"])

    @property
    def place(self) -> tuple[float, float, str, str] | None:
        return None if self._facts["place"] is None else tuple(self._facts["place"])

    @property
    def projection(self) -> str | None:
        return self._facts["projection"]

    @property
    def attribution(self) -> str:
        return self._facts["attribution"]

    @property
    def source(self) -> pathlib.Path:
        return pathlib.Path(to_host(self._facts["source"]))

    @property
    def sea_level_m(self) -> float | None:
        return self._facts["sea_level_m"]

    @property
    def whole(self) -> list[float] | None:
        return self._facts["whole"]

    @functools.cached_property
    def hash(self) -> str:
        return str(self._call("scene_hash", scene=self))

    def set_source(self, text: str, name: str) -> None:
        self._call("set_scene_source", scene=self, text=text, name=name)

    def prepare(self, progress: Progress = None) -> None:
        self._call("prepare_scene", progress, scene=self)

    def report(self) -> str:
        return str(self._call("scene_report", scene=self))

    def save(self, file: str | os.PathLike[str]) -> float:
        return float(self._call("save_scene", scene=self, file=_file(file)))


def load_scene(text: str, name: str, progress: Progress = None) -> Scene:
    one = engine()
    return Scene(one, one.call("load_scene", progress, text=text, name=name))


def scene_from_arrays(vertices: Numbers, faces: Numbers, object_of: Numbers, objects: Sequence[tuple[str, str, int]],
                      place: tuple[float, float, str, str] | None, sea_level_m: float | None,
                      whole: Sequence[float] | None = None, attribution: str = "", ledger: Sequence[Any] = ()) -> Scene:
    one = engine()
    return Scene(one, one.call("scene_from_arrays", vertices=vertices, faces=faces, object_of=object_of, objects=list(objects),
                               place=place, sea_level_m=sea_level_m, whole=None if whole is None else list(whole),
                               attribution=attribution, ledger=list(ledger)))


@functools.cache
def object_kinds() -> list[str]:
    return list(engine().call("object_kinds"))


def scene_position(scene: Scene, latitude_deg: float, longitude_deg: float, z_m: float = 0.0) -> tuple[float, float]:
    east, north = scene.engine.call("scene_position", scene=scene, latitude_deg=latitude_deg, longitude_deg=longitude_deg,
                                    z_m=z_m)
    return east, north


def is_map(place: tuple[float, float, str, str]) -> bool:
    return bool(engine().call("is_map", place=list(place)))


def seems_swapped(scene: Scene, latitude_deg: float, longitude_deg: float) -> bool:
    return bool(scene.engine.call("seems_swapped", scene=scene, latitude_deg=latitude_deg, longitude_deg=longitude_deg))


class Volume(Held):
    kind = "volume"

    @functools.cached_property
    def _facts(self) -> dict[str, Any]:
        facts: dict[str, Any] = self._call("volume_facts", volume=self)
        return facts

    def __getattr__(self, name: str) -> Any:
        if name not in ("outcome", "reason", "hint", "tolerance_m", "lift_m", "rounding_m", "stated_hash", "seconds",
                        "provenance", "projection"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return self._facts[name]

    @functools.cached_property
    def vertices(self) -> Numbers:
        return self.engine.array(self._facts["vertices"], "f8", 3)

    @functools.cached_property
    def faces(self) -> Numbers:
        return self.engine.array(self._facts["faces"], "u4", 3)

    @functools.cached_property
    def cause_of(self) -> Numbers:
        return self.engine.array(self._facts["cause_of"], "u4")

    @functools.cached_property
    def polygon_of(self) -> Numbers:
        return self.engine.array(self._facts["polygon_of"], "u4")

    @property
    def causes(self) -> list[tuple[str, str, float, int | None, str, int]]:
        return [tuple(row) for row in self._facts["causes"]]

    @property
    def notes(self) -> list[tuple[str, str]]:
        return [(code, text) for code, text in self._facts["notes"]]

    @property
    def place(self) -> tuple[float, float, str, str] | None:
        return None if self._facts["place"] is None else tuple(self._facts["place"])

    @functools.cached_property
    def hash(self) -> str:
        return str(self._call("volume_hash", volume=self))

    def measures(self) -> dict[str, Any]:
        found: dict[str, Any] = self._call("volume_measures", volume=self)
        return {**found, "bounds": None if found["bounds"] is None else tuple(found["bounds"])}

    def report(self) -> str:
        return str(self._call("volume_report", volume=self))

    def save(
        self, file: str | os.PathLike[str], up: str = "z", scale: float = 1.0, sea_level_m: float | None = None
    ) -> tuple[float, int]:
        rounding_m, facets = self._call(
            "save_volume", volume=self, file=_file(file), up=up, scale=scale, sea_level_m=sea_level_m
        )
        return rounding_m, facets

    def compare(self, other: Volume, name: str, other_name: str, progress: Progress = None) -> tuple[str, Volume, Volume]:
        text, a, b = self._call("compare_volumes", progress, volume=self, other=other, name=name, other_name=other_name)
        return text, Volume(self.engine, a), Volume(self.engine, b)

    def simplify_to(self, facets: int, progress: Progress = None) -> tuple[Volume, str]:
        return self._simplified(progress, facets, None)

    def simplify_within(self, error_m: float, progress: Progress = None) -> tuple[Volume, str]:
        return self._simplified(progress, None, error_m)

    def _simplified(self, progress: Progress, facets: int | None, error_m: float | None) -> tuple[Volume, str]:
        made, text = self._call("simplify_volume", progress, volume=self, facets=facets, error_m=error_m)
        return Volume(self.engine, made), text


def read_volume(file: str | os.PathLike[str], up: str, scale: float, scene: Scene | None, progress: Progress = None) -> Volume:
    one = engine() if scene is None else scene.engine
    return Volume(one, one.call("read_volume", progress, file=_file(file), up=up, scale=scale, scene=scene))


def volume_from_arrays(vertices: Numbers, faces: Numbers, cause: str) -> Volume:
    one = engine()
    return Volume(one, one.call("volume_from_arrays", vertices=vertices, faces=faces, cause=cause))


def empty_volume(outcome: str, reason: str) -> Volume:
    one = engine()
    return Volume(one, one.call("empty_volume", outcome=outcome, reason=reason))


@functools.cache
def output_formats(scenes: bool) -> list[str]:
    return list(engine().call("output_formats", scenes=scenes))


def intersect_volumes(volumes: Sequence[Volume], progress: Progress = None) -> Volume:
    one = engine()
    return Volume(one, one.call("intersect_volumes", progress, volumes=list(volumes)))


def unite_volumes(volumes: Sequence[Volume], progress: Progress = None) -> Volume:
    one = engine()
    return Volume(one, one.call("unite_volumes", progress, volumes=list(volumes)))


def slice_volume(volume: Volume, z_m: float) -> list[list[Numbers]]:
    polygons = volume.engine.call("slice_volume", volume=volume, z_m=z_m)
    return [[np.array(ring, np.float64).reshape(-1, 2) for ring in rings] for rings in polygons]


class SolidIndex(Held):
    kind = "index"

    def __init__(self, volume: Volume) -> None:
        super().__init__(volume.engine, volume.engine.call("solid_index", volume=volume))

    def depths(self, points: Numbers, threads: int = 0) -> Numbers:
        return self._call("index_depths", index=self, points=points)

    def contains(self, points: Numbers, threads: int = 0, progress: Progress = None) -> Numbers:
        return self._call("index_contains", progress, index=self, points=points)

    def comes_near(self, other: SolidIndex, within_m: float) -> bool:
        return bool(self._call("index_comes_near", index=self, other=other, within_m=within_m))


@functools.cache
def mission_keys() -> list[dict[str, Any]]:
    return list(engine().call("mission_keys"))


class Mission(Held):
    kind = "mission"

    def __init__(self, scene: Scene, number: int) -> None:
        super().__init__(scene.engine, number)
        self.scene = scene

    @functools.cached_property
    def _facts(self) -> dict[str, Any]:
        facts: dict[str, Any] = self._call("mission_facts", mission=self)
        return facts

    def __getattr__(self, name: str) -> Any:
        if name not in ("count", "target_name", "tolerance_m", "method"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return self._facts[name]

    @property
    def range_m(self) -> float:
        return float("inf") if self._facts["range_m"] is None else self._facts["range_m"]

    @functools.cached_property
    def target_parts(self) -> list[Numbers]:
        parts = [np.array(part, np.float64).reshape(-1, 3) for part in self._facts["target_parts"]]
        for part in parts:
            part.flags.writeable = False
        return parts

    @functools.cached_property
    def hash(self) -> str:
        return str(self._call("mission_hash", mission=self))

    @property
    def notes(self) -> list[tuple[str, str]]:
        return [(code, text) for code, text in self._call("mission_notes", mission=self)]

    def one(self, index: int) -> Mission:
        return Mission(self.scene, self._call("one_mission", mission=self, index=index))

    def text(self, folder: str | os.PathLike[str]) -> str:
        return str(self._call("mission_text", mission=self, folder=_file(folder)))

    def run(self, threads: int = 0, progress: Progress = None) -> list[Result]:
        return [Result(self.scene, told) for told in self._call("run", progress, mission=self)]

    def try_each(self, threads: int = 0, progress: Progress = None) -> list[Result | Error]:
        return [error_of(told["error"]) if "error" in told else Result(self.scene, told)
                for told in self._call("try_each", progress, mission=self)]


class Result(Held):
    kind = "result"

    def __init__(self, scene: Scene, told: dict[str, Any]) -> None:
        super().__init__(scene.engine, told["result"])
        self.mission = Mission(scene, told["mission"])
        self.volume = Volume(scene.engine, told["volume"])
        self.spheres: str | None = told["spheres"]

    def report(self) -> str:
        return str(self._call("result_report", result=self))

    def save(self, files: Sequence[str | os.PathLike[str]], progress: Progress = None) -> list[str]:
        reports = self._call("save_result", progress, result=self, files=[_file(one) for one in files])
        return [to_host(one) for one in reports]


Meshes = Sequence[tuple[Numbers, Numbers, str]]


def _meshes(rows: Meshes) -> list[dict[str, Any]]:
    return [{"vertices": vertices, "faces": faces, "name": name} for vertices, faces, name in rows]


def resolve(scene: Scene, text: str, name: str, meshes: Meshes, progress: Progress = None) -> Mission:
    return Mission(scene, scene.engine.call("resolve", progress, scene=scene, text=text, name=name, meshes=_meshes(meshes)))


def check(scene: Scene, text: str, name: str, meshes: Meshes, prepares: bool, progress: Progress = None) -> int:
    return int(scene.engine.call("check", progress, scene=scene, text=text, name=name, meshes=_meshes(meshes), prepares=prepares))


def read_mission(file: str | os.PathLike[str], progress: Progress = None) -> Mission:
    one = engine()
    mission, scene = one.call("read_mission", progress, file=_file(file))
    return Mission(Scene(one, scene), mission)


class Query(Held):
    kind = "query"

    def answer(self, points: Numbers, threads: int = 0, progress: Progress = None) -> dict[str, Any]:
        answers: dict[str, Any] = self._call("answers", progress, query=self, points=points)
        return answers

    def fractions(self, points: Numbers, measure: str = "area", polygons: bool = False, threads: int = 0,
                  progress: Progress = None) -> tuple[Numbers, list[Any]]:
        shares, seen = self._call("fractions", progress, query=self, points=points, measure=measure, polygons=polygons)
        return shares, seen


def query(mission: Mission, progress: Progress = None) -> Query:
    return Query(mission.engine, mission.engine.call("query", progress, mission=mission))


def prove(mission: Mission, volume: Volume, shrink: float, maximal: bool, threads: int = 0, progress: Progress = None) -> str:
    return str(mission.engine.call("prove", progress, mission=mission, volume=volume, shrink=shrink, maximal=maximal))


def prove_by_provenance(volume: Volume, scene: Scene, shrink: float, maximal: bool, threads: int = 0,
                        progress: Progress = None) -> str:
    return str(volume.engine.call("prove_by_provenance", progress, volume=volume, scene=scene, shrink=shrink, maximal=maximal))


def certify(mission: Mission, volume_file: str | os.PathLike[str], certificate: str | os.PathLike[str], shrink: float, maximal: bool,
            threads: int = 0, progress: Progress = None) -> str:
    return str(mission.engine.call("certify", progress, mission=mission, volume_file=_file(volume_file),
                                   certificate=_file(certificate), shrink=shrink, maximal=maximal))


def outer_volume(mission: Mission, tolerance_m: float, limit_margin_m: float, threads: int = 0,
                 progress: Progress = None) -> tuple[Volume, int, int, list[str]]:
    made, facets, open_facets, ignored = mission.engine.call("outer_volume", progress, mission=mission, tolerance_m=tolerance_m,
                                                             limit_margin_m=limit_margin_m)
    return Volume(mission.engine, made), facets, open_facets, ignored


def cameras() -> str:
    return str(engine().call("cameras"))


def error_codes() -> list[str]:
    return list(engine().call("codes")["errors"])


def warning_codes() -> list[str]:
    return list(engine().call("codes")["warnings"])


def without_secrets(text: bytes, is_address: bool) -> bytes:
    return str(engine().call("without_secrets", text=text.decode("utf-8", "replace"), is_address=is_address)).encode("utf-8")
