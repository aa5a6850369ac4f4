"""Whom pictures and files of a scene name, and places whose latitude and longitude were mixed up."""

import json
import pickle
import sys
import types
import warnings

import numpy as np
import pytest
from conftest import PROJECT, SQUARE, box

import vantage as vt

TOWN = PROJECT / "examples" / "town" / "town.osm"
CREDIT = "\u00a9 OpenStreetMap contributors"


def credited(name, **options):
    corners, faces = box((20, -5, 0), (30, 15, 40))
    return vt.Scene.from_arrays(corners, faces, attribution=name, **options)


def glb_header(file):
    data = file.read_bytes()
    return json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])


def test_a_map_names_openstreetmap():
    scene = vt.Scene.from_osm(TOWN)
    assert scene.attribution == CREDIT
    assert pickle.loads(pickle.dumps(scene)).attribution == CREDIT


@pytest.mark.parametrize("georeference", [None, vt.Georeference(48.1, 11.5)])
def test_who_gives_a_scene_is_named(tmp_path, georeference):
    assert credited("").attribution == ""
    scene = credited("the city", georeference=georeference)
    assert scene.attribution == pickle.loads(pickle.dumps(scene)).attribution == "the city"
    assert scene.report["attribution"] == "the city"
    result = vt.compute(scene, SQUARE, max_range=60)
    result.save(tmp_path / "v.glb")
    scene.save(tmp_path / "s.glb")
    for name in ("v.glb", "s.glb"):
        assert glb_header(tmp_path / name)["asset"]["copyright"] == "the city"
    assert json.loads((tmp_path / "v.report.json").read_text())["attribution"] == "the city"


def test_a_mission_file_names_somebody(tmp_path):
    credited("").save(tmp_path / "city.obj")
    text = "target: {vertices: [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]}\nsensor: {max_range: 60}\n"
    (tmp_path / "m.yaml").write_text("scene: {mesh: city.obj, attribution: the city}\n" + text)
    assert vt.Mission.read(tmp_path / "m.yaml").run().scene.attribution == "the city"


def test_a_plot_names_somebody(monkeypatch):
    """Without pyvista: what is asked of it."""
    written = []

    class Plotter:
        def __init__(self, **options):
            pass

        def add_text(self, text, **options):
            written.append(text)

        def __getattr__(self, name):
            return lambda *values, **options: types.SimpleNamespace(mapper=Plotter())

    fake = types.ModuleType("pyvista")
    fake.Plotter = Plotter
    fake.PolyData = lambda *values, **options: types.SimpleNamespace(cell_data={})
    monkeypatch.setitem(sys.modules, "pyvista", fake)
    vt.compute(credited("the city"), SQUARE, max_range=60).plot()
    assert written == ["the city"]
    written.clear()
    vt.compute(credited(""), SQUARE, max_range=60).plot()
    assert written == []


def test_swapped_latitude_and_longitude_are_said():
    scene = credited("", georeference=vt.Georeference(48.0, 48.0001))
    with pytest.warns(UserWarning, match="swapped"):
        scene.position(48.0001 + 25 / 74_600, 48.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        east, north = scene.position(48.0, 48.0001 + 25 / 74_600)
        assert np.allclose((east, north), (25, 0), atol=0.1)
        scene.position(48.5, 48.0)
