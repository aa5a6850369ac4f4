"""Batches: damaged files, lost files, killed processes, other runs in the same folder."""

import collections
import contextlib
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

import pytest

import vantage as vt
from conftest import PROJECT
from test_batch import refused, triangles, without_time

pytest.importorskip("pyarrow")
pytest.importorskip("geopandas")

import vantage.batch as batch  # noqa: E402
from vantage.batch import _lock, _run, _store, _table, _work  # noqa: E402

ASKED = {"max_range": 60, "shard_rows": 3, "volumes": "ply", "workers": 1}
KILLS = int(os.environ.get("VANTAGE_BATCH_KILLS", "6"))
"""How often test_killed_again_and_again kills a process."""


@pytest.fixture(scope="module")
def whole(scene, tmp_path_factory):
    """A run to its end."""
    return batch.run(triangles(), scene, tmp_path_factory.mktemp("whole"), **ASKED)


@pytest.fixture
def finished(scene, tmp_path):
    """A folder of a finished run, and its job."""
    batch.run(triangles(), scene, tmp_path, **ASKED)
    table = _table.read(triangles(), crs=None, options=None)
    asked = {"sensor": vt.Sensor(max_range=60), "navigation": None, "method": "exact", "tolerance": None, "spheres": None}
    return tmp_path, _run._job(table, scene, _store.Store(tmp_path), asked, "ply", 3, None)


def files_of(folder, pattern="volumes/**/*.ply"):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.glob(pattern))}


# ---- damaged and lost files


def test_flipped_bits(finished):
    folder, job = finished
    name = _work.shard_name(0)
    right = _run._rows_of(job, name)
    paths = [folder / name, folder / "rows" / "000000.json", *sorted((folder / "volumes" / "000000").iterdir())]
    seed = int(os.environ.get("VANTAGE_SEED", "5"))
    print(f"seed {seed}")
    drawn, seen = random.Random(seed), collections.Counter()
    for _ in range(600):
        path = drawn.choice(paths)
        content = path.read_bytes()
        flipped = bytearray(content)
        flipped[drawn.randrange(len(flipped))] ^= 1 << drawn.randrange(8)
        path.write_bytes(flipped)
        ids = _run._ids_of(job, name)
        seen[path.suffix, "noticed" if ids is None else "harmless"] += 1
        if ids is not None:  # a blank of the JSON file
            assert path.suffix == ".json" and _run._rows_of(job, name).equals(right)
        path.write_bytes(content)
    assert _run._ids_of(job, name) == ([0, 1, 2], 0), "all is as it was"
    assert seen[".parquet", "noticed"] > 100 and seen[".ply", "noticed"] > 100 and seen[".json", "noticed"] > 100, seen
    print(dict(seen))


@pytest.mark.parametrize("file", ["rows/000001.parquet", "rows/000001.json", "volumes/000001/4.ply"])
@pytest.mark.parametrize("damage", ["flip", "cut", "lose", "empty"])
def test_what_is_damaged_is_computed_again(scene, whole, finished, file, damage):
    folder, _ = finished
    path, before = folder / file, files_of(folder)
    content = bytearray(path.read_bytes())
    if damage == "flip":
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
    elif damage == "cut":
        path.write_bytes(content[:-7])
    elif damage == "empty":
        path.write_bytes(b"")
    else:
        path.unlink()
    again = batch.run(triangles(), scene, folder, **ASKED)
    assert again.computed == 3 and again.result_hash == whole.result_hash
    assert without_time(again).equals(without_time(whole)) and files_of(folder) == before


def test_a_zarr_that_is_lost(scene, tmp_path):
    pytest.importorskip("zarr")
    asked = {**ASKED, "volumes": "zarr"}
    batch.run(triangles(3), scene, tmp_path, **asked)
    before = files_of(tmp_path, "volumes/*")
    (tmp_path / "volumes" / "000000.zarr.zip").unlink()
    assert batch.run(triangles(3), scene, tmp_path, **asked).computed == 3
    assert files_of(tmp_path, "volumes/*") == before and before


