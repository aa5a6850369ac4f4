"""Temporary folders: who removes them, also when a process is killed."""

import os
import shutil
import subprocess
import sys

import pytest

from vantage._folders import MARK, Folder, remove_abandoned, remove_all

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


def marked(path):
    """A folder as a killed process leaves it."""
    with Folder(path.name[:3], path.parent) as folder:
        text = open(os.path.join(folder, MARK)).read()
    path.mkdir()
    (path / MARK).write_text(text)
    return text


@pytest.mark.parametrize("remove", [remove_abandoned, remove_all])
def test_folders_that_vantage_did_not_make_stay(tmp_path, remove):
    """A name alone shows nothing: "vantage-scene-florence" is also one that people give."""
    text = marked(tmp_path / ".x-my_files")
    assert len(text) > 20
    for name in ("florence", "examples", "longnote", "the_link", "a_folder"):
        (tmp_path / f".x-{name}").mkdir()
        (tmp_path / f".x-{name}" / "city.osm.pbf").write_text("mine")
    (tmp_path / ".x-examples" / MARK).write_text("my notes")
    (tmp_path / ".x-longnote" / MARK).write_text(text + "x")
    (tmp_path / "mark").write_text(text)
    (tmp_path / ".x-the_link" / MARK).symlink_to(tmp_path / "mark")
    (tmp_path / ".x-a_folder" / MARK).mkdir()
    remove(".x-", tmp_path)
    assert not (tmp_path / ".x-my_files").exists()
    assert [path.read_text() for path in tmp_path.glob(".x-*/city.osm.pbf")] == ["mine"] * 5


@pytest.mark.parametrize("remove", [remove_abandoned, remove_all])
def test_a_process_may_be_killed_before_the_mark_is_whole(tmp_path, remove):
    text = marked(tmp_path / ".x-my_files")
    for name, part in (("no_bytes", ""), ("all_half", text[:20]), ("and_more", text[:20]), ("my_notes", "my notes")):
        (tmp_path / f".x-{name}").mkdir(0o700)
        (tmp_path / f".x-{name}" / MARK).write_text(part)
    (tmp_path / ".x-and_more" / "city.osm.pbf").write_text("mine")
    (tmp_path / ".x-no_marks").mkdir(0o700)
    remove(".x-", tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [".x-and_more", ".x-my_notes"]
    assert (tmp_path / ".x-and_more" / MARK).read_text() == text[:20]


@pytest.mark.parametrize("remove", [remove_abandoned, remove_all])
def test_an_empty_folder_that_somebody_else_made_stays(tmp_path, remove):
    (tmp_path / ".x-my_files").mkdir()
    (tmp_path / ".x-my_files").chmod(0o755)
    remove(".x-", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [".x-my_files"]


@pytest.mark.parametrize("remove", [remove_abandoned, remove_all])
def test_what_comes_while_a_folder_is_removed_stays(tmp_path, monkeypatch, remove):
    """Somebody writes into a folder that was empty when it was looked at."""
    (tmp_path / ".x-no_marks").mkdir(0o700)
    remove_folder = os.rmdir

    def write_and_remove(path):
        (tmp_path / ".x-no_marks" / "city.osm.pbf").write_text("mine")
        remove_folder(path)

    monkeypatch.setattr(os, "rmdir", write_and_remove)
    remove(".x-", tmp_path)
    assert (tmp_path / ".x-no_marks" / "city.osm.pbf").read_text() == "mine"


def test_it_is_marked_before_anything_else_is_in_it(tmp_path):
    with Folder(".x-", tmp_path) as folder:
        assert os.listdir(folder) == [MARK]


def test_the_mark_is_removed_last(tmp_path, monkeypatch):
    """What is left of a removal is still marked."""
    seen = []
    with Folder(".x-", tmp_path) as folder:
        os.makedirs(os.path.join(folder, "deep", "deeper"))
        for name in ("a", "deep/b", "z"):
            open(os.path.join(folder, name), "w").close()
        whole = shutil.rmtree

        def rmtree(path, *arguments, **options):
            seen.append(sorted(os.listdir(folder)))
            whole(path, *arguments, **options)

        monkeypatch.setattr(shutil, "rmtree", rmtree)
    assert seen[-1] == [MARK] and all(MARK in names for names in seen) and list(tmp_path.iterdir()) == []


def test_links_are_not_followed(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "file").write_text("mine")
    with Folder(".x-", tmp_path) as folder:
        os.symlink(tmp_path / "mine", os.path.join(folder, "link"))
        os.mkdir(os.path.join(folder, "deep"))
        os.symlink(tmp_path / "mine", os.path.join(folder, "deep", "link"))
    assert [path.name for path in tmp_path.iterdir()] == ["mine"] and (tmp_path / "mine" / "file").read_text() == "mine"


def test_nothing_else_is_removed(tmp_path):
    (tmp_path / ".x-longer_than_it_is").mkdir()
    (tmp_path / ".x-abcdefgh").write_text("a file")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / ".x-12345678").symlink_to(tmp_path / "elsewhere")
    before = sorted(tmp_path.iterdir())
    remove_abandoned(".x-", tmp_path)
    assert sorted(tmp_path.iterdir()) == before
    marked(tmp_path / ".x-00000000")
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
