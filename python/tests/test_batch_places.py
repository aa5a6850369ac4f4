"""Batches: geometries in other coordinate reference systems, not convex, with and without heights."""

import json

import numpy as np
import pytest

import vantage as vt
from conftest import box

shapely = pytest.importorskip("shapely")
pyproj = pytest.importorskip("pyproj")
geopandas = pytest.importorskip("geopandas")

import vantage.batch as batch  # noqa: E402
from vantage.batch import _geometry, _table  # noqa: E402

LATITUDE, LONGITUDE = 48.1374, 11.5755
L_SHAPE = [(0, 0), (12, 0), (12, 4), (4, 4), (4, 12), (0, 12)]


@pytest.fixture(scope="module")
def city():
    """Flat ground in Munich, and a tower beside the origin."""
    corners, sides = box((20, -5, 0), (30, 15, 40))
    vertices = [[-100, -100, 0], [100, -100, 0], [100, 100, 0], [-100, 100, 0], *corners]
    faces = [[0, 1, 2], [0, 2, 3], *([i + 4 for i in face] for face in sides)]
    return vt.Scene.from_arrays(vertices, faces, object_of=[0, 0] + [1] * 12,
                                objects=[vt.SceneObject("ground", kind="ground"), vt.SceneObject("tower", kind="building")],
                                georeference=vt.Georeference(LATITUDE, LONGITUDE, "flat ground"))


def in_crs(city, corners, crs):
    move = pyproj.Transformer.from_crs(city.crs, crs, always_xy=True)
    return shapely.Polygon([move.transform(x, y) for x, y in corners])


def rows_of(table):
    return _table.read(table).rows


def parts_of(city, geometry, crs="scene", **keys):
    row = rows_of([{"id": 1, "geometry": geometry, **keys}])[0]
    targets = _geometry.targets_of(row, _geometry.CrsTransform(city, crs))
    mission = vt.Mission.of(city, targets[0] if len(targets) == 1 else targets, max_range=60)
    return mission.target_parts


def plan_area(parts):
    return sum(shapely.Polygon(part[:, :2]).area for part in parts)


def test_other_systems_are_transformed(city, tmp_path):
    alone = vt.compute(city, vt.Target(outline=L_SHAPE), max_range=60)
    for number, crs in enumerate(("EPSG:25832", "EPSG:4326", "EPSG:3857", city.crs)):
        frame = geopandas.GeoDataFrame({"id": ["square"]}, geometry=[in_crs(city, L_SHAPE, crs)], crs=crs)
        places = _geometry.CrsTransform(city, _table.read(frame).crs)
        targets = _geometry.targets_of(rows_of(frame)[0], places)
        assert np.array(targets[0].outline) == pytest.approx(np.array(L_SHAPE, float), abs=2e-6), crs
        if number:
            continue
        table = batch.run(frame, city, tmp_path, max_range=60, workers=1).table()
        assert table["volume_m3"][0] == pytest.approx(alone.volume_m3, rel=1e-4)
        assert table.crs == "OGC:CRS84"
        there = in_crs(city, L_SHAPE, "OGC:CRS84")
        assert shapely.hausdorff_distance(table.geometry[0], there) < 1e-9


def test_systems_that_are_missing_or_unknown(city, scene, tmp_path):
    square = shapely.box(0, 0, 1, 1)

    def refused(where, **options):
        with pytest.raises(vt.Error) as raised:
            batch.run([{"id": 1, "geometry": square}], where, tmp_path, max_range=60, **options)
        return raised.value

    error = refused(city)
    assert error.code == "crs-missing" and "set_crs" in error.fix
    assert refused(scene, crs="EPSG:4326").code == "not-georeferenced"
    assert refused(city, crs="EPSG:999999").code == "crs-unknown"
    assert list(tmp_path.iterdir()) == []
    far = batch.run([{"id": 1, "geometry": shapely.box(5, 5, 5.001, 5.001)}], city, tmp_path, max_range=60, crs="EPSG:4326",
                    workers=1)
    assert far.table()["error_code"][0] == "too-far-away"


def test_geojson_with_an_old_crs(tmp_path):
    text = {"type": "FeatureCollection", "crs": {"properties": {"name": "urn:ogc:def:crs:EPSG::25832"}},
            "features": [{"id": "a", "properties": {}, "geometry": None}, {"id": "b", "properties": {"osm": "way/1"}}]}
    (tmp_path / "t.geojson").write_text(json.dumps(text))
    table = _table.read(tmp_path / "t.geojson")
    assert "25832" in table.crs and [row.id for row in table.rows] == ["a", "b"]


def test_polygons_that_are_not_convex(city):
    """All of the polygon must be seen: its parts cover it, no less and no more."""
    for seed in range(20):
        random = np.random.default_rng(seed)
        angles = np.sort(random.uniform(0, 2 * np.pi, random.integers(4, 30)))
        star = np.column_stack([np.cos(angles), np.sin(angles)]) * random.uniform(3, 12, len(angles))[:, None] - [40, 0]
        polygon = shapely.Polygon(star)
        if not polygon.is_valid or polygon.area < 1:
            continue
        flat = parts_of(city, polygon)
        assert plan_area(flat) == pytest.approx(polygon.area, rel=1e-4), f"seed {seed}"
        tilted = shapely.Polygon([(x, y, 20 + 0.1 * x) for x, y in star])
        raised = parts_of(city, tilted)
        assert plan_area(raised) == pytest.approx(polygon.area, rel=1e-9), f"seed {seed}"
        for part in raised:
            assert part[:, 2] == pytest.approx(20 + 0.1 * part[:, 0])
            assert polygon.buffer(1e-9).covers(shapely.Polygon(part[:, :2])), f"seed {seed}"


