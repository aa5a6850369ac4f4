"""Points in volumes, slices and footprints, and where these lie on the earth."""

import json

import numpy as np
import pytest

import vantage as vt
from conftest import box
from vantage import Slice

PLACE = vt.Georeference(40.7484, -73.9857)


def torus(ring=30.0, tube=10.0, around=48, across=24, at=(0, 0, 20)):
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    r = ring + tube * np.cos(b)
    vertices = np.stack([r * np.cos(a), r * np.sin(a), tube * np.sin(b)], axis=-1).reshape(-1, 3) + at
    here = (u * across + v).ravel()
    over = (u * across + (v + 1) % across).ravel()
    along = ((u + 1) % around * across + v).ravel()
    both = ((u + 1) % around * across + (v + 1) % across).ravel()
    return vt.Volume.from_arrays(vertices, np.concatenate([np.column_stack([here, along, both]),
                                                           np.column_stack([here, both, over])]))


@pytest.fixture(scope="module")
def placed():
    """A volume that knows where it is: that of a square on the ground at the Empire State Building."""
    ground = vt.Scene.from_arrays([[-200, -200, 0], [200, -200, 0], [200, 200, 0], [-200, 200, 0]], [[0, 1, 2], [0, 2, 3]],
                                  objects=[vt.SceneObject("ground", kind="ground")], georeference=PLACE)
    return vt.compute(ground, [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]], max_range=60)


def test_contains_is_exact_and_closed():
    cube = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1)))
    above = np.nextafter(1.0, 2)
    points = [[0.5, 0.5, 0.5], [0, 0, 0], [1, 1, 1], [0.5, 0.5, 1], [0.5, 0.5, above], [above, 0, 0], [-1e-300, 0.5, 0.5]]
    assert cube.contains(points).tolist() == [True, True, True, True, False, False, False]
    assert cube.contains([0.5, 0.5, 0.5]).tolist() == [True]  # a single point
    assert cube.contains(np.zeros((0, 3))).shape == (0,)
    assert cube.contains(points).dtype == np.bool_


def test_contains_agrees_with_the_formula():
    volume = torus(around=240, across=120)
    rng = np.random.default_rng(seed := 5)
    points = rng.uniform(-45, 45, (20000, 3)) + [0, 0, 20]
    depth = 10 - np.hypot(np.hypot(points[:, 0], points[:, 1]) - 30, points[:, 2] - 20)
    sure = abs(depth) > 0.02
    assert (volume.contains(points)[sure] == (depth > 0)[sure]).all(), f"seed {seed}"
    assert volume.contains(points, threads=1).tolist() == volume.contains(points).tolist()


def test_a_result_asks_the_scene_a_volume_the_mesh(placed):
    rng = np.random.default_rng(seed := 3)
    points = rng.uniform([-60, -60, -1], [70, 70, 60], (5000, 3))
    of_mesh, exact = placed.volume.contains(points), placed.contains(points)
    assert of_mesh.sum() > 100
    assert not (of_mesh & ~exact).any(), f"seed {seed}"  # the mesh claims nothing that cannot be used
    assert (of_mesh != exact).mean() < 0.01


def test_open_meshes_are_refused():
    corners, faces = box((0, 0, 0), (1, 1, 1))
    turned = [faces[0][::-1], *faces[1:]]
    for mesh, code in ((faces[1:], "mesh-not-closed"), (turned, "mesh-not-oriented")):
        volume = vt.Volume.from_arrays(corners, mesh)
        for ask in (lambda: volume.contains([[0, 0, 0]]), lambda: volume.slice(z=0.5), volume.footprint):
            with pytest.raises(vt.Error) as raised:
                ask()
            assert raised.value.code == code and raised.value.fix
    for z, code in ((float("nan"), "value-out-of-range"), (float("-inf"), "value-out-of-range"), ("high", "wrong-type"),
                    (None, "wrong-type"), ([1, 2], "wrong-type"), (True, "wrong-type")):
        with pytest.raises(vt.Error) as raised:
            vt.Volume.from_arrays(corners, faces).slice(z=z)
        assert raised.value.code == code and raised.value.where == "z", z


def test_slices_of_a_box():
    volume = vt.Volume.from_arrays(*box((1, 2, 3), (4, 6, 9)))
    for z, area in ((3, 12), (5.5, 12), (8.999, 12), (9, 0), (2.999, 0)):
        one = volume.slice(z=z)
        assert one.area_m2 == area and one.z_m == z and one.empty == (area == 0)
    ring = volume.slice(z=5).polygons[0][0]
    assert ring.shape == (4, 2) and ring.dtype == np.float64 and not ring.flags.writeable
    assert sorted(map(tuple, ring.tolist())) == [(1, 2), (1, 6), (4, 2), (4, 6)]


