"""Tables of slices: GeoPackage and GeoParquet, read back by sqlite3 and pyarrow alone."""

import json
import sqlite3
import struct

import numpy as np
import pytest

import vantage as vt
from conftest import SQUARE, refused, yard

pytest.importorskip("geopandas")
parquet = pytest.importorskip("pyarrow.parquet")

HEIGHTS = [10.0, 20.0, 35.0]
CLOSED = 1e-9
"""Of areas, as a share: corners are written as they are."""


@pytest.fixture(scope="module")
def placed():
    scene = yard()
    scene = vt.Scene.from_arrays(scene.vertices, scene.faces, georeference=vt.Georeference(40.7484, -73.9857))
    return vt.compute(scene, SQUARE, max_range=60)


@pytest.fixture(scope="module")
def slices(placed):
    return [placed.slice(z=z) for z in HEIGHTS]


def polygons_of(wkb):
    """The rings of a MultiPolygon in ISO WKB, arrays of (n, 2) or (n, 3)."""
    at = 0

    def take(form):
        nonlocal at
        values = struct.unpack_from("<" + form, wkb, at)
        at += struct.calcsize("<" + form)
        return values

    def header():
        order, kind = take("BI")
        assert order == 1
        return kind

    width = {6: 2, 1006: 3, 0x80000006: 3}[header()]
    found = []
    for _ in range(take("I")[0]):
        assert header() in (3, 1003, 0x80000003)
        rings = []
        for _ in range(take("I")[0]):
            count, = take("I")
            rings.append(np.array(take(f"{count * width}d")).reshape(count, width))
        found.append(rings)
    assert at == len(wkb)
    return found


def area_of(polygons):
    """The rings close themselves; holes go out, however they turn."""
    def ring_area(ring):
        x, y = (ring[:, :2] - ring[0, :2]).T
        assert np.array_equal(ring[0], ring[-1])
        return abs(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1])) / 2

    return sum(ring_area(rings[0]) - sum(map(ring_area, rings[1:])) for rings in polygons)


def geopackage_rows(file):
    """(columns of the feature, its WKB) in order, and the CRS of the layer as (organisation, its number, definition)."""
    database = sqlite3.connect(file)
    database.row_factory = sqlite3.Row
    (table, column, z), = database.execute("select table_name, column_name, z from gpkg_geometry_columns").fetchall()
    crs = database.execute("select organization, organization_coordsys_id, definition from gpkg_spatial_ref_sys natural join "
                           "(select srs_id from gpkg_geometry_columns)").fetchone()
    rows = []
    for row in database.execute(f"select * from {table}"):
        blob = row[column]
        assert blob[:2] == b"GP"
        envelope = {0: 0, 1: 32, 2: 48, 3: 48, 4: 64}[blob[3] >> 1 & 7]
        rows.append((dict(row), blob[8 + envelope:]))
    database.close()
    return rows, tuple(crs), z


def check_rows(rows, slices):
    assert len(rows) == len(slices)
    for (row, wkb), one in zip(rows, slices):
        polygons = polygons_of(wkb)
        assert row["z_m"] == one.z_m and row["area_m2"] == one.area_m2
        assert area_of(polygons) == pytest.approx(one.area_m2, rel=CLOSED)
        assert all((ring[:, 2] == one.z_m).all() for rings in polygons for ring in rings)


def test_geopackage_has_a_row_for_each_height(slices, tmp_path):
    vt.write_slices(tmp_path / "a.gpkg", slices, names=["low", "middle", "high"])
    rows, crs, z = geopackage_rows(tmp_path / "a.gpkg")
    check_rows(rows, slices)
    assert [row["name"] for row, _ in rows] == ["low", "middle", "high"] and z in (1, 2)
    assert "40.7484" in crs[2]  # the scene's frame
    assert [file.name for file in tmp_path.iterdir()] == ["a.gpkg"]


