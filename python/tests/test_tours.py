"""Tours: one flight that sees every target, its bound, and the files of both."""

import json
import subprocess
import sys

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, refused, yard

PLACE = vt.Georeference(48.137, 11.575, "EGM96 geoid")
SQUARES = [[[x, y, 0], [x + 6, y, 0], [x + 6, y + 6, 0], [x, y + 6, 0]] for x, y in ((-60, -60), (-60, 50), (60, 50))]
SETTINGS = {"home": [0, -50, 0], "view": {"dwell": 1, "margin": 0.5}, "clearance": 4, "gap": 0.2, "time_limit": 5}


def placed(georeference=PLACE):
    scene = yard()
    return vt.Scene.from_arrays(scene.vertices, scene.faces, object_of=scene.object_of, objects=scene.objects,
                                georeference=georeference)


@pytest.fixture(scope="module")
def mission():
    targets = [vt.Target(vertices=square, name=name) for square, name in zip(SQUARES, ("south", "north", "east"))]
    return vt.Mission.of(placed(), targets, max_range=25, navigation=vt.Navigation(altitude=(5, 30)), tour=SETTINGS)


@pytest.fixture(scope="module")
def found(mission):
    return vt.tour(mission)


def test_every_target_is_seen(mission, found):
    assert found.targets == ["south", "north", "east"] and sorted(found.order) == [0, 1, 2]
    assert found.is_complete and not found.left_out and found.end == "done" and found.vehicle == "multirotor"
    assert found.home.tolist() == [0, -50, 0]
    assert found.positions[0].tolist() == found.positions[-1].tolist() and found.positions[0][:2].tolist() == [0, -50]
    judged = found.check()
    assert judged.passes, judged.failures
    for visit in found.visits:
        assert visit.name == found.targets[visit.target] and visit.dwell_s >= 1
        spans = judged.targets[visit.target].seen_m
        assert ((spans[:, 0] <= visit.begin_m + 1e-6) & (spans[:, 1] >= visit.end_m - 1e-6)).any(), visit
    assert found.length_m == pytest.approx(judged.length_m) == pytest.approx(found.flight.length_m)
    assert found.time_s > found.length_m / 8


