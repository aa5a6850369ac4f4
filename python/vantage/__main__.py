"""`python -m vantage` is the program `vantage`, and has the command `batch` besides."""

from __future__ import annotations

import signal
import sys

from . import _core


def main() -> int:
    """Runs the program with the arguments of the command line; its exit code."""
    arguments = ["batch", "--help"] if sys.argv[1:3] == ["help", "batch"] else sys.argv[1:]
    if arguments[:1] == ["batch"]:
        from .batch import _cli

        return _cli.main(arguments[1:])
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the program has its own handler
    return _core.run_program(arguments)


if __name__ == "__main__":
    sys.exit(main())
