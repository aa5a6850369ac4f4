"""Arguments that are wrong in every way that is known: each call works, or raises an error in our words."""

import collections
import inspect
import os
import pickle
import subprocess
import sys
import threading
import unittest.mock

import numpy as np
import pytest
from conftest import PROJECT, SQUARE, box, yard

import vantage as vt

TOWN = PROJECT / "examples" / "town" / "town.osm"
PLAZA = PROJECT / "examples" / "plaza" / "plaza.obj"
POINTS = [[5, 5, 20], [28, 5, 5]]


class Angry:
    """Raises whatever is asked of it."""

    def __repr__(self):
        raise RuntimeError("angry")

    __array__ = __len__ = __iter__ = __float__ = __int__ = __index__ = __fspath__ = __bool__ = __repr__


NESTED = []
NESTED.append(NESTED)

WRONG = {
    "None": None, "True": True, "a text": "x", "an empty text": "", "half a character": "\ud800", "bytes": b"x", "-1": -1, "2.5": 2.5,
    "10**30": 10**30, "nan": float("nan"), "inf": float("inf"), "[]": [], "{}": {}, "a list in itself": NESTED, "object": object(),
    "angry": Angry(), "a class": int, "complex": 1j, "a set": {1, 2}, "a generator": (i for i in range(3)),
    "objects": np.array([object()] * 3), "float16": np.zeros((2, 3), np.float16), "masked": np.ma.masked_all((2, 3)),
    "dates": np.zeros((2, 3), "M8[s]"), "5 dimensions": np.zeros((1, 1, 1, 1, 1)), "0 dimensions": np.array(3.5),
    "nan points": np.full((2, 3), np.nan), "huge": np.full((2, 3), 1e308), "a record": np.zeros(3, [("x", float)]),
    "a module": sys, "a lambda": lambda: None, "range": range(3), "a NUL": "a\0b", "numpy text": np.array("x"),
}


@pytest.fixture(scope="module")
def things(tmp_path_factory):
    """Good arguments for each public function, by the name of the parameter."""
    folder = tmp_path_factory.mktemp("hostile")
    scene = yard()
    result = vt.compute(scene, SQUARE, max_range=60)
    volume = vt.Volume.from_arrays(*box((0, 0, 0), (2, 2, 2)))
    result.save(folder / "volume.ply")
    (folder / "mission.yaml").write_text(f"scene: {{mesh: '{PLAZA}'}}\ntarget: {{point: [0, 0, 30]}}\nsensor: {{max_range: 9}}\n")
    return dict(scene=scene, result=result, volume=volume, mission=result.mission, folder=folder, slice=volume.slice(z=1))


