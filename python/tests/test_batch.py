"""Batches: one row a target, whatever happens to the run."""

import contextlib
import io
import json
import os
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, box

pytest.importorskip("pyarrow")
pytest.importorskip("geopandas")

import pyarrow.parquet  # noqa: E402

import vantage.batch as batch  # noqa: E402
from vantage.batch import _parquet, _rows, _table  # noqa: E402

PIERCED = [[25, 0, -5], [25, 1, -5], [25, 0, 5]]
PLAZA = PROJECT / "examples" / "plaza" / "plaza.obj"


def triangles(count=9):
    """Targets beside the tower of the yard, and one that the ground passes through."""
    rows = [{"id": i, "vertices": [[x, y, 0], [x + 9, y, 0], [x + 9, y + 7, 0]]}
            for i, (x, y) in enumerate((-60 + 30 * (k // 3), -60 + 60 * (k % 3)) for k in range(count))]
    return rows + [{"id": 100, "vertices": PIERCED, "name": "through the ground"}]


def without_time(report_or_folder):
    folder = getattr(report_or_folder, "output", report_or_folder)
    table = pyarrow.parquet.read_table(f"{folder}/results.parquet")
    return table.drop_columns(list(_rows.TIME_COLUMNS))


@pytest.fixture(scope="module")
def whole(scene, tmp_path_factory):
    """A run to its end."""
    return batch.run(triangles(), scene, tmp_path_factory.mktemp("whole"), max_range=60, shard_rows=3, volumes="ply",
                     workers=2)


def test_one_row_a_target(scene, whole):
    table = whole.table()
    assert table["id"].tolist() == [*range(9), 100]
    assert whole.rows == 10 and whole.computed == 10 and whole.errors == 1 and whole.deaths == 0
    alone = vt.compute(scene, triangles()[7]["vertices"], max_range=60)
    row = table.iloc[7]
    assert row["outcome"] == "computed" and row["volume_m3"] == alone.volume_m3 and row["area_m2"] == alone.area_m2
    assert row["volume_hash"] == alone.volume.hash and row["mission_hash"] == alone.mission.hash
    causes = {cause["name"]: cause for cause in row["causes"]}
    assert set(causes) == {"max_range", "target plane", "tower"}
    assert sum(cause["share"] for cause in causes.values()) == pytest.approx(1)
    assert row["geometry"].area == pytest.approx(9 * 7 / 2)
    volume = vt.Volume.read(f"{whole.output}/{row['volume_file']}")
    assert volume.hash == alone.volume.hash and volume.prove(scene)["verdict"] == "proved"
    held = sum(worker.rows for worker in whole.workers.values())
    assert held == 10 and all(worker.peak_mib > 10 for worker in whole.workers.values())


def test_one_that_is_wrong_stops_no_other(whole):
    row = whole.table().iloc[9]
    assert row["outcome"] == "error" and row["error_code"] == "target-pierced" and row["error_kind"] == "input"
    assert row["name"] == "through the ground" and "ground" in row["error_problem"] and row["error_fix"]
    assert np.isnan(row["volume_m3"])


def test_order_and_workers_show_nowhere(scene, whole, tmp_path):
    again = batch.run(triangles()[::-1], scene, tmp_path, max_range=60, shard_rows=4, volumes="ply", workers=1)
    assert again.result_hash == whole.result_hash
    assert without_time(again).drop_columns(["volume_file"]).equals(without_time(whole).drop_columns(["volume_file"]))


def test_goes_on_where_it_was(scene, whole, tmp_path):
    def stop(stage, fraction):
        return fraction < 0.3

    with pytest.raises(vt.CancelledError) as raised:
        batch.run(triangles(), scene, tmp_path, max_range=60, shard_rows=3, volumes="ply", workers=1, progress=stop)
    assert "run it again" in raised.value.fix
    written = sorted(path.name for path in (tmp_path / "rows").glob("*.parquet"))
    assert 0 < len(written) < 4 and not (tmp_path / "results.parquet").exists()
    first = (tmp_path / "rows" / written[0]).read_bytes()
    (tmp_path / "rows" / written[-1]).write_bytes(first[:100])  # as a disk leaves it that loses power
    again = batch.run(triangles(), scene, tmp_path, max_range=60, shard_rows=5, volumes="ply", workers=1)
    assert 0 < again.computed <= 10 and again.errors == 1 and again.result_hash == whole.result_hash
    assert without_time(again).equals(without_time(whole))
    for path in sorted((tmp_path / "volumes").rglob("*.ply")):
        assert path.read_bytes() == (type(path)(whole.output) / path.relative_to(tmp_path)).read_bytes()
    ready = batch.run(triangles(), scene, tmp_path, max_range=60, volumes="ply")
    assert ready.computed == 0 and ready.workers == {} and without_time(ready).equals(without_time(whole))


def test_a_worker_that_dies(scene, whole, tmp_path, monkeypatch):
    marker = tmp_path / "died"
    monkeypatch.setenv("VANTAGE_BATCH_KILL", f"4:{marker}")
    report = batch.run(triangles(), scene, tmp_path / "out", max_range=60, shard_rows=3, volumes="ply", workers=2)
    assert marker.exists() and report.deaths == 1
    assert without_time(report).equals(without_time(whole)), "nothing lost, nothing twice"


def test_a_target_that_kills_workers(scene, whole, tmp_path, monkeypatch):
    monkeypatch.setenv("VANTAGE_BATCH_KILL", "4")
    report = batch.run(triangles(), scene, tmp_path, max_range=60, shard_rows=3, attempts=2, workers=2)
    table, right = report.table(), whole.table()
    assert report.errors == 2 and report.deaths == 4 and report.computed == 10
    assert table["error_code"][4] == "internal-defect" and "2 times" in table["error_problem"][4]
    others = [i for i in range(10) if i != 4]
    assert table["volume_hash"][others].equals(right["volume_hash"][others])


def test_workers_that_never_live_end_the_run(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(vt.Error) as raised:
        batch.run(triangles(), scene, tmp_path, max_range=60, shard_rows=3, workers=1, attempts=1)
    assert raised.value.kind == "internal" and "ends its workers" in raised.value.problem
    assert not (tmp_path / "rows").exists()


def test_workers_that_die_one_after_the_other():
    from vantage.batch._pool import LostTask
    from vantage.batch._queue import Queue
    from vantage.batch._work import Task

    class Team:
        shares_workers = False
        given = []

        def room(self):
            return 100 - len(self.given)

        def busy(self):
            return len(self.given)

        give = given.append

        def ended(self, timeout_s):
            ended, self.given[:] = [LostTask(task) for task in self.given], []
            return ended

    rows = _table.read(triangles()).rows
    with pytest.raises(vt.Error) as raised:
        Queue([Task(number, rows) for number in range(50)], 3).run(Team(), print, lambda: None)
    assert "21 workers died one after the other" in raised.value.problem


def test_volumes_as_zarr(scene, tmp_path):
    zarr = pytest.importorskip("zarr")
    report = batch.run(triangles(3), scene, tmp_path / "a", max_range=60, volumes="zarr", workers=1)
    name = report.table()["volume_file"][0]
    group = zarr.open_group(zarr.storage.ZipStore(f"{report.output}/{name}", mode="r"), mode="r")
    assert group.attrs["ids"] == ["0", "1", "2"]
    alone = vt.compute(scene, triangles()[1]["vertices"], max_range=60)
    vertices, faces = group["first_vertex"][:], group["first_face"][:]
    assert np.array_equal(group["vertices"][vertices[1]:vertices[2]], alone.vertices)
    assert np.array_equal(group["faces"][faces[1]:faces[2]], alone.faces)
    assert np.array_equal(group["cause_of"][faces[1]:faces[2]], alone.cause_of)
    assert group.attrs["volume_hash"][1] == alone.volume.hash
    batch.run(triangles(3), scene, tmp_path / "b", max_range=60, volumes="zarr", workers=1)
    assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    assert zipfile.ZipFile(tmp_path / "a" / name).testzip() is None


def test_workers_know_what_the_scene_lacks(scene, tmp_path):
    from vantage.batch import _scenes

    lack = (("crane", "node/1", 1), "man_made=crane", "nothing tells how wide it is", [-40, -60, 0, -38, -58, 40], 40.0, None, "",
            False, [])
    known = vt.Scene.from_arrays(scene.vertices, scene.faces, object_of=scene.object_of, objects=scene.objects,
                                 attribution="\u00a9 somebody", _ledger=[lack])
    copy = _scenes._of_bytes(_scenes.to_bytes(known), "")
    assert copy.ledger == known.ledger and copy.ledger and copy.attribution == known.attribution
    report = batch.run(triangles(1), known, tmp_path, max_range=60, workers=1)
    assert "scene-incomplete" in report.table().iloc[0]["notes"]
    assert known.hash == scene.hash
    error = refused(triangles(1), scene, tmp_path, max_range=60, workers=1)
    assert error.code == "folder-in-use" and "ledger" in error.problem


# ---- results of something else


def refused(*arguments, **options):
    with pytest.raises(vt.Error) as raised:
        batch.run(*arguments, **options)
    return raised.value


def test_results_of_something_else(scene, tmp_path):
    asked = {"max_range": 60, "shard_rows": 2, "workers": 1}
    batch.run(triangles(1), scene, tmp_path, **asked)
    before = (tmp_path / "results.parquet").read_bytes()
    other = vt.Scene.from_arrays(np.array(scene.vertices) + [0, 0, 1], scene.faces)
    for error, said in ((refused(triangles(1), other, tmp_path, **asked), "another scene"),
                        (refused(triangles(2), scene, tmp_path, **asked), "other targets"),
                        (refused(triangles(1), scene, tmp_path, **{**asked, "max_range": 61}), "another sensor"),
                        (refused(triangles(1), scene, tmp_path, **asked, volumes="ply"), "another choice")):
        assert error.code == "folder-in-use" and said in error.problem and error.fix
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    assert manifest["scene_hash"] == scene.hash and manifest["version"] == vt.__version__
    (tmp_path / "manifest.json").write_text(json.dumps({**manifest, "version": "0.0.1"}))
    error = refused(triangles(1), scene, tmp_path, **asked)
    assert error.code == "folder-in-use" and "another version" in error.problem and "0.0.1" in error.problem
    (tmp_path / "manifest.json").unlink()
    assert refused(triangles(1), scene, tmp_path, **asked).code == "folder-in-use"
    (tmp_path / "manifest.json").write_text("{}")
    assert refused(triangles(1), scene, tmp_path, **asked).code == "folder-in-use"
    assert (tmp_path / "results.parquet").read_bytes() == before


def test_meshes_to_stay_in_count_by_their_content(scene, tmp_path):
    from vantage.batch import _manifest

    def volume(height):
        return vt.Volume.from_arrays(*box((-90, -90, -1), (90, 90, height)))

    path = tmp_path / "box.ply"
    volume(50).save(path)
    for number, (meshes, later) in enumerate((([str(path)], [str(path)]), ([path], [path]), ([{"mesh": path}], [{"mesh": path}]),
                                              ([volume(50)], [volume(30)]))):
        for kind in (dict, vt.Navigation):
            volume(50).save(path)
            asked = {"max_range": 60, "workers": 1}
            folder = tmp_path / f"{kind.__name__}-{number}"
            batch.run(triangles(1), scene, folder, **asked, navigation=kind(meshes=meshes))
            batch.run(triangles(1), scene, folder, **asked, navigation=kind(meshes=meshes))
            volume(30).save(path)
            error = refused(triangles(1), scene, folder, **asked, navigation=kind(meshes=later))
            assert error.code == "folder-in-use" and "other limits" in error.problem
        assert _manifest._plain({"meshes": meshes}) == _manifest._plain(vt.Navigation(meshes=meshes))
    assert _manifest._plain({"meshes": None}) == {"meshes": None}
    result = vt.compute(scene, triangles(1)[0]["vertices"], max_range=60)
    assert _manifest._plain({"meshes": [result]}) == _manifest._plain({"meshes": [result.volume]})
    for meshes in ("box.ply", [3], 3):
        assert refused(triangles(1), scene, tmp_path / "wrong", **asked, navigation={"meshes": meshes}).code == "wrong-type"


def test_rows_of_another_run(scene, tmp_path):
    asked = {"max_range": 60, "workers": 1}
    batch.run(triangles(1), scene, tmp_path / "a", **asked)
    batch.run(triangles(2), scene, tmp_path / "b", **asked)
    for name in ("000000.parquet", "000000.json"):
        (tmp_path / "a" / "rows" / name).write_bytes((tmp_path / "b" / "rows" / name).read_bytes())
    assert refused(triangles(1), scene, tmp_path / "a", **asked).code == "folder-in-use"


def test_a_scene_that_changes(tmp_path):
    from vantage.batch import _scenes
    from vantage.batch._store import Store

    with pytest.raises(vt.Error) as raised:
        _scenes.kept({"mesh": str(PLAZA)}, "0" * 64, Store(tmp_path))
    assert raised.value.code == "file-changed"


# ---- bad input


def test_ids(scene, tmp_path):
    rows = triangles(2)
    error = refused([*rows, rows[1], rows[0]], scene, tmp_path, max_range=60)
    assert error.code == "duplicate-key" and "0, 1" in error.problem
    assert refused([{"vertices": PIERCED}], scene, tmp_path, max_range=60).code == "missing-key"
    assert refused([*rows, {"id": "a", "vertices": PIERCED}], scene, tmp_path, max_range=60).code == "wrong-type"
    assert refused([{"id": 1.5, "vertices": PIERCED}], scene, tmp_path, max_range=60).code == "wrong-type"
    assert not (tmp_path / "rows").exists()


def test_tables_without_targets(scene, tmp_path):
    error = refused([{"id": 1, "height": 3}], scene, tmp_path, max_range=60)
    assert error.code == "missing-key" and "geometry" in error.fix
    assert refused([], scene, tmp_path, max_range=60).code == "nothing-given"
    assert refused(7, scene, tmp_path, max_range=60).code == "wrong-type"
    assert refused([7], scene, tmp_path, max_range=60).where == "targets[0]"
    assert refused(tmp_path / "none.parquet", scene, tmp_path, max_range=60).code == "file-not-found"
    for name, content in (("a.csv", b"id"), ("b.parquet", b"PAR1"), ("c.geojson", b"[1]"), ("d.geojson", b"{")):
        (tmp_path / name).write_bytes(content)
        assert refused(tmp_path / name, scene, tmp_path / "out", max_range=60).code == "table-syntax", name


def test_what_is_wrong_for_all_targets_stops_the_run(scene, tmp_path):
    assert refused(triangles(), scene, tmp_path).code == "missing-key"
    assert refused(triangles(), scene, tmp_path, sensor=vt.Sensor(max_range=60, incidence=95)).where == "sensor.incidence"
    error = refused(triangles(), scene, tmp_path, max_range=60, navigation=vt.Navigation(altitude=(20, 10)))
    assert error.where == "navigation['altitude']"
    for options in ({"volumes": "obj"}, {"workers": -1}, {"shard_rows": 0}, {"attempts": 1.5}):
        assert refused(triangles(), scene, tmp_path, max_range=60, **options).where in options
    assert refused(triangles(), "none.obj", tmp_path, max_range=60).code == "file-not-found"
    assert refused(triangles(), {"mesh": PLAZA, "upp": "y"}, tmp_path, max_range=60).code == "unknown-key"
    assert refused(triangles(), {"up": "y"}, tmp_path, max_range=60).code == "missing-key"
    assert list(tmp_path.iterdir()) == []


def test_rows_that_say_too_little_or_too_much(scene, tmp_path):
    rows = [*triangles(1), {"id": 1}, {"id": 2, "vertices": PIERCED, "point": [0, 0, 5]},
            {"id": 3, "center": [48, 11], "width": 3, "length": 4}, {"id": 4, "object": "none", "part": "roof"}]
    codes = batch.run(rows, scene, tmp_path, max_range=60, workers=1).table()["error_code"].tolist()
    assert codes[1:5] == ["missing-key", "conflicting-keys", "not-georeferenced", "object-missing"]


@pytest.mark.parametrize("volumes, bytes_of_a_file, advice", [(None, 5_000, "make room"), ("ply", 20_000, "run it again")])
def test_a_full_disk(tmp_path, volumes, bytes_of_a_file, advice):
    """A limit to the size of files stands for the disk: what cannot be written is one clear error, and nothing is left
    half-written."""
    code = f"""
import resource, sys
sys.path.insert(0, {str(PROJECT / 'python' / 'tests')!r})
import vantage as vt, vantage.batch
from conftest import yard
from test_batch import triangles
resource.setrlimit(resource.RLIMIT_FSIZE, ({bytes_of_a_file}, {bytes_of_a_file}))
try:
    vantage.batch.run(triangles(), yard(), {str(tmp_path)!r}, max_range=60, volumes={volumes!r}, workers=1)
except vt.Error as error:
    assert error.kind == "output" and error.code == "output-unwritable", error
    assert {advice!r} in error.fix and {str(tmp_path)!r} in error.where, error
    print("told")
"""
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                         env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})
    assert ran.stdout == "told\n", ran.stderr
    left = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert {path.name for path in left} == {"manifest.json", "scene.npz"}, left


def test_failures_that_nobody_thought_of(scene, monkeypatch):
    from vantage.batch import _geometry, _work

    def fail(*arguments):
        raise ZeroDivisionError("by zero")

    monkeypatch.setattr(_work, "resolved", fail)
    row = _table.read(triangles(1)).rows[0]
    found, result = _work.compute(None, scene, _geometry.CrsTransform(scene, None), row)
    assert result is None and found["outcome"] == "error" and found["error_code"] == "internal-defect"
    assert "ZeroDivisionError" in found["error_problem"]


# ---- what rows say


def test_volume_above_a_level():
    corners, faces = box((-1, -2, -3), (4, 5, 7))
    vertices, faces = np.array(corners, float), np.array(faces, np.uint32)
    for level, height in ((-4, 10), (-3, 10), (0, 7), (6.5, 0.5), (7, 0), (9, 0)):
        assert _rows.volume_above(vertices, faces, level) == pytest.approx(5 * 7 * height, abs=1e-9)
    assert _rows.volume_above(np.zeros((0, 3)), np.zeros((0, 3), np.uint32), 0) == 0


def test_volume_above_a_level_of_a_real_one(result):
    """What is below plus what is above is all, at levels through vertices and between them; and a cut by the engine
    agrees."""
    mirrored = np.array(result.vertices) * [1, 1, -1]
    for level in (0.0, 7.3, float(result.vertices[11, 2]), 40.0, 59.0):
        above = _rows.volume_above(result.vertices, result.faces, level)
        below = _rows.volume_above(mirrored, result.faces[:, ::-1], -level)
        assert above + below == pytest.approx(result.volume_m3, rel=1e-9)
        corners, faces = box((-100, -100, level), (100, 100, 100))
        cut = result.volume & vt.Volume.from_arrays(corners, faces)
        assert above == pytest.approx(0 if cut.empty else cut.volume_m3, rel=1e-6, abs=1e-3)


def test_sky_share(scene):
    half_ball = 2 / 3 * np.pi * 60 ** 3
    open_field = vt.compute(scene, [[-60, 0, 0], [-59.9, 0, 0], [-59.9, 0.1, 0]], max_range=60)
    assert 0.98 < _rows.sky_share(open_field) <= 1
    low = vt.compute(scene, [[-60, 0, 0], [-59, 0, 0], [-59, 1, 0]], max_range=60,
                     navigation=vt.Navigation(altitude=(0, 10)))
    assert _rows.sky_share(low) == pytest.approx(low.volume_m3 / half_ball, rel=1e-9)
    point = vt.compute(scene, vt.Target(point=[-60, 0, 30]), max_range=20)
    assert _rows.sky_share(point) == pytest.approx(1, abs=0.01) and point.volume_m3 > 1.9 * 2 / 3 * np.pi * 20 ** 3
    empty = vt.compute(scene, [[-60, 0, 0], [-59, 0, 0], [-59, 1, 0]], max_range=60,
                       navigation=vt.Navigation(altitude=(500, 600)))
    assert _rows.sky_share(empty) == 0


def test_rows_become_the_same_bytes():
    row = {"id": 1, "outcome": "computed", "volume_m3": 2.5, "causes": [], "geometry": None}
    columns = _rows.schema(True, {"version": "x"}, False)
    assert _rows.to_bytes([row], columns) == _rows.to_bytes([row], columns)
    assert _rows.of_bytes(_rows.to_bytes([row], columns)).schema.metadata[b"version"] == b"x"
    assert _rows.of_bytes(b"") is None and _rows.of_bytes(_rows.to_bytes([row], columns)[:-9]) is None


def test_readers_of_arrow_hold_nothing_of_python():
    data = bytes(1000)
    count = sys.getrefcount(data)
    file = _parquet.memory_file(data)
    assert sys.getrefcount(data) == count and file.read() == data


def test_tables_are_the_same_whatever_they_come_as(tmp_path):
    pandas, geopandas, shapely = (pytest.importorskip(name) for name in ("pandas", "geopandas", "shapely"))
    squares = [shapely.box(i, 0, i + 1, 1) for i in range(3)]
    frame = geopandas.GeoDataFrame({"id": ["c", "a", "b"], "height": [1, 2, 3]}, geometry=squares, crs=4326)
    frame.to_parquet(tmp_path / "t.parquet")
    (tmp_path / "t.geojson").write_text(frame.to_json())
    of_frame, of_file = _table.read(frame), _table.read(tmp_path / "t.parquet")
    assert [row.id for row in of_frame.rows] == ["a", "b", "c"] and of_frame.rows == of_file.rows
    assert [row.geometry for row in _table.read(tmp_path / "t.geojson").rows] == [row.geometry for row in of_frame.rows]
    assert json.loads(of_frame.crs)["id"]["code"] == 4326
    records = frame.to_dict("records")
    assert _table.read(records, crs="EPSG:4326").rows == of_frame.rows
    assert _table.read(frame.set_index("id")).rows == of_frame.rows
    plain = pandas.DataFrame({"id": [2, 1], "osm": ["way/2", None], "center": [None, [48.1, 11.5]], "width": [3.0, 4.0]})
    rows = _table.read(plain).rows
    assert rows == [(1, {"center": [48.1, 11.5], "width": 4.0}, None), (2, {"osm": "way/2"}, None)]
    named = _table.read({"x": vt.Target(point=[1, 2, 3]), "y": {"osm": "way/1"}}).rows
    assert named == [("x", {"point": [1, 2, 3]}, None), ("y", {"osm": "way/1"}, None)]
    assert [row.id for row in _table.read([vt.Target(point=[1, 2, 3])] * 2).rows] == [0, 1]

    class Area:
        source_id, name = "way/7", "square"

        def target(self):
            return vt.Target(osm=self.source_id)

    class Face:
        name = "way/7, roof 2"

        def target(self):
            return vt.Target(point=[1, 2, 3], name=self.name)

    assert _table.read([Area()]).rows == [("way/7", {"osm": "way/7"}, None)]
    assert _table.read([Face()]).rows == [("way/7, roof 2", {"point": [1, 2, 3], "name": "way/7, roof 2"}, None)]
    assert _table.read([{"osm": "way/7"}]).rows == [("way/7", {"osm": "way/7"}, None)]


# ---- the command


def command(*arguments):
    from vantage.batch import _cli

    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = _cli.main([str(argument) for argument in arguments])
        except SystemExit as ended:
            code = ended.code
    return code, out.getvalue(), err.getvalue()


def test_the_command(tmp_path):
    import pandas

    square = [[-12, -9, 0], [8, -11, 0], [11, 0, 0]]
    pandas.DataFrame({"id": [1], "vertices": [square]}).to_parquet(tmp_path / "t.parquet")
    code, out, err = command(tmp_path / "t.parquet", "--scene", PLAZA, "--max-range", 70, "-o", tmp_path / "out",
                             "--workers", 1)
    assert code == 0 and "0 failed" in out and "results.parquet" in out and "100.0 %" in err
    alone = vt.compute(vt.Scene.from_mesh(PLAZA), square, max_range=70)
    assert batch.results(tmp_path / "out")["volume_hash"].tolist() == [alone.volume.hash]
    ran = subprocess.run([sys.executable, "-m", "vantage", "batch", tmp_path / "t.parquet", "--scene", PLAZA, "--sensor",
                          '{"max_range": 70}', "-o", tmp_path / "out", "--json"], capture_output=True, text=True)
    assert ran.returncode == 0 and json.loads(ran.stdout)["computed"] == 0, ran.stderr
    pandas.DataFrame({"id": [1, 2], "vertices": [square, square[:2]]}).to_parquet(tmp_path / "u.parquet")
    assert command(tmp_path / "u.parquet", "--scene", PLAZA, "--max-range", 70, "-o", tmp_path / "two", "-q")[:2] == (1, "")
    code, out, err = command(tmp_path / "u.parquet", "--scene", PLAZA, "--max-range", 70, "-o", tmp_path / "out")
    assert code == 2 and "other targets" in err and "what to do" in err
    assert command(tmp_path / "u.parquet", "--scene", PLAZA, "-o", tmp_path / "x")[0] == 2
    assert command(tmp_path / "u.parquet")[0] == 2
    two = [square, [[x + 1, y, z] for x, y, z in square]]
    pandas.DataFrame({"id": [1], "parts": [two]}).to_parquet(tmp_path / "p.parquet")
    assert command(tmp_path / "p.parquet", "--scene", PLAZA, "--max-range", 70, "-o", tmp_path / "few", "-q", "--workers", 1,
                   "--work-limit", 100)[0] == 1
    assert batch.results(tmp_path / "few")["error_code"].tolist() == ["work-too-large"]
    assert command("t", "--scene", "s", "-o", "x", "--sensor", "[1]")[0] == 2
    code, out, err = command("--help")
    assert code == 0 and "examples:" in out and "exit codes:" in out