def test_slices_have_holes():
    volume = torus()
    one = volume.slice(z=22)
    assert [len(rings) for rings in one.polygons] == [2]
    assert one.area_m2 == pytest.approx(4 * np.pi * 30 * np.sqrt(96), rel=0.02)
    assert volume.footprint().area_m2 == pytest.approx(np.pi * (40**2 - 20**2), rel=0.02)
    assert volume.footprint().z_m is None
    assert "hole" not in repr(one) and "z = 22 m" in repr(one) and "footprint" in repr(volume.footprint())


def test_geo_interface_and_shapely():
    shapely = pytest.importorskip("shapely")
    one = torus().slice(z=22)
    shape = shapely.geometry.shape(one)
    assert shape.geom_type == "MultiPolygon" and shape.is_valid
    assert shape.area == pytest.approx(one.area_m2, rel=1e-12)
    assert one.to_shapely().equals(shape)
    nothing = torus().slice(z=500)
    assert nothing.to_shapely().is_empty and shapely.geometry.shape(nothing).is_empty
    # Rings that touch in a point are two polygons.
    touching = vt.Volume.from_arrays(*box((0, 0, 0), (1, 1, 1))) | vt.Volume.from_arrays(*box((1, 1, 0), (2, 2, 1)))
    assert touching.slice(z=0.5).to_shapely().is_valid and touching.slice(z=0.5).area_m2 == 2


def test_every_height_of_a_real_volume_is_valid(placed):
    pytest.importorskip("shapely")
    heights = np.concatenate([np.linspace(0, 60, 41), placed.vertices[::97, 2]])  # also exactly at corners
    areas = []
    for z in heights:
        one = placed.slice(z=z)
        shape = one.to_shapely()
        assert shape.is_valid and shape.area == pytest.approx(one.area_m2, abs=1e-6)
        areas.append(one.area_m2)
    # The volume is the integral of its slices.
    steps = np.linspace(0, 60, 601)
    integral = np.trapezoid([placed.slice(z=z).area_m2 for z in steps], steps)
    assert integral == pytest.approx(placed.volume_m3, rel=2e-3)
    assert max(areas) > 1000


def test_the_footprint_covers_all_slices(placed):
    pytest.importorskip("shapely")
    footprint = placed.footprint().to_shapely().buffer(1e-4)
    for z in (0.5, 10, 30, 50):
        assert footprint.covers(placed.slice(z=z).to_shapely())
    assert (placed.volume & placed.volume).footprint().area_m2 == pytest.approx(placed.footprint().area_m2, rel=1e-6)


def test_to_crs_is_that_of_pyproj(placed):
    pyproj = pytest.importorskip("pyproj")
    one = placed.slice(z=20)
    utm = one.to_crs(32618)
    assert utm.crs == "EPSG:32618" and utm.z_m == 20 and utm.area_m2 == one.area_m2
    there = pyproj.Transformer.from_crs(one.crs, 32618, always_xy=True)
    for ring, moved in zip(one.polygons[0], utm.polygons[0]):
        assert np.allclose(np.column_stack(there.transform(*ring.T)), moved, atol=1e-5)
    # 4,511,322 m north and 585,628 m east: the middle of Manhattan.
    assert abs(utm.polygons[0][0].mean(axis=0) - [585628, 4511322]).max() < 60
    for same in ("EPSG:32618", pyproj.CRS(32618), np.int64(32618), pyproj.CRS(32618).to_wkt()):
        assert np.allclose(one.to_crs(same).polygons[0][0], utm.polygons[0][0], atol=1e-9, rtol=0)
    # There and back by way of another one: from the frame each time, nothing adds up.
    assert np.array_equal(one.to_crs(4326).to_crs(32618).polygons[0][0], utm.polygons[0][0])
    lonlat = one.to_crs(4326).polygons[0][0]
    assert abs(lonlat - [-73.9857, 40.7484]).max() < 1e-3  # longitude first


def test_sides_stay_straight_within_the_bound():
    """What the docstring of to_crs tells: 300 m at 60 degrees."""
    place = vt.Georeference(60, 18)
    one = Slice([[np.array([[-150.0, 0], [0, 0], [150, 0], [0, 1]])]], 1.0, place)
    for crs, metres, bound in ((32633, 1, 1e-4), (4326, 111_320, 4e-3)):
        west, middle, east, _ = one.to_crs(crs).polygons[0][0]
        assert bound / 10 < np.linalg.norm((west + east) / 2 - middle) * metres < bound