def calls(t):
    """Name, function and good arguments."""
    folder, corners_faces = t["folder"], box((0, 0, 0), (1, 1, 1))
    return {
        "compute": (vt.compute, dict(scene=t["scene"], target=SQUARE, max_range=60, sensor=None, navigation=None, combine="all",
                                     crs=None, method="exact", tolerance=0.1, spheres=None, work_limit=1e7, threads=1,
                                     progress=None)),
        "compute_many": (vt.compute_many, dict(scene=t["scene"], targets=[SQUARE], max_range=60, sensor=None, navigation=None,
                                               crs=None, method="exact", tolerance=0.1, spheres=None, work_limit=1e7,
                                               errors="collect", threads=1, progress=None)),
        "Mission.read": (vt.Mission.read, dict(path=folder / "mission.yaml", progress=None)),
        "mission.query": (t["mission"].query, dict(points=POINTS, threads=1, progress=None)),
        "mission.fraction": (t["mission"].fraction, dict(points=POINTS, measure="area", threads=1, progress=None)),
        "mission.prove": (t["mission"].prove, dict(volume=t["volume"], maximal=False, shrink=1e-6, threads=1, progress=None)),
        "mission.verify": (t["mission"].verify, dict(volume=t["volume"], points=10, seed=1, threads=1, progress=None)),
        "mission.text": (t["mission"].text, dict(folder=folder)),
        "result.contains": (t["result"].contains, dict(points=POINTS, threads=1, progress=None)),
        "Scene.from_mesh": (vt.Scene.from_mesh, dict(path=PLAZA, up="z", scale=1.0, lod=None, crs=None, origin=None,
                                                     sea_level=None, progress=None)),
        "Scene.from_osm": (vt.Scene.from_osm, dict(path=TOWN, center=None, radius=None, bbox=None, terrain=None, error=None,
                                                   without=["trees"], defaults={"level": 3.2}, frame=None, sea_level=None,
                                                   progress=None)),
        "Scene.from_bytes": (vt.Scene.from_bytes, dict(data=b"v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n", format="obj")),
        "Scene.from_arrays": (vt.Scene.from_arrays, dict(vertices=corners_faces[0], faces=corners_faces[1], object_of=None,
                                                         objects=None, georeference=None, sea_level=None)),
        "scene.position": (t["scene"].position, dict(latitude=1.0, longitude=2.0)),
        "scene.find_faces": (t["scene"].find_faces, dict(kind="roof", min_area_m2=1.0, objects=["tower"], progress=None)),
        "scene.save": (t["scene"].save, dict(path=folder / "yard.obj")),
        "Volume.read": (vt.Volume.read, dict(path=folder / "volume.ply", scene=t["scene"], up="z", scale=1.0, progress=None)),
        "Volume.from_arrays": (vt.Volume.from_arrays, dict(vertices=corners_faces[0], faces=corners_faces[1], cause="mesh")),
        "volume.contains": (t["volume"].contains, dict(points=POINTS, threads=1, progress=None)),
        "volume.simplify": (t["volume"].simplify, dict(facets=12, error_m=None, progress=None)),
        "volume.compare": (t["volume"].compare, dict(other=t["volume"], names=("A", "B"), progress=None)),
        "volume.save": (t["volume"].save, dict(path=folder / "out.ply", up="z", scale=1.0)),
        "volume.slice": (t["volume"].slice, dict(z=1.0)),
        "volume.prove": (t["result"].volume.prove, dict(scene=t["scene"], maximal=False, shrink=1e-6, threads=1, progress=None)),
        "intersect": (vt.intersect, dict(volumes=[t["volume"], t["volume"]], progress=None)),
        "unite": (vt.unite, dict(volumes=[t["volume"], t["volume"]], progress=None)),
        "slice.to_crs": (t["slice"].to_crs, dict(crs=4326)),
        "slice.save": (t["slice"].save, dict(path=folder / "slice.geojson")),
        "areas": (vt.areas, dict(path=TOWN, tags=(), named=False, center=None, radius=None, bbox=None, progress=None)),
        "tiles": (vt.tiles, dict(path=TOWN, size_m=500.0, margin_m=100.0, without=None, defaults=None, progress=None)),
        "devices": (vt.devices, dict(choice="cpu")),
        "visibility_sphere": (vt.visibility_sphere, dict(scene=t["scene"], viewpoint=(0, 0, 10), radius_m=5.0, cubemap=8,
                                                         conservative=True, merge=2.5e-4, device="cpu", threads=1, progress=None)),
        "Target.from_shape": (lambda shape, z: vt.Mission.of(t["scene"], vt.Target.from_shape(shape, z=z), max_range=60),
                              dict(shape={"type": "Polygon", "coordinates": [[*SQUARE, SQUARE[0]]]}, z=None)),
    }


NAMES = list(calls(collections.defaultdict(unittest.mock.MagicMock)))


def is_angry(what, error):
    """What an argument raises is its own."""
    return what == "angry" and isinstance(error, RuntimeError) and str(error) == "angry"


@pytest.mark.parametrize("name", NAMES)
def test_wrong_arguments_are_refused_in_our_words(name, things):
    call, good = calls(things)[name]
    parameters = list(good)
    for parameter in parameters:
        for what, value in WRONG.items():
            if what == "a generator":
                value = (i for i in range(3))
            if parameter == "progress" and what in ("a lambda", "a class"):
                continue  # it may be called
            try:
                call(**{**good, parameter: value})
            except vt.Error as error:
                assert error.kind in ("input", "output"), f"{name}({parameter}={what}): {error}"
                assert error.problem and (error.fix or error.code == "not-georeferenced"), f"{name}({parameter}={what}): {error}"
            except Exception as error:
                if not is_angry(what, error):
                    raise AssertionError(f"{name}({parameter}={what}): {type(error).__name__}: {error}") from error


FIELDS = [("target", vt.Target), ("sensor", vt.Sensor), ("navigation", vt.Navigation)]


@pytest.mark.parametrize("argument, of", FIELDS)
def test_wrong_keys_are_refused_in_our_words(argument, of, scene):
    for key in inspect.signature(of).parameters:
        for what, value in WRONG.items():
            if what == "a generator":
                value = (i for i in range(3))
            request = {"target": SQUARE, "sensor": vt.Sensor(max_range=9)}
            fields = {key: value} if argument == "navigation" else {
                "target": {"vertices": SQUARE, key: value}, "sensor": {"max_range": 9, key: value}}[argument]
            for given in (of(**fields), fields):
                try:
                    vt.compute(scene, **{**request, argument: given})
                except vt.Error as error:
                    assert error.kind == "input" and error.problem and error.fix, f"{argument}.{key}={what}: {error}"
                except Exception as error:
                    if not is_angry(what, error):
                        raise AssertionError(f"{argument}.{key}={what}: {type(error).__name__}: {error}") from error


