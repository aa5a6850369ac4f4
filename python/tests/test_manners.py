"""How the package behaves: notebooks, bars, pickles, the first example."""

import io
import os
import pathlib
import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import vantage as vt
from vantage._extras import advice
from vantage import _progress
from conftest import PROJECT, SQUARE, box, yard

TOWN = PROJECT / "examples" / "town" / "town.osm"
NASTY = "<script>alert('1')</script> & \"co\""


def test_notebooks_escape_names():
    corners, faces = box((20, -5, 0), (30, 15, 40))
    scene = vt.Scene.from_arrays(corners, faces, objects=[vt.SceneObject(NASTY, kind="building")],
                                 georeference=vt.Georeference(1, 2, NASTY, NASTY))
    target = vt.Target(vertices=SQUARE, name=NASTY)
    mission = vt.Mission.of(scene, target, max_range=60)
    result = mission.run()
    shown = {"scene": scene, "volume": result.volume, "mission": mission, "target": target, "result": result,
             "slice": result.slice(z=10), "sensor": vt.Sensor(max_range=60, camera=NASTY), "navigation":
             vt.Navigation(ground=NASTY)}
    for what, one in shown.items():
        html = one._repr_html_()
        assert "<table>" in html and "<script>" not in html, what
        assert "alert" in html or what in ("slice",), what
    assert "12" in shown["scene"]._repr_html_() and "m³" in shown["volume"]._repr_html_()
    assert "60 m" in shown["mission"]._repr_html_() and "max_range" in shown["sensor"]._repr_html_()
    answers = result.query([[5, 5, 20], [28, 5, 5], [5, 5, 500]])
    assert "1 of 3 points" in answers._repr_html_() and "range" in answers._repr_html_() and "<script>" not in answers._repr_html_()
    empty = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude=(500, 600)))
    assert "outside_limits" in empty.volume._repr_html_() and "outside_limits" in empty._repr_html_()


def test_notebooks_show_what_maps_and_searches_give():
    area = vt.Area("way/1", NASTY, {"leisure": NASTY}, [[[(11.0, 48.0), (11.001, 48.0), (11.0, 48.001)]]], (48.0, 11.0), 4144.0)
    face = vt.Face(vt.SceneObject(NASTY), 0, NASTY, np.array([0, 0, 1.0]), 20.0, [np.zeros((3, 3))], None)
    found = vt.Positions(np.arange(36.0).reshape(12, 3), [[1, 2]] * 12, np.zeros(12), np.ones(12), 12, [], 2, [], 12.0, False,
                         [NASTY])
    for one, words in ((area, ("way/1", "4,144 m²", "<svg")), (face, ("20.0 m²", "0.000, 0.000, 1.000")),
                       (found, ("12 positions", "sees 2: 1, 2", "and 2 more"))):
        html = one._repr_html_()
        assert "<script>" not in html and "alert" in html
        for word in words:
            assert word in html, word


class Recorder:
    """In place of tqdm."""

    made: "list[Recorder]" = []

    def __init__(self, **options):
        self.options, self.n, self.stages, self.is_closed = options, 0, [], False
        Recorder.made.append(self)

    def set_description_str(self, text, refresh=True):
        self.stages.append(text)

    def refresh(self):
        assert 0 <= self.n <= 100

    def close(self):
        self.is_closed = True


def slow(progress, cells=16):
    return vt.compute(yard(), SQUARE, sensor=vt.Sensor(max_range=60, visible=0.5, cells=cells), work_limit=1e12,
                      progress=progress)


def test_a_bar(monkeypatch):
    tqdm = pytest.importorskip("tqdm.auto")
    monkeypatch.setattr(tqdm, "tqdm", Recorder)
    monkeypatch.setattr(_progress, "_PATIENCE_S", 0)
    Recorder.made.clear()
    slow(True)
    assert Recorder.made and all(one.is_closed and one.stages for one in Recorder.made)
    Recorder.made.clear()
    slow(False)
    slow(None)
    assert not Recorder.made
    with pytest.raises(vt.Error):
        vt.compute(yard(), [[0, 0, 0]], max_range=60, progress=True)


