"""Fields of shares: equal to what points see, with the names that users of xarray expect, and on their way to files."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, SQUARE
from vantage._extras import advice

xarray = pytest.importorskip("xarray")
BOX = ((-60, -60, -4), (60, 60, 60))


@pytest.fixture(scope="module")
def field(scene):
    return vt.fraction_field(scene, SQUARE, BOX, 3)


def run(arguments, folder):
    """Another Python, with the package that is tested."""
    found = str(pathlib.Path(vt.__file__).absolute().parents[1])
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, cwd=folder,
                          env={**os.environ, "PYTHONPATH": found})


def places(field, step=1):
    z, y, x = np.meshgrid(field.z, field.y, field.x, indexing="ij")
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()])[::step]


def test_is_what_points_see(scene, field):
    shares = vt.Mission.of(scene, SQUARE, max_range=200).fraction(places(field))
    assert (field.values.ravel() == shares).all()
    assert (shares == 1).any() and (shares == 0).any() and ((shares > 0) & (shares < 1)).any()
    assert 0 < field.attrs["voxels_evaluated"] < 0.3 * field.size


def test_is_what_the_program_says(scene, field, tmp_path):
    scene.save(tmp_path / "yard.ply")
    (tmp_path / "mission.yaml").write_text(
        f"scene: {{mesh: yard.ply}}\ntarget: {{vertices: {SQUARE}}}\nsensor: {{max_range: 200}}\n")
    seed = 20261123
    print("seed", seed)
    points = np.random.default_rng(seed).permutation(places(field))[:10_000]
    (tmp_path / "points.csv").write_text("".join(f"{x!r},{y!r},{z!r}\n" for x, y, z in points.tolist()))
    told = run(["-m", "vantage", "query", "mission.yaml", "points.csv", "--fraction", "area"], tmp_path)
    assert told.returncode == 0, told.stderr
    by_program = np.array([float(line.rsplit(",", 1)[1]) for line in told.stdout.splitlines()[1:]])
    sought = field.sel(x=xarray.DataArray(points[:, 0]), y=xarray.DataArray(points[:, 1]), z=xarray.DataArray(points[:, 2]))
    assert len(by_program) == 10_000 and np.unique(by_program).size > 100
    assert (sought.values == by_program).all()


def test_names_and_units(field):
    assert field.dims == ("z", "y", "x") and field.name == "fraction" and field.dtype == np.float64
    assert field.shape == (22, 40, 40)
    assert field.x.values[0] == -58.5 and field.z.values[0] == -2.5
    for name in "xyz":
        assert field[name].attrs["units"] == "m" and field[name].attrs["axis"] == name.upper()
    assert field.z.attrs["positive"] == "up"
    assert field.attrs["units"] == "1" and field.attrs["measure"] == "area"
    assert field.vantage.low.tolist() == [-60, -60, -4] and field.vantage.high.tolist() == [60, 60, 62]


def test_reference_system(tmp_path):
    pyproj = pytest.importorskip("pyproj")
    corners = [[-9, -9, 0], [9, -9, 0], [0, 9, 0]]
    scene = vt.Scene.from_arrays(corners, [[0, 1, 2]], georeference=vt.Georeference(48.137, 11.575, "EGM96 geoid"))
    field = vt.fraction_field(scene, [[-1, -1, 2], [1, -1, 2], [0, 1, 2]], ((-3, -3, 0), (3, 3, 3)), 1)
    assert field.x.attrs["standard_name"] == "projection_x_coordinate"
    assert "EGM96 geoid" in field.z.attrs["long_name"]
    field.vantage.save(tmp_path / "field.nc")
    with xarray.open_dataset(tmp_path / "field.nc", decode_coords="all") as read:
        assert read.attrs["Conventions"] == "CF-1.11"
        assert read["fraction"].encoding["grid_mapping"] == "spatial_ref"
        crs = pyproj.CRS.from_cf(read["spatial_ref"].attrs)
    assert crs == pyproj.CRS.from_user_input(scene.crs)


@pytest.mark.parametrize("name", ["field.nc", "field.zarr"])
def test_files(field, tmp_path, name):
    path = tmp_path / name
    for _ in range(2):  # the second time in the place of the first
        field.vantage.save(path)
    with (xarray.open_zarr(path) if name.endswith("zarr") else xarray.open_dataset(path)) as read:
        xarray.testing.assert_equal(read["fraction"].drop_attrs(), field.drop_attrs())
        assert read["fraction"].attrs["scene_hash"] == field.attrs["scene_hash"]
        assert read["fraction"].vantage.contour(0.8).hash == field.vantage.contour(0.8).hash
    assert [one.name for one in tmp_path.iterdir()] == [name]


def test_xarrays_own_writers(field, tmp_path):
    field.to_netcdf(tmp_path / "a.nc")
    field.to_zarr(tmp_path / "a.zarr")
    with xarray.open_dataarray(tmp_path / "a.nc") as read:
        assert (read.values == field.values).all()


class Vdb:
    """Stands in for OpenVDB's module, which is no package of pip."""

    class GridClass:
        FOG_VOLUME = "fog"

    class FloatGrid:
        def copyFromArray(self, array):
            self.array = array

    def createLinearTransform(self, matrix):
        return np.array(matrix)

    def write(self, file, grids):
        self.grids = grids
        with open(file, "wb") as out:
            out.write(b"vdb")


