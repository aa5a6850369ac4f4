"""Clouds of points as solids; the files are written here."""

import numpy as np
import pytest

import vantage as vt
from conftest import refused

SEED = 20261129


def box_of_points(rng, low, high, count):
    return rng.uniform(low, high, (count, 3))


@pytest.mark.parametrize("scale", [1e-2, 1, 1e3])
@pytest.mark.parametrize("offset", [0, 5e5])
def test_all_points_lie_in_the_solid(scale, offset):
    rng = np.random.default_rng(SEED)
    points = box_of_points(rng, [-20, -5, 0], [10, 25, 9], 400) * scale + [offset, offset, 0]
    points[:40, :2] = np.floor(points[:40, :2] / scale) * scale  # on the borders of cells
    scene = vt.Scene.from_points(points, cell_m=scale)
    solid = vt.Volume.from_arrays(scene.vertices, scene.faces)
    assert solid.contains(points).all(), SEED
    assert solid.volume_m3 > 0
    below = np.column_stack([points[:, :2], rng.uniform(points[:, 2].min() - 0.9, points[:, 2])])
    assert solid.contains(below).all(), SEED
    low, high = scene.bounds
    assert (low[:2] >= points[:, :2].min(axis=0) - 1.001 * scale).all() and high[2] == points[:, 2].max()


def test_cells_without_points_are_as_high_as_those_beside_them():
    points = [[x + 0.5, y + 0.5, 3.0 if x < 2 else 8.0] for x in range(10) for y in range(10) if not (3 < x < 7 and 3 < y < 7)]
    scene = vt.Scene.from_points(points, cell_m=1)
    assert vt.Volume.from_arrays(scene.vertices, scene.faces).contains([[5.5, 5.5, 8.0], [5.5, 5.5, 2.1]]).all()


@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (37, 1), (2, 50), (23, 31), (64, 33)])
def test_cells_far_from_points_are_filled_step_by_step(shape):
    rng = np.random.default_rng(SEED)
    for share in (0, 0.01, 0.1, 0.6):
        y, x = np.nonzero(rng.random(shape) < share)
        y, x = np.append(y, [0, shape[0] - 1]), np.append(x, [0, shape[1] - 1])  # so that the grid has that shape
        z = rng.integers(0, 9, len(y)).astype(float)
        scene = vt.Scene.from_points(np.column_stack([x + 0.5, y + 0.5, z]), cell_m=1)
        heights = np.full(shape, -np.inf)
        np.maximum.at(heights, (y, x), z)
        while np.isneginf(heights).any():
            around = np.pad(heights, 1, constant_values=-np.inf)
            highest = np.maximum.reduce([around[i:i + shape[0], j:j + shape[1]] for i in range(3) for j in range(3)])
            heights = np.where(np.isneginf(heights), highest, heights)
        around = np.pad(heights, 1, constant_values=-np.inf)
        tops = np.maximum.reduce([around[i:i + shape[0] + 1, j:j + shape[1] + 1] for i in range(2) for j in range(2)])
        found = np.full(tops.shape, -np.inf)
        at = scene.vertices[:, :2].astype(int)
        is_corner = (scene.vertices[:, :2] == at).all(axis=1) & (scene.vertices[:, 2] >= 0)
        np.maximum.at(found, (at[is_corner, 1], at[is_corner, 0]), scene.vertices[is_corner, 2])
        assert np.array_equal(found, tops), (SEED, share)


def test_a_long_row_of_cells_without_points_takes_seconds():
    scene = vt.Scene.from_points([[0.5, 0.5, 1], [399_999.5, 0.5, 3]], cell_m=1)
    high = scene.vertices[scene.vertices[:, 2] == 3]
    assert high[:, 0].min() == 200_000 and high[:, 0].max() == 400_000


def test_it_hides_as_much_as_a_wall_of_points():
    rng = np.random.default_rng(SEED)
    ground = box_of_points(rng, [-30, -30, 0], [30, 30, 0.001], 20000)
    wall = box_of_points(rng, [-2, -30, 0], [-1, 30, 12], 20000)
    scene = vt.Scene.from_points(np.concatenate([ground, wall]), cell_m=1)
    mission = vt.Mission.of(scene, [[8, -2, 1], [12, -2, 1], [12, 2, 1], [8, 2, 1]], max_range=60)
    answers = mission.query([[10, 0, 20], [-20, 0, 5], [5, 0, 5]])
    assert answers.inside.tolist() == [True, False, True] and answers.blocked_by[1] == ["points"]
    assert mission.run().prove()["verdict"] == "proved"


def test_targets_in_the_solid_are_seen_from_inside_alone():
    rng = np.random.default_rng(SEED)
    scene = vt.Scene.from_points(box_of_points(rng, [-30, -30, 0], [30, 30, 5], 20000), cell_m=1)
    result = vt.compute(scene, [[0, 0, 2], [3, 0, 2], [3, 3, 2]], max_range=20)
    assert "target-inside" in [note.code for note in result.notes], result.notes
    solid = vt.Volume.from_arrays(scene.vertices, scene.faces)
    assert solid.contains(result.vertices - [0, 0, 1e-6]).all()  # and no position outside