# ---- arrays


def test_numbers_that_would_be_lost_are_refused(result):
    volume = result.volume
    for ask in (volume.contains, result.contains, lambda what: vt.Scene.from_arrays(what, [[0, 0, 0]])):
        for wrong, code in (
                (np.ma.masked_values([[4, 4, -9999.0]], -9999.0), "wrong-type"),
                (np.ma.array([[4, 4, 20.0]], mask=[[0, 0, 1]]), "wrong-type"),
                (np.array([[2**53 + 1, 0, 0]]), "value-out-of-range"), (np.array([[-(2**53) - 1, 0, 0]]), "value-out-of-range"),
                (np.array([[2**63 + 1, 0, 0]], np.uint64), "value-out-of-range"), ([[2**70, 0, 0]], "value-out-of-range"),
                (np.zeros((1, 3), np.float16), "wrong-type"), (np.zeros((1, 3), np.longdouble), "wrong-type")):
            with pytest.raises(vt.Error) as raised:
                ask(wrong)
            assert raised.value.code == code and raised.value.fix, wrong
    assert result.contains(np.ma.array([[5, 5, 20.0]])).tolist() == [True]  # nothing is masked
    assert vt.Scene.from_arrays(np.array([[2**53, 0, 0], [0, -(2**53), 0], [0, 0, 1]]), [[0, 1, 2]]).vertices[0, 0] == 2.0**53


def test_views_cannot_be_changed_and_arrays_are_copied(result):
    for view in (result.vertices, result.faces, result.cause_of, result.scene.vertices, result.scene.object_of,
                 *result.mission.target_parts):
        with pytest.raises(ValueError):
            view[...] = 0
        with pytest.raises(ValueError):
            view.flags.writeable = True
    corners, faces = np.array(box((0, 0, 0), (1, 1, 1))[0], float), np.array(box((0, 0, 0), (1, 1, 1))[1], np.uint32)
    volume = vt.Volume.from_arrays(corners, faces)
    corners[:] = 7
    faces[:] = 0
    assert volume.volume_m3 == 1


class Points(np.ndarray):
    """A subclass that would change what is done with it."""

    def __array_finalize__(self, other):
        self.touched = True

    def astype(self, *arguments, **options):
        raise RuntimeError("not mine to convert")


def test_arrays_of_every_make_are_taken(result):
    points = np.array(POINTS, float)
    expected = result.contains(points).tolist()
    readonly = points.copy()
    readonly.flags.writeable = False
    for same in (points.view(Points), readonly, np.matrix(points), points[::-1][::-1], np.broadcast_to(points, (2, 3)),
                 points.astype(">f4"), memoryview(points), [tuple(row) for row in POINTS], np.array(POINTS, np.int8)):
        assert result.contains(same).tolist() == expected
    assert result.contains(np.zeros((0, 3))).tolist() == [] and result.contains([]).tolist() == []


def test_volumes_are_joined_with_volumes_only(result):
    volume = result.volume
    for other in (3, None, "v.ply", [volume]):
        for join in (lambda: volume & other, lambda: volume | other, lambda: vt.intersect([volume, other]),
                     lambda: vt.unite([volume, other]), lambda: volume.compare(other)):
            with pytest.raises(vt.Error) as raised:
                join()
            assert raised.value.code == "wrong-type" and "vt.Volume" in raised.value.fix
    with pytest.raises(vt.Error):
        vt.intersect(volume)
    assert (volume & result).volume_m3 == pytest.approx(volume.volume_m3)  # a result holds a volume


@pytest.mark.parametrize("threads, code", [("2", "wrong-type"), (2.5, "wrong-type"), (True, "wrong-type"), (None, "wrong-type"),
                                           (-1, "value-out-of-range"), (1025, "value-out-of-range"), (10**12, "value-out-of-range")])
def test_threads_are_a_small_whole_number(scene, result, threads, code):
    for call in (lambda: vt.compute(scene, SQUARE, max_range=60, threads=threads), lambda: result.query(POINTS, threads=threads),
                 lambda: result.volume.contains(POINTS, threads=threads), lambda: result.prove(threads=threads),
                 lambda: vt.compute_many(scene, [SQUARE], max_range=60, threads=threads),
                 lambda: result.fraction(POINTS, threads=threads), lambda: result.verify(threads=threads)):
        with pytest.raises(vt.Error) as raised:
            call()
        assert raised.value.code == code and raised.value.where == "threads"
    assert vt.compute(scene, SQUARE, max_range=60, threads=np.int64(1)).outcome == "computed"