def test_openvdb(field, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "openvdb", None)
    monkeypatch.setitem(sys.modules, "pyopenvdb", None)
    with pytest.raises(vt.Error) as raised:
        field.vantage.save(tmp_path / "a.vdb")
    assert raised.value.code == "component-missing" and "python3-openvdb" in raised.value.fix
    assert not list(tmp_path.iterdir())
    vdb = Vdb()
    monkeypatch.setitem(sys.modules, "openvdb", vdb)
    field.vantage.save(tmp_path / "a.vdb")
    grid = vdb.grids[0]
    i, j, k = 30, 11, 5
    assert grid.array[i, j, k] == np.float32(field.values[k, j, i])
    place = np.array([i, j, k, 1]) @ grid.transform
    assert place[:3].tolist() == [field.x.values[i], field.y.values[j], field.z.values[k]]


def test_contour_is_closed_and_holds_what_sees_enough(field):
    for level in (0.2, 0.8, 1.0):
        volume = field.vantage.contour(level)
        assert volume.measures["closed"] and volume.measures["oriented"] and volume.volume_m3 > 0
        assert volume.bounds[0].min() >= -60 and (volume.bounds[1] <= [60, 60, 62]).all()
        by_voxels = (field.values >= level).sum() * 27
        assert volume.volume_m3 == pytest.approx(by_voxels, rel=0.06)
    assert field.vantage.contour(0.8).volume_m3 < field.vantage.contour(0.2).volume_m3
    # All voxels of a full box: the box, but for its edges.
    full = field.copy(data=np.ones(field.shape)).vantage.contour(0.5)
    assert full.volume_m3 == pytest.approx(120 * 120 * 66, rel=0.01)
    assert np.abs(full.bounds - [[-60, -60, -4], [60, 60, 62]]).max() < 1e-3


def test_contour_refuses(field):
    for level, code in ((0, "value-out-of-range"), (1.5, "value-out-of-range"), (float("nan"), "value-out-of-range")):
        with pytest.raises(vt.Error) as raised:
            field.vantage.contour(level)
        assert raised.value.code == code and raised.value.where == "level"
    with pytest.raises(vt.Error) as raised:
        (field * 0.5).vantage.contour(0.8)
    assert raised.value.code == "region-empty"
    with pytest.raises(vt.Error) as raised:
        field.isel(z=0).vantage.contour(0.8)
    assert raised.value.where == "field"


def test_samples(scene, field):
    sampled = vt.fraction_field(scene, SQUARE, BOX, 3, samples=64, cubemap=256, device="cpu")
    errors = np.abs(sampled - field).values
    partly = (field.values > 0) & (field.values < 1)
    assert np.quantile(errors[partly], 0.95) < 1 / 8 and errors.mean() < 0.02
    assert sampled.attrs["samples"] == 64 and sampled.attrs["device"].startswith("CPU")
    assert ((sampled.values * 64) % 1 == 0).all()


