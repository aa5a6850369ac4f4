"""Sensors by the names of cameras."""

import pytest

import vantage as vt
from conftest import SQUARE


def test_cameras_have_names_that_sensors_take(scene):
    names = [camera["name"] for camera in vt.cameras()]
    assert len(names) == len(set(names)) > 10
    by_name = vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, camera=names[0]))
    by_model = vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, camera={"model": names[0]}))
    assert by_name.mission.hash == by_model.mission.hash
    assert by_name.volume.hash == by_model.volume.hash


def test_an_unknown_camera_is_named(scene):
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, camera="box brownie"))
    assert raised.value.where.startswith("sensor") and "box brownie" in raised.value.problem
