"""The package over the engine in WebAssembly: what it computes, what it lacks, and what it keeps. Run by `make wheelwasm`.

VANTAGE: the program (build/bin/vantage), whose volumes must have the same bytes; without it these tests are skipped.
VANTAGE_SHARED: the folder that holds data/.
"""

from __future__ import annotations

import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import threading

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "build-web/python"))
pytest.importorskip("wasmtime", reason="wasmtime is not installed")
if not (ROOT / "build-web/python/vantage/_core/engine.wasm").exists():
    pytest.skip("the package is not built: scripts/build_wasm_wheel.py", allow_module_level=True)

import vantage as vt  # noqa: E402
from vantage._core import _cache, _missing, _system  # noqa: E402

PROGRAM = pathlib.Path(os.environ.get("VANTAGE", ROOT / "build/bin/vantage"))
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", ROOT.parent / "shared"))
PLAZA = ROOT / "examples/plaza/mission.yaml"
SQUARE = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]


@pytest.fixture
def ground() -> vt.Scene:
    return vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])


MESHES = {
    "charlotte": ("data/charlotte/uptownCharlotte.obj", "  up: y\n", "[[-346.654, -59.171, 1], [-369.28, -39.471, 1], [-340.906, -29.727, 1]]"),
    "munich": ("data/mesh/munich_merged.ply", "", "[[-5, -112, 0.05], [10, -112, 0.05], [10, -97, 0.05], [-5, -97, 0.05]]"),
}
LIMITS = {
    "gimbal": "sensor: {max_range: 60, fov: [60, 40]}\n",
    "sun": "sensor: {max_range: 60, sun: {azimuth: 200, elevation: 30, exclude: 20}}\n",
    "share": "sensor: {max_range: 60, visible: 0.5, cells: 6}\n",
    "clearance": "sensor: {max_range: 60}\nnavigation: {clearance: 2, altitude: [2, 50]}\n",
    "zones": "sensor: {max_range: 60}\nnavigation: {keep_out: [{min: [-20, -20, 5], max: [10, 10, 20]}]}\n",
}


def assert_same_bytes(mission: pathlib.Path, folder: pathlib.Path) -> None:
    if not PROGRAM.exists():
        pytest.skip(f"no program at {PROGRAM}: set VANTAGE")
    native, here = folder / "native.ply", folder / "here.ply"
    subprocess.run([PROGRAM, "compute", mission, "-o", native, "-q"], check=True)
    vt.Mission.read(mission).run().save(here)
    assert here.read_bytes() == native.read_bytes()


def test_example_has_the_bytes_of_the_program(tmp_path: pathlib.Path) -> None:
    assert_same_bytes(PLAZA, tmp_path)


@pytest.mark.parametrize("name", MESHES)
def test_cities_have_the_bytes_of_the_program(name: str, tmp_path: pathlib.Path) -> None:
    file, keys, corners = MESHES[name]
    if not (SHARED / file).exists():
        pytest.skip("set VANTAGE_SHARED to the folder that holds data/")
    mission = tmp_path / "mission.yaml"
    mission.write_text(f"scene:\n  mesh: {SHARED / file}\n{keys}target: {{vertices: {corners}}}\nsensor: {{max_range: 300}}\n")
    assert_same_bytes(mission, tmp_path)


@pytest.mark.parametrize("name", LIMITS)
def test_limits_have_the_bytes_of_the_program(name: str, tmp_path: pathlib.Path) -> None:
    mission = tmp_path / "mission.yaml"
    mission.write_text(f"scene:\n  mesh: {ROOT / 'examples/plaza/plaza.obj'}\ntarget: {{vertices: [[2, 3, 0], [7, 3, 0], "
                       f"[7, 8, 0], [2, 8, 0]]}}\n{LIMITS[name]}")
    assert_same_bytes(mission, tmp_path)