def test_range_and_dtype(scene, field):
    near = vt.fraction_field(scene, SQUARE, BOX, 3, max_range=30, dtype="float32")
    assert near.dtype == np.float32 and near.attrs["max_range_m"] == 30
    points = places(field)
    farthest = np.linalg.norm(np.abs(points - [5, 5, 0]) + [5, 5, 0], axis=1).reshape(field.shape)
    within, beyond = farthest < 29.9, farthest > 30.1
    assert np.abs(near.values - field.values)[within].max() <= 1e-7
    assert (near.values[beyond] == 0).all() and (near.values[within] > 0).any()
    assert ((near.values == 1) == (field.values == 1))[within].all()


def test_threads(scene, field):
    assert (vt.fraction_field(scene, SQUARE, BOX, 3, threads=1).values == field.values).all()


@pytest.mark.parametrize("wanted, options", [("dividing space", {}), ("looking from voxels", {}),
                                            ("looking from samples", {"samples": 200})])
def test_every_stage_can_be_stopped(scene, wanted, options):
    for step in (0.75, 0.5, 0.35):  # Python is told of what takes 50 ms and more
        told = []
        try:
            vt.fraction_field(scene, SQUARE, BOX, step, device="cpu", threads=1, **options,
                              progress=lambda stage, part: told.append(stage) or stage != wanted)
        except vt.CancelledError as error:
            assert told[-1] == wanted and wanted in error.problem
            return
        assert wanted not in told, "it said no, and was not heard"
    pytest.fail(f"nothing was told of {wanted}, also on the finest grid")


@pytest.mark.parametrize("box, step, options, code, where", [
    (((0, 0), (1, 1)), 1, {}, "array-sizes-differ", "box"),
    (((0, 0, 0), (1, 1, float("nan"))), 1, {}, "coordinate-not-finite", "box"),
    (((0, 0, 0), (1, 0, 1)), 1, {}, "limits-reversed", "box"),
    (BOX, 0, {}, "value-out-of-range", "step"),
    (BOX, float("nan"), {}, "value-out-of-range", "step"),
    (BOX, 1e-4, {}, "value-out-of-range", "step"),
    (BOX, 9, {"measure": "weight"}, "unknown-choice", "measure"),
    (BOX, 9, {"dtype": "int8"}, "unknown-choice", "dtype"),
    (BOX, 9, {"samples": 0}, "value-out-of-range", "samples"),
    (BOX, 9, {"samples": 2.5}, "wrong-type", "samples"),
    (BOX, 9, {"samples": 70000}, "value-out-of-range", "samples"),
    (BOX, 9, {"samples": 4, "cubemap": 0}, "value-out-of-range", "cubemap"),
    (BOX, 9, {"samples": 4, "measure": "pixels"}, "not-applicable", "measure"),
    (BOX, 9, {"samples": 4, "device": "99"}, "device-missing", "device"),
    (BOX, 9, {"max_range": -3}, "value-out-of-range", "max_range"),
])
def test_refuses(scene, box, step, options, code, where):
    with pytest.raises(vt.Error) as raised:
        vt.fraction_field(scene, SQUARE, box, step, **options)
    assert raised.value.code == code and where in raised.value.where


def test_several_targets_are_refused(scene):
    with pytest.raises(vt.Error) as raised:
        vt.fraction_field(scene, [vt.Target(vertices=SQUARE), vt.Target(point=(0, 0, 9))], BOX, 9)
    assert raised.value.code == "not-applicable"


def test_bad_places(field, tmp_path):
    (tmp_path / "kept.zarr").mkdir()
    (tmp_path / "kept.zarr" / "mine").write_text("mine")
    (tmp_path / "others.zarr").mkdir()  # a store, but not of a field
    (tmp_path / "others.zarr" / ".zgroup").write_text('{"zarr_format": 2}')
    for name, code in (("a.txt", "output-format-unknown"), ("none/a.nc", "output-folder-missing"),
                       ("kept.zarr", "folder-in-use"), ("others.zarr", "folder-in-use")):
        with pytest.raises(vt.OutputError) as raised:
            field.vantage.save(tmp_path / name)
        assert raised.value.code == code
    assert (tmp_path / "kept.zarr" / "mine").read_text() == "mine"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["kept.zarr", "others.zarr"]
    assert (tmp_path / "others.zarr" / ".zgroup").exists()


