"""Errors: of the argument that is wrong, in the words of the program."""

import pickle

import pytest

import vantage as vt
from conftest import SQUARE


def refused(*arguments, **options):
    with pytest.raises(vt.Error) as raised:
        vt.compute(*arguments, **options)
    return raised.value


def test_of_the_argument(scene):
    error = refused(scene, SQUARE, sensor=vt.Sensor(max_range=60, incidence=95))
    assert error.where == "sensor.incidence" and error.code == "value-out-of-range"
    error = refused(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude=(20, 10)))
    assert error.where == "navigation['altitude']" and error.code == "limits-reversed"
    error = refused(scene, SQUARE, max_range=60, navigation=vt.Navigation(keep_out=[{"min": [0, 0, 0], "max": [1, 1]}]))
    assert error.where == "navigation['keep_out'][0]['max']"
    error = refused(scene, vt.Target(vertices=SQUARE, facing="south"), max_range=60)
    assert error.where == "target['facing']"
    error = refused(scene, SQUARE, max_range=60, navigation=vt.Navigation(keep_in=[{"centre": 3}]))
    assert error.code == "unknown-key" and error.where.startswith("navigation['keep_in'][0]")
    error = refused(scene, SQUARE, max_range=60, method="guess")
    assert error.where == "method"


def test_without_keys_of_servers():
    for name in ("https://me:SECRET@a.example/x.obj?key=SECRET", "https://me:SE/CRET@a.example/x.obj", "ftp:/me:SECRET@a/x"):
        with pytest.raises(vt.Error) as raised:
            vt.Scene.from_mesh(name)
        assert "SECRET" not in str(raised.value) and "CRET" not in raised.value.where
    error = vt.Error("input", "file-not-found", "not at 'https://a.example/x?key=SECRET': why?", "s3://me:SECRET@b/\udcff", "")
    assert error.problem == "not at 'https://a.example/x': why?" and error.where == "s3://b/\udcff"


def test_of_too_much_work(scene):
    parts = [SQUARE, [[0, 12, 0], [10, 12, 0], [10, 20, 0], [0, 20, 0]]]
    targets = [vt.Target(vertices=part) for part in parts]
    error = refused(scene, targets, max_range=60, work_limit=100)
    assert error.code == "work-too-large" and "work_limit" in error.fix
    assert vt.compute(scene, targets, max_range=60, work_limit=1e6).outcome == "computed"
    several = vt.compute_many(scene, [vt.Target(parts=parts)], max_range=60, work_limit=100, errors="collect")
    assert [error.code for error in several.errors.values()] == ["work-too-large"]
    error = refused(scene, SQUARE, max_range=60, work_limit=0)
    assert error.where == "work_limit" and error.code == "value-out-of-range"
    assert vt.Mission.of(scene, SQUARE, max_range=60, work_limit=100).hash == vt.Mission.of(scene, SQUARE, max_range=60).hash


def test_of_the_target(scene):
    error = refused(scene, [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.9, 0.1, 0]], max_range=60)
    assert error.code == "target-not-convex" and error.where.startswith("target['vertices']")
    assert refused(scene, [[25, 0, -5], [25, 1, -5], [25, 0, 5]], max_range=60).code == "target-pierced"
    assert refused(scene, [0, 0], max_range=60).code == "array-sizes-differ"


def test_range_once_and_only_once(scene):
    assert refused(scene, SQUARE).code == "missing-key"
    assert refused(scene, SQUARE, max_range=60, sensor=vt.Sensor(max_range=60)).code == "conflicting-keys"
    assert refused(scene, SQUARE, max_range=float("inf")).code == "value-out-of-range"
    assert refused(scene, SQUARE, max_range="far").code in ("wrong-type", "not-a-number")
    assert refused(scene, SQUARE, sensor=vt.Sensor(max_range=60, camera=object())).code == "wrong-type"


def test_texts_stay_texts(scene):
    """No key can be smuggled in by a name."""
    name = 'a", sensor: {max_range: 1} # \\ \u2028 é'
    mission = vt.Mission.of(scene, vt.Target(vertices=SQUARE, name=name), max_range=60)
    assert mission.range_m == 60
    assert mission.target_name == name


def test_files_that_are_missing(tmp_path):
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_mesh(tmp_path / "city.obj")
    assert raised.value.code == "file-not-found" and raised.value.where
    with pytest.raises(vt.Error) as raised:
        vt.Volume.read(tmp_path / "volume.ply")
    assert raised.value.code == "file-not-found"
    with pytest.raises(vt.Error) as raised:
        vt.Mission.read(tmp_path / "mission.yaml")
    assert raised.value.code == "file-not-found"


def test_outputs_that_cannot_be(result, tmp_path):
    old = tmp_path / "volume.xyz"
    old.write_text("old")
    with pytest.raises(vt.Error) as raised:
        result.save(old)
    assert raised.value.code == "output-format-unknown" and old.read_text() == "old"
    with pytest.raises(vt.Error) as raised:
        result.save(tmp_path / "missing" / "volume.ply")
    assert raised.value.code == "output-folder-missing"


def test_they_can_be_pickled():
    error = vt.InputError("input", "mesh-empty", "nothing", "here", "there", 3)
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is vt.InputError and again.code == "mesh-empty" and again.object == 3 and str(again) == str(error)


def test_codes_are_listed():
    assert "target-not-convex" in vt.error_codes()


def test_errors_of_a_run_name_the_argument(scene):
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, [[15, 0, 0], [25, 0, 0], [25, 10, 0]], max_range=50)
    assert raised.value.code == "target-pierced"
    assert raised.value.where.startswith("target") and "arguments:" not in raised.value.where