def test_what_is_no_cloud_is_refused():
    for call, code in ((lambda: vt.Scene.from_points(np.zeros((0, 3))), "nothing-given"),
                       (lambda: vt.Scene.from_points([[0, 0, 0], [1e8, 1e8, 0]], cell_m=1), "mesh-too-large"),
                       (lambda: vt.Scene.from_points([[0, 0, 0], [2e9, 0, 0]], cell_m=1e5), "coordinate-too-large"),
                       (lambda: vt.Scene.from_points([[0, 0, 0]], cell_m=0), "value-out-of-range"),
                       (lambda: vt.Scene.from_points([[0, 0, 0]], cell_m=float("nan")), None),
                       (lambda: vt.Scene.from_points([[0, 0, float("inf")]]), None)):
        error = refused(call)
        assert code is None or error.code == code


def cloud_file(file, points, classes=None, crs=None):
    laspy = pytest.importorskip("laspy", reason="the extra `laz` is not installed")
    pytest.importorskip("lazrs", reason="the extra `laz` is not installed")
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [0.001] * 3, np.floor(np.min(points, axis=0))
    if crs is not None:
        header.add_crs(pytest.importorskip("pyproj").CRS(crs))
    data = laspy.LasData(header)
    data.x, data.y, data.z = np.array(points).T
    if classes is not None:
        data.classification = np.array(classes, np.uint8)
    data.write(file)
    return file


@pytest.mark.parametrize("ending", ["las", "laz"])
def test_files_are_the_solids_of_their_points(tmp_path, ending):
    points = np.round(box_of_points(np.random.default_rng(SEED), [0, 0, 0], [20, 20, 9], 500), 3)
    scene = vt.Scene.from_laz(cloud_file(tmp_path / f"a.{ending}", points), cell_m=2)
    same = vt.Scene.from_points(points, cell_m=2)
    assert scene.georeference is None and np.allclose(scene.vertices, same.vertices, atol=1e-6)


def test_classes_can_be_left_out(tmp_path):
    file = cloud_file(tmp_path / "a.laz", [[0.5, 0.5, 1], [1.5, 1.5, 2], [0.5, 0.5, 500]], [2, 6, 7])
    assert vt.Scene.from_laz(file).bounds[1, 2] == pytest.approx(500)
    scene = vt.Scene.from_laz(file, without=(7, 18))
    assert scene.bounds[1, 2] == pytest.approx(2)
    (_, what, _, box, *_), = scene._core.ledger_rows
    assert what == "points of the classes 7, 18: 1" and box[5] > 2
    assert refused(lambda: vt.Scene.from_laz(file, without=(2, 6, 7))).code == "nothing-given"
    refused(lambda: vt.Scene.from_laz(file, without=(300,)))


def test_the_crs_of_a_file_places_it(tmp_path):
    points = np.round(box_of_points(np.random.default_rng(SEED), [5e5, 5e6, 300], [500040, 5000040, 320], 500), 3)
    for scene in (vt.Scene.from_laz(cloud_file(tmp_path / "a.laz", points, crs=32632)),
                  vt.Scene.from_laz(cloud_file(tmp_path / "b.laz", points), crs="EPSG:32632")):
        place = scene.georeference
        assert place.source_crs == "EPSG:32632" and place.longitude_deg == pytest.approx(9, abs=1e-3)
        assert abs(scene.bounds[:, :2].mean(axis=0)).max() < 1.5 and scene.bounds[1, 2] == pytest.approx(points[:, 2].max())


def test_feet_are_not_taken_for_metres(tmp_path):
    points = np.round(box_of_points(np.random.default_rng(SEED), [6.36e5, 8.49e5, 400], [636100, 849100, 420], 500), 3)
    file = cloud_file(tmp_path / "a.laz", points, crs=2994)  # Oregon, in feet
    assert refused(lambda: vt.Scene.from_laz(file)).code == "height-unknown"
    scene = vt.Scene.from_laz(file, z_unit_m=0.3048)
    assert scene.bounds[1, 2] == pytest.approx(0.3048 * points[:, 2].max()) and np.ptp(scene.vertices[:, 0]) < 33
    with_heights = vt.Scene.from_laz(file, crs="EPSG:2994+6360")
    assert with_heights.bounds[1, 2] == pytest.approx(1200 / 3937 * points[:, 2].max())


def file_of_keys(file, keys, doubles=(), crs=None):
    """A file with GeoTIFF keys, (number, where its value is, value), and, with `crs`, WKT."""
    known = pytest.importorskip("laspy.vlrs.known")
    points = np.round(box_of_points(np.random.default_rng(SEED), [6.36e5, 8.49e5, 400], [636100, 849100, 420], 50), 3)
    laspy = pytest.importorskip("laspy")
    cloud_file(file, points, crs=crs)
    data = laspy.read(file)
    directory = known.GeoKeyDirectoryVlr()
    directory.geo_keys_header.number_of_keys = len(keys)
    directory.geo_keys = [known.GeoKeyEntryStruct(id=number, tiff_tag_location=where, count=1, value_offset=value)
                          for number, where, value in keys]
    values = known.GeoDoubleParamsVlr()
    values.parse_record_data(np.array(doubles, "<f8").tobytes())
    data.header.vlrs += [directory, values]
    data.write(file)
    return file, points[:, 2].max()