def test_only_fields_that_vantage_wrote_are_replaced(field, tmp_path):
    """Not those of other programs that have a variable of that name, nor what somebody put into the folder."""
    path = tmp_path / "field.zarr"

    def refused():
        before = {file.relative_to(path): file.read_bytes() for file in path.rglob("*") if file.is_file()}
        with pytest.raises(vt.OutputError) as raised:
            field.vantage.save(path)
        assert raised.value.code == "folder-in-use"
        assert {file.relative_to(path): file.read_bytes() for file in path.rglob("*") if file.is_file()} == before

    cloud = xarray.DataArray(np.zeros((2, 3)), dims=("y", "x"), name="fraction").to_dataset()
    for format, attributes in ((2, {}), (3, {}), (2, {"Conventions": "CF-1.11", "source": "a model of clouds"}),
                               (3, {"Conventions": "CF-1.11"})):
        cloud.assign_attrs(attributes).to_zarr(path, mode="w", zarr_format=format)
        refused()
    field.to_dataset().assign_attrs(Conventions="CF-1.11").to_zarr(path, mode="w", zarr_format=2)
    field.vantage.save(path)  # as version 0.1 wrote them
    for name in ("notes.txt", "mine/notes.txt"):
        (path / name).parent.mkdir(exist_ok=True)
        (path / name).write_text("mine")
        refused()
        (path / name).unlink()
    (path / "mine").rmdir()
    field.vantage.save(path)
    own = xarray.DataArray(np.ones((2, 3, 4)), {name: np.arange(float(size)) for name, size in zip("zyx", (2, 3, 4))},
                           ("z", "y", "x"), attrs={"step_m": 1.0})
    for _ in range(2):
        own.vantage.save(tmp_path / "own.zarr")


def test_the_older_field_stays_where_the_new_one_cannot_take_its_place(field, tmp_path, monkeypatch):
    """Nor does it lie meanwhile where the next process removes it, if this one is killed."""
    from vantage import _folders, fields

    path = tmp_path / "field.zarr"
    field.vantage.save(path)
    before = {file.relative_to(path): file.read_bytes() for file in path.rglob("*") if file.is_file()}
    whole, seen = os.replace, []

    def failing(made, place):
        if str(place) != str(path):
            return whole(made, place)
        _folders.remove_all(_folders.BESIDE, tmp_path)  # what is left, whoever holds it
        seen.extend(one for one in tmp_path.rglob("fraction"))
        raise OSError("the disk is broken")

    monkeypatch.setattr(fields.os, "replace", failing)
    with pytest.raises(vt.OutputError):
        field.vantage.save(path)
    assert len(seen) == 1
    assert {file.relative_to(path): file.read_bytes() for file in path.rglob("*") if file.is_file()} == before
    assert [one.name for one in tmp_path.iterdir()] == ["field.zarr"]


def test_missing_extra_is_named():
    code = ("import sys; sys.modules['xarray'] = None\n"
            "import vantage as vt\n"
            "scene = vt.Scene.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])\n"
            "try: vt.fraction_field(scene, [[0, 0, 1], [1, 0, 1], [0, 1, 1]], ((0, 0, 0), (9, 9, 9)), 3)\n"
            "except vt.Error as error: print(error.code, error.fix)")
    told = run(["-c", code], PROJECT)
    assert told.stdout.strip() == f"component-missing {advice('fields')}", told.stderr


def test_import_does_not_need_xarray():
    code = "import sys, vantage; print('xarray' in sys.modules)"
    told = run(["-c", code], PROJECT)
    assert told.stdout.strip() == "False", told.stderr


def test_city(shared):
    scene = vt.Scene.from_mesh(shared / "mesh/munich_merged.ply")
    square = [[-5, -112, 0], [25, -112, 0], [22, -97, 0], [-8, -97, 0]]
    field = vt.fraction_field(scene, square, ((-90, -200, 0), (110, 0, 100)), 8)
    points = places(field, 3)
    assert (field.values.ravel()[::3] == vt.Mission.of(scene, square, max_range=500).fraction(points)).all()
    assert field.attrs["voxels_evaluated"] < field.size
