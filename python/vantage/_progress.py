"""How long calls tell what they do."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, Union

from ._errors import input_error

Listener = Union[Callable[[str, float], Any], None]
"""What is called, if anything."""

Progress = Union[bool, Listener]
"""True shows a bar. Or a function that is called with the stage and the part of it that is done; False stops the work."""

_PATIENCE_S = 0.5
"""What takes no longer than this shows no bar."""


class Bar:
    """A bar of tqdm, or a line on standard error where tqdm is not installed. Called with the stage and the part of it that is
    done. The extension makes one where `progress` is True; `listener` does for what is written in Python.

    Example:
        >>> bar = Bar()
        >>> bar("reading", 0.5)
        >>> bar.close()
    """

    def __init__(self) -> None:
        self._start = time.monotonic()
        self._stage = ""
        self._tqdm: Any = None
        self._line = ""
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._make: Any = None
        else:
            self._make = tqdm

    def __call__(self, stage: str, fraction: float) -> None:
        if time.monotonic() - self._start < _PATIENCE_S:
            return
        percent = round(100 * min(max(fraction, 0.0), 1.0))
        if self._make is None:
            self._write(f"{stage} {percent:3d} %")
            return
        if self._tqdm is None:
            self._tqdm = self._make(total=100, bar_format="{desc} {percentage:3.0f} %|{bar}| {elapsed}", leave=False)
        if stage != self._stage:
            self._stage = stage
            self._tqdm.set_description_str(stage, refresh=False)
        self._tqdm.n = percent
        self._tqdm.refresh()

    def close(self) -> None:
        """Takes the bar away, or ends its line."""
        if self._tqdm is not None:
            self._tqdm.close()
            self._tqdm = None
        if self._line:
            self._line = ""
            _say("\n")

    def __del__(self) -> None:
        self.close()

    def _write(self, line: str) -> None:
        if line == self._line:
            return
        _say("\r" + line.ljust(len(self._line)))
        self._line = line


def _say(text: str) -> None:
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except OSError:  # no one can read it: the work goes on
        pass


def listener(progress: Progress) -> Listener:
    """What functions that are written in Python call: True becomes a bar, which goes when it is no longer used."""
    if isinstance(progress, bool):
        return Bar() if progress else None
    if progress is not None and not callable(progress):
        raise input_error("wrong-type", "progress is neither a function nor True or False", "progress",
                          "pass a function of a stage and a fraction, or True for a bar")
    return progress
