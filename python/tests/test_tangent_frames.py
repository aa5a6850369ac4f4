"""Scenes of 3D Tiles: their frame touches the ellipsoid, and is no map. Places on the earth against PROJ."""

import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import box

import vantage as vt
from vantage._flight import line_of, table_of

pyproj = pytest.importorskip("pyproj")

EXACT_M = 1e-6
ORIGINS = [(0.0, 12.0), (48.1, 11.5), (-33.9, 151.2), (69.6, 18.9)]
DISTANCES_M = (0, 400, 2000, 10000)
EAST_NORTH = (0.6, -0.8)


def place_of(origin):
    return vt.Georeference(*origin, "ellipsoidal height", "EPSG:4978")


class Proj:
    """Between longitude, latitude, height and the frame that touches the ellipsoid, by PROJ."""

    def __init__(self, origin):
        self._pipeline = pyproj.Transformer.from_pipeline(
            "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 "
            f"+step +proj=topocentric +ellps=WGS84 +lat_0={origin[0]} +lon_0={origin[1]} +h_0=0")

    def frame(self, degrees):
        return np.column_stack(self._pipeline.transform(*np.transpose(degrees)))

    def degrees(self, points):
        return np.column_stack(self._pipeline.transform(*np.transpose(points), direction="INVERSE"))


def points_about(distance_m):
    """Of the frame."""
    east, north = EAST_NORTH
    return np.array([[east * distance_m, north * distance_m, z] for z in (-20.0, 0.0, 120.0, 900.0)])


CASES = pytest.mark.parametrize(("origin", "distance_m"), [(origin, distance) for origin in ORIGINS for distance in DISTANCES_M])


def tower_at(origin, x, y):
    """A scene with flat ground at z = 40 and a tower."""
    corners, faces = box((x + 20, y - 5, 40), (x + 30, y + 15, 90))
    reach = 12500
    ground = [[-reach, -reach, 40], [reach, -reach, 40], [reach, reach, 40], [-reach, reach, 40]]
    return vt.Scene.from_arrays(ground + corners, [[0, 1, 2], [0, 2, 3]] + [[i + 4 for i in face] for face in faces],
                                object_of=[0, 0] + [1] * 12, georeference=place_of(origin),
                                objects=[vt.SceneObject("ground", kind="ground"), vt.SceneObject("tower", kind="building")])


@CASES
def test_positions_are_those_of_proj(origin, distance_m):
    scene, proj, points = tower_at(origin, 0, 0), Proj(origin), points_about(distance_m)
    degrees = proj.degrees(points)
    assert np.abs(scene.positions(degrees, 4979) - points).max() < EXACT_M
    there = scene.positions_in_crs(points, 4326)
    assert np.abs(proj.frame(there) - points).max() < EXACT_M
    assert np.abs(there[:, 2] - degrees[:, 2]).max() < EXACT_M
    for (x, y, z), (longitude, latitude, _) in zip(points, degrees):
        assert np.abs(np.subtract(scene.position(latitude, longitude, z), (x, y))).max() < EXACT_M
    # Without heights at z = 0, both ways.
    flat = scene.positions_in_crs(points[1:2, :2], 4326)
    assert np.abs(flat - degrees[1:2, :2]).max() * 111e3 < EXACT_M
    assert np.abs(scene.positions(flat, 4326) - points[1:2, :2]).max() < EXACT_M


def test_a_map_has_heights_as_z():
    scene = vt.Scene.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]], georeference=vt.Georeference(48.0, 11.0))
    flat, high = scene.positions([[11.02, 48.01]], 4326), scene.positions([[11.02, 48.01, 120]], 4326)
    assert high.tolist() == [[*flat[0], 120]]
    assert scene.positions([[11.02, 48.01, 120]], "EPSG:4326+5715")[0, 2] == -120  # a depth