def test_results_answer_and_are_proved(ground: vt.Scene, tmp_path: pathlib.Path) -> None:
    result = vt.compute(ground, SQUARE, max_range=50)
    assert result.outcome == "computed" and result.prove()["verdict"] == "proved"
    assert result.contains([[4, 4, 30], [4, 4, 60]]).tolist() == [True, False]
    assert result.fraction([[4, 4, 30]]).tolist() == [1.0]
    assert result.vertices.shape[1] == 3 and not result.vertices.flags.writeable
    assert len(result.cause_of) == len(result.faces)
    reports = result.save(tmp_path / "volume.ply", tmp_path / "volume.glb")
    assert [pathlib.Path(one).name for one in reports] == ["volume.report.json"] * len(reports)
    again = vt.Volume.read(tmp_path / "volume.ply")
    assert again.hash == result.volume.hash and again.provenance["scene_hash"] == ground.hash
    assert (result.volume & again).volume_m3 == pytest.approx(result.volume_m3)
    assert result.slice(20).area_m2 > 0
    assert again.simplify(facets=200).volume_m3 <= again.volume_m3


def test_errors_name_the_argument(ground: vt.Scene) -> None:
    with pytest.raises(vt.InputError) as told:
        vt.compute(ground, [[0, 0, 0], [9, 0, 0], [1, 1, 0], [0, 9, 0]], max_range=50)
    assert told.value.code == "target-not-convex" and told.value.where.startswith("target")


def test_output_that_cannot_be_written_leaves_files_alone(ground: vt.Scene, tmp_path: pathlib.Path) -> None:
    result = vt.compute(ground, SQUARE, max_range=50)
    with pytest.raises(vt.Error):
        result.save(tmp_path / "missing" / "volume.ply")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", sorted(_missing.NAMES))
def test_what_is_missing_is_named(name: str) -> None:
    with pytest.raises(vt.NotInBuildError) as told:
        getattr(vt._core, name)
    assert told.value.code == "component-missing" and _missing.NAMES[name] in told.value.problem


def test_maps_and_tours_are_missing(ground: vt.Scene) -> None:
    for ask in (lambda: vt.Scene.from_osm(ROOT / "examples/town/town.osm"), lambda: vt.devices(),
                lambda: vt.compute(ground, SQUARE, max_range=50).verify(), lambda: vt.tour(vt.Mission.of(ground, SQUARE, max_range=50)),
                lambda: vt.compute(ground, SQUARE, max_range=50).view()):
        with pytest.raises(vt.NotInBuildError):
            ask()


def test_formats_of_scenes_are_fewer_than_those_of_volumes() -> None:
    assert {"ply", "kml"} <= set(vt.output_formats()) and set(vt.output_formats(scenes=True)) < set(vt.output_formats())


def test_progress_stops_and_its_error_comes_through(ground: vt.Scene) -> None:
    with pytest.raises(vt.CancelledError):
        vt.compute(ground, SQUARE, max_range=50, progress=lambda stage, fraction: False)

    def broken(stage: str, fraction: float) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        vt.compute(ground, SQUARE, max_range=50, progress=broken)
    with pytest.raises(vt.NotInBuildError):
        vt.compute(ground, SQUARE, max_range=50, progress=lambda *_: ground.prepare())
    assert vt.compute(ground, SQUARE, max_range=50).outcome == "computed"


