"""Arrays in and out: views that outlive what they are of, and errors that say what is wrong."""

import gc

import numpy as np
import pytest

import vantage as vt
from conftest import SQUARE, yard


def test_views_are_read_only_and_outlive_the_volume(scene):
    result = vt.compute(scene, SQUARE, max_range=60)
    arrays = [result.vertices, result.faces, result.cause_of]
    copies = [array.copy() for array in arrays]
    again = result.vertices
    assert again.__array_interface__["data"] == arrays[0].__array_interface__["data"]  # no copy
    for array in arrays:
        assert not array.flags.writeable
        with pytest.raises(ValueError):
            array[0] = 0
    del result, again
    gc.collect()
    for array, copy in zip(arrays, copies):
        assert np.array_equal(array, copy)


def test_a_scene_lives_as_long_as_its_volumes():
    scene = yard()
    result = vt.compute(scene, SQUARE, max_range=60)
    del scene
    gc.collect()
    assert result.prove()["verdict"] == "proved"
    assert len(result.scene.faces) == 14


def test_scenes_copy_their_arrays():
    vertices, faces = np.array(yard().vertices), np.array(yard().faces)
    scene = vt.Scene.from_arrays(vertices, faces)
    before = scene.hash
    vertices[:] = 0
    assert scene.hash == before


@pytest.mark.parametrize("dtype", [np.float32, np.int32, np.int64, np.float64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_numbers_that_float64_holds_are_taken(scene, dtype, order):
    points = np.asarray([[5, 5, 20], [50, 5, 5]], dtype=dtype, order=order)
    assert vt.Mission.of(scene, SQUARE, max_range=60).query(points).inside.tolist() == [True, False]
    assert vt.Mission.of(scene, SQUARE, max_range=60).query(points[::-1]).inside.tolist() == [False, True]


@pytest.mark.parametrize("points, code", [
    ([[1, 2]], "array-sizes-differ"),
    ([[[1, 2, 3]]], "array-sizes-differ"),
    ([[1, 2, float("nan")]], "coordinate-not-finite"),
    ([[1, 2, float("inf")]], "coordinate-not-finite"),
    ([["a", "b", "c"]], "wrong-type"),
    ([[1, 2, 3j]], "wrong-type"),
    ([[1, 2, 3], [4, 5]], "wrong-type"),
    (np.zeros((2, 3), np.longdouble), "wrong-type"),
    (np.array([[1, 2, 2**60 + 1]]), "value-out-of-range"),
])
def test_points_that_are_refused(result, points, code):
    with pytest.raises(vt.Error) as raised:
        result.query(points)
    assert raised.value.code == code and raised.value.kind == "input" and raised.value.fix


def test_no_points_are_no_answers(result):
    assert len(result.query([]).inside) == 0
    assert result.fraction(np.zeros((0, 3))).shape == (0,)


@pytest.mark.parametrize("faces, code", [
    ([[0, 1, 4]], "index-out-of-range"),
    ([[0, 1, -1]], "index-out-of-range"),
    ([[0.0, 1.0, 2.0]], "wrong-type"),
    ([[0, 1]], "array-sizes-differ"),
])
def test_faces_that_are_refused(faces, code):
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], faces)
    assert raised.value.code == code and isinstance(raised.value, ValueError)


def test_labels_must_fit():
    square = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    for options, code in (({"object_of": [0, 1]}, "array-sizes-differ"),
                          ({"object_of": [1], "objects": ["one"]}, "array-sizes-differ"),
                          ({"objects": [vt.SceneObject("a", kind="castle")]}, "unknown-choice")):
        with pytest.raises(vt.Error) as raised:
            vt.Scene.from_arrays(square, [[0, 1, 2]], **options)
        assert raised.value.code == code
