"""Scenes that many tests use, and where the real inputs lie."""

import os
import pathlib

import pytest

import vantage as vt

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", PROJECT.parent / "shared"))

SQUARE = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]


def box(low, high):
    """Vertices and outward faces of a box."""
    corners = [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return corners, faces


def yard():
    """Flat ground 200 m across, and a tower beside the square."""
    vertices = [[-100, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0]]
    faces = [[0, 1, 2], [0, 2, 3]]
    corners, sides = box((20, -5, 0), (30, 15, 40))
    faces += [[i + 4 for i in face] for face in sides]
    return vt.Scene.from_arrays(vertices + corners, faces, object_of=[0, 0] + [1] * 12,
                                objects=[vt.SceneObject("ground", kind="ground"), vt.SceneObject("tower", kind="building")])


def refused(call):
    """The error of a call that must be refused for its input."""
    with pytest.raises(vt.Error) as raised:
        call()
    assert raised.value.kind == "input" and raised.value.problem and raised.value.fix, raised.value
    return raised.value


@pytest.fixture(scope="session")
def scene():
    return yard()


@pytest.fixture(scope="session")
def result(scene):
    return vt.compute(scene, SQUARE, max_range=60)


@pytest.fixture
def shared():
    """The folder of real inputs."""
    if not (SHARED / "data").is_dir():
        pytest.skip("set VANTAGE_SHARED to the folder that holds data/")
    return SHARED / "data"
