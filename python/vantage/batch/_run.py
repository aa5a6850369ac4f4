"""A run: which shards are missing, who computes them, and the table that they make."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import time
from collections.abc import Iterable, Mapping
from typing import Any

from .._core import version
from .._errors import Error, make
from .._extras import require
from .._requests import Navigation, Path, Sensor
from .._result import sensor_keys
from .._progress import Listener, Progress, listener
from .._scene import Scene
from . import _checksums, _geometry, _manifest, _parquet, _rows, _scenes, _table, _work
from ._dask import DaskWorkers
from ._lock import Lock
from ._manifest import REPORT, RESULTS
from ._pool import LocalWorkers, Workers
from ._queue import Queue
from ._store import Store
from ._work import Job, Task, TaskResult


@dataclasses.dataclass
class WorkerReport:
    """What one process did."""

    rows: int = 0
    seconds: float = 0.0
    """in tasks, with reading the scene"""
    cpu_seconds: float = 0.0
    """of the processors, meanwhile"""
    peak_mib: float = 0.0
    """the most memory that it held"""


@dataclasses.dataclass
class Report:
    """What a run did; also in the folder of the results, as report.json."""

    output: str
    rows: int
    """of the table"""
    errors: int
    """rows of targets that failed"""
    computed: int
    """rows that this run computed; the others were there"""
    deaths: int
    """how often a task was lost with its worker"""
    seconds: float
    """of this run, with reading the scene in each worker"""
    workers: dict[str, WorkerReport]
    """by machine and process"""
    result_hash: str
    """SHA-256 of the ids with the hashes of their missions and volumes"""
    results_sha256: str
    """of the file results.parquet"""
    scene_hash: str
    mission_hash: str
    version: str

    @property
    def rows_per_s(self) -> float:
        """Rows that this run computed, by its time."""
        return self.computed / self.seconds if self.seconds > 0 else 0.0

    def table(self, storage_options: Mapping[str, Any] | None = None) -> Any:
        """The results, as a GeoDataFrame."""
        return results(self.output, storage_options)

    def __repr__(self) -> str:
        return (f"<vantage.batch.Report: {self.rows:,} rows, {self.errors:,} of them errors, {self.computed:,} computed in "
                f"{self.seconds:.1f} s>")


def run(targets: Any, scene: _scenes.AnyScene, output: Path, *, max_range: float | None = None,
        sensor: Sensor | None = None, navigation: Navigation | None = None, method: str = "exact",
        tolerance: float | None = None, spheres: Mapping[str, Any] | None = None, work_limit: float | None = None,
        crs: str | None = None, volumes: str | None = None, workers: int = 0, cluster: Any = None, shard_rows: int = 64,
        attempts: int = 3, storage_options: Mapping[str, Any] | None = None, progress: Progress = None) -> Report:
    """A volume for each target of a table: one row a target, written as they come.

    Run it again with the same arguments after it was stopped, and it goes on where it was: results.parquet is the same but
    for the column `seconds`. A target that is wrong is a row with its error, and stops no other.

    Args:
        targets: a GeoDataFrame, the path of a GeoParquet, Parquet or GeoJSON file, a list of `Target`s or of dictionaries,
            or areas of a map. Columns: `id`, unique; one of `geometry`, `osm`, `object`, `at`, `center`, `vertices`, ...;
            and what else `Target` has. Polygons without z are laid on the ground.
        scene: a path, or the keys of a mission file's `scene`: {"osm": "city.osm.pbf", "center": ..., "radius": ...};
            or a `Scene`, of which areas of the map cannot be targets.
        output: a folder, or one of an object store: "s3://bucket/results".
        max_range, sensor, navigation, method, tolerance, spheres, work_limit: as of `compute`, for all targets.
        crs: of the geometries, where they do not say it: "EPSG:25832"; "scene": metres of the scene's frame.
        volumes: "ply": a file for each volume; "zarr": one for each shard. Default: rows alone.
        workers: processes of this machine, each with the scene. 0: as many as there are processors.
        cluster: instead of these, a `dask.distributed.Client`, a cluster, or the address of a scheduler.
        shard_rows: rows that are written together. What was computed of an unfinished shard is lost with its worker.
        attempts: how often a target may end its worker before it counts as failed.
        storage_options: for fsspec, of the output and of remote inputs.
        progress: called with what is done and which part of all; False stops.

    Returns:
        the report; results are in results.parquet, sorted by id (docs/python-batch.md).

    Raises:
        Error: targets, scene or limits are wrong; the output holds results of something else; nothing can be written.

    Example:
        report = vt.batch.run(squares, "city.osm.pbf", "results/", max_range=300)
        report.table()[["id", "outcome", "volume_m3"]]
    """
    started, notify = time.perf_counter(), listener(progress)
    _check_choices(volumes, workers, shard_rows, attempts)
    table = _table.read(targets, crs=crs, options=storage_options)
    asked = {"sensor": sensor_keys(sensor, max_range), "navigation": navigation, "method": method, "tolerance": tolerance,
             "spheres": spheres}
    if work_limit is not None:  # without one a folder of an older version is gone on with
        asked["work_limit"] = work_limit
    store = Store(output, storage_options)
    job = _job(table, scene, store, asked, volumes, shard_rows, notify)
    with Lock(store):
        _claim(job, scene)
        shards = [Task(number, rows) for number, rows in _table.shards(table.rows, int(job.metadata["shard_rows"]))]
        state = _RunState(job, shards, started)
        missing = _missing(job, shards, state, notify)
        if missing:
            count = min(workers or len(os.sched_getaffinity(0)), len(missing))
            pool: Workers = LocalWorkers(job, count) if cluster is None else DaskWorkers(job, cluster)
            try:
                queue = Queue(missing, attempts)
                queue.run(pool, state.done, lambda: state.tell(notify))
                state.deaths = queue.deaths
            finally:
                pool.close()
        return state.finished(_merge(job, shards))


def results(output: Path, storage_options: Mapping[str, Any] | None = None) -> Any:
    """The results of a finished run, as a GeoDataFrame; geometries are longitude and latitude (or the scene's frame)."""
    store = Store(output, storage_options)
    data, told = store.read(RESULTS), store.read(REPORT)
    if data is None or told is None:
        raise make("input", "file-not-found", "there are no finished results", store.where(RESULTS),
                   "run it to its end first", None)
    if hashlib.sha256(data).hexdigest() != _written(told):
        raise make("input", "file-changed", f"the results are not those that the run wrote, by the hash in {REPORT}",
                   store.where(RESULTS), "run it again: it goes on where it was", None)
    return require("geopandas", "geo").read_parquet(_parquet.memory_file(data))


def _written(report: bytes) -> str | None:
    """The hash of the results in a report; None where the report is damaged."""
    try:
        return str(json.loads(report)["results_sha256"])
    except (ValueError, KeyError, TypeError):
        return None


def _check_choices(volumes: str | None, workers: int, shard_rows: int, attempts: int) -> None:
    if volumes not in (None, "ply", "zarr"):
        raise make("input", "unknown-choice", f"volumes cannot be {volumes!r}", "volumes", "write 'ply' or 'zarr'", None)
    for name, value, least in (("workers", workers, 0), ("shard_rows", shard_rows, 1), ("attempts", attempts, 1)):
        if not isinstance(value, int) or value < least:
            raise make("input", "value-out-of-range", f"{name} is {value!r}", name, f"pass a whole number, {least} or more",
                       None)


def _job(table: _table.Table, scene: _scenes.AnyScene, store: Store, asked: Mapping[str, Any], volumes: str | None,
         shard_rows: int, progress: Listener) -> Job:
    """All that can be checked before the work begins is checked here."""
    request = _scenes.request_of(scene)
    reading = None if progress is None else lambda stage, fraction: progress(f"reading the scene: {stage}", 0.0)
    read = scene if isinstance(scene, Scene) else _scenes.load(request, store, reading)
    has_geometries = any(row.geometry is not None for row in table.rows)
    _geometry.check_crs(table.crs, read, has_geometries)
    _manifest.check_packages(volumes, has_geometries)
    keys = _manifest.keys(table, read, asked, volumes, shard_rows)
    is_number = isinstance(table.rows[0].id, int)
    job = Job(store, request, read.hash, asked, table.crs, volumes, keys, is_number, read.crs is not None)
    _check_asked(job, read, table.rows)
    return job


def _claim(job: Job, scene: _scenes.AnyScene) -> None:
    """Makes the folder one of this run, or finds that it is."""
    job.metadata.update(_manifest.agree(job.store, job.metadata, job.scene))
    job.store.remove_unfinished()
    if isinstance(scene, Scene):
        _scenes.save(scene, job.store)


def _check_asked(job: Job, scene: Scene, rows: list[_table.Row]) -> None:
    """Raises an error that is not of a target, but of what is asked for all of them."""
    transform = _geometry.CrsTransform(scene, job.crs)
    told = []
    for row in rows[:3]:
        try:
            _work.resolved(job, scene, transform, row)
            return
        except Error as error:
            told.append(error)
    if len({(error.code, error.where) for error in told}) == 1 and \
            told[0].where.split(".")[0].split("[")[0] in ("sensor", "navigation", "method", "tolerance", "spheres",
                                                          "work_limit"):
        raise told[0]


def _missing(job: Job, shards: list[Task], state: _RunState, progress: Listener) -> list[Task]:
    """The shards that are not there, whole and with all volumes."""
    there = set(job.store.names("rows"))
    missing = []
    for shard in shards:
        name = _work.shard_name(shard.number)
        rows = _ids_of(job, name) if name.rsplit("/", 1)[-1] in there else None
        if rows is None or rows[0] != [row.id for row in shard.rows]:
            missing.append(shard)
        else:
            state.found(len(shard.rows), rows[1])
        state.tell(progress)
    return missing


def _rows_of(job: Job, name: str) -> Any:
    """A shard's rows, as a table of pyarrow; None where they are not those that were written. They are only read where
    their hash is right."""
    content, checksums = job.store.read(name), _checksums.read(job.store, name)
    if content is None or checksums is None or not _checksums.matches(content, checksums[0]):
        return None
    table = _rows.of_bytes(content)
    if table is None:
        return None
    _manifest.check_shard(table.schema.metadata or {}, job.metadata, job.store.where(name))
    named = {file for file in table["volume_file"].to_pylist() if file is not None}
    return table if named <= set(checksums[1]) else None


def _ids_of(job: Job, name: str) -> tuple[list[Any], int] | None:
    """The ids of a shard's file, and how many are errors; None where it, or a volume of it, is not whole."""
    table, checksums = _rows_of(job, name), _checksums.read(job.store, name)
    if table is None or checksums is None or not _checksums.volumes_match(job.store, checksums[1]):
        return None
    return table["id"].to_pylist(), table["outcome"].to_pylist().count("error")


class _RunState:
    """What is done so far, for progress and the report."""

    def __init__(self, job: Job, shards: Iterable[Task], started: float):
        self._job, self._started = job, started
        self._rows = sum(len(shard.rows) for shard in shards)
        self._there, self._computed, self._errors = 0, 0, 0
        self._workers: dict[str, WorkerReport] = {}
        self.deaths = 0

    def found(self, rows: int, errors: int) -> None:
        """Counts rows of an earlier run."""
        self._there += rows
        self._errors += errors

    def done(self, done: TaskResult) -> None:
        self._computed += done.count
        self._errors += done.errors
        worker = self._workers.setdefault(done.worker, WorkerReport())
        worker.rows += done.count
        worker.seconds += done.seconds
        worker.cpu_seconds += done.cpu_seconds
        worker.peak_mib = max(worker.peak_mib, done.peak_mib)

    def tell(self, progress: Listener) -> None:
        if progress is None:
            return
        ready = self._there + self._computed
        said = f"{ready} of {self._rows} targets" + (f", {self._errors} errors" if self._errors else "")
        if progress(said, ready / self._rows) is False:
            raise make("cancelled", "cancelled", "the run was stopped", self._job.store.where(),
                       "run it again: it goes on where it was", None)

    def finished(self, merged: tuple[int, str, str]) -> Report:
        errors, result_hash, results_sha256 = merged
        keys = self._job.metadata
        report = Report(self._job.store.where(), self._rows, errors, self._computed, self.deaths,
                        time.perf_counter() - self._started, self._workers, result_hash, results_sha256,
                        keys["scene_hash"], keys["mission_hash"], version)
        text = json.dumps({**dataclasses.asdict(report), "rows_per_s": report.rows_per_s}, indent=2) + "\n"
        self._job.store.put(REPORT, text.encode())
        self._job.store.remove_unfinished()
        return report


def _merge(job: Job, shards: Iterable[Task]) -> tuple[int, str, str]:
    """Writes results.parquet, a group of rows for each shard: how many rows are errors, the hash of all, and the file's."""
    parquet = require("pyarrow.parquet", "batch")
    content, errors = hashlib.sha256(), 0
    writer = None
    with job.store.scratch() as folder:
        local = os.path.join(folder, RESULTS)
        with job.store.writing(RESULTS):
            for shard in shards:
                table = _rows_of(job, _work.shard_name(shard.number))
                if table is None:
                    raise make("input", "file-changed", "a shard was lost or changed while the run went on",
                               job.store.where(_work.shard_name(shard.number)), "run it again", None)
                for row in zip(*(table[name].to_pylist() for name in ("id", "outcome", "mission_hash", "volume_hash"))):
                    content.update(json.dumps(row).encode())
                    errors += row[1] == "error"
                writer = writer or parquet.ParquetWriter(local, table.schema, compression="zstd")
                writer.write_table(table)
            if writer is not None:
                writer.close()
            with open(local, "rb") as file:
                results_sha256 = hashlib.file_digest(file, "sha256").hexdigest()
        job.store.put_file(RESULTS, local)
    return errors, content.hexdigest(), results_sha256
