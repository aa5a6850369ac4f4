"""Scenes of footprints with heights."""

import numpy as np
import pytest

import vantage as vt

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")
pyproj = pytest.importorskip("pyproj")

EAST, NORTH = 585628.0, 4511322.0  # in UTM 18 north: New York


def table(geometries, crs=32618, **columns):
    return geopandas.GeoDataFrame(columns, geometry=geometries, crs=crs)


def solid(scene, number):
    """One object as a volume."""
    faces = np.array(scene.faces)[np.array(scene.object_of) == number]
    return vt.Volume.from_arrays(scene.vertices, faces)


def refused(gdf, **options):
    with pytest.raises(vt.Error) as raised:
        vt.Scene.from_geodataframe(gdf, **options)
    assert raised.value.kind == "input" and raised.value.problem and raised.value.fix
    return raised.value


COURT = shapely.Polygon([(0, 0), (30, 0), (30, 20), (0, 20)], [[(10, 5), (20, 5), (20, 15), (10, 15)]])
ELL = shapely.Polygon([(40, 0), (60, 0), (60, 5), (50, 5), (50, 20), (45, 20), (40, 20)])  # with a corner on a straight side


def test_prisms_are_closed_and_have_the_volume():
    """In metres of the frame: to the bit."""
    pair = shapely.MultiPolygon([shapely.box(0, 40, 10, 50), shapely.box(20, 40, 25, 50)])
    touching = shapely.Polygon([(0, 60), (30, 60), (30, 80), (0, 80)], [[(0, 70), (10, 65), (10, 75)]])
    assert touching.is_valid
    gdf = table([COURT, ELL, pair, touching], crs=None, height=[10.0, 4.0, 5.0, 2.0], name=["court", "ell", "pair", "touching"])
    scene = vt.Scene.from_geodataframe(gdf, ground=False)
    assert [one.name for one in scene.objects] == ["court", "ell", "pair", "touching"]
    assert {one.kind for one in scene.objects} == {"building"} and [one.source_id for one in scene.objects] == [f"row {i}" for i in range(4)]
    for number, row in gdf.iterrows():
        volume = solid(scene, number)
        # Where a hole touches the outline, four triangles meet in an edge.
        assert volume.measures["closed"] == (row["name"] != "touching")
        assert volume.volume_m3 == pytest.approx(row.geometry.area * row.height, rel=1e-12)
        assert volume.footprint().area_m2 == pytest.approx(row.geometry.area, rel=1e-6)
        for share in (0, 0.5):
            assert volume.slice(z=share * row.height).to_shapely().symmetric_difference(row.geometry).area < 1e-9
    assert scene.georeference is None and scene.crs is None


@pytest.mark.parametrize("crs", [32618, 4326, 2263, 3857])
def test_the_crs_is_that_of_meshes(crs, tmp_path):
    """Corners are moved as those of a mesh with that CRS are; 2263 is in feet, 3857 is stretched."""
    local = shapely.box(EAST, NORTH, EAST + 20, NORTH + 10)
    gdf = table([local], height=[10.0]).to_crs(crs)
    scene = vt.Scene.from_geodataframe(gdf, ground=False)
    corners = np.asarray(gdf.geometry[0].exterior.coords)[:-1]
    (tmp_path / "mesh.obj").write_text("".join(f"v {x!r} {y!r} {z}\n" for x, y in corners.tolist() for z in (0, 10))
                                       + "f 1 3 5\nf 2 4 6\n")
    place = scene.georeference
    mesh = vt.Scene.from_mesh(tmp_path / "mesh.obj", crs=f"EPSG:{crs}", origin=(place.latitude_deg, place.longitude_deg))
    there = {tuple(corner) for corner in np.array(mesh.vertices).tolist()}
    assert {tuple(corner) for corner in np.array(scene.vertices).tolist()} <= there | {
        (x, y, z) for x, y, _ in there for z in (0.0, 10.0)}
    assert solid(scene, 0).volume_m3 == pytest.approx(20 * 10 * 10, rel=1e-3)
    assert place.source_crs == f"EPSG:{crs}" and place.vertical == "flat ground"
    assert abs(np.array(scene.vertices)[:, :2]).max() < 20  # about the middle of the data