def test_holes_and_several_polygons(city):
    ring = shapely.box(-30, -10, -10, 10) - shapely.box(-22, -2, -18, 2)
    assert plan_area(parts_of(city, ring)) == pytest.approx(ring.area, rel=1e-4)
    raised = shapely.transform(shapely.force_3d(ring, 5.0), lambda c: c, include_z=True)
    assert plan_area(parts_of(city, raised)) == pytest.approx(ring.area, rel=1e-9)
    both = shapely.MultiPolygon([shapely.box(-30, 0, -20, 5), shapely.box(-50, 0, -45, 5)])
    row = rows_of([{"id": 1, "geometry": both}])[0]
    targets = _geometry.targets_of(row, _geometry.CrsTransform(city, "scene"))
    result = vt.compute(city, targets, max_range=60)
    seen = [vt.compute(city, one, max_range=60) for one in targets]
    assert 0 < result.volume_m3 < min(one.volume_m3 for one in seen)


def test_geometries_beside_other_columns_are_only_shown(city, tmp_path):
    rows = [{"id": 1, "geometry": shapely.box(-50, 0, -40, 5), "vertices": [[0, 0, 0], [9, 0, 0], [9, 9, 0]]}]
    table = batch.run(rows, city, tmp_path, max_range=60, crs="scene", workers=1).table()
    alone = vt.compute(city, rows[0]["vertices"], max_range=60)
    assert table["volume_hash"][0] == alone.volume.hash
    west, *_ = table.geometry[0].bounds
    assert city.position(LATITUDE, west)[0] == pytest.approx(-50, abs=1e-3)


def test_heights_are_those_given(city):
    wall = shapely.Polygon([(0, 30, 1), (9, 30, 1), (9, 30, 6), (0, 30, 6)])
    assert np.array(parts_of(city, wall)[0])[:, 2].tolist() == [1, 1, 6, 6]
    assert parts_of(city, shapely.Point(1, 2, 30))[0].tolist() == [[1, 2, 30]]
    raised = parts_of(city, shapely.box(-30, 0, -20, 5), offset=0.5)
    assert raised[0].shape == (4, 3)


def test_heights_are_in_the_unit_of_the_crs(city, tmp_path):
    """EPSG:8228 counts in feet, EPSG:5715 downwards; of EPSG:25832 alone z is metres."""
    for crs, unit in (("EPSG:25832+8228", 0.3048), ("EPSG:25832+5715", -1), ("EPSG:25832+7837", 1), ("EPSG:25832", 1)):
        flat = in_crs(city, [(-50, 10), (-40, 10), (-40, 20)], "EPSG:25832")
        shape = shapely.Polygon([(x, y, 6 / unit) for x, y in flat.exterior.coords])
        point = shapely.Point(shape.exterior.coords[0])
        frame = geopandas.GeoDataFrame({"id": [1, 2]}, geometry=[shape, point], crs=crs)
        places = _geometry.CrsTransform(city, _table.read(frame).crs)
        polygon, single = (_geometry.targets_of(row, places)[0] for row in rows_of(frame))
        assert np.array(polygon.vertices)[:, 2] == pytest.approx([6, 6, 6]), crs
        assert single.point[2] == pytest.approx(6), crs
        table = batch.run(frame, city, tmp_path / crs, max_range=60, workers=1).table()
        assert shapely.get_coordinates(table.geometry, include_z=True)[:, 2] == pytest.approx(6), crs


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_geometries_that_are_none(city, tmp_path):
    bow_tie = shapely.Polygon([(0, 0), (9, 9), (9, 0), (0, 9)])
    cases = {
        "bow tie": (bow_tie, "zone-not-simple"),
        "bow tie, raised": (shapely.Polygon([(x, y, 9) for x, y in bow_tie.exterior.coords]), "zone-not-simple"),
        "empty": (shapely.Polygon(), "nothing-given"),
        "flat point": (shapely.Point(0, 0), "missing-key"),
        "garbled": (b"\x01\x02", "value-syntax"),
        "in the tower": (shapely.box(22, 0, 25, 5), "target-inside-solid"),
        "line": (shapely.LineString([(0, 0), (1, 1)]), "value-unsupported"),
        "not finite": (shapely.Polygon([(0, 0), (1, float("nan")), (1, 1)]), "coordinate-not-finite"),
        "sliver": (shapely.box(0, 0, 5, 0.001), "target-without-area"),
    }
    rows = [{"id": name, "geometry": shape} for name, (shape, _) in cases.items()]
    table = batch.run(rows, city, tmp_path, max_range=60, crs="scene", workers=1).table()
    assert dict(zip(table["id"], table["error_code"])) == {name: code for name, (_, code) in cases.items()}
    with pytest.raises(vt.Error):
        _table.read([{"id": 1, "geometry": "square"}])
