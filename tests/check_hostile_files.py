#!/usr/bin/env python3
"""The program on files that were changed at random, and on small files that ask for much.

    check_hostile_files.py PROGRAM [--mutants 300] [--seed 1] [--readers REGEX] [--bombs] [--jobs 2] [--keep FOLDER]

Prints a line for each kind of file, and exits with 1 where the program crashes, ends with 3, takes more than 20 seconds
of the processor or 2000 MB, or prints what a terminal obeys. --keep: where the files that did so are left.
With --self-test it runs programs that do all that, and fails unless each is noticed.
"""

import argparse
import concurrent.futures
import pathlib
import random
import re
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from hostile import bombs, mutate, readers, runs  # noqa: E402


class Tally:
    """Of one kind of file."""

    def __init__(self) -> None:
        self.read = self.refused = 0
        self.seconds = self.megabytes = 0.0
        self.faults: list[str] = []

    def add(self, run: runs.Run, fault: str) -> None:
        self.read += run.code in (0, 1, 4) and not run.was_refused
        self.refused += run.was_refused
        self.seconds = max(self.seconds, run.seconds)
        self.megabytes = max(self.megabytes, run.megabytes)
        if fault:
            self.faults.append(fault)

    def line(self, name: str, count: int) -> str:
        return (f"{name:28} {count:4} files: {self.read:3} read, {self.refused:3} refused, {len(self.faults)} faults; "
                f"at most {self.seconds:.1f} s, {self.megabytes:.0f} MB")


def keep(kept: pathlib.Path | None, name: str, content: bytes) -> str:
    """Leaves a file that did harm; returns what to say of it."""
    if kept is None:
        return ""
    kept.mkdir(parents=True, exist_ok=True)
    (kept / name).write_bytes(content)
    return f" ({kept / name})"


def try_reader(program: str, reader: readers.Reader, base: pathlib.Path, arguments: argparse.Namespace) -> Tally:
    """Mutants of one kind of file, in a folder of its own."""
    tally = Tally()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "work"
        shutil.copytree(base, folder)
        command = [reader.file if word == "FILE" else word for word in reader.arguments]
        runs_it = reader.program or program
        for i in range(arguments.mutants):
            numbers = random.Random(f"{arguments.seed} {reader.name} {i}")
            original = reader.originals[i % len(reader.originals)]
            content = reader.pack(mutate.mutated(original, reader.originals, numbers) if i >= len(reader.originals)
                                  else original)  # first as it is
            (folder / reader.file).write_bytes(content)
            run = runs.run(runs_it, command, folder, is_checker=bool(reader.program))
            fault = run.fault()
            if not fault and i < len(reader.originals) and run.was_refused:
                fault = f"refuses what is right: {run.err[:300]!r}"
            if fault:
                name = f"{re.sub('[^a-z]+', '-', reader.name)}-{arguments.seed}-{i}-{pathlib.PurePath(reader.file).name}"
                fault = f"{reader.name}, mutant {i}: {fault}{keep(arguments.keep, name, content)}"
            tally.add(run, fault)
    return tally


def try_bomb(program: str, bomb: bombs.Bomb, base: pathlib.Path) -> tuple[runs.Run, str]:
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "work"
        shutil.copytree(base, folder)
        (folder / bomb.file).write_bytes(bomb.content())
        run = runs.run(program, bomb.arguments, folder)
        fault = run.fault()
        if not fault and bomb.is_refused and not run.was_refused:
            fault = f"ends with {run.code} and is not refused"
        return run, fault


def prepared(program: str, folder: pathlib.Path) -> None:
    def must(arguments: list[str]) -> None:
        run = runs.run(program, arguments, folder)
        if run.code != 0:
            sys.exit(f"cannot begin: {' '.join(arguments)}: {run.err.decode()}")

    readers.prepare(folder, must)
    bombs.prepare(folder)


def check(program: str, arguments: argparse.Namespace) -> list[str]:
    """What went wrong."""
    faults: list[str] = []
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        base = pathlib.Path(scratch)
        prepared(program, base)
        chosen = [reader for reader in readers.all_readers(base) if re.search(arguments.readers, reader.name)]
        if arguments.mutants > 0:
            for reader, tally in zip(chosen, pool.map(
                    lambda reader: try_reader(program, reader, base, arguments), chosen)):
                print(tally.line(reader.name, arguments.mutants), flush=True)
                faults += tally.faults
        if arguments.bombs:
            wanted = [bomb for bomb in bombs.all_bombs() if re.search(arguments.readers, bomb.name)]
            for bomb, (run, fault) in zip(wanted, pool.map(lambda bomb: try_bomb(program, bomb, base), wanted)):
                said = (run.err or run.out).split(b"\n")[0][:90].decode("utf-8", "replace")
                print(f"{bomb.name:44} {'refused' if run.was_refused else 'read   '} {run.seconds:5.1f} s "
                      f"{run.megabytes:5.0f} MB  {said}", flush=True)
                if fault:
                    faults.append(f"{bomb.name}: {fault}")
    return faults


def self_test() -> list[str]:
    """Programs that do what is forbidden."""
    bad = {"crash": "kill -SEGV $$", "defect": "echo 'vantage: no' >&2; exit 3", "escape": "printf 'vantage: \\033[2J\\n' >&2; exit 2",
           "silent": "exit 2", "loop": "ulimit -t 1; while :; do :; done",
           "escape in results": "printf 'a\\033[2J\\n'", "order": "printf 'a\\xe2\\x80\\xae\\n'", "separator": "printf 'a\\xe2\\x80\\xa8\\n'",
           "no text": "printf '\\x9b2J\\n'", "traceback": "echo 'Traceback (most recent call last):' >&2; exit 1",
           "memory": f"exec {sys.executable} -c 'bytearray({runs.MOST_MEMORY + 200} << 20)'"}
    missed = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, text in bad.items():
            file = folder / name
            file.write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
            file.chmod(0o755)
            if not runs.run(str(file), [], folder).fault():
                missed.append(name)
        good = folder / "good"
        good.write_text("#!/bin/bash\necho 'vantage: no' >&2; [ \"$1\" != query ] || printf 'a\\033[2J\\n'; exit 2\n",
                        encoding="utf-8")
        good.chmod(0o755)
        for arguments in ([], ["query"]):  # the second one passes through what users have in their tables
            if runs.run(str(good), arguments, folder).fault():
                missed.append("good")
    return [f"not noticed: {name}" for name in missed]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--mutants", type=int, default=300, help="of each kind of file (default 300)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--readers", default="", help="a regular expression: only kinds whose name it matches")
    parser.add_argument("--bombs", action="store_true", help="also the files that ask for much")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        faults = self_test()
    else:
        print(f"seed {arguments.seed}")
        faults = check(str(pathlib.Path(arguments.program).resolve()), arguments)
    for fault in faults:
        print(f"FAULT {fault}", file=sys.stderr)
    print(f"hostile files: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
