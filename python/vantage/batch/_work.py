"""What a worker does: the targets of a shard, in a scene that it keeps."""

from __future__ import annotations

import dataclasses
import hashlib
import os
import signal
import socket
import time
import urllib.parse
from collections.abc import Mapping
from typing import Any

from .._errors import Error, OutputError, make
from .._result import Mission, Result
from .._scene import Scene
from . import _checksums, _geometry, _rows, _scenes, _volumes
from ._store import Store, unwritable
from ._table import Id, Row


@dataclasses.dataclass(frozen=True)
class Job:
    """What all shards of a run have in common."""

    store: Store
    scene: Mapping[str, Any]
    scene_hash: str
    asked: Mapping[str, Any]
    """arguments of `Mission.of`"""
    crs: str | None
    volumes: str | None
    metadata: dict[str, str]
    """of the files of rows: whose results they are"""
    is_number: bool
    """whether ids are"""
    is_on_earth: bool
    """whether the results' geometries are longitude and latitude"""


@dataclasses.dataclass(frozen=True)
class Task:
    """A shard to compute and to write."""

    number: int
    rows: list[Row]
    alone: bool = False
    """one row, which is only tried: does the worker live?"""
    excluded: Mapping[Id, int] = dataclasses.field(default_factory=dict)
    """rows that end workers, and how often they did: they are errors"""


@dataclasses.dataclass(frozen=True)
class TaskResult:
    """What a worker says of a task."""

    number: int
    count: int
    errors: int
    seconds: float
    cpu_seconds: float
    worker: str
    peak_mib: float
    tried: Id | None = None
    """the row that was only tried"""


def shard_name(number: int) -> str:
    """The file of a shard's rows."""
    return f"rows/{number:06d}.parquet"


def run(job: Job, task: Task) -> TaskResult:
    """Computes a task. One target that is wrong is an error in its row.

    Raises:
        Error: the scene cannot be read, or is another one; the results cannot be written.
    """
    started, began = time.perf_counter(), time.process_time()
    scene = _scenes.kept(job.scene, job.scene_hash, job.store)
    transform = _geometry.CrsTransform(scene, job.crs)
    if task.alone:
        _kill_for_tests(task.rows[0])
        compute(job, scene, transform, task.rows[0])
        return _done(task, 0, 0, started, began, task.rows[0].id)
    rows, results = [], []
    checksums: dict[str, _checksums.Checksum] = {}
    for row in task.rows:
        if row.id in task.excluded:
            found, result = lost_row(row, task.excluded[row.id], transform), None
        else:
            _kill_for_tests(row)
            found, result = compute(job, scene, transform, row)
        if job.volumes == "ply" and result is not None and not result.empty:
            name = ply_name(task.number, row)
            found["volume_file"], checksums[name] = name, _put_ply(job.store, name, result)
        rows.append(found)
        results.append(result if job.volumes == "zarr" else None)
    if job.volumes == "zarr":
        checksums.update(write_zarr(job, task.number, rows, results))
    content = _rows.to_bytes(rows, _rows.schema(job.is_number, job.metadata, job.is_on_earth))
    job.store.put(shard_name(task.number), content)
    _checksums.write(job.store, shard_name(task.number), content, checksums)
    errors = sum(row["outcome"] == "error" for row in rows)
    return _done(task, len(rows), errors, started, began)


def _done(task: Task, count: int, errors: int, started: float, began: float, tried: Id | None = None) -> TaskResult:
    return TaskResult(task.number, count, errors, time.perf_counter() - started, time.process_time() - began, worker_name(),
                peak_mib(), tried)


def compute(job: Job, scene: Scene, transform: _geometry.CrsTransform, row: Row) -> tuple[dict[str, Any], Result | None]:
    """The row of one target, and what came of it."""
    started = time.perf_counter()
    result, parts, failure = None, None, None
    try:
        result = resolved(job, scene, transform, row).run(threads=1)
        parts = result.mission.target_parts
        found = _rows.of_result(row.id, result, time.perf_counter() - started)
    except MemoryError:
        failure = make("input", "out-of-memory", "the memory is used up", "", "compute this target on a larger machine, alone",
                       None)
    except Error as error:
        if error.kind == "cancelled":
            raise
        failure = error
    except Exception as error:  # the other targets are not to suffer
        failure = make("internal", "internal-defect", f"unexpected failure: {type(error).__name__}: {error}", "",
                       "this is a defect of vantage: please report it with the target", None)
    if failure is not None:
        found = _rows.of_error(row.id, _geometry.name_of(row), failure, time.perf_counter() - started)
    found["geometry"] = _geometry.footprint(row, parts, transform)
    return found, result


def resolved(job: Job, scene: Scene, transform: _geometry.CrsTransform, row: Row) -> Mission:
    """What a row asks for, in the scene."""
    targets = _geometry.targets_of(row, transform)
    return Mission.of(scene, targets[0] if len(targets) == 1 else targets, **job.asked)


def lost_row(row: Row, times: int, transform: _geometry.CrsTransform) -> dict[str, Any]:
    """The row of a target that ended its worker again and again."""
    problem = f"the worker died {times} times while it computed this target"
    error = make("internal", "internal-defect", problem, "", "look for a lack of memory; else compute it alone, and report it",
                 None)
    return {**_rows.of_error(row.id, _geometry.name_of(row), error, 0.0), "geometry": _geometry.footprint(row, None, transform)}


def write_zarr(job: Job, number: int, rows: list[dict[str, Any]], results: list[Result | None]) -> dict[str, _checksums.Checksum]:
    """The shard's volumes; their rows get its name."""
    name = f"volumes/{number:06d}.zarr.zip"
    held = [(str(row["id"]), result) for row, result in zip(rows, results) if result is not None and not result.empty]
    content = _volumes.to_zarr(held, job.metadata)
    job.store.put(name, content)
    for row, result in zip(rows, results):
        if result is not None and not result.empty:
            row["volume_file"] = name
    return {name: _checksums.checksum_of(content)}


def ply_name(number: int, row: Row) -> str:
    """The file of a target's volume."""
    name = urllib.parse.quote(str(row.id), safe="")
    if len(name) > 150:
        name = name[:80] + "-" + hashlib.sha256(name.encode()).hexdigest()[:32]
    return f"volumes/{number:06d}/{name}.ply"


def _put_ply(store: Store, path: str, result: Result) -> _checksums.Checksum:
    with store.scratch() as folder:
        try:
            local = os.path.join(folder, "volume.ply")
            result.volume.save(local)
            with open(local, "rb") as file:
                content = file.read()
            if store.is_local:
                store.put_file(path, local)
            else:
                store.put(path, content)
        except (OSError, OutputError) as error:
            raise unwritable(error, store.where(path)) from error
    return _checksums.checksum_of(content)


# ---- about the process


def worker_name() -> str:
    """Of this process, for reports."""
    return f"{socket.gethostname()}:{os.getpid()}"


def peak_mib() -> float:
    """The most memory that this process has held so far, MiB."""
    try:
        with open("/proc/self/status") as status:
            for line in status:
                if line.startswith("VmHWM:"):
                    return int(line.split()[1]) / 1024
    except OSError:
        pass
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _kill_for_tests(row: Row) -> None:
    """For tests: VANTAGE_BATCH_KILL=ID ends the process at that target, ID:FILE only if it can make the file."""
    told = os.environ.get("VANTAGE_BATCH_KILL", "")
    id, _, marker = told.partition(":")
    if not told or id != str(row.id):
        return
    if marker:
        try:
            os.close(os.open(marker, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return
    os.kill(os.getpid(), signal.SIGKILL)
