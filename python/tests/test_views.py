"""Standpoints, orbits, and what the positions of a cover are worth."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, SQUARE, yard

PLACE = vt.Georeference(48.137, 11.575, "flat ground")
COLUMNS = ["position", "target", "x", "y", "z", "longitude_deg", "latitude_deg", "above_ground_m", "above_sea_m", "yaw_deg",
           "pitch_deg", "is_centred", "distance_m", "pixel_m", "incidence_deg", "obstacle_distance_m", "obstacle", "depth_m"]


@pytest.fixture(scope="module")
def placed():
    """The yard with a place on the earth."""
    scene = yard()
    return vt.Scene.from_arrays(scene.vertices, scene.faces, object_of=scene.object_of, objects=scene.objects, georeference=PLACE,
                                sea_level=-500)


@pytest.fixture(scope="module")
def standing(placed):
    return vt.standpoints(vt.Mission.of(placed, SQUARE, max_range=60), margin_m=2)


def test_standpoints_are_inside(placed, standing):
    assert [one.kind for one in standing] == ["deepest", "nearest", "best_incidence", "farthest"]
    result = vt.compute(placed, SQUARE, max_range=60)
    assert result.contains(standing.positions).all()
    for one in standing:
        assert one.margin_m >= 2 and one.target == "target" and one.obstacle == "tower"
        assert one.z == one.above_ground_m == pytest.approx(one.above_sea_m - 500)
        line = np.array([5, 5, 0]) - one.position
        assert one.distance_m == pytest.approx(np.linalg.norm(line))
        assert one.pitch_deg == pytest.approx(np.degrees(np.arctan2(line[2], np.hypot(*line[:2]))))
        assert placed.position(one.latitude_deg, one.longitude_deg) == pytest.approx(one.position[:2], abs=1e-6)
        assert one.pixel_m is None and one.to_dict()["x"] == one.x
    nearest = standing[1]
    assert nearest.value == pytest.approx(nearest.distance_m) and nearest.bound <= nearest.value
    search, = standing.searches
    assert search.margin_m == 2 and search.reason == "" and len(search.notes) == 1  # there is no camera
    told, = standing.to_dict()["targets"]
    assert told["margin_m"] == 2 and [one["kind"] for one in told["standpoints"]] == [one.kind for one in standing]
    assert repr(standing) == "<vantage.Standpoints: 4 for 1 target>"


def test_of_several_targets_each_has_its_answer(placed):
    through_the_tower = [[18, 0, 5], [32, 0, 5], [32, 9, 5], [18, 9, 5]]
    targets = [vt.Target(vertices=SQUARE, name="west"), vt.Target(vertices=through_the_tower, name="pierced"),
               vt.Target(vertices=[[60, 0, 0], [70, 0, 0], [70, 10, 0], [60, 10, 0]], name="east")]
    for asked in (vt.Mission.of(placed, targets, max_range=60, combine="each"),
                  vt.compute_many(placed, targets, max_range=60, errors="collect")):
        found = vt.standpoints(asked)
        assert [bool(search.reason) for search in found.searches] == [False, True, False]
        assert {one.target for one in found} == {"west", "east"}
        assert [len(row["standpoints"]) > 0 for row in found.to_dict()["targets"]] == [True, False, True]


def test_targets_of_one_name(placed):
    """Of two results without names each has its own standpoints."""
    results = [vt.compute(placed, square, max_range=60) for square in (SQUARE, [[60, 0, 0], [70, 0, 0], [70, 10, 0], [60, 10, 0]])]
    found = vt.standpoints(results)
    assert [search.target for search in found.searches] == ["target", "target"]
    first, second = found.to_dict()["targets"]
    assert len(first["standpoints"]) == first["count"] == 4 and len(second["standpoints"]) == 4
    assert np.mean([one["x"] for one in first["standpoints"]]) < 40 < np.mean([one["x"] for one in second["standpoints"]])


def test_orbits_are_inside(placed):
    result = vt.compute(placed, SQUARE, max_range=60)
    found = vt.orbits(result, least_radius_m=15, clockwise=False)
    assert [one.kind for one in found] == ["widest", "deepest"] and found[0].shape == "circle"
    for one in found:
        flight = one.flight(0.05)
        assert result.contains(flight.positions).all() and flight.chord_error_m <= 0.05
        assert np.allclose(np.linalg.norm(flight.positions - one.centre, axis=1), one.radius_m)
        assert one.length_m == pytest.approx(2 * np.pi * one.radius_m) and not one.clockwise and one.obstacle == "tower"
        judged = vt.check(result, one)
        assert judged.passes and judged.targets[0].seen_m.tolist() == [[0, judged.length_m]]
    assert found[0].radius_m >= found[1].radius_m and found[0].radius_m <= found[0].bound
    none = vt.orbits(result, least_radius_m=500, racetracks=False)
    assert not none and none.searches[0].reason and none.to_dict()["targets"][0]["orbits"] == []


def test_what_is_wrong_is_told(placed):
    mission = vt.Mission.of(placed, SQUARE, max_range=60)
    for call, where in ((lambda: vt.standpoints(mission, margin_m=-1), "margin"),
                        (lambda: vt.orbits(mission, centre="here"), "centre"),
                        (lambda: vt.standpoints(3), "mission"), (lambda: vt.standpoints([3]), "mission[0]"),
                        (lambda: vt.standpoints(mission, most_boxes=0), "most_boxes"),
                        (lambda: vt.orbits(mission, least_radius_m=0), "radius")):
        with pytest.raises(vt.Error) as raised:
            call()
        assert raised.value.kind == "input" and where in raised.value.where + raised.value.problem, raised.value
    with pytest.raises(vt.CancelledError):
        vt.standpoints(mission, tolerance_m=1e-4, progress=lambda stage, fraction: False)


def test_tables(placed, standing):
    pytest.importorskip("geopandas")
    table = standing.to_geodataframe()
    assert table.crs == placed.crs and table.geometry.has_z.all() and table.kind.tolist() == [one.kind for one in standing]
    assert np.allclose(table.geometry.get_coordinates(include_z=True), standing.positions) and table.pixel_m.isna().all()
    earth = table.to_crs(4326)
    assert np.allclose(earth.geometry.x, table.longitude_deg, atol=1e-9)
    circles = vt.orbits(vt.Mission.of(placed, SQUARE, max_range=60), least_radius_m=15).to_geodataframe()
    assert circles.geometry.is_ring.all() and np.allclose(circles.geometry.length, circles.length_m, rtol=0.01)
    assert (circles.geometry.get_coordinates(include_z=True).z > 0).all() and "centre" not in circles
    assert len(vt.Standpoints([], [], None).to_geodataframe()) == 0


def test_positions_are_described(placed):
    pytest.importorskip("ortools")
    squares = [SQUARE, [[-10, 0, 0], [-4, 0, 0], [-4, 6, 0], [-10, 6, 0]], [[60, 0, 0], [70, 0, 0], [70, 10, 0], [60, 10, 0]]]
    results = vt.compute_many(placed, squares, max_range=40)
    answer = vt.fewest_positions(results)
    assert [(view.position, view.target) for view in answer.views] == [
        (k, target) for k, sees in enumerate(answer.sees) for target in sees]
    for view in answer.views:
        place = answer.positions[view.position]
        assert (view.x, view.y, view.z) == tuple(place) and view.obstacle == "tower" and view.above_ground_m == place[2]
        middle = np.mean(squares[view.target], axis=0)
        assert view.distance_m == pytest.approx(np.linalg.norm(middle - place)) and view.incidence_deg > 0
        assert view.depth_m >= answer.depth_m[view.position] - 1e-9 or answer.assigned[view.target] != view.position
    assert answer.to_dict()["views"][0]["yaw_deg"] == answer.views[0].yaw_deg
    if pytest.importorskip("geopandas"):
        table = answer.to_geodataframe()
        assert [name for name in table.columns if name != "geometry"] == COLUMNS and table.crs == placed.crs
    bare = vt.fewest_positions([results[0].volume, results[1]])
    views = {view.target: view for view in bare.views}
    assert views[0].distance_m is None and views[0].depth_m > 0 and views[1].distance_m > 0


def test_places_of_several_grounds(placed):
    """Views of missions that measure heights from other grounds do not share what was made of the scene."""
    from vantage._views import described

    def agl(ground):
        return {"ground": ground, "altitude": {"agl": (-100, 100)}}

    missions = [vt.Mission.of(placed, SQUARE, max_range=60, navigation=navigation)
                for navigation in (None, agl(10.0), None, agl("tower"))]
    place = np.array([[25.0, 5.0, 50.0]])
    views = described(missions, [place] * 4)
    assert [view.above_ground_m for view in views] == [50, 40, 50, 10]
    assert [view.obstacle for view in views] == ["tower"] * 4


def program(*arguments):
    """What the program prints as JSON."""
    ran = subprocess.run([sys.executable, "-m", "vantage", *map(str, arguments), "--json"], capture_output=True, text=True,
                         env={**os.environ, "PYTHONPATH": ":".join(sys.path)})
    return json.loads(ran.stdout)


def test_the_program_says_the_same(tmp_path):
    plaza = PROJECT / "examples" / "plaza" / "mission.yaml"
    told, = program("stand", plaza, "--margin", "2")["targets"]
    found = vt.standpoints(plaza, margin_m=2)
    assert [search.target for search in found.searches] == [told["target"]] and found.searches[0].notes == told["notes"]
    for one, row in zip(found, told["standpoints"], strict=True):
        x, y, z = row.pop("position")
        assert {**row, "x": x, "y": y, "z": z, "target": told["target"]} == one.to_dict()
    told, = program("orbit", plaza, "--radius", "20")["targets"]
    for one, row in zip(vt.orbits(plaza, least_radius_m=20), told["orbits"], strict=True):
        assert {**row, "target": told["target"]} == one.to_dict()
    plan = tmp_path / "flight.csv"
    plan.write_text("x,y,z\n-40,-30,45\n40,-30,45\n")
    told = program("check", plaza, plan, "--heights", "scene", "--speed", "5", "--tube", "1")
    assert vt.check(plaza, plan, heights="scene", speed_m_s=5, tube_m=1).to_dict() == told
    assert vt.tour(plaza).to_dict() == program("tour", plaza)
