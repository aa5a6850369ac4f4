"""The end of the interpreter: with threads in vantage, after Ctrl-C, in forks and in subinterpreters."""

import os
import signal
import subprocess
import sys
import textwrap

import pytest

TESTS = os.path.dirname(__file__)
START = f"""
import os, signal, sys, threading, time
sys.path.insert(0, {TESTS!r})
import numpy as np
import vantage as vt
from conftest import SQUARE, yard
scene = yard()
"""


def ended(text, *, timeout=120):
    """What became of a script: exit code, standard output and error."""
    ran = subprocess.run([sys.executable, "-c", START + textwrap.dedent(text)], capture_output=True, text=True,
                         timeout=timeout)
    return ran.returncode, ran.stdout, ran.stderr


WORK = {
    "compute": "vt.compute(scene, SQUARE, max_range=60)",
    "query": "result.query(points)",
    "prove": "result.prove(maximal=True)",
    "errors": "try_it(lambda: vt.compute(scene, [[0, 0, 0]], max_range=60))",
    "callback": "vt.compute(scene, SQUARE, sensor=half, progress=lambda stage, share: time.sleep(0.001))",
    "callback of another thread": "result.query(points, progress=lambda stage, share: time.sleep(0.001))",
    "bar": "vt.compute(scene, SQUARE, sensor=half, progress=True)",
    "hash": "result.volume.hash",
    "save": "result.volume.save(os.path.join(os.environ['HERE'], 'volume.ply'))",
    "contains": "result.volume.contains(points)",
}


@pytest.mark.parametrize("work", WORK)
def test_a_daemon_thread_in_vantage_does_not_disturb_the_end(work, tmp_path, monkeypatch):
    monkeypatch.setenv("HERE", str(tmp_path))
    code, told, said = ended(f"""
        result = vt.compute(scene, SQUARE, max_range=60)
        half = vt.Sensor(max_range=60, visible=0.5, cells=64)
        points = np.random.default_rng(1).uniform(-60, 60, (20000, 3))
        from vantage import _progress
        _progress._PATIENCE_S = 0
        sys.stderr = open(os.devnull, "w")  # bars; what the process itself says comes through

        def try_it(call):
            try:
                call()
            except vt.Error:
                pass

        def work():
            while True:
                {WORK[work]}

        for _ in range(3):
            threading.Thread(target=work, daemon=True).start()
        time.sleep(0.4)
        print("the main thread ends")
        """)
    assert (code, told, said) == (0, "the main thread ends\n", ""), f"{code}: {said}"


def test_ctrl_c_while_the_main_thread_waits_for_one_in_vantage():
    code, told, said = ended("""
        signal.signal(signal.SIGINT, signal.default_int_handler)

        def work():
            vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, visible=0.5, cells=256), work_limit=1e12)

        thread = threading.Thread(target=work)
        thread.start()
        threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        thread.join()
        """)
    assert code in (1, 130, -signal.SIGINT) and "KeyboardInterrupt" in said, said
    assert "nanobind" not in said and "leaked" not in said and "terminate" not in said


def test_threads_of_vantage_leave_signals_to_the_main_thread():
    """Else one of them may take Ctrl-C, and the main thread goes on waiting."""
    code, told, said = ended("""
        def holds(task, number):
            try:
                with open(f"/proc/self/task/{task}/status") as status:
                    held = next(line for line in status if line.startswith("SigBlk")).split()[1]
            except (FileNotFoundError, ProcessLookupError):
                return None  # it has ended
            return bool(int(held, 16) >> (number - 1) & 1)

        def tasks():
            return {int(task) for task in os.listdir("/proc/self/task")}

        def query():
            while True:
                result.query([[5, 5, 20]])

        def compute():
            vt.compute(scene, SQUARE, sensor=vt.Sensor(max_range=60, visible=0.5, cells=256), work_limit=1e12)

        result = vt.compute(scene, SQUARE, max_range=60)
        before = tasks()
        threading.Thread(target=query, daemon=True).start()
        time.sleep(0.2)
        before |= {thread.native_id for thread in threading.enumerate()}
        print({holds(task, signal.SIGINT) for task in tasks() - before})
        computing = threading.Thread(target=compute, daemon=True)
        computing.start()
        time.sleep(0.2)
        seen = [holds(task, signal.SIGINT) for task in tasks() - before for _ in range(50) if not time.sleep(0.001)]
        print(len(seen) > 50, set(seen) - {None}, holds(computing.native_id, signal.SIGSEGV))
        print(holds(threading.main_thread().native_id, signal.SIGINT))
        """)
    assert (code, told, said) == (0, "{True}\nTrue {True} False\nFalse\n", "")


def test_nothing_leaks_of_what_ends_by_itself():
    """Our warnings of leaks are off for others. Here they are on."""
    code, told, said = ended("""
        from vantage import _core
        _core.warn_of_leaks(True)
        result = vt.compute(scene, SQUARE, max_range=60, progress=lambda stage, share: None)
        result.query([[5, 5, 20]])
        result.contains([[5, 5, 20]])
        result.volume.contains([[5, 5, 20]])
        result.volume.simplify(facets=100)
        result.prove()
        result.slice(z=10).polygons
        kept = result.vertices, result.scene.object_of
        for wrong in ([[0, 0, 0]], [[0, 0, np.nan]] * 3):
            try:
                vt.compute(scene, wrong, max_range=60)
            except vt.Error:
                pass
        print(result)
        """)
    assert code == 0 and "facets" in told and said == "", said


def test_a_forked_process_ends_at_once(tmp_path):
    """Though it was forked while another thread computed."""
    code, told, said = ended("""
        def work():
            while True:
                vt.compute(scene, SQUARE, max_range=60)

        threading.Thread(target=work, daemon=True).start()
        time.sleep(0.3)
        pid = os.fork()
        if pid == 0:
            sys.exit(7)
        began = time.monotonic()
        print(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), time.monotonic() - began < 3)
        """)
    assert (code, told) == (0, "7 True\n"), said
    assert "terminate" not in said and "Fatal" not in said


def test_subinterpreters_are_refused():
    code, told, said = ended("""
        import _xxsubinterpreters as other
        one = other.create()
        try:
            other.run_string(one, "import sys; sys.path[:] = %r; import vantage" % sys.path)
        except other.RunFailedError as error:
            print(error)
        """)
    assert code == 0 and "ImportError" in told and "spawn" in told, (told, said)
