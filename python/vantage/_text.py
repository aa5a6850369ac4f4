"""Arguments as the text of a mission file: the names, the checks and the meaning are those of the mission file."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from ._checks import shown, text as checked_text
from ._errors import Error, input_error

T = TypeVar("T")

NAME = "arguments"
"""What stands for the file in places, "arguments:3:5", which become names of arguments."""


class Text:
    """Lines of YAML, one for each value, and which argument each line is of."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._arguments: list[str] = []

    def add(self, key: str, value: Any, argument: str | None = None) -> None:
        """A key of the outermost map. `argument`: what the caller knows it as."""
        self._add(f"{key}:", value, 0, argument or key)

    def add_items(self, key: str, items: Sequence[Any], arguments: Sequence[str]) -> None:
        """A key with a list. `arguments`: what the caller knows each item as."""
        self._line(f"{key}:", 0, key)
        for item, argument in zip(items, arguments):
            self._add("-", item, 1, argument)

    def _add(self, head: str, value: Any, depth: int, argument: str) -> None:
        try:
            self._value(head, value, depth, argument)
        except RecursionError:
            raise input_error("value-syntax", f"{argument} is nested too deeply", argument,
                              "pass plain lists and dictionaries") from None

    def text(self) -> str:
        return "".join(line + "\n" for line in self._lines) or "{}\n"

    def _line(self, text: str, depth: int, argument: str) -> None:
        self._lines.append("  " * depth + text)
        self._arguments.append(argument)

    def _value(self, head: str, value: Any, depth: int, argument: str) -> None:
        if isinstance(value, Mapping):
            if not value:
                return self._line(f"{head} {{}}", depth, argument)
            self._line(head, depth, argument)
            for key, item in value.items():
                self._value(f"{_key(key, argument)}:", item, depth + 1, f"{argument}[{key!r}]")
        elif _is_list(value) and any(isinstance(item, Mapping) for item in value):
            self._line(head, depth, argument)
            for number, item in enumerate(value):
                self._value("-", item, depth + 1, f"{argument}[{number}]")
        else:
            self._line(f"{head} {flow(value, argument)}", depth, argument)

    def call(self, work: Callable[[], T]) -> T:
        """What `work` returns. Errors in the text become errors of the argument."""
        try:
            return work()
        except Error as error:
            raise self.renamed(error) from None

    def renamed(self, error: Error) -> Error:
        """The same error, with the argument for its place in the text."""
        match = re.search(rf"(?:^|/){NAME}:(\d+):\d+", error.where)
        if not match:
            whole = re.match(rf"(?:/.*/)?{NAME}(?:, |$)", error.where)  # of the mission, no line of it
            where = error.where[whole.end():] if whole else error.where
            return type(error)(error.kind, error.code, error.problem, where, error.fix, error.object)
        argument = self._arguments[min(int(match[1]), len(self._arguments)) - 1] if self._arguments else ""
        rest = error.where[match.end():].strip(" ,:")
        # "sensor.incidence" says more than the line of the section; but not of which target something is.
        is_exact = re.fullmatch(r"\w+(\.\w+)+", rest) and not argument.startswith("target")
        where = rest if is_exact else f"{argument}, {rest}" if rest else argument
        return type(error)(error.kind, error.code, error.problem, where, error.fix, error.object)


def _key(key: Any, argument: str) -> str:
    """A key as it may stand in the text: nothing in it begins another one."""
    if not isinstance(key, str) or not re.fullmatch(r"[A-Za-z_][\w.]*", key):
        raise input_error("unknown-key", f"{shown(key)} is not a key", argument, "use the mission file's keys")
    return key


def _is_list(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def flow(value: Any, argument: str) -> str:
    """A value on one line."""
    if isinstance(value, np.ndarray) and value.dtype == np.float64 and np.isfinite(value).all():
        return repr(value.tolist())  # what follows says the same, number by number
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise input_error("value-out-of-range", f"{argument} has the number {value}", argument,
                              "pass finite numbers")
        return repr(value)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return json.dumps(checked_text(value, argument))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key, argument)}: {flow(item, argument)}" for key, item in value.items()) + "}"
    if _is_list(value):
        return "[" + ", ".join(flow(item, argument) for item in value) + "]"
    raise input_error("wrong-type", f"{argument} has a value of type {type(value).__name__}", argument,
                      "pass numbers, texts, lists and dictionaries")