def test_none_is_shorter(found, tmp_path):
    assert 0 < found.bound.length_m <= found.length_m
    assert found.bound.gap == pytest.approx(1 - found.bound.length_m / found.length_m)
    assert found.reaches_gap == (found.bound.gap <= 0.2) and found.bound.ignored
    certificate = tmp_path / "tour.cert"
    found.write_certificate(certificate)
    ran = subprocess.run([sys.executable, PROJECT / "tools" / "check_tour.py", certificate], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert json.loads(certificate.read_text())["bound_m"] == pytest.approx(found.bound.length_m)


@pytest.mark.parametrize("ending", ["plan", "waypoints", "kml", "kmz", "gpx", "geojson", "csv"])
def test_plans_hold_the_tour(mission, found, tmp_path, ending):
    """Read again, the plan sees the same."""
    file = tmp_path / f"tour.{ending}"
    above = {"undulation_m": 46.0} if ending == "geojson" else {}  # heights above the ellipsoid
    notes = found.write(file, aircraft=(77, 0, 66) if ending == "kmz" else None, **above)
    assert any("in the air" in note for note in notes) == (ending in ("kml", "gpx", "geojson", "csv"))
    again = vt.check(mission, file, speed_m_s=8, dwell_s=0, **above)
    assert all(target.seen for target in again.targets), again.failures
    distances = np.linalg.norm(again.flight.positions[:, None] - found.positions[None], axis=2)
    assert distances.min(axis=0).max() < 1e-3


def test_settings_take_the_place_of_those_of_the_mission(mission, found):
    quick = vt.tour(mission, vt.TourSettings(view={"dwell": 0}, time_limit=1), bound=False)
    assert quick.bound is None and quick.home is None and not quick.reaches_gap and quick.is_complete
    assert quick.length_m < found.length_m  # it need not go home
    assert "vantage.Tour: 3 of 3 targets" in repr(quick) and "none is shorter" in repr(found)
    assert quick.check().passes
    assert refused(lambda: quick.write_certificate("no.cert")).code == "nothing-given"
    for settings, code, where in (({"speed": 3}, "unknown-key", "settings"), ({"gap": 2}, "value-out-of-range", "gap"),
                                  ({"vehicle": {"kind": "balloon"}}, "unknown-choice", "settings"),
                                  ({"home": [48.2, 11.575]}, "target-off-ground", "settings"),
                                  ({"home": [25, 5, 1]}, "viewpoint-inside-solid", "settings"), (3, "wrong-type", "settings")):
        error = refused(lambda: vt.tour(mission, settings, bound=False))
        assert error.code == code and where in error.where, error
    assert refused(lambda: vt.Mission.of(placed(), SQUARES, max_range=25, tour={"clearance": -1})).code == "value-out-of-range"


def test_one_of_many_is_toured_alone(mission):
    results = vt.compute_many(placed(), SQUARES, max_range=25, navigation={"altitude": (5, 30)})
    alone = vt.tour(results[2], {"view": {"dwell": 0}, "time_limit": 1}, bound=False)
    assert alone.targets == [results[2].mission.target_name] and alone.order == [0]


def test_a_tour_through_the_fewest_positions():
    """What a cover found becomes a flight, which sees what the cover says from where it says."""
    pytest.importorskip("ortools")
    squares = [[[x, y, 0], [x + 4, y, 0], [x + 4, y + 4, 0], [x, y + 4, 0]] for x, y in ((-60, 0), (-50, 0), (-10, -60))]
    mission = vt.Mission.of(placed(), squares, max_range=25, combine="each", navigation={"altitude": (5, 30)})
    answer = vt.fewest_positions(mission.run_each())
    assert len(answer) == 2 and answer.assigned[0] == answer.assigned[1]
    tour = vt.tour(mission, {"gap": 0.5, "time_limit": 5}, positions=answer)
    assert tour.is_complete and 0 < tour.bound.length_m <= tour.length_m and "the positions that are given" in tour.bound.ignored
    for visit in tour.visits:
        place = answer.positions[answer.assigned[visit.target]]
        views = tour.positions[visit.first_point:visit.last_point + 1]
        assert np.linalg.norm(views - place, axis=1).max() < 0.01 and visit.dwell_s >= 2
    assert all(target.longest.duration_s >= 2 for target in tour.check().targets)
    own = vt.tour(mission, {"gap": 0.5, "time_limit": 5}, bound=False)
    assert own.length_m < tour.length_m
    assert refused(lambda: vt.tour(mission, positions=answer.positions)).code == "array-sizes-differ"
    error = refused(lambda: vt.tour(mission, positions=[[0, 0, 90]] * 3))
    assert error.code == "value-out-of-range" and error.where == "positions[0]"
    assert refused(lambda: vt.tour(mission, positions=[[0, 0, float("nan")]] * 3)).code == "coordinate-not-finite"


def boxes_ply(path, low, high):
    """A box as a closed mesh."""
    corners = [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
             (1, 5, 7), (1, 7, 3)]
    path.write_text("\n".join([
        "ply", "format ascii 1.0", "element vertex 8", *(f"property double {axis}" for axis in "xyz"), "element face 12",
        "property list uchar int vertex_indices", "end_header", *(" ".join(map(str, corner)) for corner in corners),
        *(f"3 {a} {b} {c}" for a, b, c in faces)]) + "\n")
    return path


def test_volumes_are_flown_through(tmp_path):
    """The flight stays in each for the dwell; the check says where it is inside; the bound is the way between them."""
    west = boxes_ply(tmp_path / "west.ply", [-70, -10, 10], [-50, 10, 30])
    east = boxes_ply(tmp_path / "east.ply", [50, -60, 10], [70, -50, 30])
    mission = vt.Mission.of(placed(), [vt.Target(volume=west), vt.Target(volume=str(east), name="second")], combine="each",
                            tour={"view": {"dwell": 0, "margin": 0}, "clearance": 1, "gap": 0.1, "time_limit": 5})
    tour = vt.tour(mission)
    apart = 2 * np.hypot(100, 40)  # there and back
    assert tour.is_complete and 0.99 * apart < tour.bound.length_m <= apart + 1e-6
    assert apart - 1e-6 < tour.length_m < 1.1 * apart
    check = tour.check()
    assert [(target.name, target.is_volume, target.gimbal) for target in check.targets] == [("west", True, None), ("second", True, None)]
    assert "2 of 2 targets seen whole or flown through" in repr(check) and "seen whole" not in check._repr_html_().split("<tr>", 1)[1]
    told = tour.to_dict()
    assert all(visit["volume"] for visit in told["visits"]) and told["notes"] == tour.notes == []
    for target, low, high in zip(check.targets, ([-70, -10, 10], [50, -60, 10]), ([-50, 10, 30], [70, -50, 30])):
        assert target.seen
        for span in target.seen:
            for place in (span.begin, span.end):
                assert np.all(place >= np.subtract(low, 1e-6)) and np.all(place <= np.add(high, 1e-6))
    for wrong, code in ((vt.Target(volume=west, point=[0, 0, 0]), "conflicting-keys"),
                        (vt.Target(volume=tmp_path / "none.ply"), "file-not-found")):
        assert refused(lambda: vt.Mission.of(placed(), wrong)).code == code


def test_what_cannot_be_reached_is_left_out():
    """All from which the second square is seen lies nearer to the tower than the clearance."""
    squares = [[[x, y, 0], [x + 2, y, 0], [x + 2, y + 2, 0], [x, y + 2, 0]] for x, y in ((-60, 0), (17, 0))]
    mission = vt.Mission.of(placed(None), squares, max_range=5)
    tour = vt.tour(mission, {"view": {"dwell": 0, "margin": 0.1}, "clearance": 8, "time_limit": 1}, bound=False)
    left, = tour.left_out
    assert (left.target, left.kind, left.neighbour) == (1, "no_place", None) and tour.order == [0] and not tour.is_complete
    assert "left out" in tour._repr_html_() and tour.check().failures == [f"{left.name} is nowhere seen whole"]


def test_files_that_cannot_be_written(mission, found, tmp_path):
    with pytest.raises(vt.Error) as raised:
        found.write(tmp_path / "tour.txt")
    assert raised.value.code == "output-format-unknown"
    with pytest.raises(vt.Error):
        found.write(tmp_path / "none" / "tour.plan")
    nowhere = vt.tour(vt.Mission.of(placed(None), SQUARES[:1], max_range=25), {"time_limit": 1}, bound=False)
    with pytest.raises(vt.Error) as raised:
        nowhere.write(tmp_path / "tour.plan")
    assert raised.value.code == "not-georeferenced" and not list(tmp_path.iterdir())
    nowhere.write(tmp_path / "tour.csv")
    assert np.allclose(vt.Flight.read(nowhere.mission, tmp_path / "tour.csv", heights="scene").positions, nowhere.positions)


def test_tables_and_words_of_a_tour(found):
    html = found._repr_html_()
    assert "in view" in html and "south" in html
    told = found.to_dict()
    assert told["length_m"] == found.length_m and len(told["points"]) == len(found.positions)
    pytest.importorskip("geopandas")
    table = found.to_geodataframe()
    assert table.crs == found.mission.scene.crs and (table.end_m - table.begin_m).sum() == pytest.approx(found.length_m)
    assert {name for names in table.sees for name in names.split(", ") if name} == {"south", "north", "east"}


def test_the_profile_of_a_tour(found, tmp_path):
    pytest.importorskip("matplotlib")
    figure = found.check().plot(tmp_path / "tour.svg")
    assert [label.get_text() for label in figure.axes[1].get_yticklabels()] == found.targets
    assert (tmp_path / "tour.svg").stat().st_size > 10_000


def test_a_tour_is_stopped(mission):
    with pytest.raises(vt.CancelledError):
        vt.tour(mission, progress=lambda stage, fraction: False)
