"""Workers of a Dask cluster."""

from __future__ import annotations

import uuid
from typing import Any

from .._errors import Error, input_error
from .._extras import require
from ._pool import LostTask, Outcome, attempt
from ._work import Job, Task

_AHEAD = 2
"""Tasks for each thread of the cluster that are given at a time, so that none waits."""


class DaskWorkers:
    """Plain tasks of `dask.distributed`; each process of the cluster keeps the scene that it read."""

    shares_workers = True

    def __init__(self, job: Job, cluster: Any):
        distributed = require("distributed", "batch")
        self._killed = distributed.scheduler.KilledWorker
        self._lost = distributed.client.FutureCancelledError
        self._is_own = not isinstance(cluster, distributed.Client)
        try:
            self._client = distributed.Client(cluster) if self._is_own else cluster
        except (OSError, TimeoutError) as error:
            raise input_error("device-missing", f"there is no Dask scheduler: {error}", str(cluster),
                              "start 'dask scheduler', and pass its address, tcp://...") from None
        self._wait, self._run = distributed.wait, uuid.uuid4().hex[:8]
        self._job = job
        self._given = 0
        self._tasks: dict[Any, Task] = {}

    def room(self) -> int:
        threads = sum(self._client.nthreads().values())
        return max(0, _AHEAD * max(1, threads) - len(self._tasks))

    def give(self, task: Task) -> None:
        self._given += 1
        future = self._client.submit(attempt, self._job, task, pure=False, key=f"vantage-{self._run}-{self._given}")
        self._tasks[future] = task

    def busy(self) -> int:
        return len(self._tasks)

    def ended(self, timeout_s: float) -> list[Outcome]:
        try:
            done = self._wait(list(self._tasks), timeout=timeout_s, return_when="FIRST_COMPLETED").done
        except TimeoutError:
            return []
        told: list[Outcome] = []
        for future in done:
            task = self._tasks.pop(future)
            try:
                answer = future.result()
            except (self._killed, self._lost):
                answer = LostTask(task)
            if isinstance(answer, Error):
                raise answer
            told.append(answer)
        return told

    def close(self) -> None:
        self._client.cancel(list(self._tasks))
        if self._is_own:
            self._client.close()
