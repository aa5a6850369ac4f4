"""What can be a target or a request: dictionaries, polygons of shapely, tables of geopandas, files."""

import json

import numpy as np
import pytest
from conftest import SQUARE, yard

import vantage as vt

BENT = [(30, -40), (50, -40), (50, -20), (40, -35)]


def hash_of(scene, target, **request):
    return vt.Mission.of(scene, target, **{"max_range": 60, **request}).hash


# ---- dictionaries


def test_dictionaries_are_the_same_as_their_classes(scene):
    sensor = dict(
        max_range=60, incidence=70, fov=(84, 60))
    navigation = dict(altitude={"agl": (3, 40)}, ground=0, clearance=2, keep_in=[{"min": [-50, -50, 0], "max": [50, 50, 50]}],
                      keep_out=[{"polygon": [[0, 0], [9, 0], [9, 30]], "heights": "any"}])
    by_class = vt.Mission.of(scene, vt.Target(vertices=SQUARE, name="square"), sensor=vt.Sensor(**sensor),
                             navigation=vt.Navigation(**navigation))
    by_keys = vt.Mission.of(scene, {"vertices": SQUARE, "name": "square"}, sensor=sensor, navigation=navigation)
    assert by_keys.hash == by_class.hash and by_keys.text() == by_class.text()
    without = vt.Mission.of(scene, SQUARE, sensor={**sensor, "min_range": None}, navigation={"altitude": None})
    assert without.hash == vt.Mission.of(scene, SQUARE, sensor=sensor).hash  # None is not given
    corners = vt.Volume.from_arrays([[-9, -9, -9], [99, -9, -9], [-9, 99, -9], [-9, -9, 99]],
                                    [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    assert hash_of(scene, SQUARE, navigation={"meshes": [corners]}) == hash_of(
        scene, SQUARE, navigation=vt.Navigation(meshes=[corners]))


@pytest.mark.parametrize("request_, where, nearest", [
    (dict(sensor={"max_rnage": 60}), "sensor", "max_range"), (dict(sensor={"max_range": 60, "incidense": 3}), "sensor", "incidence"),
    (dict(max_range=60, navigation={"altitudes": (3, 4)}), "navigation", "altitude"),
    (dict(max_range=60, navigation={"keep_out": [{"polgon": 3}]}), "navigation['keep_out'][0]", "polygon"),
    (dict(max_range=60, target={"vertexes": SQUARE}), "target", "vertices"),
    (dict(max_range=60, target={"object": "tower", "prt": "roof"}), "target", "part"),
])
def test_keys_that_are_not_known_lead_to_the_nearest(scene, request_, where, nearest):
    target = request_.pop("target", SQUARE)
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, target, **request_)
    assert raised.value.code == "unknown-key" and raised.value.where.startswith(where) and nearest in raised.value.fix


@pytest.mark.parametrize("request_, where", [
    (dict(sensor=300), "sensor"), (dict(sensor="far"), "sensor"), (dict(sensor=[("max_range", 60)]), "sensor"),
    (dict(max_range=60, navigation=(3, 40)), "navigation"), (dict(max_range=60, navigation="low"), "navigation"),
    (dict(max_range=60, navigation={"meshes": "a.ply"}), "navigation.meshes"),
    (dict(max_range=60, navigation={"meshes": [3]}), "navigation.meshes[0]"),
    (dict(max_range=60, navigation={"keep_in": {"min": 3}}), "navigation['keep_in']"),
    (dict(max_range=60, navigation={"keep_in": [3]}), "navigation['keep_in'][0]"),
    (dict(max_range=60, spheres=3), "spheres"), (dict(sensor={"max_range": 60, 3: 4}), "sensor"),
])
def test_requests_of_another_type_are_refused(scene, request_, where):
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, SQUARE, **request_)
    assert raised.value.where.startswith(where) and raised.value.fix


# ---- polygons


class Shape:
    """As shapely's, without shapely."""

    def __init__(self, kind, coordinates):
        self.__geo_interface__ = {"type": kind, "coordinates": coordinates}


def closed(ring):
    return (*map(tuple, ring), tuple(ring[0]))


def test_polygons_with_z_are_vertices(scene):
    assert hash_of(scene, Shape("Polygon", [closed(SQUARE)])) == hash_of(scene, SQUARE)
    several = [Shape("Polygon", [closed(SQUARE)]), vt.Target(vertices=[[40, 0, 0], [45, 0, 0], [45, 5, 0]])]
    assert len(vt.Mission.of(scene, several, max_range=60).target_parts) == 2
    upright = [(0, 0, 3), (4, 0, 3), (4, 0, 6), (0, 0, 6)]
    assert hash_of(scene, Shape("Polygon", [closed(upright)])) == hash_of(scene, upright)


