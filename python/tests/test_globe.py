"""Volumes as 3D Tiles."""

import json

import numpy as np
import pytest
from conftest import SQUARE, box

import vantage as vt


def placed(georeference):
    corners, faces = box((20, -5, 0), (30, 15, 40))
    return vt.compute(vt.Scene.from_arrays(corners, faces, georeference=georeference), SQUARE, max_range=60)


def test_a_tileset_lies_where_the_scene_does(tmp_path):
    result = placed(vt.Georeference(48.1, 11.5))
    assert result.save(tmp_path / "a.tiles", tmp_path / "b.ply") == [str(tmp_path / "a.report.json"), str(tmp_path / "b.report.json")]
    result.volume.save(f"{tmp_path}/again.tiles/")
    for name in ("a.tiles", "again.tiles"):
        assert sorted(file.name for file in (tmp_path / name).iterdir()) == ["tileset.json", "volume.glb"]
    root = json.loads((tmp_path / "a.tiles" / "tileset.json").read_text())["root"]
    place = np.array(root["transform"]).reshape(4, 4)[3, :3]
    up = np.array([np.cos(np.radians(48.1)) * np.cos(np.radians(11.5)), np.cos(np.radians(48.1)) * np.sin(np.radians(11.5)),
                   np.sin(np.radians(48.1))])
    across = 6378137 / np.sqrt(1 - 0.0066943799901413165 * np.sin(np.radians(48.1)) ** 2)
    origin = across * up * [1, 1, 1 - 0.0066943799901413165]
    assert np.linalg.norm(place - origin) < 60 and 0 < (place - origin) @ up < 60


def test_a_tileset_needs_a_place_and_leaves_others_folders_alone(tmp_path):
    with pytest.raises(vt.Error) as raised:
        placed(None).save(tmp_path / "a.tiles")
    assert raised.value.code == "not-georeferenced" and not list(tmp_path.iterdir())
    (tmp_path / "a.tiles").mkdir()
    (tmp_path / "a.tiles" / "notes.txt").write_text("precious")
    with pytest.raises(vt.Error) as raised:
        placed(vt.Georeference(48.1, 11.5)).volume.save(tmp_path / "a.tiles")
    assert raised.value.code == "folder-in-use"
    assert [file.name for file in (tmp_path / "a.tiles").iterdir()] == ["notes.txt"]