def test_results_that_are_damaged(scene, finished):
    folder, _ = finished
    for name in ("results.parquet", "report.json"):
        content = bytearray((folder / name).read_bytes())
        at = content.index(b"results_sha256") + 20 if name == "report.json" else len(content) // 3
        (folder / name).write_bytes(content[:at] + bytes([content[at] ^ 2]) + content[at + 1:])
        with pytest.raises(vt.Error) as raised:
            batch.results(folder)
        assert raised.value.code == "file-changed" and "results.parquet" in raised.value.where
        (folder / name).write_bytes(content)
        assert len(batch.results(folder)) == 10
    (folder / "report.json").unlink()
    with pytest.raises(vt.Error) as raised:
        batch.results(folder)
    assert raised.value.code == "file-not-found"


def test_a_scene_that_is_damaged(scene, tmp_path):
    from vantage.batch import _scenes

    store = _store.Store(tmp_path)
    _scenes.save(scene, store)
    content = (tmp_path / "scene.npz").read_bytes()
    for at in range(0, len(content), 97):
        (tmp_path / "scene.npz").write_bytes(content[:at] + bytes([content[at] ^ 64]) + content[at + 1:])
        with contextlib.suppress(vt.Error):
            _scenes._kept.clear()
            assert _scenes.kept({"arrays": scene.hash}, scene.hash, store).hash == scene.hash


# ---- other runs in the same folder


def test_one_run_at_a_time(scene, whole, tmp_path):
    told = []

    def another(stage, fraction):
        if not told:
            told.append(refused(triangles(), scene, tmp_path, **ASKED))
        return True

    report = batch.run(triangles(), scene, tmp_path, **ASKED, progress=another)
    assert told[0].code == "folder-in-use" and f"process {os.getpid()} " in told[0].problem
    assert without_time(report).equals(without_time(whole)) and not (tmp_path / _lock.LOCK).exists()


def test_the_lock_ends_with_its_process(tmp_path):
    store = _store.Store(tmp_path)
    code = f"""
import time, vantage.batch
from vantage.batch import _lock, _store
with _lock.Lock(_store.Store({str(tmp_path)!r})):
    print("held", flush=True)
    time.sleep(600)
"""
    other = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=with_our_modules())
    assert other.stdout.readline() == "held\n"
    with pytest.raises(vt.Error) as raised:
        _lock.Lock(store).__enter__()
    assert raised.value.code == "folder-in-use" and f"process {other.pid} " in raised.value.problem
    other.kill()
    other.communicate()
    with _lock.Lock(store):
        assert (tmp_path / _lock.LOCK).read_text().startswith(f"process {os.getpid()} of ")
    assert list(tmp_path.iterdir()) == []


def test_a_file_system_without_locks_is_told(tmp_path, monkeypatch):
    def flock(*arguments):
        raise OSError(_lock.errno.EOPNOTSUPP, "not supported")

    monkeypatch.setattr(_lock.fcntl, "flock", flock)
    with pytest.warns(UserWarning, match="has no locks"), _lock.Lock(_store.Store(tmp_path)):
        pass


@pytest.mark.parametrize("kind", ["text", "link", "link to nothing", "folder", "pipe", "half"])
def test_what_only_has_the_name_of_the_lock_stays(tmp_path, kind):
    lock, mine, out = tmp_path / "out" / _lock.LOCK, tmp_path / "mine", tmp_path / "out"
    out.mkdir()
    mine.write_text("process 1 of mine\n")
    if kind == "text":
        lock.write_text("pid 17\nprocess 17 of here\n")
    elif kind == "half":
        lock.write_text("process 17 of here\nand more")
    elif kind == "folder":
        lock.mkdir()
    elif kind == "pipe":
        os.mkfifo(lock)
    else:
        lock.symlink_to(mine if kind == "link" else tmp_path / "none")
    before = lock.lstat()
    with pytest.raises(vt.Error) as raised:
        _lock.Lock(_store.Store(out)).__enter__()
    assert raised.value.code == "folder-in-use" and raised.value.where == str(lock) and "move it" in raised.value.fix
    assert os.path.samestat(lock.lstat(), before) and lock.lstat().st_size == before.st_size
    assert mine.read_text() == "process 1 of mine\n" and not (tmp_path / "none").exists()


def test_the_lock_of_another_program_stays(tmp_path):
    (tmp_path / ".lock").write_text("of another program")
    with _lock.Lock(_store.Store(tmp_path)):
        pass
    assert [path.name for path in tmp_path.iterdir()] == [".lock"]
    assert (tmp_path / ".lock").read_text() == "of another program"


