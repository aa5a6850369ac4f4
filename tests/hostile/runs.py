"""Runs the program within limits of the system, and judges how it ended."""

import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import time
from typing import NamedTuple

MOST_MEMORY = 2000  # MB, of what is resident
MOST_TIME = 20  # seconds of the processor
ALLOWED = (0, 1, 2, 4)  # docs/command-line.md: 3 is a defect
# Control characters, what turns the order of others, and bytes that are no UTF-8: src/core/printable.cpp.
OBEYED = re.compile("[\0-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\udc80-\udcff]")


class Run(NamedTuple):
    """How the program ended."""

    code: int  # negative: the signal that ended it
    seconds: float  # of the processor
    megabytes: float
    out: bytes
    err: bytes
    passes_data: bool = False  # to standard output, as they are: those of the user
    is_checker: bool = False  # of certificates: 1 is a certificate that is wrong

    @property
    def was_refused(self) -> bool:
        return self.code == 2 or (self.is_checker and self.code == 1)

    def fault(self) -> str:
        """What is wrong with it; empty when nothing is."""
        if self.code == -signal.SIGXCPU or self.code == -signal.SIGKILL or self.seconds > MOST_TIME:
            return f"takes more than {MOST_TIME} s"
        if self.code < 0:
            return f"is ended by the signal {signal.Signals(-self.code).name}"
        if self.code not in ALLOWED:
            return f"ends with {self.code}: {self.err[:200]!r}"
        if self.megabytes > MOST_MEMORY:
            return f"takes {self.megabytes:.0f} MB"
        for text in (self.err, b"" if self.passes_data else self.out):
            for line in text.decode("utf-8", "surrogateescape").split("\n"):  # splitlines would take out U+2028 as well
                if OBEYED.search(line):
                    return f"prints what a terminal obeys: {line[:200]!r}"
        if b"Traceback (most recent call last)" in self.err:
            return f"prints a traceback: {self.err[-200:]!r}"
        is_told = (self.err.startswith((b"REFUSED: ", b"error: ")) or len(self.err.splitlines()) == 1 if self.is_checker
                   else self.err.startswith(b"vantage: "))  # that of tours says it in one line
        if self.was_refused and not is_told:
            return f"refuses without a message: {self.err[:200]!r}"
        return ""


def limited() -> None:
    """In the child. The address space is bounded above what is allowed, so that the machine is safe."""
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_TIME + 2, MOST_TIME + 4))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))


def run(program: str, arguments: list[str], folder: pathlib.Path, is_checker: bool = False) -> Run:
    """Runs the program in the folder, on one thread: so that processor time is time."""
    passes_data = arguments[:1] == ["query"]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        environment = os.environ | {"VANTAGE_PROGRESS": "never"}  # a line of progress would look like a message
        process = subprocess.Popen([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                   env=environment, preexec_fn=limited)
        deadline = time.monotonic() + 20 * MOST_TIME  # for what waits and does not work
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > deadline:
                process.kill()
            time.sleep(0.002)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        return Run(process.returncode, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, out.read(1 << 20),
                   err.read(1 << 20), passes_data, is_checker)
