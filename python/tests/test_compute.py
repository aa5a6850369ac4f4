"""Volumes from Python: what they hold, and what can be asked of them."""

import numpy as np
import pytest

import vantage as vt
from conftest import SQUARE, box


def test_volume_holds_what_it_says(result):
    assert result.outcome == "computed" and not result.empty
    assert result.vertices.dtype == np.float64 and result.vertices.shape[1] == 3
    assert result.faces.dtype == np.uint32 and result.faces.shape[1] == 3
    assert result.cause_of.shape == (len(result.faces),)
    assert result.cause_of.max() < len(result.causes)
    assert {"tower", "max_range", "target plane"} <= {cause.name for cause in result.causes}
    measures = result.volume.measures
    assert measures["closed"] and measures["oriented"] and measures["euler"] == 2
    corners = result.vertices[result.faces.astype(np.int64)]
    by_hand = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert result.volume_m3 == pytest.approx(by_hand, rel=1e-9)


def test_report_is_that_of_the_program(result):
    report = result.report
    assert report["volume_m3"] == result.volume_m3
    assert report["outcome"] == "computed"


def test_hidden_and_free_points(result):
    points = [[5, 5, 20], [50, 5, 5], [5, 5, 70], [5, 5, -3]]
    answers = result.query(points)
    assert answers.inside.tolist() == [True, False, False, False]
    assert answers.blocked_by[1] == ["tower"]
    assert answers.out_of_range.tolist() == [False, False, True, False]
    assert answers.behind_target.tolist() == [False, False, False, True]
    assert answers.margin_m[0] > 0 > answers.margin_m[1]
    assert result.contains(points).tolist() == answers.inside.tolist()


def test_fractions(result):
    shares = result.fraction([[5, 5, 20], [50, 5, 5], [45, 5, 35]])
    assert shares[0] == 1 and shares[1] == 0 and 0 <= shares[2] < 1
    with pytest.raises(vt.Error) as raised:
        result.fraction([[0, 0, 1]], measure="weight")
    assert raised.value.code == "unknown-choice"


def test_proof_and_its_counterpart(scene, result):
    proof = result.prove(maximal=True)
    assert proof["verdict"] == "proved" and proof["maximal"]["proved_share"] > 0.99
    larger = vt.Volume.from_arrays(np.array(result.vertices) * 1.001 + [0, 0, 0.001], result.faces)
    assert result.mission.prove(larger)["verdict"] == "wrong"


def test_verify(result):
    report = result.verify(points=2000)
    assert report["over_claimed"] == 0 and report["inside"] > 100


def test_limits_by_the_names_of_the_mission_file(scene, result):
    low = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude=(10, 20)))
    assert low.vertices[:, 2].min() >= 10 and low.vertices[:, 2].max() <= 20
    agl = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude={"agl": (10, 20)}))
    assert agl.volume_m3 == pytest.approx(low.volume_m3, rel=1e-6)
    corners, faces = box((0, 0, 5), (9, 9, 50))
    mesh = vt.Volume.from_arrays(corners, faces)
    inside = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(meshes=[mesh]))
    assert inside.vertices[:, :2].min() >= -1e-9 and inside.vertices[:, :2].max() <= 9 + 1e-9
    both = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(
        keep_in=[{"min": [0, 0, 5], "max": [9, 9, 50]}], keep_out=[{"polygon": [[0, 0], [5, 0], [5, 5]], "heights": "any"}]))
    assert 0 < both.volume_m3 < inside.volume_m3
    steep = vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, incidence=45))
    assert 0 < steep.volume_m3 < result.volume_m3


def test_a_volume_of_several_targets(scene):
    parts = [vt.Target(vertices=SQUARE, name="one"), vt.Target(point=[0, 0, 10], name="two")]
    both = vt.compute(scene, parts, max_range=60)
    either = vt.compute(scene, parts, max_range=60, combine="any")
    assert 0 < both.volume_m3 < either.volume_m3
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, parts, max_range=60, combine="each")
    assert raised.value.code == "not-applicable"


def test_many_targets_are_those_computed_alone(scene):
    squares = [np.array(SQUARE, float) + [dx, dy, 0] for dx in (-60, -30, 0) for dy in (-60, 0, 60)]
    results = vt.compute_many(scene, squares, max_range=60)
    for square, one in zip(squares, results):
        alone = vt.compute(scene, square, max_range=60)
        assert np.array_equal(alone.vertices, one.vertices) and np.array_equal(alone.faces, one.faces)
    assert vt.compute_many(scene, [], max_range=60) == []


def test_threads_do_not_change_the_result(scene, result):
    assert vt.compute(scene, SQUARE, max_range=60, threads=1).volume.hash == result.volume.hash


def test_spheres(scene):
    spheres = vt.compute(scene, SQUARE, max_range=60, method="spheres", spheres={"cubemap": 32, "device": "cpu"})
    assert spheres.outcome == "computed" and spheres.volume_m3 > 0
    sphere = vt.visibility_sphere(scene, (0, 0, 10), 30, cubemap=32, device="cpu")
    assert 0 < sphere.volume_m3 < 4 / 3 * np.pi * 30**3


def test_nothing_to_see_is_no_error(scene):
    hidden = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude=(500, 600)))
    assert hidden.empty and hidden.outcome == "outside_limits" and hidden.reason
    assert hidden.volume_m3 == 0 and len(hidden.vertices) == 0
    assert "outside_limits" in repr(hidden)


def test_simplify_compare_and_set_operations(result):
    small = result.volume.simplify(facets=60)
    assert len(small.faces) <= 60 and small.volume_m3 < result.volume_m3
    assert result.mission.prove(small)["verdict"] == "proved"
    difference = result.volume.compare(small)
    assert difference["only_b"].volume_m3 == pytest.approx(0, abs=1e-6)
    assert (result.volume & small).volume_m3 == pytest.approx(small.volume_m3, rel=1e-6)
    assert (result.volume | small).volume_m3 == pytest.approx(result.volume_m3, rel=1e-6)
    within = result.volume.simplify(error_m=0.5)
    assert len(small.faces) < len(within.faces) < len(result.faces)


def test_notebooks_show_the_numbers(result):
    html = result._repr_html_()
    assert "m³" in html and "tower" in html
    assert "60 m" in repr(result.mission)
    assert "m3" in repr(result) and "triangles" in repr(result.scene)