OREGON, UTM = (3072, 0, 2994), (3072, 0, 32610)  # feet; metres
US_FOOT_M = 1200 / 3937


@pytest.mark.parametrize("keys, z_unit_m", [
    ([UTM], 1), ([UTM, (3076, 0, 9001)], 1), ([UTM, (4099, 0, 9003)], US_FOOT_M), ([UTM, (4099, 0, 9002)], 0.3048),
    ([UTM, (4096, 0, 6360)], US_FOOT_M), ([UTM, (4096, 0, 6360), (4099, 0, 9003)], US_FOOT_M), ([UTM, (4096, 0, 5703)], 1),
    ([UTM, (4096, 0, 5103), (4099, 0, 9001)], 1),  # a number of GeoTIFF 1.0
    ([OREGON, (3076, 0, 9002), (4099, 0, 9001)], 1), ([OREGON, (3076, 0, 32767), (3077, 34736, 0), (4099, 0, 9002)], 0.3048)])
def test_units_in_geotiff_keys_count(tmp_path, keys, z_unit_m):
    file, highest = file_of_keys(tmp_path / "a.las", keys, doubles=[0.3048])
    assert vt.Scene.from_laz(file, cell_m=10).bounds[1, 2] == pytest.approx(z_unit_m * highest, rel=1e-9)


@pytest.mark.parametrize("keys, code", [
    ([UTM, (3076, 0, 9003)], "crs-missing"),  # the CRS has metres
    ([UTM, (3076, 0, 9002)], "crs-missing"), ([OREGON, (3076, 0, 9003), (4099, 0, 9003)], "crs-missing"),
    ([UTM, (3076, 0, 32767), (3077, 34736, 0)], "crs-missing"), ([UTM, (3076, 0, 1)], "value-unsupported"),
    ([UTM, (4096, 0, 5703), (4099, 0, 9003)], "height-unknown"), ([UTM, (4099, 0, 32767)], "value-unsupported"),
    ([OREGON], "height-unknown"), ([(3072, 0, 32767)], "crs-missing"), ([(1024, 0, 1)], "crs-missing"),
    ([(1024, 0, 1), (2048, 0, 4326)], "crs-missing"),  # a projection that is not named
    ([(3072, 0, 32767), (2048, 0, 4326)], "crs-missing"), ([(3076, 0, 9003)], "crs-missing"), ([(3072, 0, 1100)], "crs-unknown")])
def test_units_and_crs_that_are_not_clear_are_refused(tmp_path, keys, code):
    file, highest = file_of_keys(tmp_path / "a.las", keys, doubles=[0.3048])
    assert refused(lambda: vt.Scene.from_laz(file, cell_m=10)).code == code
    said = vt.Scene.from_laz(file, cell_m=10, crs="EPSG:2994", z_unit_m=0.3048)  # what is given counts
    assert said.bounds[1, 2] == pytest.approx(0.3048 * highest, rel=1e-9)


def test_the_vertical_axis_of_wkt_and_keys_must_agree(tmp_path):
    file, highest = file_of_keys(tmp_path / "a.las", [(4099, 0, 9001)], crs="EPSG:2994+6360")
    assert refused(lambda: vt.Scene.from_laz(file, cell_m=10)).code == "height-unknown"
    assert vt.Scene.from_laz(file, cell_m=10, crs="EPSG:2994+6360").bounds[1, 2] == pytest.approx(US_FOOT_M * highest, rel=1e-9)


def test_keys_that_say_nothing_of_the_coordinates_are_no_crs(tmp_path):
    for keys in ([], [(1025, 0, 1)], [(1024, 0, 0)]):
        assert vt.Scene.from_laz(file_of_keys(tmp_path / "a.las", keys)[0], cell_m=10).georeference is None


def test_files_that_are_cut_short_are_refused(tmp_path):
    points = box_of_points(np.random.default_rng(SEED), [0, 0, 0], [20, 20, 9], 5000)
    whole = cloud_file(tmp_path / "a.laz", points).read_bytes()
    cut = tmp_path / "cut.laz"
    for length in (0, 4, 100, 300, len(whole) // 2, len(whole) - 1):
        cut.write_bytes(whole[:length])
        refused(lambda: vt.Scene.from_laz(cut))
    for at in (100, 243):  # records of variable length that are not there: thousands of millions of them
        cut.write_bytes(whole[:at] + b"\xff\xff\xff\xff" + whole[at + 4:])
        assert refused(lambda: vt.Scene.from_laz(cut)).code == "record-garbled"
    assert refused(lambda: vt.Scene.from_laz(tmp_path / "none.laz")).code == "file-not-found"
