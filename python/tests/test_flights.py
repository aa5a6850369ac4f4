"""Flights: plans that are read, and what they see."""

import csv
import io
import json
import pickle

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, SQUARE, refused, yard

PLAZA = PROJECT / "examples" / "plaza" / "mission.yaml"
PAST_THE_TOWER = [[-60, 5, 20], [90, 5, 20]]


@pytest.fixture(scope="module")
def mission():
    return vt.Mission.of(yard(), SQUARE, max_range=60)


@pytest.fixture(scope="module")
def found(mission):
    return vt.check(mission, PAST_THE_TOWER, speed_m_s=5)


def test_what_is_seen_is_what_the_query_says(mission, found):
    """Positions on both sides of each end, in the middle of each stretch, and where it is said why not."""
    target, = found.targets
    assert target.seen and target.longest in target.seen
    along = np.linspace(0, found.length_m, 301)
    inside = mission.query(found.flight.at(along)).inside
    said = np.zeros(len(along), bool)
    for begin, end in target.seen_m:
        said |= (along >= begin) & (along <= end)
    assert (inside[said]).all(), "seen where the query says no"
    assert (inside != said).sum() <= 2 * len(target.seen), "ends are those of the query"
    for span in target.seen:
        assert np.allclose(span.begin, found.flight.at(span.begin_m)) and np.allclose(span.end, found.flight.at(span.end_m))
        assert span.begin_s == pytest.approx(span.begin_m / 5) and span.duration_s == pytest.approx(span.length_m / 5)
    assert {reason.kind for reason in target.not_seen} == {"hidden", "out_of_range"}
    hidden = next(reason for reason in target.not_seen if reason.kind == "hidden")
    assert hidden.name == "tower" and hidden.length_m > 0
    assert target.gimbal.min_pitch_deg < target.gimbal.max_pitch_deg < 0 and target.gimbal.rate_deg_s > 0


def test_a_tube_sees_less(mission, found):
    wide = vt.check(mission, PAST_THE_TOWER, speed_m_s=5, tube_m=3)
    assert wide.tube_m == 3 and wide.nearest.distance_m == 0
    assert sum(span.length_m for span in wide.targets[0].seen) < sum(span.length_m for span in found.targets[0].seen)


def test_what_is_required(mission, found):
    through, = found.failures
    assert not found.passes and through.startswith("the flight meets tower")
    assert found.nearest.object == "tower" and found.nearest.distance_m == 0
    failed = vt.check(mission, PAST_THE_TOWER, speed_m_s=5, clearance_m=2, dwell_s=1e4, gimbal_rate_deg_s=0.1)
    assert not failed.passes and len(failed.failures) == 2  # what is not seen for so long need not be followed either
    slow = vt.check(mission, PAST_THE_TOWER, speed_m_s=5, dwell_s=1, gimbal_rate_deg_s=0.1)
    assert len(slow.failures) == 2 and slow.targets[0].followed is None and slow.targets[0].longest.duration_s > 1
    fast = vt.check(mission, PAST_THE_TOWER, speed_m_s=5, dwell_s=1, gimbal_rate_deg_s=90)
    assert fast.failures == found.failures and fast.targets[0].followed.duration_s == pytest.approx(fast.targets[0].longest.duration_s)
    assert found.targets[0].followed is None
    high = vt.Mission.of(yard(), SQUARE, max_range=60, navigation=vt.Navigation(altitude=(25, 90)))
    limit, = vt.check(high, PAST_THE_TOWER).broken
    assert (limit.worst, limit.unit) == (5, "m") and limit.spans[0].length_m == pytest.approx(150)
    assert np.isnan(limit.spans[0].duration_s) and "vantage.FlightCheck: 150.0 m" in repr(found)
    assert not vt.check(high, [[-50, 5, 90]]).passes  # one point, from which it is too far


def test_what_cannot_be_followed_is_not_judged(tmp_path):
    """A plan with a command that moves the vehicle elsewhere passes nothing, and its name is told everywhere."""
    squares = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]],
                                   georeference=vt.Georeference(48.0, 11.0))
    mission = vt.Mission.of(squares, SQUARE, max_range=90)
    rows = ["QGC WPL 110", "0 1 0 16 0 0 0 0 48 11 500 1", "1 0 3 16 0 0 0 0 48 11 30 1",
            "2 0 3 94 10 0 0 0 48.0001 11 30 1", "3 0 3 16 0 0 0 0 48.0001 11.0001 30 1"]
    (tmp_path / "a.waypoints").write_text("\n".join(rows) + "\n")
    check = vt.check(mission, tmp_path / "a.waypoints", home_z_m=0)
    assert not check.passes and not check.failures
    told, = check.not_judged
    assert "item 2" in told and "94" in told
    assert check.to_dict()["not_judged"] == [told] and check.to_dict()["passes"] is False
    assert "not judged" in repr(check) and "NAV_PAYLOAD_PLACE" in check._repr_html_()