def test_a_line_without_tqdm(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(_progress, "_PATIENCE_S", 0)
    slow(True)
    told = capsys.readouterr().err
    assert "%" in told and told.endswith("\n") and "\r" in told


def test_quick_calls_show_no_bar(monkeypatch, capsys):
    monkeypatch.setattr(_progress, "_PATIENCE_S", 1e9)
    slow(True)
    assert capsys.readouterr().err == ""


def test_functions_in_python_show_a_bar_too(monkeypatch):
    pytest.importorskip("ortools")
    tqdm = pytest.importorskip("tqdm.auto")
    monkeypatch.setattr(tqdm, "tqdm", Recorder)
    monkeypatch.setattr(_progress, "_PATIENCE_S", 0)
    Recorder.made.clear()
    corners, faces = box((0, 0, 0), (1, 1, 1))
    vt.fewest_positions([vt.Volume.from_arrays(corners, faces)] * 2, progress=True)
    assert Recorder.made and all(one.is_closed for one in Recorder.made)


def roof_and_area(scene):
    area = next(one for one in vt.areas(TOWN) if "building" not in one.tags and "building:part" not in one.tags)
    return vt.Mission.of(scene, area.target(), max_range=50).hash


def test_a_pickled_scene_remembers_its_map(tmp_path):
    town = tmp_path / "town.osm"
    shutil.copy(TOWN, town)
    scene = vt.Scene.from_osm(town)
    kept = pickle.dumps(scene)
    again = pickle.loads(kept)
    assert again.hash == scene.hash and roof_and_area(again) == roof_and_area(scene)
    assert roof_and_area(pickle.loads(pickle.dumps(pickle.loads(kept)))) == roof_and_area(scene)  # twice over
    moved = pickle.loads(kept)
    town.rename(tmp_path / "gone.osm")
    for change, code in ((lambda: None, "file-not-found"), (lambda: town.write_text("<osm/>"), "file-changed")):
        change()
        with pytest.raises(vt.Error) as raised:
            roof_and_area(moved)
        assert raised.value.code == code and raised.value.where == str(town) and raised.value.fix
        # All else goes on.
        assert vt.compute(moved, [[0, 0, 30], [4, 0, 30], [4, 4, 30]], max_range=20).volume is not None
    (tmp_path / "gone.osm").replace(town)
    assert roof_and_area(moved) == roof_and_area(scene)


def test_a_map_that_changed_before_it_was_pickled(tmp_path):
    town = tmp_path / "town.osm"
    shutil.copy(TOWN, town)
    scene = vt.Scene.from_osm(town)
    town.write_bytes(TOWN.read_bytes() + b"\n<!-- another -->\n")
    with pytest.raises(vt.Error) as raised:
        roof_and_area(pickle.loads(pickle.dumps(scene)))
    assert raised.value.code == "file-changed"


def test_each_example_is_run():
    """A new one needs a test, and says which extras it needs: pip install 'vantage[...]'."""
    scripts = sorted((PROJECT / "examples" / "python").glob("*.py"))
    assert [script.name for script in scripts] == ["first_volume.py"]
    for script in scripts:
        text = script.read_text()
        assert ("pip install 'vantage[plot]'" in text) == (".plot(" in text)


def test_the_first_example_without_its_extra(tmp_path):
    """It computes and prints all the same, and says what to install for the picture."""
    script = PROJECT / "examples" / "python" / "first_volume.py"
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "pyvista.py").write_text("raise ImportError('not here')\n")
    environment = {**os.environ, "PYTHONPATH": f"{hidden}:{pathlib.Path(vt.__file__).parents[1]}"}
    ran = subprocess.run([sys.executable, script, tmp_path / "picture.png"], capture_output=True, text=True, cwd=tmp_path,
                         env=environment)
    assert "proof: proved" in ran.stdout and advice("plot") in ran.stderr, ran.stderr
    assert not (tmp_path / "picture.png").exists()


def test_the_first_example(tmp_path):
    """Thirty lines that fetch nothing and end in a picture."""
    pytest.importorskip("pyvista")
    script = PROJECT / "examples" / "python" / "first_volume.py"
    lines = [line for line in script.read_text().split('"""')[2].splitlines() if line.strip() and not line.startswith("#")]
    assert len(lines) <= 30
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(vt.__file__).parents[1])}
    ran = subprocess.run([sys.executable, script, tmp_path / "picture.png"], capture_output=True, text=True, cwd=tmp_path,
                         env=environment)
    assert ran.returncode == 0, ran.stderr
    assert "proof: proved" in ran.stdout and "church" in ran.stdout
    image = pytest.importorskip("PIL.Image").open(tmp_path / "picture.png")
    pixels = np.asarray(image.convert("RGB")).reshape(-1, 3).astype(int)
    assert image.size == (1200, 900)
    # The volume is drawn over houses and ground, which are grey, in colours; and the legend names them.
    assert (np.ptp(pixels, axis=1) > 25).mean() > 0.1


# ---- what else can go wrong


@pytest.mark.parametrize("make", [
    lambda a: a.astype(np.float32), lambda a: np.asfortranarray(a), lambda a: a.astype(">f8"), lambda a: a.tolist(),
    lambda a: np.repeat(a, 2, axis=0)[::2], lambda a: np.lib.stride_tricks.as_strided(a, a.shape, a.strides),
])
def test_orders_and_types_of_arrays_are_taken(make):
    corners, faces = box((0, 0, 0), (1, 2, 4))
    points = np.array([[0.5, 1, 2], [0.5, 1, 5]])
    volume = vt.Volume.from_arrays(make(np.array(corners, float)), np.asfortranarray(faces))
    assert volume.volume_m3 == 8 and volume.contains(make(points)).tolist() == [True, False]
    assert vt.Scene.from_arrays(make(np.array(corners, float)), np.array(faces, np.int16)).hash