def test_a_lock_that_was_left_is_taken(tmp_path):
    (tmp_path / _lock.LOCK).write_text("process 17 of here\n")
    with _lock.Lock(_store.Store(tmp_path)):
        assert (tmp_path / _lock.LOCK).read_text().startswith(f"process {os.getpid()} of ")
        (tmp_path / _lock.LOCK).unlink()
        (tmp_path / _lock.LOCK).write_text("mine")
    assert (tmp_path / _lock.LOCK).read_text() == "mine", "it is another file by now"


def test_only_what_a_run_left_is_tidied(tmp_path):
    from vantage import _folders

    store = _store.Store(tmp_path)
    mine = [".unfinished-novel/1.txt", ".unfinished-novels_1/1.txt", "rows/.unfinished-12345678/1.txt", ".film.mkv.part",
            ".film.mkv.12-34.part", "mine/.000001.json.vantage-12-34.part", "volumes/mine/.a.ply.vantage-1-2.part",
            "rows/.000001.json.vantage-12.part", "rows/000001.json.vantage-12-34.part"]
    left = [_store._beside("report.json"), _store._beside("rows/000001.json"), _store._beside("volumes/000001.zarr.zip")]
    for name in mine + left:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    (tmp_path / "volumes" / left[0]).symlink_to(tmp_path / mine[0])
    folder = store.scratch()
    folder._end.detach()  # as of a killed process
    (pathlib.Path(folder.path) / "volume.ply").write_text("half")
    assert os.path.isfile(os.path.join(folder.path, _folders.MARK))
    store.remove_unfinished()
    assert [name for name in mine if not (tmp_path / name).is_file()] == []
    assert [name for name in left if (tmp_path / name).exists()] == [] and not os.path.exists(folder.path)
    assert (tmp_path / "volumes" / left[0]).is_symlink()


def test_a_folder_with_files_of_others_is_refused(scene, tmp_path):
    for name in ("results.parquet", "report.json", "scene.npz", "volumes/000000/0.ply", "rows/000000.parquet"):
        out = tmp_path / name.replace("/", "_")
        (out / name).parent.mkdir(parents=True)
        (out / name).write_text("mine")
        told = refused(triangles(), scene, out, **ASKED)
        assert told.code == "folder-in-use" and name.partition("/")[0] in told.where, told
        assert [path for path in out.rglob("*") if path.is_file()] == [out / name] and (out / name).read_text() == "mine"


class Line:
    """A store on the other end of a line that breaks: its files appear with their first byte."""

    def __init__(self, folder, breaks):
        from fsspec.implementations.local import LocalFileSystem

        class Breaking(LocalFileSystem):
            protocol = "line"
            names = []

            def put_file(self, local, path, **options):
                self.names.append(path)
                with open(local, "rb") as file:
                    content = file.read()
                self.pipe_file(path, content)

            def pipe_file(self, path, content, **options):
                self.names.append(path)
                with open(path, "wb") as file:
                    file.write(content[:2] if breaks else content)
                if breaks:
                    raise OSError("the line broke")

        self.store = _store.Store(folder)
        self.store.files = Breaking()
        self.store.protocol, self.store.is_local = "line", False


@pytest.mark.parametrize("from_file", [False, True])
def test_elsewhere_files_are_whole_or_not_there(tmp_path, from_file):
    (tmp_path / "local").write_bytes(b"12345")

    def put(store):
        if from_file:
            store.put_file("rows/a", tmp_path / "local")
        else:
            store.put("rows/a", b"12345")

    put(Line(tmp_path / "out", False).store)
    assert (tmp_path / "out" / "rows" / "a").read_bytes() == b"12345"
    (tmp_path / "out" / "rows" / "a").write_bytes(b"older")
    broken = Line(tmp_path / "out", True).store
    with pytest.raises(vt.Error) as raised:
        put(broken)
    assert raised.value.code == "output-unwritable" and "the line broke" in raised.value.problem
    assert str(tmp_path / "out" / "rows" / "a") not in broken.files.names
    assert [(path.name, path.read_bytes()) for path in (tmp_path / "out" / "rows").iterdir()] == [("a", b"older")]


# ---- processes