def test_polygons_without_z_lie_on_the_ground(scene):
    parts = vt.Mission.of(scene, Shape("Polygon", [closed(BENT)]), max_range=60).target_parts
    assert len(parts) > 1 and all((part[:, 2] == 0).all() for part in parts)
    assert hash_of(scene, Shape("Polygon", [closed(BENT)])) == hash_of(scene, vt.Target(outline=BENT))


def test_a_height_for_all_corners(scene):
    flat = vt.Target.from_shape(Shape("Polygon", [closed(BENT)]), z=12, name="deck", offset=0.5)
    assert flat.name == "deck" and flat.offset == 0.5
    parts = vt.Mission.of(scene, flat, max_range=60).target_parts
    assert len(parts) > 1 and all((part[:, 2] == 12).all() for part in parts)
    assert vt.Target.from_shape(Shape("Point", (1, 2)), z=3).point == [1, 2, 3]


def test_holes_and_several_polygons(scene):
    ring, hole = [(30, -60), (60, -60), (60, -30), (30, -30)], [(40, -50), (50, -50), (50, -40), (40, -40)]
    holed = vt.Mission.of(scene, Shape("Polygon", [closed(ring), closed(hole)]), max_range=90)
    assert area_of(holed) == pytest.approx(900 - 100, abs=0.01)
    two = Shape("MultiPolygon", [[closed(ring), closed(hole)], [closed([(-60, 30), (-40, 30), (-40, 50)])]])
    mission = vt.Mission.of(scene, two, max_range=200)
    assert area_of(mission) == pytest.approx(800 + 200, abs=0.01)
    assert mission.text().count("name:") == 1  # one target


def area_of(mission):
    total = 0.0
    for part in mission.target_parts:
        x, y, _ = part.T
        total += abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2
    return total


@pytest.mark.parametrize("shape, code", [
    (Shape("LineString", [(0, 0), (1, 1)]), "value-unsupported"), (Shape("Point", (0, 0)), "missing-key"),
    (Shape("Polygon", []), "nothing-given"), (Shape("MultiPolygon", []), "nothing-given"),
    (Shape("Polygon", [[(0, 0), (np.nan, 1), (2, 2), (0, 0)]]), "coordinate-not-finite"),
    (Shape("Polygon", [[(0, 0), (1, "x"), (2, 2)]]), "wrong-type"), (Shape("Polygon", 3), "wrong-type"),
    (Shape("Polygon", [closed(SQUARE), closed(BENT)]), "array-sizes-differ"),
    (Shape("Feature", None), "value-unsupported"), (Shape(3, None), "wrong-type"),
    (Shape("Polygon", [[(0, 0), (9, 9), (9, 0), (0, 9), (0, 0)]]), "zone-not-simple"),
])
def test_shapes_that_are_no_targets(scene, shape, code):
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, shape, max_range=60)
    assert raised.value.code == code and raised.value.where.startswith("target") and raised.value.fix


def test_areas_and_faces_are_targets_as_they_are():
    from test_many import TOWN

    scene = vt.Scene.from_osm(TOWN)
    face = scene.find_faces("roof", min_area_m2=5)[0]
    assert hash_of(scene, face) == hash_of(scene, face.target())
    area = next(one for one in vt.areas(TOWN) if "building" not in one.tags and "building:part" not in one.tags)
    assert hash_of(scene, area) == hash_of(scene, area.target())


# ---- shapely and geopandas themselves


def test_shapely(scene):
    shapely = pytest.importorskip("shapely")
    assert hash_of(scene, shapely.Polygon(SQUARE)) == hash_of(scene, SQUARE)
    # Shapely turns and begins rings as it likes: the same polygon, whatever its corners' order.
    box = vt.Mission.of(scene, shapely.box(40, -60, 50, -40), max_range=90)
    assert area_of(box) == pytest.approx(200, abs=0.01)
    both = shapely.MultiPolygon([shapely.box(40, -60, 50, -40), shapely.box(-60, 40, -50, 50)])
    assert area_of(vt.Mission.of(scene, both, max_range=200)) == pytest.approx(300, abs=0.01)
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, shapely.Polygon(), max_range=60)
    assert raised.value.code == "nothing-given"