def test_checks_say_what_their_plans_leave_out(tmp_path):
    placed = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]],
                                  georeference=vt.Georeference(48.0, 11.0))
    mission = vt.Mission.of(placed, SQUARE, max_range=90)
    rows = ["QGC WPL 110", "0 1 0 16 0 0 0 0 48 11 500 1", "1 0 3 16 0 0 0 0 48 11 30 1",
            "2 0 2 31010 0 0 0 0 0 0 0 1", "3 0 3 16 0 0 0 0 48.0001 11.0001 30 1"]
    (tmp_path / "a.waypoints").write_text("\n".join(rows) + "\n")
    check = vt.check(mission, tmp_path / "a.waypoints", home_z_m=0)
    told = [note.text for note in check.flight.notes]
    assert any("31010" in text for text in told)
    assert set(told) <= set(check.notes) and check.to_dict()["notes"] == check.notes


def test_each_target_is_judged_by_itself():
    """Whatever `combine` says, also of a mission that was made one of several, and with meshes that are in memory."""
    squares = [SQUARE, [[-60, 0, 0], [-50, 0, 0], [-50, 10, 0], [-60, 10, 0]]]
    path = [[-90, 5, 30], [15, 5, 30]]
    room = vt.compute(yard(), SQUARE, max_range=45)
    for combine in ("all", "any", "each"):
        mission = vt.Mission.of(yard(), squares, max_range=60, combine=combine, navigation={"meshes": [room]})
        judged = vt.check(mission, path)
        assert [target.name for target in judged.targets] == ["target 1", "target 2"], combine
        assert all(target.seen for target in judged.targets)
        assert [limit.name for limit in judged.broken] == ["mesh navigation.meshes[0]"], combine
    results = vt.compute_many(yard(), squares, max_range=60)
    assert [target.name for target in vt.check(results[1], path).targets] == [results[1].mission.target_name]
    assert vt.check(results[1], path).targets[0].seen_m.tolist() == judged.targets[1].seen_m.tolist()


def test_links_are_judged():
    """Below the tower's roof a pilot at its foot loses sight behind it."""
    links = [{"name": "pilot", "point": [-60, 5, 2]}, {"name": "mast", "point": [0, -40, 60], "max_range": 90, "frequency": 2.4}]
    mission = vt.Mission.of(yard(), SQUARE, max_range=60, links=links)
    check = vt.check(mission, PAST_THE_TOWER, speed_m_s=5)
    pilot, mast = check.links
    assert pilot.name == "pilot" and pilot.max_range_m is None and mast.max_range_m == 90
    assert (pilot.frequency_ghz, pilot.clear, mast.frequency_ghz, mast.clear) == (None, None, 2.4, 0.6)
    assert not check.targets[0].is_volume
    for link, told in zip(check.links, check.to_dict()["links"]):
        assert link.holds == told["holds"] == (not link.lost) and link.farthest_m == told["farthest_m"]
        assert link.holds or any(link.name in failure for failure in check.failures)
        whole = sum(span.length_m for span in link.linked + link.lost)
        assert whole == pytest.approx(check.length_m)
    assert not mast.holds and {reason.kind for reason in mast.reasons} >= {"out_of_range"}
    assert pilot.farthest_m == pytest.approx(np.linalg.norm(np.subtract([90, 5, 20], [-60, 5, 2])))
    assert "link_out_of_range" in check._core.csv()
    assert refused(lambda: vt.Mission.of(yard(), SQUARE, max_range=60, links=[3])).where == "links[0]"


def test_plans_are_read(tmp_path):
    plan = tmp_path / "flight.csv"
    plan.write_text("x,y,z,hold,speed\n-40,-30,45,0,\n40,-30,45,2,5\n40,30,45,0,8\n")
    flight = vt.Flight.read(PLAZA, plan, heights="scene")
    assert flight.positions.tolist() == [[-40, -30, 45], [40, -30, 45], [40, 30, 45]]
    assert flight.hold_s.tolist() == [0, 2, 0] and flight.speed_m_s[1:].tolist() == [5, 8] and len(flight) == 3
    assert flight.at_m.tolist() == [0, 80, 140] and flight.length_m == 140
    assert flight.between(70, 90).tolist() == [[30, -30, 45], [40, -30, 45], [40, -20, 45]]
    same = vt.check(PLAZA, flight).to_dict()
    assert vt.check(str(PLAZA), str(plan), heights="scene").to_dict() == same
    assert vt.check(PLAZA, vt.Flight.of(flight.positions, hold_s=flight.hold_s, speed_m_s=flight.speed_m_s)).to_dict() == same
    scene = yard()
    placed = vt.Scene.from_arrays(scene.vertices, scene.faces, object_of=scene.object_of, objects=scene.objects,
                                  georeference=vt.Georeference(48.137, 11.575))
    there = vt.Mission.of(placed, SQUARE, max_range=60)
    plan.write_text("lon,lat,height\n11.575,48.137,20\n11.575,48.1371,20\n")
    assert refused(lambda: vt.check(there, plan)).code == "height-unknown"
    low = vt.Flight.read(there, plan, heights="ground", track="")
    assert np.allclose(low.positions, [[0, 0, 20], [0, 11.1203, 20]], atol=1e-3) and low.crs == placed.crs
    assert refused(lambda: vt.check(PLAZA, plan, heights="moon")).code == "unknown-choice"


