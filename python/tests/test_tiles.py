"""Maps in tiles: volumes are those of the whole map, to the bit."""

import pickle

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT

TOWN = PROJECT / "examples" / "town" / "town.osm"
RANGE = 40


@pytest.fixture(scope="module")
def tiles():
    return vt.tiles(TOWN, size_m=60, margin_m=60)


def bits(result):
    """All of a volume but the numbers of objects."""
    return (result.vertices.tobytes(), result.faces.tobytes(), result.cause_of.tobytes(),
            [(cause.kind, cause.name, cause.source_id, cause.area_m2) for cause in result.causes])


def test_volumes_are_those_of_the_whole(tiles):
    whole = tiles.whole()
    assert whole.hash == vt.Scene.from_osm(TOWN).hash
    assert len(tiles) > 1 and tiles[0].index == 0 and repr(tiles).startswith("<vantage.Tiles: ")
    compared = set()
    for roof in whole.find_faces("roof", min_area_m2=30)[:12]:
        tile = tiles.of(roof, RANGE)
        scene = tile.scene()
        (same,) = [face for face in scene.find_faces(objects=[roof.object.source_id]) if face.name == roof.name]
        in_tile = vt.compute(scene, same.target(), max_range=RANGE)
        assert bits(in_tile) == bits(vt.compute(whole, roof.target(), max_range=RANGE))
        compared.add(tile.index)
    assert len(compared) > 1


def test_an_area_is_the_same_target_in_its_tile(tiles):
    area = next(one for one in vt.areas(TOWN) if "building" not in one.tags and "building:part" not in one.tags)
    roomy = vt.tiles(TOWN, size_m=200, margin_m=150)
    scene = roomy.of(area, RANGE).scene()
    ours, theirs = (vt.Mission.of(one, area.target(), max_range=RANGE).target_parts for one in (scene, roomy.whole()))
    assert len(ours) == len(theirs) and all(np.array_equal(a, b) for a, b in zip(ours, theirs))


def test_a_tile_that_was_pickled_is_the_same(tiles):
    scene = tiles[len(tiles) // 2].scene()
    square = np.array([[0, 0, 30], [8, 0, 30], [8, 6, 30], [0, 6, 30]]) + [*np.mean(scene.bounds, axis=0)[:2], 0]
    again = pickle.loads(pickle.dumps(scene))
    assert bits(vt.compute(again, square, max_range=RANGE)) == bits(vt.compute(scene, square, max_range=RANGE))


def test_each_place_has_a_tile(tiles):
    for tile in tiles:
        west, south, east, north = tile.square_m
        middle = np.array([[(west + east) / 2, (south + north) / 2]])
        assert tiles.of(middle, RANGE) is tile
    far = np.array([[1e5, 1e5]])
    assert tiles.of(far, RANGE) is tiles[len(tiles) - 1], "beyond the tiles there is nothing to build"
    assert tiles.position(*tiles.frame["origin"]) == (0, 0)


def test_a_target_that_needs_more_room_is_refused(tiles):
    west, south, east, north = tiles[0].square_m
    wide = np.array([[west, south], [east + 30, south], [east + 30, north], [west, north]])
    for place, reach in [(wide, RANGE), (wide[:1], 61)]:
        with pytest.raises(vt.InputError) as raised:
            tiles.of(place, reach)
        assert raised.value.code == "value-out-of-range" and raised.value.where == "margin_m"
    assert tiles.of(wide[:1], 60) is tiles[0]


@pytest.mark.parametrize("call, code, where", [
    (lambda: vt.tiles(TOWN, 0, 100), "value-out-of-range", "size"),
    (lambda: vt.tiles(TOWN, 100, -1), "value-out-of-range", "margin"),
    (lambda: vt.tiles("no-such.osm", 100, 100), "file-not-found", "scene"),
    (lambda: vt.tiles(TOWN, 100, 100, defaults={"levle": 3}), "unknown-choice", ""),
    (lambda: vt.Scene.from_osm(TOWN, frame={"origin": [48, 11]}), "missing-key", "frame"),
    (lambda: vt.Scene.from_osm(TOWN, frame={"origin": [48, 11], "ground": [1, 2, 0, 3], "reach": 1}),
     "value-out-of-range", "frame"),
])
def test_bad_tiles(call, code, where):
    with pytest.raises(vt.InputError) as raised:
        call()
    assert raised.value.code == code and where in raised.value.where


def test_bad_places(tiles):
    for place in ([], [[1, 2, 3, 4]], [[float("nan"), 0]], "square"):
        with pytest.raises(vt.InputError):
            tiles.of(place, RANGE)