def test_an_origin_that_is_given():
    gdf = table([shapely.box(EAST, NORTH, EAST + 20, NORTH + 10)], height=[10.0])
    scene = vt.Scene.from_geodataframe(gdf, origin=(40.7484, -73.9857), ground=False)
    assert scene.georeference[:2] == (40.7484, -73.9857)
    x, y = scene.position(40.7484, -73.9857)
    assert (x, y) == (0, 0)
    east, north = pyproj.Transformer.from_crs(32618, scene.crs, always_xy=True).transform(EAST, NORTH)
    assert np.allclose(np.array(scene.vertices)[:, :2].min(axis=0), [east, north], atol=0.3)
    # Without a CRS the coordinates are those of the frame about it.
    scene = vt.Scene.from_geodataframe(table([COURT], crs=None, height=[10.0]), origin=(40.7484, -73.9857))
    assert scene.georeference is not None and scene.georeference.source_crs == ""


def test_long_sides_do_not_shrink():
    """A side of 2 km along a parallel curves by decimetres in the frame: points of it are in the prism, or next to it."""
    gdf = table([shapely.box(10.0, 59.99, 10.036, 60.0)], crs=4326, height=[10.0])
    scene = vt.Scene.from_geodataframe(gdf, ground=False)
    assert solid(scene, 0).measures["closed"]
    outline = solid(scene, 0).footprint().to_shapely()
    for longitude in np.linspace(10.0001, 10.0359, 101):
        for latitude in (59.99, 60.0):
            assert outline.boundary.distance(shapely.Point(scene.position(latitude, longitude))) < 1e-4
    corners = [scene.position(60.0, longitude) for longitude in (10.0, 10.018, 10.036)]
    assert shapely.LineString([corners[0], corners[2]]).distance(shapely.Point(corners[1])) > 0.05  # it does curve


def test_bases_heights_ground_and_names():
    gdf = table([shapely.box(0, 0, 10, 10), shapely.box(20, 0, 30, 10)], crs=None, tall=[10.0, None], foot=[5, 7],
                label=["a", None])
    scene = vt.Scene.from_geodataframe(gdf, "tall", base="foot", default_height=3, name="label", kind="other", sea_level=-2)
    assert [tuple(one) for one in scene.objects] == [("a", "row 0", "other"), ("", "row 1", "other"), ("ground", "", "ground")]
    z = [np.array(scene.vertices)[np.unique(np.array(scene.faces)[np.array(scene.object_of) == i])][:, 2] for i in range(3)]
    assert [(one.min(), one.max()) for one in z] == [(5, 15), (7, 10), (5, 5)]
    assert scene.bounds[0][0] == -1000 and scene.bounds[1][0] == 1030
    assert vt.Scene.from_geodataframe(gdf, 4.0, ground=2.5).bounds[0][2] == 0
    assert vt.Scene.from_geodataframe(gdf, 4, base=1, ground=False).bounds[0][2] == 1
    result = vt.compute(vt.Scene.from_geodataframe(gdf, 4.0), [[2, -20, 0], [8, -20, 0], [8, -12, 0]], max_range=60)
    assert result.outcome == "computed" and "row 0" in {cause.name for cause in result.causes}