def test_interrupt_while_a_file_is_read(ground: vt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(number: int, size: int) -> bytes:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(_system.os, "read", interrupted)
        with pytest.raises(KeyboardInterrupt):
            vt.Scene.from_mesh(ROOT / "examples/plaza/plaza.obj")
    assert vt.compute(ground, SQUARE, max_range=50).outcome == "computed"


def test_engine_that_stopped_is_replaced(ground: vt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    stopped = ground._core.engine
    with monkeypatch.context() as patched:
        patched.setitem(stopped._exports, "vantage_python_call", lambda *_: 1 // 0)
        with pytest.raises(vt.InternalError):
            ground.prepare()
    with pytest.raises(vt.InternalError):
        ground.prepare()
    again = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [0, 99, 0]], [[0, 1, 2]])
    assert again._core.engine is not stopped
    assert again.prepare().hash != ""


def test_threads_wait_for_each_other(ground: vt.Scene) -> None:
    volumes: list[float] = []
    threads = [threading.Thread(target=lambda: volumes.append(vt.compute(ground, SQUARE, max_range=50).volume_m3)) for _ in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert len(volumes) == 4 and len(set(volumes)) == 1


# ---- what is kept


@pytest.fixture
def cache(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    folder = tmp_path / "cache"
    monkeypatch.setenv(_cache.FOLDER_KEY, str(folder))
    return folder


def _compile() -> list[str]:
    """The names of what is kept after a tiny module was compiled or loaded; its one function answers 7."""
    import wasmtime

    engine = wasmtime.Engine()
    module = _cache.compiled(engine, bytes(wasmtime.wat2wasm('(module (func (export "seven") (result i32) i32.const 7))')))
    store = wasmtime.Store(engine)
    assert wasmtime.Instance(store, module, []).exports(store)["seven"](store) == 7
    folder = _cache.cache_folder()
    return sorted(one.name for one in folder.iterdir()) if folder is not None and folder.exists() else []


posix = pytest.mark.skipif(os.name == "nt", reason="Windows keeps access elsewhere")


@posix
def test_kept_engine_is_private(cache: pathlib.Path) -> None:
    [name] = _compile()
    assert cache.stat().st_mode & 0o777 == 0o700 and (cache / name).stat().st_mode & 0o077 == 0
    before = (cache / name).stat().st_mtime_ns
    assert _compile() == [name] and (cache / name).stat().st_mtime_ns == before


@pytest.mark.parametrize("damage", [b"", b"foreign", None])
def test_damaged_file_is_compiled_anew(cache: pathlib.Path, damage: bytes | None) -> None:
    [name] = _compile()
    good = (cache / name).read_bytes()
    flipped = bytearray(good)
    flipped[-1] ^= 1
    (cache / name).write_bytes(bytes(flipped) if damage is None else damage)
    assert _compile() == [name]
    body = (cache / name).read_bytes()[len(_cache._MARK):]
    assert body[:32] == hashlib.sha256(body[32:]).digest()


def test_code_of_another_engine_is_compiled_anew(cache: pathlib.Path) -> None:
    [name] = _compile()
    code = b"not what wasmtime makes"
    (cache / name).write_bytes(_cache._MARK + hashlib.sha256(code).digest() + code)
    assert _compile() == [name] and not (cache / name).read_bytes().endswith(code)


@posix
def test_file_that_others_may_write_is_not_read(cache: pathlib.Path) -> None:
    [name] = _compile()
    (cache / name).chmod(0o666)
    assert _cache._read(cache / name) is None
    (cache / name).chmod(0o600)
    assert _cache._read(cache / name) is not None
    shutil.move(cache / name, cache / "elsewhere")
    (cache / name).symlink_to(cache / "elsewhere")
    assert _cache._read(cache / name) is None


@posix
def test_folder_that_others_may_write_is_not_used(cache: pathlib.Path) -> None:
    cache.mkdir()
    cache.chmod(0o777)
    assert _compile() == []
    cache.chmod(0o700)
    assert len(_compile()) == 1
    cache.parent.chmod(0o777)
    assert _cache._own_folder() is None


def test_nothing_is_kept_where_the_user_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(_cache.FOLDER_KEY, "")
    assert _cache.cache_folder() is None and _compile() == []


def test_names_with_drives(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_system.os, "name", "nt")
    try:
        assert _system.to_engine("C:\\maps\\town.obj") == "/C:/maps/town.obj"
        assert _system.to_host("/C:/maps/town.obj") == "C:/maps/town.obj"
        assert _system.to_host("/C:/flights/D:\\maps\\town.obj") == "D:\\maps\\town.obj"
    finally:
        monkeypatch.undo()


def test_arrays_are_copied_right(ground: vt.Scene) -> None:
    assert np.array_equal(ground.faces, [[0, 1, 2], [0, 2, 3]]) and ground.faces.dtype == np.uint32
    assert ground.vertices[2].tolist() == [99, 99, 0]
