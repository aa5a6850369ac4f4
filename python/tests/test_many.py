"""Many targets: errors beside results, and one result for each target."""

import math
import random
import re
import types

import numpy as np
import pytest
from conftest import PROJECT, SQUARE, box

import vantage as vt

BENT = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [8, 1, 0]]
UNDER_THE_TOWER = [[21, 0, 0], [29, 0, 0], [29, 8, 0], [21, 8, 0]]
THROUGH_IT = [[15, 0, 5], [25, 0, 5], [25, 10, 5]]
OPEN = types.SimpleNamespace(vertices=box((0, 0, 0), (9, 9, 9))[0], faces=box((0, 0, 0), (9, 9, 9))[1][1:])
"""A mesh with a hole, in memory: it is checked with the limits, not when it is read."""
TOWN = PROJECT / "examples" / "town" / "town.osm"


def beside(x):
    return [[x, 20, 0], [x + 5, 20, 0], [x + 5, 25, 0], [x, 25, 0]]


def test_errors_are_collected_beside_results(scene):
    targets = [SQUARE, BENT, vt.Target(vertices=THROUGH_IT, name="through"), beside(0), [[0, 0]], vt.Target(osm="way/1"),
               {"vertices": SQUARE, "fornt": [0, 0, 1]}, None]
    results = vt.compute_many(scene, targets, max_range=60, errors="collect")
    assert isinstance(results, vt.Results) and isinstance(results, list) and len(results) == len(targets)
    assert [type(one).__name__ for one in results] == ["Result", "InputError", "InputError", "Result"] + ["InputError"] * 4
    assert {number: error.code for number, error in results.errors.items()} == {
        1: "target-not-convex", 2: "target-pierced", 4: "array-sizes-differ", 5: "not-applicable", 6: "unknown-key",
        7: "wrong-type"}
    for number, error in results.errors.items():
        assert error.where.startswith(f"targets[{number}]") and error.fix, error
    assert "front" in results.errors[6].fix
    assert results.good == [results[0], results[3]]
    assert results[0].volume.hash == vt.compute(scene, SQUARE, max_range=60).volume.hash
    assert results[3].volume.hash == vt.compute(scene, beside(0), max_range=60).volume.hash
    assert repr(results).startswith("<vantage.Results: 2 results, 6 errors (") and "target-pierced" in repr(results)
    assert "2 results" in results._repr_html_() and "target-pierced" in results._repr_html_()


def test_one_that_is_wrong_stops_all_unless_told_otherwise(scene):
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, [SQUARE, THROUGH_IT], max_range=60)
    assert raised.value.code == "target-pierced" and raised.value.where.startswith("targets[1]")
    assert "errors='collect'" in raised.value.fix
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, [SQUARE, BENT, [[0, 0]]], max_range=60)
    assert raised.value.where == "targets[2]" and raised.value.code == "array-sizes-differ"  # what is no target comes first
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, [SQUARE], max_range=60, errors="ignore")
    assert raised.value.where == "errors" and raised.value.code == "unknown-choice"


def a_list_with_wrong_ones(seed):
    """Targets, and the codes of those that are wrong, by their index: found in the arrays, where they are, and prepared."""
    rng = random.Random(seed)
    wrong = {"target-not-convex": BENT, "target-pierced": THROUGH_IT, "array-sizes-differ": [[0, 0]], "wrong-type": None}
    targets, codes = [], {}
    for number in range(12):
        code = rng.choice(sorted(wrong)) if rng.random() < 0.5 else None
        targets.append(beside(rng.uniform(-60, 60)) if code is None else wrong[code])
        if code is not None:
            codes[number] = code
    return targets, codes


@pytest.mark.parametrize("seed", range(6))
def test_errors_are_at_the_index_of_their_target(scene, seed):
    targets, codes = a_list_with_wrong_ones(seed)
    results = vt.compute_many(scene, targets, max_range=60, errors="collect")
    assert {number: error.code for number, error in results.errors.items()} == codes, seed
    for number, error in results.errors.items():
        assert error.where.startswith(f"targets[{number}]"), f"{seed}: {error}"
    if codes:
        with pytest.raises(vt.Error) as raised:
            vt.compute_many(scene, targets, max_range=60)
        number = int(re.match(r"targets\[(\d+)\]", raised.value.where)[1])
        assert codes[number] == raised.value.code, f"{seed}: {raised.value}"


def test_errors_of_all_together_are_at_the_index_too(scene, monkeypatch):
    """A target that is right by itself, and wrong beside the others."""
    resolve = vt._core.resolve

    def picky(scene, text, name, meshes, progress=None):
        lines = text.splitlines()
        for number, line in enumerate(lines):
            if "20.0, 25.0" in line and "combine" in text:
                raise vt.InputError("input", "too-far-away", "it is wrong beside others", f"{name}:{number + 1}:3", "move it")
        return resolve(scene, text, name, meshes, progress)

    monkeypatch.setattr(vt._many._core, "check", lambda *arguments: 1)
    monkeypatch.setattr(vt._result._core, "resolve", picky)
    odd = [[20, 20, 0], [25, 20, 0], [20.0, 25.0, 0]]
    results = vt.compute_many(scene, [SQUARE, None, odd, beside(0), odd], max_range=60, errors="collect")
    assert {number: error.where.split("]")[0] for number, error in results.errors.items()} == {
        1: "targets[1", 2: "targets[2", 4: "targets[4"}
    assert len(results.good) == 2


