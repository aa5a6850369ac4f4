"""Temporary folders: who removes them, also when a process is killed."""

import os
import subprocess
import sys

import pytest

from vantage._folders import Folder, remove_abandoned

HOLDER = """
import sys
from vantage._folders import Folder
held = Folder(".x-", sys.argv[1])
open(held.path + "/file", "w").close()
print(held.path, flush=True)
sys.stdin.read()
"""


def holder(parent):
    """A process that has a folder until it is killed, or told to end by the end of its input."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    process = subprocess.Popen([sys.executable, "-c", HOLDER, str(parent)], env=environment, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    return process, process.stdout.readline().strip()


def test_goes_with_its_block(tmp_path):
    with Folder(".x-", tmp_path) as folder:
        assert os.path.dirname(folder) == str(tmp_path) and os.stat(folder).st_mode & 0o777 == 0o700
        open(os.path.join(folder, "file"), "w").close()
    assert list(tmp_path.iterdir()) == []


def test_goes_with_the_process(tmp_path):
    process, path = holder(tmp_path)
    assert os.path.isdir(path)
    process.communicate(timeout=60)
    assert list(tmp_path.iterdir()) == []


def test_of_a_killed_process_goes_with_the_next(tmp_path):
    process, path = holder(tmp_path)
    with Folder(".x-", tmp_path):
        assert os.path.isfile(os.path.join(path, "file")), "that of a process that lives stays"
    process.kill()
    process.wait()
    assert os.path.isdir(path)
    with Folder(".y-", tmp_path), Folder(".x-", tmp_path, removes_others=False):
        assert os.path.isdir(path), "another kind; and one that leaves others alone"
    with Folder(".x-", tmp_path) as mine:
        assert os.listdir(tmp_path) == [os.path.basename(mine)]


def test_nothing_else_is_removed(tmp_path):
    (tmp_path / ".x-longer_than_it_is").mkdir()
    (tmp_path / ".x-abcdefgh").write_text("a file")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / ".x-12345678").symlink_to(tmp_path / "elsewhere")
    before = sorted(tmp_path.iterdir())
    remove_abandoned(".x-", tmp_path)
    assert sorted(tmp_path.iterdir()) == before
    (tmp_path / ".x-00000000").mkdir()
    remove_abandoned(".x-", tmp_path)
    assert sorted(tmp_path.iterdir()) == before
    remove_abandoned(".x-", tmp_path / "none")


def test_a_forked_process_leaves_those_of_its_parent(tmp_path):
    code = ("import os, sys\nfrom vantage._folders import Folder\nheld = Folder('.x-', sys.argv[1])\n"
            "if os.fork() == 0:\n    sys.exit(0)\nos.wait()\nprint(os.path.isdir(held.path))")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    said = subprocess.run([sys.executable, "-c", code, str(tmp_path)], env=environment, capture_output=True, text=True)
    assert said.stdout.split() == ["True"], said
    assert list(tmp_path.iterdir()) == []


def test_none_can_be_made(tmp_path):
    with pytest.raises(FileNotFoundError):
        Folder(".x-", tmp_path / "none")