def test_what_is_wrong_is_told(mission, tmp_path):
    assert refused(lambda: vt.check(mission, [[0, 0, float("nan")]])).code == "coordinate-not-finite"
    assert refused(lambda: vt.check(mission, np.zeros((0, 3)))).code
    assert refused(lambda: vt.check(mission, [[0, 0]])).code == "array-sizes-differ"
    assert refused(lambda: vt.check(mission, PAST_THE_TOWER, tube_m=-1)).code == "value-out-of-range"
    assert refused(lambda: vt.check(mission, PAST_THE_TOWER, dwell_s=2)).code == "missing-key"
    assert refused(lambda: vt.check(mission, PAST_THE_TOWER, home_z_m=0)).where == "home_z_m"
    assert refused(lambda: vt.check(3, PAST_THE_TOWER)).where == "mission"
    assert refused(lambda: vt.Flight.of(PAST_THE_TOWER, speed_m_s=[1, 2, 3])).where == "speed_m_s"
    assert refused(lambda: vt.Flight.of(PAST_THE_TOWER, speed_m_s=-1)).code == "value-out-of-range"
    (tmp_path / "no.plan").write_text("{}")
    assert "no.plan" in refused(lambda: vt.check(mission, tmp_path / "no.plan")).where
    with pytest.raises(vt.CancelledError):
        vt.check(PLAZA, np.random.default_rng(1).uniform(-50, 50, (20000, 3)), progress=lambda stage, fraction: False)


def test_files_of_a_check(found, tmp_path):
    found.save(tmp_path / "check.json")
    assert json.loads((tmp_path / "check.json").read_text()) == found.to_dict()
    found.save(tmp_path / "check.csv")
    rows = list(csv.DictReader(io.StringIO((tmp_path / "check.csv").read_text())))
    assert [row["state"] for row in rows].count("seen") == len(found.targets[0].seen)
    with pytest.raises(vt.OutputError):
        found.save(tmp_path / "check.txt")
    assert "seen whole" in found._repr_html_()


def test_what_is_not_pickled_says_what_to_pickle(found):
    for one in (found, found.flight):
        with pytest.raises(vt.Error, match="cannot be pickled"):
            pickle.dumps(one)


def test_tables_of_a_check(found):
    pytest.importorskip("geopandas")
    table = found.to_geodataframe()
    assert table.geometry.has_z.all() and table.crs is None
    for row in table.itertuples():
        assert row.geometry.length == pytest.approx(row.end_m - row.begin_m)
    seen = table[table.state == "seen"]
    assert seen[["begin_m", "end_m"]].to_numpy().tolist() == found.targets[0].seen_m.tolist()
    legs = vt.Flight.of([[0, 0, 5], [3, 4, 5], [3, 4, 9]], hold_s=[0, 1, 2], speed_m_s=3).to_geodataframe()
    assert legs.end_m.tolist() == [5, 9] and legs.hold_s.tolist() == [1, 2] and legs.speed_m_s.tolist() == [3, 3]


def test_a_hover_is_a_point():
    pytest.importorskip("geopandas")
    table = vt.check(vt.Mission.of(yard(), SQUARE, max_range=60), [[5, 5, 20]]).to_geodataframe()
    assert table.state.tolist() == ["seen"] and table.geometry[0].geom_type == "Point"


def test_the_profile_is_drawn(found, tmp_path):
    """Where it is seen the picture is green, in the strip and nowhere else."""
    pytest.importorskip("matplotlib")
    image = pytest.importorskip("PIL.Image")
    figure = found.plot(tmp_path / "profile.png", size=(900, 600))
    over, under = figure.axes
    pixels = np.asarray(image.open(tmp_path / "profile.png").convert("RGB"))
    assert pixels.shape == (600, 900, 3)
    box = under.get_window_extent()
    begin, end = found.targets[0].seen_m[0]
    for at, is_green in (((begin + end) / 2, True), (begin - 3, False), (end + 3, False)):
        x, y = under.transData.transform((at, 0.3))
        red, green, blue = pixels[599 - int(y), int(x)].astype(int)
        assert (green > red + 40 and green > blue + 40) == is_green, (at, red, green, blue)
    assert over.get_xlim() == under.get_xlim() and box.y1 < over.get_window_extent().y0
    assert min(line.get_ydata().min() for line in over.lines) == 0, "the ground"
    assert refused(lambda: found.plot(size=(1, 2, 3))).where == "size"