@pytest.mark.parametrize("request_, where", [
    (dict(max_range=-1), "sensor.max_range"), (dict(max_range=60, sensor=vt.Sensor(max_range=60)), "max_range"),
    (dict(sensor={"max_range": 60, "incidence": 95}), "sensor.incidence"),
    (dict(max_range=60, navigation={"altitude": (20, 10)}), "navigation['altitude']"),
    (dict(max_range=60, navigation={"keep_out": [{"file": "missing.kml"}]}), "navigation['keep_out'][0]['file']"),
    (dict(max_range=60, threads=-1), "threads"), (dict(max_range=60, method="guess"), "method"),
    (dict(max_range=60, navigation={"meshes": [OPEN]}), "navigation"), (dict(max_range=60, crs="EPSG:4326"), ""),
    (dict(max_range=60, crs="nowhere"), ""), (dict(max_range=60, method="spheres", spheres={"cubemap": 0}), "spheres"),
])
@pytest.mark.parametrize("targets", [[SQUARE, BENT], [BENT], [None, THROUGH_IT]])
def test_what_is_wrong_with_all_is_raised(scene, request_, where, targets):
    """Also where no target is right, and where it is known only after they are."""
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, targets, errors="collect", **request_)
    assert raised.value.where.startswith(where) if where else not raised.value.where, raised.value
    assert "errors='collect'" not in raised.value.fix and "arguments" not in raised.value.where


def test_no_targets(scene):
    assert vt.compute_many(scene, [], max_range=60) == []
    none = vt.compute_many(scene, [], max_range=60, errors="collect")
    assert none == [] and none.good == [] and none.errors == {} and repr(none) == "<vantage.Results: 0 results>"
    only_wrong = vt.compute_many(scene, [BENT], max_range=60, errors="collect")
    assert only_wrong.good == [] and list(only_wrong.errors) == [0]
    for wrong in (SQUARE[0][0], "text", None, vt.Target(vertices=SQUARE), {"vertices": SQUARE}):
        with pytest.raises(vt.Error) as raised:
            vt.compute_many(scene, wrong, max_range=60)
        assert raised.value.code == "wrong-type" and raised.value.where == "targets"


def test_collected_results_are_those_of_compute_with_limits(scene):
    """Zones, altitudes and meshes hold for each, whatever else is in the list."""
    navigation = vt.Navigation(altitude={"agl": (3, 40)}, keep_out=[{"polygon": [[0, 0], [9, 0], [9, 30]], "z": (0, 30)}], ground=0,
                               clearance=2)
    targets = [SQUARE, THROUGH_IT, beside(0), BENT, beside(-40)]
    results = vt.compute_many(scene, targets, max_range=60, navigation=navigation, errors="collect", threads=2)
    assert list(results.errors) == [1, 3]
    for number in (0, 2, 4):
        alone = vt.compute(scene, targets[number], max_range=60, navigation=navigation)
        assert results[number].volume.hash == alone.volume.hash and results[number].mission.hash == alone.mission.hash


def test_a_target_of_several_faces_has_one_result():
    scene = vt.Scene.from_osm(TOWN)
    faces = scene.find_faces("facade", min_area_m2=5)
    counts = {}
    for face in faces:
        counts[face.object.source_id] = counts.get(face.object.source_id, 0) + 1
    building = next(name for name, count in counts.items() if count > 1)
    targets = [faces[0].target(), vt.Target(object=building, part="facade"), vt.Target(object="nothing", part="roof")]
    results = vt.compute_many(scene, targets, max_range=80, errors="collect")
    assert len(results) == 3 and results[2].code == "object-missing" and results[2].where.startswith("targets[2]")
    raised = vt.compute_many(scene, targets[:2], max_range=80)
    assert len(raised) == 2
    for number in (0, 1):
        alone = vt.compute(scene, targets[number], max_range=80)
        assert results[number].volume.hash == alone.volume.hash == raised[number].volume.hash


def test_what_the_method_cannot_do_is_no_error_of_each_target(scene):
    """The method of spheres finds it when it begins."""
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, [SQUARE, beside(0)], sensor={"max_range": 60, "visible": 0.5}, method="spheres",
                        errors="collect")
    assert raised.value.code == "not-applicable" and raised.value.where.startswith("sensor")


