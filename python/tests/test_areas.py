"""Areas of maps, and roofs and facades of scenes, as targets."""

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, box

TOWN = PROJECT / "examples" / "town" / "town.osm"


@pytest.fixture(scope="module")
def town():
    return vt.Scene.from_osm(TOWN)


def test_areas_are_listed_by_tags():
    everything = vt.areas(TOWN)
    buildings = vt.areas(TOWN, "building=*")
    assert 0 < len(buildings) <= len(everything)
    assert {one.source_id for one in buildings} == {one.source_id for one in everything
                                                    if one.tags.get("building", "no") != "no"}
    assert all(one.name for one in vt.areas(TOWN, named=True))
    assert vt.areas(TOWN, ["building=*"]) == buildings


def test_an_area_is_a_feature_and_a_target(town):
    park = next(one for one in vt.areas(TOWN) if "building" not in one.tags and "building:part" not in one.tags)
    feature = park.__geo_interface__
    assert feature["properties"]["osm"] == park.source_id
    ring = feature["geometry"]["coordinates"][0]
    assert feature["geometry"]["type"] == "Polygon" and list(ring[0]) == list(ring[-1])
    assert park.target(offset=2).osm == park.source_id
    parts = vt.Mission.of(town, park.target(), max_range=50).target_parts
    area = sum(np.linalg.norm(sum(np.cross(p[i] - p[0], p[i + 1] - p[0]) for i in range(1, len(p) - 1))) / 2
               for p in parts)
    assert area == pytest.approx(park.area_m2, rel=1e-6)
    east, north = town.position(*park.center)
    low = np.min([part.min(axis=0) for part in parts], axis=0)[:2]
    high = np.max([part.max(axis=0) for part in parts], axis=0)[:2]
    assert np.allclose([east, north], (low + high) / 2, atol=0.01)


def test_areas_that_are_not_there_are_explained():
    with pytest.raises(vt.InputError) as raised:
        vt.areas(TOWN, "bulding=*")
    assert raised.value.code == "map-object-missing" and "'building'" in raised.value.fix
    for call, code in [(lambda: vt.areas(TOWN, "building"), "value-syntax"),
                       (lambda: vt.areas(TOWN, [7]), "wrong-type"),
                       (lambda: vt.areas(TOWN, bbox=(1, 2, 3)), "value-syntax"),
                       (lambda: vt.areas(TOWN, center=(48, 11)), "region-invalid"),
                       (lambda: vt.areas("no-such.osm"), "file-not-found")]:
        with pytest.raises(vt.InputError) as raised:
            call()
        assert raised.value.code == code


def test_roofs_are_what_the_target_of_a_roof_is(town):
    roofs = town.find_faces("roof", min_area_m2=20)
    assert roofs and all(roof.area_m2 >= 20 and roof.normal[2] > 0 for roof in roofs)
    alone = [roof for roof in roofs if len(town.find_faces(objects=[roof.index])) == 1]
    assert alone
    for roof in alone[:5]:
        ours = vt.Mission.of(town, roof.target(), max_range=50).target_parts
        theirs = vt.Mission.of(town, vt.Target(object=roof.object.source_id, part="roof"), max_range=50).target_parts
        assert len(ours) == len(theirs) and all(np.array_equal(a, b) for a, b in zip(ours, theirs))


def test_all_faces_of_an_object_are_those_of_its_target(town):
    walls = town.find_faces("facade", min_area_m2=0, objects=[town.find_faces()[0].index])
    together = vt.Target(object=walls[0].object.source_id, part="facade")
    parts = vt.Mission.of(town, together, max_range=50).target_parts
    assert len(parts) == sum(len(wall.parts) for wall in walls)
    for theirs, ours in zip(parts, (part for wall in walls for part in wall.parts)):
        assert np.array_equal(theirs, ours)
    assert [wall.name.rsplit(" ", 1)[1] for wall in walls] == [str(k + 1) for k in range(len(walls))]


def test_faces_of_objects_that_are_named(scene):
    (roof,) = scene.find_faces(objects=["tower"])
    assert roof.object.name == "tower" and roof.index == 1 and roof.area_m2 == pytest.approx(200)
    assert len(scene.find_faces("facade")) == 4, "the ground is not looked at"
    result = vt.compute(scene, roof.target(), max_range=60)
    assert result.outcome == "computed" and result.mission.target_name == "tower, roof 1"


def test_a_face_that_looks_down_keeps_its_side():
    corners = np.array([[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0], [-1, -1, 9], [9, -1, 9], [9, 9, 9], [-1, 9, 9]], float)
    faces = [[4, 5, 6], [4, 6, 7], [0, 2, 1], [0, 3, 2]]
    for k in range(4):
        a, b = k, (k + 1) % 4
        faces += [[a, b, b + 4], [a, b + 4, a + 4]]
    scene = vt.Scene.from_arrays(corners, faces)
    walls = scene.find_faces("facade")
    assert len(walls) == 4 and all(wall.normal[2] < 0 and wall.front is not None for wall in walls)
    volume = vt.compute(scene, walls[0].target(), max_range=30).volume
    middle = walls[0].parts[0].mean(axis=0)
    assert volume.volume_m3 > 0
    assert np.all((volume.vertices - middle) @ walls[0].normal > -1e-6)


@pytest.mark.parametrize("arguments, code", [
    ({"kind": "floor"}, "unknown-choice"),
    ({"min_area_m2": float("nan")}, "value-out-of-range"),
    ({"objects": ["castle"]}, "object-missing"),
    ({"objects": [2]}, "object-missing"),
    ({"objects": [-1]}, "object-missing"),
])
def test_bad_questions_for_faces(scene, arguments, code):
    with pytest.raises(vt.InputError) as raised:
        scene.find_faces(**arguments)
    assert raised.value.code == code


def test_looking_for_faces_can_be_stopped():
    count = 4000
    corners, sides = box((0, 0, 0), (10, 10, 5))
    vertices = np.concatenate([np.array(corners) + [12 * (i % 64), 12 * (i // 64), 0] for i in range(count)])
    faces = np.concatenate([np.array(sides) + 8 * i for i in range(count)])
    boxes = vt.Scene.from_arrays(vertices, faces, object_of=np.repeat(np.arange(count), 12))
    told = []

    def progress(stage, fraction):
        told.append((stage, fraction))
        return False

    with pytest.raises(vt.CancelledError):
        boxes.find_faces("facade", progress=progress)
    assert told and told[0][0] == "faces" and told[0][1] < 1