def with_our_modules(**more):
    return {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path), **more}


def driver(folder, rows, environment=None, cwd=None, scene="yard()", **asked):
    """A process that runs a batch."""
    code = f"""
import sys
sys.path.insert(0, {str(PROJECT / 'python' / 'tests')!r})
import vantage as vt, vantage.batch
from conftest import yard
from test_batch import triangles
rows = {rows}
report = vantage.batch.run(rows, {scene}, {str(folder)!r}, **{asked!r})
print(report.computed, flush=True)
"""
    script = pathlib.Path(folder).parent / "script" / "drive.py"
    script.parent.mkdir(exist_ok=True)
    script.write_text(code)
    return subprocess.Popen([sys.executable, str(script)], env=environment or with_our_modules(), cwd=cwd,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def children(pid):
    try:
        return [int(word) for word in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def is_alive(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in ("Z", "X")
    except OSError:
        return False


def wait_until(is_so, seconds=120):
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.05)


def test_modules_of_the_current_folder_are_left_alone(tmp_path):
    """The script lies elsewhere: nobody asked for what the folder holds in which it was started."""
    current = tmp_path / "current"
    current.mkdir()
    for name in ("pyarrow", "numpy", "shapely", "json", "vantage", "sitecustomize"):
        (current / f"{name}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'a').write({name!r})\n")
    process = driver(tmp_path / "out", "triangles(2)", cwd=current, **ASKED)
    said = process.communicate(timeout=300)[0]
    assert process.returncode == 0, said
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()


def test_where_workers_look_for_modules(tmp_path, monkeypatch):
    from vantage.batch import _pool

    own = str(pathlib.Path(vt.__file__).parents[1])
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", "")
    monkeypatch.setattr(sys, "path", ["", str(tmp_path), "/usr/lib/python3", own])
    assert _pool.module_path() == os.pathsep.join(["/usr/lib/python3", own])
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))  # somebody meant it
    assert _pool.module_path().split(os.pathsep)[0] == str(tmp_path)
    monkeypatch.setattr(sys, "path", ["", "/usr/lib/python3"])  # vantage came from the current folder
    monkeypatch.chdir(own)
    assert _pool.module_path() == os.pathsep.join([own, "/usr/lib/python3"])


def test_workers_end_with_their_driver(tmp_path):
    rows = "[{**row, 'id': i} for i, row in enumerate(triangles() * 4000)]"  # minutes for one shard
    process = driver(tmp_path / "out", rows, max_range=60, shard_rows=100_000, workers=1, volumes="ply")
    try:  # a walk by pathlib fails where a folder goes meanwhile
        wait_until(lambda: any(name.endswith(".ply") for _, _, names in os.walk(tmp_path / "out") for name in names))
        workers = children(process.pid)
    finally:
        process.kill()
        process.wait()
    assert workers, "it was to be in the middle of its shard"
    try:
        wait_until(lambda: not any(map(is_alive, workers)), 60)
    finally:
        for worker in filter(is_alive, workers):
            os.kill(worker, signal.SIGKILL)
    assert not (tmp_path / "out" / "rows").exists(), "it was not the end of the shard that ended them"


REMOTE = f"'file://{PROJECT / 'examples' / 'plaza' / 'plaza.obj'}'"
SQUARES = "[{'id': i, 'vertices': [[-12, -9, 0], [8, -11, 0], [11, 0, 0]]} for i in range(4)]"


def test_copies_of_remote_files_do_not_stay(tmp_path):
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    process = driver(tmp_path / "out", SQUARES, with_our_modules(TMPDIR=str(temporary)), scene=REMOTE, max_range=60,
                     shard_rows=2, workers=2)
    said = process.communicate(timeout=300)[0]
    assert process.returncode == 0 and said.split()[-1] == "4", said
    assert list(temporary.iterdir()) == []


