"""Batches on a Dask cluster, and into an object store: both on this machine."""

import os
import signal

import pytest

import vantage as vt
from test_batch import triangles, without_time

pytest.importorskip("pyarrow")
import vantage.batch as batch  # noqa: E402


@pytest.fixture(scope="module")
def whole(scene, tmp_path_factory):
    return batch.run(triangles(), scene, tmp_path_factory.mktemp("whole"), max_range=60, shard_rows=2, workers=2)


@pytest.fixture(scope="module")
def bucket():
    """A bucket of a server that keeps it in memory; options of fsspec for it."""
    server_of = pytest.importorskip("moto.server")
    s3fs = pytest.importorskip("s3fs")
    server = server_of.ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    _, port = server.get_host_and_port()
    options = {"key": "nobody", "secret": "nothing", "client_kwargs": {"endpoint_url": f"http://127.0.0.1:{port}"}}
    s3fs.S3FileSystem(**options).mkdir("city")
    yield options
    server.stop()


def test_an_object_store(scene, whole, bucket, tmp_path):
    import pandas
    import s3fs

    pandas.DataFrame(triangles()).to_parquet(tmp_path / "t.parquet")
    files = s3fs.S3FileSystem(**bucket)
    files.put_file(str(tmp_path / "t.parquet"), "city/t.parquet")
    scene.save(tmp_path / "yard.ply")
    files.put_file(str(tmp_path / "yard.ply"), "city/yard.ply")
    asked = {"max_range": 60, "shard_rows": 2, "workers": 1, "storage_options": bucket, "volumes": "ply"}
    where = ("s3://city/t.parquet", "s3://city/yard.ply", "s3://city/results")
    with pytest.raises(vt.CancelledError):
        batch.run(*where, **asked, progress=lambda stage, fraction: fraction < 0.3)
    report = batch.run(*where, **asked)
    assert 0 < report.computed < 10 and report.rows == 10 and report.errors == 1
    table, right = batch.results(report.output, bucket), whole.table()
    assert table["volume_m3"][:9].tolist() == pytest.approx(right["volume_m3"][:9].tolist(), rel=1e-9)
    data = files.cat_file("city/results/" + table["volume_file"][3])
    (tmp_path / "v.ply").write_bytes(data)
    assert vt.Volume.read(tmp_path / "v.ply").hash == table["volume_hash"][3]
    assert not [name for name in files.find("city/results") if "unfinished" in name or ".part" in name]
    with pytest.raises(vt.Error) as raised:
        batch.run(*where, **{**asked, "max_range": 50})
    assert raised.value.code == "folder-in-use"
    with pytest.raises(vt.Error) as raised:
        batch.run("s3://city/none.parquet", *where[1:], **asked)
    assert raised.value.code == "file-not-found"
    with pytest.raises(vt.Error) as raised:
        batch.run(*where[:2], "s3://no-such-bucket/results", **asked)
    assert raised.value.kind == "output"


def test_stores_that_are_none(scene):
    with pytest.raises(vt.Error) as raised:
        batch.run(triangles(1), scene, "gopher://results", max_range=60)
    assert raised.value.code == "value-unsupported"


def test_a_dask_cluster_that_loses_its_workers(scene, whole, tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None,
                                  silence_logs=50) as cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        told = []

        def kill(stage, fraction):
            told.append(fraction)
            if 0 < fraction < 1 and pids:
                os.kill(pids.pop(), signal.SIGKILL)

        # Four of the ten tasks at most are with the cluster at a time: it hears twice, at least, that a part is done.
        report = batch.run(triangles(), scene, tmp_path, max_range=60, shard_rows=1, cluster=client, progress=kill)
        assert not pids and told[-1] == 1, "both were killed"
        assert report.result_hash == whole.result_hash and without_time(report).equals(without_time(whole))
        assert sum(worker.rows for worker in report.workers.values()) >= 10


def test_a_target_that_kills_workers_of_a_cluster(scene, whole, tmp_path, monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setenv("VANTAGE_BATCH_KILL", "4")
    import dask

    with dask.config.set({"distributed.scheduler.allowed-failures": 0}), \
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None,
                                     silence_logs=50) as cluster:
        report = batch.run(triangles(), scene, tmp_path, max_range=60, shard_rows=5, attempts=1,
                           cluster=cluster.scheduler_address)
    table, right = report.table(), whole.table()
    assert report.errors == 2 and table["error_code"][4] == "internal-defect"
    others = [i for i in range(10) if i != 4]
    assert table["volume_hash"][others].equals(right["volume_hash"][others])