# ---- pickles


def fits_together(volume):
    """Whether the arrays say corners and triangles: a file may hold any mesh, and what proves a volume looks at the rest."""
    return bool(np.isfinite(volume.vertices).all()) and volume.faces.max() < len(volume.vertices)


def test_pickles_that_were_tampered_with_are_refused_or_fit_together(result):
    """Each of 300 bytes changed: pickle or the reader refuses it, or what is read fits together."""
    good = pickle.dumps(result.volume)
    assert fits_together(pickle.loads(good))
    refused = 0
    for number in range(0, len(good), max(1, len(good) // 300)):
        bad = bytearray(good)
        bad[number] ^= 0xFF
        try:
            again = pickle.loads(bytes(bad))
        except vt.Error as error:
            assert error.kind == "input" and error.problem, f"byte {number}: {error}"
            refused += 1
        except (pickle.UnpicklingError, AttributeError, EOFError, ImportError, IndexError, KeyError, TypeError, ValueError,
                OverflowError, MemoryError):  # pickle names these as its own
            refused += 1
        else:
            if isinstance(again, vt.Volume):
                assert fits_together(again), f"byte {number}"
    assert refused > 30


# ---- callbacks and threads


def test_a_callback_may_call_vantage_itself(scene, result):
    seen = []

    def progress(stage, fraction):
        if len(seen) < 6:
            seen.append(vt.compute(scene, SQUARE, max_range=40, progress=lambda stage, share: None).outcome)
            seen.append(result.contains(POINTS).tolist())

    sensor = vt.Sensor(max_range=60, visible=0.5, cells=64)
    assert vt.compute(yard(), SQUARE, sensor=sensor, progress=progress).outcome == "computed"
    assert set(map(str, seen)) == {"computed", "[True, False]"}


def test_a_callback_may_use_the_scene_that_is_being_prepared():
    """On the thread that prepares it, too: `compute` works on the calling one."""
    script = """
import sys, numpy as np, vantage as vt
rng = np.random.default_rng(6)
told = []
for count in (60_000, 240_000, 960_000):  # until preparing takes so long that it is told of
    corners = rng.uniform(-90, 90, (count, 1, 3)) + rng.uniform(0, 0.3, (count, 3, 3))
    scene = vt.Scene.from_arrays(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    def progress(stage, fraction):
        told.append(stage)
        if len(told) < 3:
            told.append(scene.hash)
            vt.compute(scene, [[0, 0, 100], [9, 0, 100], [9, 9, 100]], max_range=20)
    vt.compute(scene, [[0, 0, 100], [9, 0, 100], [9, 9, 100]], max_range=20, progress=progress)
    if told:
        break
print(len(told) > 0)
"""
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120,
                         env={**os.environ, "PYTHONPATH": ":".join(sys.path)})
    assert ran.stdout == "True\n", ran.stderr


def test_one_query_is_shared_by_threads_and_callbacks(result):
    """A query is asked by one at a time; who waits for it does not stop the one that has it."""
    points = np.random.default_rng(5).uniform(-60, 60, (50_000, 3))
    expected = result.contains(points)
    found = []

    def work():
        found.append(np.array_equal(result.query(points, progress=lambda stage, share: None).inside, expected))

    threads = [threading.Thread(target=work, daemon=True) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert found == [True] * 4


def test_generators_and_exceptions_that_are_odd(scene):
    class Odd(BaseException):
        def __str__(self):
            raise RuntimeError("no words")

    def progress(stage, fraction):
        raise Odd

    with pytest.raises(Odd):
        vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, visible=0.5, cells=256), work_limit=1e12,
                   progress=progress)
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, (corners for corners in (SQUARE, SQUARE[:2])), max_range=60)
    assert raised.value.code == "target-vertex-count" and raised.value.where.startswith("targets[1]")
    with pytest.raises(ZeroDivisionError):
        vt.compute_many(scene, (1 / 0 for _ in range(2)), max_range=60)


def test_the_program_lists_the_command_that_the_package_adds():
    environment = {**os.environ, "PYTHONPATH": ":".join(sys.path)}

    def said(*arguments):
        return subprocess.run([sys.executable, "-m", "vantage", *arguments], capture_output=True, text=True, env=environment)

    listed = said("--help").stdout
    assert any(line.split()[:1] == ["batch"] for line in listed.splitlines()), listed
    for asked in (("batch", "--help"), ("help", "batch")):
        assert "--max-range" in said(*asked).stdout
    assert said("--version").stdout.startswith("vantage ")
    wrong = said("bacth")
    assert wrong.returncode == 2 and "batch" in wrong.stderr