def test_what_cannot_be_converted(placed):
    with pytest.raises(vt.Error) as raised:
        torus().slice(z=22).to_crs(32618)
    assert raised.value.code == "not-georeferenced" and raised.value.fix
    for crs, code in ((99999, "crs-unknown"), ("nonsense", "crs-unknown"), (True, "wrong-type"), (None, "wrong-type"),
                      ("", "wrong-type"), (5.5, "wrong-type")):
        with pytest.raises(vt.Error) as raised:
            placed.slice(z=20).to_crs(crs)
        assert raised.value.code == code, crs


def test_geodataframes(placed):
    pytest.importorskip("geopandas")
    one = placed.slice(z=20)
    frame = one.to_geodataframe()
    assert len(frame) == 1 and frame.crs is not None and frame.z_m[0] == 20
    assert frame.geometry.area[0] == pytest.approx(one.area_m2)
    # UTM is scaled by 0.9996 at most here.
    assert frame.to_crs(32618).geometry.area[0] == pytest.approx(one.area_m2, rel=1e-3)
    assert one.to_crs(32618).to_geodataframe().crs.to_epsg() == 32618
    row = placed.to_geodataframe()
    assert list(row.columns) == ["target", "outcome", "volume_m3", "surface_m2", "min_z_m", "max_z_m", "footprint_m2",
                                 "geometry"]
    assert row.volume_m3[0] == placed.volume_m3 and row.target[0] == placed.mission.target_name
    assert row.geometry.area[0] == pytest.approx(row.footprint_m2[0])
    assert placed.volume.to_geodataframe().crs == row.crs
    assert torus().to_geodataframe().crs is None
    empty = vt.compute(placed.scene, [[0, 0, 0], [9, 0, 0], [9, 9, 0]], max_range=60,
                       navigation=vt.Navigation(altitude=(500, 600))).to_geodataframe()
    assert empty.outcome[0] == "outside_limits" and empty.geometry[0].is_empty and np.isnan(empty.min_z_m[0])


def test_geojson_is_longitude_and_latitude(placed, tmp_path):
    one = placed.slice(z=20)
    for name, what in (("a.geojson", one), ("b.json", one.to_crs(32618))):
        what.save(tmp_path / name)
        collection = json.loads((tmp_path / name).read_text())
        feature = collection["features"][0]
        assert collection["type"] == "FeatureCollection" and "crs" not in collection
        assert feature["properties"] == {"z_m": 20, "area_m2": one.area_m2}
        rings = feature["geometry"]["coordinates"][0]
        assert rings[0][0] == rings[0][-1]
        assert abs(np.array(rings[0]) - [-73.9857, 40.7484]).max() < 1e-3
        x, y = np.array(rings[0]).T
        assert np.dot(x[:-1], y[1:]) > np.dot(y[:-1], x[1:])  # counter-clockwise
    geopandas = pytest.importorskip("geopandas")
    read = geopandas.read_file(tmp_path / "a.geojson").to_crs(one.crs)
    assert read.geometry.area[0] == pytest.approx(one.area_m2, rel=1e-6)


def test_geojson_across_the_antimeridian(tmp_path):
    scene = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]],
                                 georeference=vt.Georeference(-17, 180))
    result = vt.compute(scene, [[0, 0, 0], [9, 0, 0], [9, 9, 0]], max_range=50)
    pytest.importorskip("shapely")
    one = result.slice(z=10)
    one.save(tmp_path / "fiji.geojson")
    geometry = json.loads((tmp_path / "fiji.geojson").read_text())["features"][0]["geometry"]
    assert geometry["type"] == "MultiPolygon"
    turns = []
    for rings in geometry["coordinates"]:
        x, y = np.array(rings[0]).T
        assert np.ptp(x) < 0.01 and abs(x).max() == 180
        turns.append((np.dot(x[:-1], y[1:]) - np.dot(y[:-1], x[1:])) / 2)
    assert len(turns) == 2 and min(turns) > 0
    east, north = 111_320 * np.cos(np.radians(17)), 110_659  # metres of a degree there
    assert sum(turns) * east * north == pytest.approx(one.area_m2, rel=2e-3)


def test_geopackage_keeps_the_crs(placed, tmp_path):
    geopandas = pytest.importorskip("geopandas")
    one = placed.slice(z=20).to_crs(32618)
    one.save(tmp_path / "a.gpkg")
    one.save(tmp_path / "a.gpkg")  # over the old one
    read = geopandas.read_file(tmp_path / "a.gpkg")
    assert read.crs.to_epsg() == 32618 and len(read) == 1
    assert read.geometry[0].symmetric_difference(one.to_shapely()).area < 1e-6
    assert [file.name for file in tmp_path.iterdir()] == ["a.gpkg"]