@pytest.mark.parametrize("points, code", [
    (np.zeros((2, 2)), "array-sizes-differ"), (np.zeros((1, 2, 3)), "array-sizes-differ"),
    ([[0, 0, np.nan]], "coordinate-not-finite"), ([[0, 0, -np.inf]], "coordinate-not-finite"),
    (np.zeros((1, 3), complex), "wrong-type"), (np.zeros((1, 3), bool), "wrong-type"),
    (np.array([["1", "2", "3"]]), "wrong-type"), (np.array([[None] * 3]), "wrong-type"), ("text", "wrong-type"),
    (np.zeros((1, 3), "datetime64[s]"), "wrong-type"),
])
def test_arrays_that_are_refused(points, code):
    volume = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1)))
    for ask in (volume.contains, lambda what: vt.Volume.from_arrays(what, [[0, 0, 0]]),
                lambda what: vt.Scene.from_arrays(what, [[0, 0, 0]])):
        with pytest.raises(vt.Error) as raised:
            ask(points)
        assert raised.value.code == code and raised.value.where and raised.value.fix


def test_slices_live_without_their_volume():
    import gc

    one = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1))).slice(z=0.5)
    gc.collect()
    ring = one.polygons[0][0]
    del one
    gc.collect()
    assert ring.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]


def test_threads_share_a_volume():
    import threading

    volume = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1)))
    points = np.random.default_rng(1).uniform(-1, 2, (20000, 3))
    expected = ((points >= 0) & (points <= 1)).all(axis=1)
    found = [None] * 4

    def work(i):
        found[i] = volume.contains(points)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all((one == expected).all() for one in found)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_is_told(result):
    pid = os.fork()
    if pid == 0:
        try:
            result.volume.contains([[0, 0, 1]])
        except vt.Error as error:
            os._exit(0 if "spawn" in error.fix else 1)
        os._exit(2)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0


@pytest.mark.parametrize("call", ["compute", "query", "prove", "simplify", "spheres"])
def test_callbacks_that_raise_stop_every_call(result, call):
    told = []

    def progress(stage, fraction):
        told.append(stage)
        raise LookupError("mine")

    calls = {"compute": lambda: slow(progress), "query": lambda: result.query(points, progress=progress),
             "prove": lambda: result.prove(maximal=True, progress=progress),
             "simplify": lambda: result.volume.simplify(facets=10, progress=progress),
             "spheres": lambda: vt.compute(yard(), SQUARE, max_range=60, method="spheres", progress=progress,
                                           spheres={"cubemap": 400, "device": "cpu"})}
    points = np.random.default_rng(2).uniform(-60, 60, (200000, 3))
    try:
        calls[call]()
    except LookupError as error:
        assert str(error) == "mine" and len(told) == 1
    else:
        assert not told  # it took less than the time between two calls
    assert result.prove()["verdict"] == "proved"  # nothing is broken


def test_points_in_a_mesh_can_be_stopped():
    volume = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1)))
    points = np.random.default_rng(3).uniform(0, 1, (3_000_000, 3))
    told = []

    def progress(stage, fraction):
        told.append(fraction)
        return False

    with pytest.raises(vt.CancelledError):
        volume.contains(points, threads=1, progress=progress)
    assert len(told) == 1 and 0 <= told[0] < 1


@pytest.mark.parametrize("raised", [KeyboardInterrupt, SystemExit])
def test_callbacks_that_end_the_program_are_heard(raised):
    def progress(stage, fraction):
        raise raised

    with pytest.raises(raised):
        slow(progress, cells=256)
    assert slow(None).outcome == "computed"


@pytest.mark.parametrize("progress", ["bar", 1, [], np.True_])
def test_what_is_no_callback_is_refused(scene, progress):
    volume = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1)))
    for call in (lambda: vt.compute(scene, SQUARE, max_range=60, progress=progress),
                 lambda: volume.contains([[0, 0, 0]], progress=progress), lambda: vt.areas(TOWN, progress=progress),
                 lambda: vt.fewest_positions([volume], progress=progress)):
        with pytest.raises(vt.Error) as raised:
            call()
        assert raised.value.code == "wrong-type" and raised.value.where == "progress" and raised.value.fix


def test_results_and_missions_say_what_to_pickle(result):
    import copy

    for one in (result, result.mission):
        for keep in (pickle.dumps, copy.deepcopy):
            with pytest.raises(vt.Error) as raised:
                keep(one)
            assert raised.value.code == "not-applicable" and "pickle" in raised.value.fix
    one = result.slice(z=20)
    again = pickle.loads(pickle.dumps(one))
    assert np.array_equal(again.polygons[0][0], one.polygons[0][0]) and again.area_m2 == one.area_m2


def test_a_full_standard_error_does_not_stop_the_work(monkeypatch):
    class Full(io.StringIO):
        def write(self, text):
            raise OSError(28, "No space left on device")

    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(_progress, "_PATIENCE_S", 0)
    monkeypatch.setattr(sys, "stderr", Full())
    assert slow(True).outcome == "computed"