def test_a_link_and_a_pilot_are_checked_with_a_point(scene):
    """Of sensors that want points the limits are checked with one."""
    points = [vt.Target(point=(0, 0, 30))]
    link = {"max_range": 60, "link": {"frequency": 2.4, "clear": 0.6}}
    assert vt.compute_many(scene, points, sensor=link, errors="collect")[0].outcome == "computed"
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, points, sensor=link, navigation={"altitude": (20, 10)}, errors="collect")
    assert raised.value.where.startswith("navigation['altitude']")


def test_one_of_several_faces_is_raised_before_volumes_are_computed(monkeypatch):
    scene = vt.Scene.from_osm(TOWN)
    faces = scene.find_faces("facade", min_area_m2=5)
    building = next(name for name in (face.object.source_id for face in faces)
                    if sum(face.object.source_id == name for face in faces) > 1)
    low, high = faces[0].parts[0].min(axis=0), faces[0].parts[0].max(axis=0)
    middle = (low + high) / 2
    through = [middle + (-3, -3, 0), middle + (3, -3, 0), middle + (3, 3, 0), middle + (-3, 3, 0)]  # of a wall
    targets = [faces[0].target(), vt.Target(object=building, part="facade"), np.array(through)]
    for name in ("run", "run_each", "_try_each"):
        monkeypatch.setattr(vt.Mission, name, lambda *arguments, **options: pytest.fail("a volume is computed"))
    with pytest.raises(vt.Error) as raised:
        vt.compute_many(scene, targets, max_range=80)
    assert raised.value.where.startswith("targets[2]") and "errors='collect'" in raised.value.fix


def test_checks_can_be_stopped_one_by_one(scene):
    told = []

    def progress(stage, fraction):
        told.append(stage)
        return fraction < 0.4

    with pytest.raises(vt.CancelledError):
        vt.compute_many(scene, [SQUARE, BENT, beside(0), beside(20), beside(40)], max_range=60, errors="collect",
                        progress=progress)
    assert set(told) == {"checking targets"}


def test_progress_is_told_and_stops_while_errors_are_collected(scene):
    stages = []
    vt.compute_many(scene, [SQUARE, BENT], max_range=60, errors="collect",
                    progress=lambda stage, fraction: stages.append((stage, fraction)))
    assert stages[0][0] == "checking targets" and all(0 <= fraction <= 1 for _, fraction in stages)
    with pytest.raises(vt.CancelledError):
        vt.compute_many(scene, [SQUARE, BENT], max_range=60, errors="collect", progress=lambda stage, fraction: False)


def test_a_stop_is_not_collected(scene):
    """A callback that says no while volumes are computed stops all."""
    told = []

    def progress(stage, fraction):
        told.append(stage)
        return stage == "checking targets"

    half = {"max_range": 60, "visible": 0.5, "cells": 256}
    with pytest.raises(vt.CancelledError):
        vt.compute_many(scene, [SQUARE, beside(0)], sensor=half, work_limit=1e12, errors="collect", progress=progress)
    assert told[-1] != "checking targets"


def test_fewest_positions_takes_the_list_with_its_errors(scene):
    pytest.importorskip("ortools")
    results = vt.compute_many(scene, [BENT, SQUARE, beside(0)], max_range=60, errors="collect")
    answer = vt.fewest_positions(results)
    assert answer.unseen == [0] and math.isfinite(answer.total_cost) and answer.lower_bound == 1


def test_parking_lots_of_midtown(shared):
    """The snippet of docs/python-areas.md on the map that it stopped on: half of the lots are indoors or have fences."""
    file = shared / "osm" / "manhattan-midtown.osm.pbf"
    scene = vt.Scene.from_osm(file, center=(40.7484, -73.9857), radius=700)
    parking = vt.areas(file, "amenity=parking", center=(40.7484, -73.9857), radius=500)
    results = vt.compute_many(scene, parking, max_range=100, errors="collect")
    assert len(results) == len(parking) > 3 and results.good and results.errors
    assert all(error.kind == "input" and error.where.startswith(f"targets[{number}]")
               for number, error in results.errors.items())


def test_arrays_of_many_targets(scene):
    """(k, n, 3): k squares."""
    squares = np.array([SQUARE, beside(0), beside(40)], float)
    results = vt.compute_many(scene, squares, max_range=60)
    assert [one.volume.hash for one in results] == [vt.compute(scene, one, max_range=60).volume.hash for one in squares]


def test_a_list_of_polygons_is_one_of_targets(scene):
    """As the documentation of `compute` says: vertices, too, may be in a list."""
    together = vt.compute(scene, [SQUARE, beside(0)], max_range=60)
    named = vt.compute(scene, [vt.Target(vertices=SQUARE), vt.Target(vertices=beside(0))], max_range=60)
    assert together.volume.hash == named.volume.hash == vt.compute(scene, np.array([SQUARE, beside(0)]), max_range=60).volume.hash
    assert len(together.mission.target_parts) == 2 and len(vt.Mission.of(scene, SQUARE, max_range=60).target_parts) == 1