@CASES
def test_slices_lie_where_proj_has_them(origin, distance_m, tmp_path):
    proj, x, y = Proj(origin), *np.multiply(EAST_NORTH, distance_m)
    scene = tower_at(origin, x, y)
    result = vt.compute(scene, [[x, y, 50], [x + 9, y, 50], [x, y + 9, 50]], max_range=60)
    cut = result.slice(z=80)
    assert not cut.empty
    corners = np.concatenate([ring for rings in cut.polygons for ring in rings])
    exact = proj.degrees(np.column_stack([corners, np.full(len(corners), 80.0)]))
    moved = cut.to_crs(4326)
    got = np.concatenate([ring for rings in moved.polygons for ring in rings])
    # Where the corner is on the earth, by its height.
    assert np.abs(proj.frame(np.column_stack([got, exact[:, 2]]))[:, :2] - corners).max() < EXACT_M
    low, high = cut.height_range_m
    outer = np.concatenate([rings[0] for rings in cut.polygons])
    heights = proj.degrees(np.column_stack([outer, np.full(len(outer), 80.0)]))[:, 2]
    assert low == pytest.approx(heights.min(), abs=EXACT_M) and high == pytest.approx(heights.max(), abs=EXACT_M)
    if distance_m >= 2000:
        assert low > 80.2  # the plane z = 80 is no level
    # The frame is no map: tables are converted to the one that they state.
    pytest.importorskip("geopandas")
    table = cut.to_geodataframe()
    assert table["height_min_m"][0] == low and table["z_m"][0] == 80
    back = np.array(table.to_crs(4326).geometry[0].geoms[0].exterior.coords)[:-1]
    ring = next(rings[0] for rings in cut.polygons if len(rings[0]) == len(back))
    assert min_distance(proj, back, exact, len(ring)) < EXACT_M
    cut.save(tmp_path / "a.geojson")
    feature = json.loads((tmp_path / "a.geojson").read_text())["features"][0]
    assert feature["properties"]["height_max_m"] == high
    for written in (ring for polygon in feature["geometry"]["coordinates"] for ring in polygon):
        assert min_distance(proj, np.array(written[:-1]), exact, len(written) - 1) < EXACT_M


def min_distance(proj, degrees, exact, count):
    """How far the farthest of some places is from the nearest of the exact ones."""
    assert len(degrees) == count
    farthest = 0.0
    for place in degrees:
        off = (exact[:, :2] - place) * [111e3 * np.cos(np.radians(place[1])), 111e3]
        farthest = max(farthest, float(np.hypot(*off.T).min()))
    return farthest


def test_tables_of_slices_have_the_height_of_each_corner(tmp_path):
    geopandas = pytest.importorskip("geopandas")
    origin, x, y = ORIGINS[1], 1200.0, -1600.0
    proj, scene = Proj(origin), tower_at(ORIGINS[1], x, y)
    result = vt.compute(scene, [[x, y, 50], [x + 9, y, 50], [x, y + 9, 50]], max_range=60)
    for crs in (4326, None):
        vt.write_slices(tmp_path / "a.gpkg", [result.slice(z=80), result.slice(z=70)], crs=crs)
        table = geopandas.read_file(tmp_path / "a.gpkg")
        places = table.to_crs("EPSG:4326") if crs is None else table
        for z, shape in zip(table["z_m"], places.geometry):
            corners = np.concatenate([np.array(part.exterior.coords) for part in shape.geoms])
            assert np.abs(proj.frame(corners)[:, 2] - z).max() < 2 * EXACT_M


@CASES
def test_targets_of_tables_lie_where_proj_has_them(origin, distance_m):
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    proj, x, y = Proj(origin), *np.multiply(EAST_NORTH, distance_m)
    scene = tower_at(origin, x, y)
    corners = np.array([[x, y, 50.0], [x + 9, y, 50.0], [x, y + 9, 53.0]])
    table = geopandas.GeoSeries([shapely.Polygon(proj.degrees(corners))], crs=4326)
    placed = parts_of(scene, table)
    assert np.abs(placed - corners).max() < EXACT_M
    flat = geopandas.GeoSeries([shapely.Polygon(proj.degrees(corners * [1, 1, 0] + [0, 0, 40])[:, :2])], crs=4326)
    laid = parts_of(scene, flat)
    for corner in laid:
        assert np.abs(corners[:, :2] - corner[:2]).max(axis=1).min() < EXACT_M
        assert corner[2] == pytest.approx(40, abs=1e-9)


def parts_of(scene, targets, **keys):
    """The corners of the one part of a target."""
    (part,) = vt.Mission.of(scene, targets, max_range=60, **keys).target_parts
    return np.array(part)