def test_tables(scene):
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    shapes = [shapely.box(40, -60, 50, -40), shapely.Polygon(SQUARE), None, shapely.LineString([(0, 0), (1, 1)])]
    series = geopandas.GeoSeries(shapes[:2], index=["north", "south"])
    results = vt.compute_many(scene, series, max_range=60)
    assert [one.mission.target_name for one in results] == ["row north", "row south"]
    table = geopandas.GeoDataFrame({"name": ["deck", "yard", None, "line"]}, geometry=shapes)
    results = vt.compute_many(scene, table, max_range=60, errors="collect")
    assert [one.mission.target_name for one in results.good] == ["deck", "yard"]
    assert {n: e.code for n, e in results.errors.items()} == {2: "nothing-given", 3: "value-unsupported"}
    assert results.errors[3].where == "targets.loc[3]"
    both = vt.compute(scene, series, max_range=120)
    assert len(both.mission.target_parts) == 2  # both must be seen
    with pytest.raises(vt.Error) as raised:
        vt.compute(scene, table, max_range=60)
    assert raised.value.where == "target.loc[2]"
    with pytest.raises(vt.Error):
        vt.compute(scene, series[:0], max_range=60)


def test_tables_with_a_crs():
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    plain = yard()
    scene = vt.Scene.from_arrays(plain.vertices, plain.faces, object_of=plain.object_of, objects=plain.objects,
                                 georeference=vt.Georeference(48.1374, 11.5755, "flat ground"))
    square = shapely.box(40, -60, 50, -40)
    table = geopandas.GeoSeries([square, shapely.Polygon(SQUARE)], crs=scene.crs)
    for crs in (4326, 32632, 25832):
        moved = vt.Mission.of(scene, table.to_crs(crs), max_range=120)
        assert area_of(moved) == pytest.approx(300, abs=1e-3)
        corners = np.concatenate(moved.target_parts)
        assert np.abs(corners[:, :2].min(axis=0) - (0, -60)).max() < 1e-6
    with pytest.raises(vt.Error) as raised:
        vt.Mission.of(plain, table, max_range=60)
    assert raised.value.code == "not-georeferenced" and "set_crs" in raised.value.fix
    with pytest.raises(vt.Error) as raised:
        vt.Mission.of(scene, table, max_range=60, crs="EPSG:4326")
    assert raised.value.code == "conflicting-keys"


FEET = 1200 / 3937


@pytest.mark.parametrize("crs, unit", [("EPSG:2263+6360", FEET), ("EPSG:32618+5715", -1), ("EPSG:2263+5703", 1),
                                       ("EPSG:2263", 1), ("EPSG:4979", 1)])
def test_heights_of_tables_are_in_the_unit_of_their_crs(crs, unit):
    """As those of the same target with the mission's crs."""
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    plain = yard()
    scene = vt.Scene.from_arrays(plain.vertices, plain.faces, object_of=plain.object_of, objects=plain.objects,
                                 georeference=vt.Georeference(40.7484, -73.9857, "flat ground"))
    plan = geopandas.GeoSeries([shapely.box(40, -60, 50, -40)], crs=scene.crs).to_crs(crs)[0]
    corners = [(x, y, 15 / unit) for x, y, *_ in plan.exterior.coords]
    by_crs = vt.Mission.of(scene, vt.Target(vertices=corners[:-1]), max_range=120, crs=crs)
    assert by_crs.target_parts[0][:, 2] == pytest.approx([15] * 4, abs=1e-9)
    bent = [corners[0], corners[1], corners[2], tuple(0.7 * np.array(corners[0]) + 0.15 * np.array(corners[1])
                                                      + 0.15 * np.array(corners[2]))]
    shapes = [shapely.Polygon(corners), shapely.Point(corners[0]), shapely.Polygon(bent),
              shapely.Polygon(corners, [[0.25 * np.array(corners[k]) + 0.75 * np.mean(corners[:4], axis=0)
                                         for k in range(4)]])]
    table = geopandas.GeoSeries(shapes, crs=crs)
    missions = [vt.Mission.of(scene, table[k:k + 1], max_range=120) for k in range(len(shapes))]
    assert missions[0].target_parts[0] == pytest.approx(by_crs.target_parts[0], abs=1e-9)
    for mission in missions:
        assert np.concatenate(mission.target_parts)[:, 2] == pytest.approx(15, abs=2e-3)
    flat = geopandas.GeoSeries([plan], crs=crs)
    assert np.abs(vt.Mission.of(scene, flat, max_range=120).target_parts[0][:, 2]).max() < 3e-3  # on the ground


