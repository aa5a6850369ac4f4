"""Which tasks are given to workers, and what becomes of those that are lost."""

from __future__ import annotations

import collections
import dataclasses
from collections.abc import Callable, Iterable

from .._errors import make
from ._pool import LostTask, Workers
from ._table import Id
from ._work import Task, TaskResult

_DEATHS_OF_A_SHARD = 2
"""After so many its targets are tried alone, to find out which of them ends workers."""


class Queue:
    """The shards of a run that are missing. One whose worker died is done again; one that ends workers again and again is
    done without the targets that do so when they are tried alone."""

    def __init__(self, missing: Iterable[Task], attempts: int):
        self._shards = collections.deque(missing)
        self._probes: collections.deque[Task] = collections.deque()
        self._attempts = attempts
        self._deaths: collections.Counter[tuple[int, Id | None]] = collections.Counter()
        self._tried: dict[int, _IsolatedShard] = {}
        self._in_a_row = 0
        self.deaths = 0

    def run(self, pool: Workers, done: Callable[[TaskResult], None], tell: Callable[[], None]) -> None:
        """Gives all of it to workers; `done` is called for each task, `tell` now and then.

        Raises:
            Error: of a task that failed; workers die and nothing gets done.
        """
        while self._shards or self._probes or pool.busy():
            while self._shards and pool.room():
                pool.give(self._shards.popleft())
            # Where tasks share workers it must be clear which one it was: one at a time, and nothing else.
            while self._probes and not self._shards and pool.room() and not (pool.shares_workers and pool.busy()):
                pool.give(self._probes.popleft())
            for outcome in pool.ended(0.5):
                if isinstance(outcome, LostTask):
                    self._lost(outcome.task)
                else:
                    self._in_a_row = 0
                    done(outcome)
                    if outcome.tried is not None:
                        self._found(outcome.number, outcome.tried, 0)
            tell()

    def _lost(self, task: Task) -> None:
        self.deaths += 1
        self._in_a_row += 1
        if self._in_a_row > 4 * self._attempts + 8:
            raise make("internal", "internal-defect",
                       f"{self._in_a_row} workers died one after the other, and none finished a task", "",
                       "look at what they print, and at their memory; run it again: it goes on where it was", None)
        tried = task.rows[0].id if task.alone else None
        self._deaths[task.number, tried] += 1
        times = self._deaths[task.number, tried]
        if tried is not None and times >= self._attempts:
            self._found(task.number, tried, times)
        elif tried is not None:
            self._probes.append(task)
        elif times < _DEATHS_OF_A_SHARD:
            self._shards.append(task)
        elif task.number not in self._tried:
            self._tried[task.number] = _IsolatedShard(task)
            self._probes.extend(Task(task.number, [row], alone=True) for row in task.rows)
        elif times < _DEATHS_OF_A_SHARD + self._attempts:
            self._shards.append(task)
        else:
            problem = f"shard {task.number} ends its workers, also without the targets that do so alone"
            raise make("internal", "internal-defect", problem, "",
                       "look at what workers print, and at their memory; pass fewer shard_rows, and an empty folder", None)

    def _found(self, number: int, id: Id, deaths: int) -> None:
        """What came of a target that was tried alone."""
        tried = self._tried[number]
        tried.left -= 1
        if deaths:
            tried.excluded[id] = deaths
        if not tried.left:
            self._shards.append(dataclasses.replace(tried.shard, excluded=tried.excluded))


class _IsolatedShard:
    """A shard whose targets are tried alone."""

    def __init__(self, shard: Task):
        self.shard = shard
        self.left = len(shard.rows)
        self.excluded: dict[Id, int] = {}