def test_files_that_cannot_be(placed, tmp_path):
    old = tmp_path / "a.shp"
    old.write_text("old")
    for what, path, code in ((placed.slice(z=20), old, "output-format-unknown"),
                             (placed.slice(z=20), tmp_path / "missing" / "a.geojson", "output-folder-missing"),
                             (torus().slice(z=22), tmp_path / "b.geojson", "not-georeferenced")):
        with pytest.raises(vt.Error) as raised:
            what.save(path)
        assert raised.value.code == code and raised.value.fix
    (tmp_path / "c.geojson").mkdir()
    with pytest.raises(vt.OutputError) as raised:
        placed.slice(z=20).save(tmp_path / "c.geojson")
    assert raised.value.code == "output-unwritable"
    assert old.read_text() == "old" and sorted(file.name for file in tmp_path.iterdir()) == ["a.shp", "c.geojson"]


def test_missing_extras_say_what_to_install(placed, monkeypatch):
    import sys

    for module, call in (("shapely", lambda: placed.slice(z=20).to_shapely()), ("trimesh", placed.to_trimesh),
                         ("geopandas", placed.to_geodataframe)):
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, module, None)
            with pytest.raises(vt.Error) as raised:
                call()
        assert raised.value.code == "component-missing" and "pip install" in raised.value.fix


def test_others_accept_the_results(result):
    """Watertight, and of the same volume."""
    trimesh, manifold3d = pytest.importorskip("trimesh"), pytest.importorskip("manifold3d")
    pyvista, geopandas = pytest.importorskip("pyvista"), pytest.importorskip("geopandas")
    mesh = result.to_trimesh()
    assert isinstance(mesh, trimesh.Trimesh) and mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(result.volume_m3, rel=1e-9) and len(mesh.face_attributes["cause"]) == len(mesh.faces)
    poly = result.to_pyvista()
    assert isinstance(poly, pyvista.PolyData) and poly.is_manifold and poly.n_open_edges == 0
    assert poly.volume == pytest.approx(result.volume_m3, rel=1e-5)  # VTK computes in single precision
    solid = result.to_manifold()
    assert solid.status() == manifold3d.Error.NoError and solid.volume() == pytest.approx(result.volume_m3, rel=1e-9)
    frame = result.to_geodataframe()
    assert isinstance(frame, geopandas.GeoDataFrame) and frame.geometry.is_valid.all()
    assert frame.geometry.area[0] == pytest.approx(mesh.projected([0, 0, 1]).area, rel=1e-4) if hasattr(mesh, "projected") else True


def test_notebooks(placed):
    html = placed.slice(z=20)._repr_html_()
    assert "<svg" in html and "20 m" in html
    assert "<svg" not in placed.slice(z=2000)._repr_html_()


@pytest.mark.parametrize("code, at_deg", [(23030, (40.4, -3.7)), (23032, (45.46, 9.19)), (4326, (48.0, 11.0)), (2263, (40.75, -73.98))])
def test_positions_of_a_crs_are_those_of_a_mesh_in_it(tmp_path, code, at_deg):
    """Old datums have several ways to WGS 84, metres apart: the mesh and the positions must go the same."""
    here = vt.Scene.from_arrays([[0, 0, 0], [90, 0, 1], [0, 60, 2]], [[0, 1, 2]], georeference=vt.Georeference(*at_deg))
    there = here.positions_in_crs(here.vertices[:, :2], code)
    mesh = tmp_path / "mesh.obj"
    mesh.write_text("".join(f"v {x:.17g} {y:.17g} {z:.17g}\n" for (x, y), z in zip(there, here.vertices[:, 2])) + "f 1 2 3\n")
    scene = vt.Scene.from_mesh(mesh, crs=f"EPSG:{code}")
    moved = scene.positions(there, code)
    assert abs(moved - scene.vertices[:, :2]).max() < 1e-6
    # Steps of Helmert's seven parameters are not exact backwards.
    assert abs(here.positions(there, code) - here.vertices[:, :2]).max() < 5e-3


def test_positions_that_cannot_be_converted():
    scene = vt.Scene.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]], georeference=PLACE)
    assert scene.positions([], 4326).shape == (0, 2) and scene.positions([-73.9857, 40.7484], 4326).shape == (1, 2)
    lost = vt.Scene.from_arrays(scene.vertices, scene.faces)
    for of, points, crs, code in ((scene, [[0, 0]], 4326, "too-far-away"), (scene, [[0, 0, 0, 0]], 4326, "array-sizes-differ"),
                                  (scene, [[0, np.nan]], 4326, "coordinate-not-finite"), (scene, [[0, 0]], 99999, "crs-unknown"),
                                  (lost, [[0, 0]], 4326, "not-georeferenced")):
        with pytest.raises(vt.Error) as raised:
            of.positions(points, crs)
        assert raised.value.code == code
