"""Workers: what they have in common, and processes of this machine."""

from __future__ import annotations

import os
import pickle
import select
import signal
import socket
import subprocess
import sys
import threading
import traceback
from collections.abc import Sequence
from multiprocessing.connection import Connection, wait
from typing import Any, NamedTuple, Protocol, Union

from .._errors import Error, make
from .._folders import remove_abandoned
from . import _scenes, _work
from ._store import UNFINISHED
from ._work import Job, Task, TaskResult


_SECONDS_TO_END = 3.0
"""A worker that has not ended itself by then is killed."""


class LostTask(NamedTuple):
    """The worker of a task ended before the task did."""

    task: Task


Outcome = Union[TaskResult, LostTask]


class Workers(Protocol):
    """What runs tasks."""

    shares_workers: bool
    """whether several tasks may die with one worker, so that it is not known which of them killed it"""

    def room(self) -> int:
        """How many tasks can be given now."""

    def give(self, task: Task) -> None:
        """Starts a task."""

    def busy(self) -> int:
        """How many tasks were given and have not ended."""

    def ended(self, timeout_s: float) -> Sequence[Outcome]:
        """The tasks that ended meanwhile; raises the Error of one that failed."""

    def close(self) -> None:
        """Ends all that runs."""


def module_path() -> str:
    """Where a worker looks for modules: where this process does, but for the current folder, which holds whatever it holds.
    Unless vantage itself is there, or PYTHONPATH names it."""
    own = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    meant = {own, *(os.path.abspath(path) for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path)}
    try:
        here = os.getcwd()
    except OSError:  # it was removed
        here = ""
    kept = [path for path in sys.path if path and (path in meant or os.path.realpath(path) != os.path.realpath(here))]
    return os.pathsep.join(kept if own in map(os.path.abspath, kept) else [own, *kept])


class _Worker:
    """A process, fresh and not forked, and the task that it has."""

    def __init__(self, job: bytes):
        ours, theirs = socket.socketpair()
        code = f"from vantage.batch._pool import serve; serve({theirs.fileno()}, {os.getpid()})"
        environment = {**os.environ, "PYTHONPATH": module_path()}
        with theirs:
            self.process = subprocess.Popen([sys.executable, "-P", "-c", code], pass_fds=[theirs.fileno()],
                                            env=environment, stdin=subprocess.DEVNULL)
        self.connection = Connection(ours.detach())
        self.task: Task | None = None
        self._job: bytes | None = job

    def give(self, task: Task) -> None:
        """Sends it; that the worker has died shows when it is asked."""
        self.task = task
        try:
            if self._job is not None:
                self.connection.send_bytes(self._job)
                self._job = None
            self.connection.send(task)
        except OSError:
            pass

    def end(self) -> None:
        """It ends itself where it can, and tidies up."""
        self.connection.close()
        try:
            self.process.wait(_SECONDS_TO_END)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class LocalWorkers:
    """Processes of this machine, each with a scene and a task of its own. One that dies is replaced."""

    shares_workers = False

    def __init__(self, job: Job, count: int):
        self._job = pickle.dumps(job)
        self._workers = [_Worker(self._job) for _ in range(count)]

    def room(self) -> int:
        return sum(worker.task is None for worker in self._workers)

    def give(self, task: Task) -> None:
        next(worker for worker in self._workers if worker.task is None).give(task)

    def busy(self) -> int:
        return sum(worker.task is not None for worker in self._workers)

    def ended(self, timeout_s: float) -> list[Outcome]:
        told: list[Outcome] = []
        ready = wait([worker.connection for worker in self._workers if worker.task is not None], timeout_s)
        for i, worker in enumerate(self._workers):
            if worker.connection not in ready:
                continue
            task, worker.task = worker.task, None
            assert task is not None
            try:
                answer = worker.connection.recv()
            except (EOFError, OSError):
                worker.end()
                self._workers[i] = _Worker(self._job)
                answer = LostTask(task)
            if isinstance(answer, Error):
                raise answer
            told.append(answer)
        return told

    def close(self) -> None:
        for worker in self._workers:
            worker.connection.close()  # all at once
        for worker in self._workers:
            worker.end()
        for prefix in (_scenes.PREFIX, UNFINISHED):  # of those that had to be killed
            remove_abandoned(prefix)


def serve(descriptor: int, driver: int) -> None:
    """The life of a worker: a job, then tasks, until the other end is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that was asked, which ends its workers
    threading.Thread(target=_end_with, args=(descriptor, driver), daemon=True).start()
    with Connection(descriptor) as connection:
        try:
            job = connection.recv()
            while True:
                connection.send(attempt(job, connection.recv()))
        except (EOFError, OSError):
            _end()


def _end_with(descriptor: int, driver: int) -> None:
    """Ends this process, in the middle of its work, when the process `driver` has ended or closed its end: what it
    computes is of no use to anybody, and holds a scene."""
    gone = select.poll()
    gone.register(descriptor, select.POLLRDHUP)
    while not gone.poll(1000):
        if os.getppid() != driver:  # a copy of it may hold the other end
            break
    _end()


def _end() -> None:
    """Ends this process at once, whatever its other threads do: a scene takes long to take apart."""
    try:
        _scenes.forget()
    finally:
        os._exit(0)


def attempt(job: Job, task: Task) -> Any:
    """What came of a task, or the Error that ends the run."""
    try:
        return _work.run(job, task)
    except Error as error:
        return error
    except Exception:
        return make("internal", "internal-defect", "unexpected failure: " + traceback.format_exc().strip(), "",
                    "this is a defect of vantage: please report it", None)
