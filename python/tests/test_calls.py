"""Long calls: progress, Ctrl-C, exceptions, threads, forks, pickles."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import vantage as vt
from conftest import SQUARE, yard


def slow(progress=None):
    """Takes seconds, unless it is stopped."""
    return vt.compute(yard(), SQUARE, sensor=vt.Sensor(max_range=60, visible=0.5, cells=256), work_limit=1e12,
                      progress=progress)


def test_progress_is_told_in_the_calling_thread():
    told = []

    def progress(stage, fraction):
        told.append((stage, fraction, threading.get_ident()))
        return len(told) < 3

    with pytest.raises(vt.CancelledError) as raised:
        slow(progress)
    assert raised.value.code == "cancelled"
    assert len(told) == 3
    for stage, fraction, thread in told:
        assert stage and 0 <= fraction <= 1 and thread == threading.get_ident()


def test_a_callback_that_raises_stops_the_work():
    def progress(stage, fraction):
        raise LookupError("mine")

    start = time.monotonic()
    with pytest.raises(LookupError, match="mine"):
        slow(progress)
    assert time.monotonic() - start < 10


def test_a_stop_is_heard_when_all_was_done_meanwhile(result):
    points = np.random.default_rng(4).uniform(-60, 60, (100_000, 3))
    told = []
    patience = 4
    start = time.monotonic()
    result.query(points, threads=1)
    seconds = time.monotonic() - start

    def progress(stage, fraction):
        told.append(stage)
        time.sleep(patience * seconds)  # the other thread comes to its end
        return False

    # Python is asked every 50 ms, and later on a machine that is busy: until it is, the work is doubled. Where the
    # other thread had not come to its end, it was stopped in its work: it gets more time.
    while True:
        start = time.monotonic()
        try:
            result.query(points, threads=1, progress=progress)
        except vt.CancelledError as error:
            assert len(told) == 1
            if told[0] in error.problem:
                return
            told.clear()
            patience *= 2
            assert patience < 1000
            continue
        assert not told
        seconds = time.monotonic() - start
        points = np.concatenate([points, points])


def test_a_callback_that_returns_none_goes_on(scene):
    assert vt.compute(scene, SQUARE, max_range=60, progress=lambda stage, fraction: None).outcome == "computed"


INTERRUPTED = """
import os, signal, sys, threading
sys.path.insert(0, {tests!r})
from test_calls import slow
threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    slow()
except KeyboardInterrupt:
    print("interrupted")
"""


def test_ctrl_c():
    start = time.monotonic()
    ran = subprocess.run([sys.executable, "-c", INTERRUPTED.format(tests=os.path.dirname(__file__))], capture_output=True,
                         text=True, timeout=120)
    assert ran.stdout.strip() == "interrupted", ran.stderr
    assert time.monotonic() - start < 30


def test_the_interpreter_goes_on_meanwhile():
    counts = []
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counts.append(1)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    told = iter(range(20))
    try:
        with pytest.raises(vt.CancelledError):
            slow(lambda stage, fraction: next(told) < 10)
    finally:  # else the interpreter would wait for the thread for ever
        stop.set()
        thread.join()
    assert len(counts) > 20


def test_threads_share_a_scene(scene, result):
    hashes = [None] * 4

    def work(i):
        hashes[i] = vt.compute(scene, SQUARE, max_range=60).volume.hash

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert hashes == [result.volume.hash] * 4


def test_threads_that_are_told_of_progress_do_not_wait_for_each_other():
    finished = []

    def work():
        scene = yard()
        for _ in range(2):
            mission = vt.Mission.of(scene, SQUARE, sensor=vt.Sensor(max_range=60, visible=0.5, cells=16),
                                    progress=lambda stage, fraction: None)
            finished.append((mission.notes, mission.run(progress=lambda stage, fraction: None).outcome))

    threads = [threading.Thread(target=work, daemon=True) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert [outcome for notes, outcome in finished] == ["computed"] * 6


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_is_refused(scene, result):
    pid = os.fork()
    if pid == 0:
        try:
            vt.compute(scene, SQUARE, max_range=60)
        except vt.Error as error:
            os._exit(0 if "spawn" in error.fix else 1)
        os._exit(2)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0


def test_pickles(scene, result):
    again = pickle.loads(pickle.dumps(scene))
    assert again.hash == scene.hash and again.objects == scene.objects
    volume = pickle.loads(pickle.dumps(result.volume))
    assert volume.hash == result.volume.hash and [c.name for c in volume.causes] == [c.name for c in result.causes]
    assert np.array_equal(volume.cause_of, result.cause_of) and volume.provenance == result.volume.provenance
    empty = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude=(500, 600))).volume
    again = pickle.loads(pickle.dumps(empty))
    assert again.empty and again.outcome == empty.outcome and again.reason == empty.reason