def test_files_of_targets(tmp_path, monkeypatch):
    plain = yard()
    scene = vt.Scene.from_arrays(plain.vertices, plain.faces, object_of=plain.object_of, objects=plain.objects,
                                 georeference=vt.Georeference(48.1374, 11.5755, "flat ground"))
    ring = [[11.5760, 48.1374], [11.5761, 48.1374], [11.5761, 48.1375], [11.5760, 48.1374]]
    (tmp_path / "lots.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": name}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
        for name in ("north", "south")]}))
    monkeypatch.chdir(tmp_path)  # paths start from the current folder
    mission = vt.Mission.of(scene, vt.Target(file="lots.geojson", feature="south"), max_range=60)
    assert mission.target_name == "south" and area_of(mission) == pytest.approx(41, rel=0.05)
    with pytest.raises(vt.Error) as raised:
        vt.Mission.of(scene, {"file": tmp_path / "lots.geojson"}, max_range=60)
    assert raised.value.code == "missing-key" and "feature" in raised.value.fix
    with pytest.raises(vt.Error) as raised:
        vt.Mission.of(scene, vt.Target(file="none.kml"), max_range=60)
    assert raised.value.code == "file-not-found" and raised.value.where.startswith("target['file']")


# ---- what leads to the right function


def test_classes_are_not_called():
    for call, word in ((lambda: vt.Scene("x.obj"), "from_mesh('x.obj')"), (lambda: vt.Scene("x.osm.pbf"), "from_osm"),
                       (lambda: vt.Scene("x.tif"), "from_raster"), (lambda: vt.Scene(3), "from_arrays"),
                       (lambda: vt.Volume("v.ply"), "Volume.read"), (lambda: vt.Mission("m.yaml"), "Mission.read"),
                       (lambda: vt.Result("r"), "vt.compute")):
        with pytest.raises(TypeError, match="is not called by itself") as raised:
            call()
        assert word in str(raised.value)


def test_files_lead_to_the_function_that_reads_them(tmp_path, scene):
    from test_many import TOWN

    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_mesh(TOWN)
    assert "from_osm" in raised.value.fix
    scene.save(tmp_path / "yard.obj")
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_osm(tmp_path / "yard.obj")
    assert "from_mesh" in raised.value.fix
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_mesh(tmp_path / "dsm.tif")
    assert raised.value.code == "file-not-found" and "from_raster" not in raised.value.fix  # that is said first
    (tmp_path / "dsm.tif").write_bytes(b"II*\0")
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_mesh(tmp_path / "dsm.tif")
    assert "from_raster" in raised.value.fix
    (tmp_path / "bad.obj").write_text("f 1 2 3\n")
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_mesh(tmp_path / "bad.obj")
    assert "vt.Scene" not in raised.value.fix
    with pytest.raises(vt.Error) as raised:
        vt.compute(str(TOWN), SQUARE, max_range=60)
    assert raised.value.where == "scene" and "from_osm" in raised.value.fix


def test_a_saved_scene_says_how_far_it_moved(tmp_path):
    far = np.array([[1000.1, 0, 0], [1009.3, 0.7, 0], [1000, 9, 3.3], [-1000.7, 0, 0]])
    scene = vt.Scene.from_arrays(far, [[0, 1, 2], [0, 1, 3]])
    rounds = {"obj": False, "ply": False, "glb": True, "stl": True}
    for ending in vt.output_formats(scenes=True):
        moved = scene.save(tmp_path / f"scene.{ending}")
        again = vt.Scene.from_mesh(tmp_path / f"scene.{ending}")
        found = np.linalg.norm(np.sort(again.vertices[again.faces].reshape(-1, 3), axis=0)
                               - np.sort(scene.vertices[scene.faces].reshape(-1, 3), axis=0), axis=1).max()
        assert (moved > 0) == (again.hash != scene.hash) and rounds.get(ending, moved > 0) == (moved > 0)
        assert found <= moved * 1.001 and moved < 1e-4
    exact = vt.Scene.from_arrays([[0, 0, 0], [64, 0, 0], [0, 64, 0.5]], [[0, 1, 2]])
    assert exact.save(tmp_path / "exact.glb") == 0 and vt.Scene.from_mesh(tmp_path / "exact.glb").hash == exact.hash


def test_one_report_for_files_of_one_name(result, tmp_path):
    assert result.save(tmp_path / "a.ply", tmp_path / "a.glb") == [str(tmp_path / "a.report.json")]
    assert sorted(one.name for one in tmp_path.iterdir()) == ["a.glb", "a.ply", "a.report.json"]
    assert json.loads((tmp_path / "a.report.json").read_text())["volume"].endswith("a.ply")
    assert len(result.save(tmp_path / "b.ply", tmp_path / "c.glb")) == 2
