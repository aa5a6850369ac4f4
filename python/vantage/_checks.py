"""Single values from callers: checked here, with an error that says what is wrong."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from ._errors import input_error

T = TypeVar("T")

_MOST_THREADS = 1024
"""As the program has it."""


def shown(value: Any) -> str:
    """What the value is, for a message: never long, and never an exception of its own."""
    try:
        text = repr(value)
    except Exception:
        text = f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."


def whole(value: Any, name: str, least: int = 0, most: int = 2**63 - 1) -> int:
    """An integer in a range. True, 2.0 and texts are none."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass a whole number")
    if not least <= value <= most:
        most_text = f"{least} to {most}" if most < 2**31 else f"at least {least}"
        raise input_error("value-out-of-range", f"{name} is {value}", name, f"pass a whole number, {most_text}")
    return int(value)


def thread_count(value: Any) -> int:
    """How many threads may be used; 0: as many as there are."""
    return whole(value, "threads", 0, _MOST_THREADS)


def text(value: Any, name: str) -> str:
    """A text that UTF-8 can hold."""
    if not isinstance(value, str):
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass a text")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise input_error("value-syntax", f"{name} holds half a character: {shown(value)}", name,
                          "pass a text without lone surrogates") from None
    return value


def flag(value: Any, name: str) -> bool:
    """True or False, or 1 or 0."""
    if isinstance(value, (bool, np.bool_)) or (isinstance(value, int) and value in (0, 1)):
        return bool(value)
    raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass True or False")


def items(value: Any, name: str, what: str) -> list[Any]:
    """What is in a list, or in what else can be gone through. A text is none."""
    if not isinstance(value, (str, bytes, Mapping)):
        try:
            return list(value)
        except TypeError:
            pass
    raise input_error("wrong-type", f"{name} is {shown(value)}", name, f"pass a list of {what}")


def choice(value: Any, name: str, choices: tuple[str, ...]) -> str:
    """One of a few words."""
    if isinstance(value, str) and value in choices:
        return value
    raise input_error("unknown-choice", f"{name} is {shown(value)}", name,
                      "choose " + ", ".join(map(repr, choices[:-1])) + f" or {choices[-1]!r}")


def path(value: Any, name: str = "path") -> str:
    """The absolute path of a file."""
    try:
        file = os.fsdecode(value)
    except TypeError:
        raise input_error("wrong-type", f"{name} is {shown(value)}", name, "pass a path: a text or a pathlib.Path") from None
    try:
        file.encode(errors="surrogateescape")  # names of files may be any bytes
    except UnicodeEncodeError:
        file = ""
    if not file or "\0" in file:
        raise input_error("value-syntax", f"{name} is {shown(value)}", name, "pass the path of a file")
    return os.path.abspath(file)


def instance(value: Any, of: type[T], name: str, fix: str) -> T:
    """An object of that class."""
    if isinstance(value, of):
        return value
    raise input_error("wrong-type", f"{name} is {shown(value)}", name, fix)


def not_called(core: Any, of: type, name: str, fix: str) -> None:
    """For classes whose objects come from functions.

    Raises:
        TypeError: it was called as if it read a file.
    """
    if not isinstance(core, of):
        raise TypeError(f"{name}({shown(core)}): {name} is not called by itself; {fix}")