@CASES
def test_batches_and_missions_with_a_crs_agree_with_proj(origin, distance_m):
    batch_geometry, batch_table = pytest.importorskip("vantage.batch._geometry"), pytest.importorskip("vantage.batch._table")
    shapely = pytest.importorskip("shapely")
    proj, x, y = Proj(origin), *np.multiply(EAST_NORTH, distance_m)
    scene = tower_at(origin, x, y)
    corners = np.array([[x, y, 50.0], [x + 9, y, 50.0], [x, y + 9, 53.0]])
    degrees = proj.degrees(corners)
    assert np.abs(parts_of(scene, degrees, crs="EPSG:4326") - corners).max() < EXACT_M
    (row,) = batch_table.read([{"id": 1, "geometry": shapely.Polygon(degrees)}]).rows
    transform = batch_geometry.CrsTransform(scene, "EPSG:4326")
    assert np.abs(parts_of(scene, batch_geometry.targets_of(row, transform)[0]) - corners).max() < EXACT_M
    shown = transform.from_scene(corners)
    assert np.abs(proj.frame(shown) - corners).max() < EXACT_M
    # Without heights on the ground, which is 40 m above z = 0.
    on_ground = corners * [1, 1, 0] + [0, 0, 40]
    (flat,) = batch_table.read([{"id": 1, "geometry": shapely.Polygon(proj.degrees(on_ground)[:, :2])}]).rows
    for corner in parts_of(scene, batch_geometry.targets_of(flat, transform)[0]):
        assert np.abs(on_ground - corner).max(axis=1).min() < EXACT_M


@CASES
def test_points_of_a_query_are_those_of_proj(origin, distance_m, tmp_path):
    proj, x, y = Proj(origin), *np.multiply(EAST_NORTH, distance_m)
    scene = tower_at(origin, x, y)
    scene.save(tmp_path / "scene.ply")
    (tmp_path / "m.yaml").write_text(
        "scene: {mesh: scene.ply, sea_level: 36.7}\nsensor: {max_range: 60}\nnavigation: {altitude: {agl: [0, 200]}, ground: 40}\n"
        f"target: {{vertices: [[{x}, {y}, 50], [{x + 9}, {y}, 50], [{x}, {y + 9}, 50]]}}\n")
    points = np.array([[x + 3, y + 3, 70], [x - 8, y + 11, 81]])
    degrees = proj.degrees(points)
    flat = ["x,y,z", *(f"{a},{b},{c}" for a, b, c in points.tolist())]
    wanted = margins(tmp_path, flat)
    for name, heights in (("z", points[:, 2]), ("amsl", degrees[:, 2] - 36.7), ("agl", points[:, 2] - 40)):
        rows = [f"lon,lat,{name}", *(f"{a!r},{b!r},{c!r}" for a, b, c in
                                     np.column_stack([degrees[:, :2], heights]).tolist())]
        assert np.abs(margins(tmp_path, rows) - wanted).max() < 2e-6, name
    rows = ["x,y,amsl", *(f"{a!r},{b!r},{c!r}" for a, b, c in np.column_stack([points[:, :2], degrees[:, 2] - 36.7]).tolist())]
    assert np.abs(margins(tmp_path, rows) - wanted).max() < 2e-6


def margins(folder, rows):
    (folder / "points.csv").write_text("\n".join(rows) + "\n")
    ran = subprocess.run([sys.executable, "-m", "vantage", "query", folder / "m.yaml", folder / "points.csv", "--json"],
                         capture_output=True, text=True, check=True)
    answers = json.loads(ran.stdout)
    assert all(answer["inside"] for answer in answers)
    return np.array([answer["margin_m"] for answer in answers])


def test_flights_in_tables_are_on_the_map():
    pytest.importorskip("geopandas")
    origin, points = ORIGINS[1], np.array([[1200.0, -1600.0, 80.0], [1250.0, -1580.0, 90.0]])
    table = table_of([{"leg": 0}], [line_of(points)], tower_at(origin, 0, 0)._map, ("leg",))
    degrees = np.array(table.to_crs(4326).geometry[0].coords)
    assert np.abs(Proj(origin).frame(degrees) - points).max() < 2 * EXACT_M