@pytest.fixture
def slow_copies(tmp_path):
    """The folder for temporary files, and an environment in which a worker that is the first to copy a remote file never
    comes to the end of it."""
    temporary, modules = tmp_path / "temporary", tmp_path / "modules"
    temporary.mkdir()
    modules.mkdir()
    (modules / "sitecustomize.py").write_text(f"""
import os, sys, time
if any("_pool" in word for word in sys.orig_argv):
    from fsspec.implementations.local import LocalFileSystem
    whole = LocalFileSystem.get_file

    def slow(self, remote, local, **options):
        try:
            os.close(os.open({str(tmp_path / "slow")!r}, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return whole(self, remote, local, **options)
        with open(local, "w") as half:
            half.write("half")
            half.flush()
            time.sleep(3600)

    LocalFileSystem.get_file = slow
""")
    path = os.pathsep.join([str(modules), *(path for path in sys.path if path)])
    return temporary, {**os.environ, "PYTHONPATH": path, "TMPDIR": str(temporary)}


def half_copies(temporary):
    return [file for file in temporary.glob("vantage-scene-*/plaza.obj") if file.read_text() == "half"]


def test_the_copy_of_a_worker_that_is_killed_does_not_stay(tmp_path, slow_copies):
    temporary, environment = slow_copies
    process = driver(tmp_path / "out", SQUARES, environment, scene=REMOTE, max_range=60, shard_rows=2, workers=1)
    wait_until(lambda: half_copies(temporary) or process.poll() is not None)
    assert half_copies(temporary), process.communicate()[0]
    for worker in children(process.pid):
        os.kill(worker, signal.SIGKILL)
    said = process.communicate(timeout=300)[0]
    assert process.returncode == 0 and said.split()[-1] == "4", said
    assert list(temporary.iterdir()) == []


def test_a_worker_that_loses_its_driver_removes_its_copy(tmp_path, slow_copies):
    from vantage._folders import Folder

    temporary, environment = slow_copies
    process = driver(tmp_path / "out", SQUARES, environment, scene=REMOTE, max_range=60, shard_rows=2, workers=1)
    wait_until(lambda: half_copies(temporary) or process.poll() is not None)
    workers = children(process.pid)
    process.kill()
    process.communicate()
    assert workers
    wait_until(lambda: not any(map(is_alive, workers)), 60)
    assert half_copies(temporary) == []
    with Folder("vantage-scene-", temporary) as mine:  # and those of the driver go with the next
        assert os.listdir(temporary) == [os.path.basename(mine)]


def test_no_copy_is_begun_when_the_process_ends(monkeypatch, tmp_path):
    from vantage.batch import _scenes

    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setattr(_scenes, "_folders", [])
    monkeypatch.setattr(_scenes, "_is_over", False)
    copy = _scenes._here(REMOTE.strip("'"), {})
    assert os.path.getsize(copy) > 0 and len(list(tmp_path.iterdir())) == 1
    _scenes.forget()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(RuntimeError):
        _scenes._here(REMOTE.strip("'"), {})
    assert list(tmp_path.iterdir()) == []


def test_killed_again_and_again(scene, tmp_path):
    """Drivers and workers, at any moment: in the end nothing is lost, nothing is twice, and nothing is left over."""
    rows = "[{**row, 'id': i} for i, row in enumerate(triangles() * 20)]"
    asked = {**ASKED, "workers": 2, "shard_rows": 4}
    right = batch.run([{**row, "id": i} for i, row in enumerate(triangles() * 20)], scene, tmp_path / "right", **asked)
    drawn, kills = random.Random(11), collections.Counter()
    out = tmp_path / "out"
    while True:
        process = driver(out, rows, **asked)
        while kills.total() < KILLS and process.poll() is None:
            wait_until(lambda: children(process.pid) or process.poll() is not None)
            end = time.monotonic() + drawn.uniform(0, 2)
            while time.monotonic() < end and process.poll() is None:
                time.sleep(0.01)
            workers = children(process.pid)
            if not workers or process.poll() is not None:
                continue
            if drawn.random() < 0.6:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(drawn.choice(workers), signal.SIGKILL)
                    kills["workers"] += 1
            else:
                process.kill()
                kills["drivers"] += 1
        said = process.communicate(timeout=300)[0]
        if process.returncode == -signal.SIGKILL:
            continue
        assert process.returncode == 0, said
        if kills.total() >= KILLS:
            break
        for path in sorted((out / "rows").iterdir())[::2]:  # it was done before it was killed often enough
            path.unlink()
    print(dict(kills))
    assert without_time(out).equals(without_time(right))
    assert files_of(out) == files_of(tmp_path / "right")
    assert [path for path in out.rglob("*") if path.name.startswith(".")] == []