def test_rows_that_are_wrong_are_named():
    boxes = [shapely.box(0, 0, 10, 10), shapely.box(20, 0, 30, 10)]
    index = ["a", "b"]

    def rows(geometries, heights=(5.0, 5.0), crs=None):
        return geopandas.GeoDataFrame({"height": list(heights)}, geometry=geometries, crs=crs, index=index)

    bow = shapely.Polygon([(0, 0), (1, 1), (1, 0), (0, 1)])
    for geometry, code in ((None, "nothing-given"), (shapely.Polygon(), "nothing-given"), (shapely.Point(0, 0), "wrong-type"),
                           (shapely.LineString([(0, 0), (1, 1)]), "wrong-type"), (bow, "zone-not-simple")):
        error = refused(rows([boxes[0], geometry]))
        assert error.code == code and "row b" in error.problem and "geometry" in error.where, error
    for size, crs in ((1e-6, None), (1e-9, 4326)):  # degrees for metres, and what has no area in degrees
        error = refused(rows([shapely.box(11, 48, 11 + size, 48 + size)] * 2, crs=crs))
        assert error.code == "nothing-given" and ("set_crs" in error.fix) == (crs is None), error
    for height in (float("nan"), None, float("inf"), 0.0, -3.0):
        error = refused(rows(boxes, (5.0, height)))
        assert error.code == "value-out-of-range" and "row b" in error.problem and "height" in error.where, error
    assert "rows a, b" in refused(rows(boxes, (None, None))).problem
    raised = shapely.force_3d(boxes[0], 7)
    error = refused(rows([boxes[0], raised]))
    assert error.code == "not-applicable" and "base" in error.fix
    assert len(vt.Scene.from_geodataframe(rows([boxes[0], raised]), base=0).objects) == 3
    assert refused(rows(boxes), height="tall").code == "missing-key"
    assert refused(rows(boxes, ("high", "low"))).code == "not-a-number"
    assert refused(rows(boxes), kind="castle").code == "unknown-choice"
    assert refused(rows(boxes), name="nobody").code == "missing-key"
    assert refused(rows(boxes).iloc[:0]).code == "nothing-given"
    assert refused({"height": [1]}).code == "wrong-type"
    assert refused(geopandas.GeoDataFrame({"height": [1]})).code == "nothing-given"
    for option, value, code in (("height", None, "wrong-type"), ("height", True, "wrong-type"), ("height", [1, 2], "wrong-type"),
                                ("default_height", "x", "wrong-type"), ("ground", "yes", "wrong-type"),
                                ("ground", float("nan"), "value-out-of-range"), ("base", float("nan"), "value-out-of-range"),
                                ("origin", (1,), "array-sizes-differ"), ("origin", "here", "wrong-type"),
                                ("origin", (float("nan"), 1), "not-on-earth"), ("origin", (95, 1), "not-on-earth")):
        error = refused(rows(boxes), **{option: value})
        assert error.code == code and option in error.where, error
    pandas = pytest.importorskip("pandas")
    twice = pandas.concat([rows(boxes), rows(boxes)[["height"]]], axis=1)
    assert "several" in refused(twice).problem
    assert "row b" in refused(rows(boxes, (1, 2)).assign(height=pandas.array([1, None], dtype="Int64"))).problem
    tiny = shapely.box(500000, 5e6, 500000 + 1e-9, 5e6 + 1e-9)
    assert "row b" in refused(rows([shapely.box(500000, 5e6, 500010, 5000010), tiny], crs=32631)).problem
    assert refused(rows([shapely.box(0, 0, 1, 1), shapely.box(400000, 0, 400010, 10)], crs=4326)).code in (
        "not-on-earth", "too-far-away")
    assert refused(rows([boxes[0], shapely.box(0, 5e6, 10, 5000010)], crs=32631), origin=(45, 3)).code == "too-far-away"


def test_random_footprints_are_closed():
    rng = np.random.default_rng(seed := 20261123)
    shapes = []
    for _ in range(60):
        angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(5, 40)))
        outline = shapely.Polygon(np.column_stack([np.cos(angles), np.sin(angles)]) * rng.uniform(3, 30, len(angles))[:, None])
        hole = shapely.Point(rng.uniform(-5, 5, 2)).buffer(rng.uniform(0.5, 4), quad_segs=3)
        shapes += [one for one in shapely.get_parts((outline.buffer(0)).difference(hole)) if one.area > 1e-6]
    scene = vt.Scene.from_geodataframe(table(shapes, crs=None), 5.0, ground=False)
    for number, shape in enumerate(shapes):
        volume = solid(scene, number)
        assert volume.volume_m3 == pytest.approx(5 * shape.area, rel=1e-9), f"seed {seed}, {number}"
        assert volume.slice(z=1).area_m2 == pytest.approx(shape.area, rel=1e-9), f"seed {seed}, {number}"