def test_geoparquet_has_a_row_for_each_height(slices, tmp_path):
    vt.write_slices(tmp_path / "a.parquet", slices)
    table = parquet.read_table(tmp_path / "a.parquet")
    check_rows([(row, row["geometry"]) for row in table.to_pylist()], slices)
    geo = json.loads(table.schema.metadata[b"geo"])
    column = geo["columns"]["geometry"]
    assert (geo["version"], geo["primary_column"], column["encoding"]) == ("1.1.0", "geometry", "WKB")
    assert column["geometry_types"] == ["MultiPolygon Z"] and column["crs"]["type"] == "ProjectedCRS"
    corners = np.concatenate([ring for one in slices for rings in one.polygons for ring in rings])
    low, high = corners.min(axis=0), corners.max(axis=0)
    bounds = np.array(column["bbox"])
    assert np.allclose(bounds[:2], low, atol=1e-6) and np.allclose(bounds[len(bounds) // 2:][:2], high, atol=1e-6)


def test_degrees_are_longitude_before_latitude(slices, tmp_path):
    vt.write_slices(tmp_path / "a.gpkg", slices, crs="EPSG:4326")
    vt.write_slices(tmp_path / "a.parquet", slices, crs=4326)
    rows, crs, _ = geopackage_rows(tmp_path / "a.gpkg")
    table = parquet.read_table(tmp_path / "a.parquet")
    assert crs[:2] == ("EPSG", 4326)
    identifier = json.loads(table.schema.metadata[b"geo"])["columns"]["geometry"]["crs"]["id"]
    assert identifier in ({"authority": "EPSG", "code": 4326}, {"authority": "OGC", "code": "CRS84"})
    for wkb in [*(wkb for _, wkb in rows), *table.column("geometry").to_pylist()]:
        corner = polygons_of(wkb)[0][0][0]
        assert abs(corner[:2] - [-73.9857, 40.7484]).max() < 1e-3
    assert [row["area_m2"] for row, _ in rows] == [one.area_m2 for one in slices]


@pytest.mark.parametrize("longitude", [180, -179.9999, 179.9997])
def test_slices_across_the_antimeridian_are_in_one_piece(tmp_path, longitude):
    scene = yard()
    scene = vt.Scene.from_arrays(scene.vertices, scene.faces, georeference=vt.Georeference(-17, longitude))
    result = vt.compute(scene, SQUARE, max_range=60)
    both = [result.slice(z=10), result.slice(z=20)]
    for crs in (4326, "OGC:CRS84", "EPSG:4258", "EPSG:3460", 32701):  # two of them are projections
        vt.write_slices(tmp_path / "a.gpkg", both, crs=crs)
        vt.write_slices(tmp_path / "a.parquet", both, crs=crs)
        both[0].to_crs(crs).save(tmp_path / "b.gpkg")
        both[0].to_crs(crs).save(tmp_path / "b.parquet")
        of_files = [wkb for name in "ab" for _, wkb in geopackage_rows(tmp_path / f"{name}.gpkg")[0]]
        of_files += [row["geometry"] for name in "ab" for row in parquet.read_table(tmp_path / f"{name}.parquet").to_pylist()]
        assert len(of_files) == 6
        metres = 1 if crs in ("EPSG:3460", 32701) else 111_320 * np.cos(np.radians(17))
        for wkb in of_files:
            corners = np.concatenate([ring for rings in polygons_of(wkb) for ring in rings])
            assert 30 < np.ptp(corners[:, 0]) * metres < 140
    assert refused(lambda: vt.write_slices(tmp_path / "a.gpkg", both, crs=3857)).code == "crs-unusable"


def test_footprints_have_no_height(placed, tmp_path):
    footprint = placed.footprint()
    vt.write_slices(tmp_path / "a.gpkg", [footprint])
    footprint.save(tmp_path / "b.parquet")
    (row, wkb), = geopackage_rows(tmp_path / "a.gpkg")[0]
    assert row["z_m"] is None and polygons_of(wkb)[0][0].shape[1] == 2
    (other,) = parquet.read_table(tmp_path / "b.parquet").to_pylist()
    for one in (wkb, other["geometry"]):
        assert area_of(polygons_of(one)) == pytest.approx(footprint.area_m2, rel=CLOSED)


def test_empty_slices_are_rows_without_polygons(placed, tmp_path):
    vt.write_slices(tmp_path / "a.parquet", [placed.slice(z=500), placed.slice(z=20)])
    first, second = parquet.read_table(tmp_path / "a.parquet").to_pylist()
    assert first["area_m2"] == 0 and polygons_of(first["geometry"]) == []
    assert second["area_m2"] == placed.slice(z=20).area_m2


def test_a_scene_without_a_place_has_no_crs(result, tmp_path):
    vt.write_slices(tmp_path / "a.parquet", [result.slice(z=20)])
    geo = json.loads(parquet.read_schema(tmp_path / "a.parquet").metadata[b"geo"])
    assert geo["columns"]["geometry"]["crs"] is None


def test_what_cannot_be_written_costs_no_file(slices, placed, tmp_path):
    old = tmp_path / "a.gpkg"
    old.write_text("old")
    mixed = [slices[0], placed.footprint()]
    for call, code in ((lambda: vt.write_slices(old, []), "nothing-given"),
                       (lambda: vt.write_slices(old, mixed), "conflicting-keys"),
                       (lambda: vt.write_slices(old, [slices[0], slices[1].to_crs(32618)]), "conflicting-keys"),
                       (lambda: vt.write_slices(old, [5]), "wrong-type"),
                       (lambda: vt.write_slices(old, slices, names=["one"]), "array-sizes-differ")):
        assert refused(call).code == code
    for path, code in ((tmp_path / "a.shp", "output-format-unknown"), (tmp_path / "none" / "a.gpkg", "output-folder-missing")):
        with pytest.raises(vt.Error) as raised:
            vt.write_slices(path, slices)
        assert raised.value.code == code
    (tmp_path / "b.parquet").mkdir()
    with pytest.raises(vt.OutputError):
        vt.write_slices(tmp_path / "b.parquet", slices)
    assert old.read_text() == "old" and sorted(file.name for file in tmp_path.iterdir()) == ["a.gpkg", "b.parquet"]
