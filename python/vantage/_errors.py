"""The exception that vantage raises."""

from __future__ import annotations

from typing import Any

from . import _core


def without_secrets(text: str, is_address: bool = False) -> str:
    """The text without what may be keys of servers in it: a user, a password, a query of an address."""
    kept = "surrogatepass"  # names of files may be no UTF-8
    return _core.without_secrets(text.encode("utf-8", kept), is_address).decode("utf-8", kept)


class Error(Exception):
    """What is wrong, where, and what to do about it.

    Attributes:
        kind: "input" (something that the caller passed or named is wrong), "output" (a result could not be written),
            "cancelled" or "internal" (a defect of vantage).
        code: for programs, such as "target-not-convex"; it stays the same from version to version.
        problem: what is wrong, a sentence.
        where: the place: a file with line and column, an argument, an object of the scene. May be empty.
        fix: what to do. May be empty.
        object: index into `Scene.objects` of what is in the way, or None.
    """

    def __init__(self, kind: str, code: str, problem: str, where: str = "", fix: str = "", object: int | None = None):
        problem, where, fix = without_secrets(problem), without_secrets(where, True), without_secrets(fix)
        lines = [problem]
        if where:
            lines.append(f"where: {where}")
        if fix:
            lines.append(f"what to do: {fix}")
        super().__init__("\n  ".join(lines))
        self.kind, self.code, self.problem, self.where, self.fix, self.object = kind, code, problem, where, fix, object

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.kind, self.code, self.problem, self.where, self.fix, self.object)


class InputError(Error, ValueError):
    """Something that the caller passed or named is wrong."""


class NotInBuildError(InputError):
    """Something that this build of vantage lacks: packages for WebAssembly, Windows and macOS have no maps, say. Those for Linux never raise it."""


class OutputError(Error):
    """A result could not be written; nothing was left half-written."""


class CancelledError(Error):
    """A progress callback returned False."""


class InternalError(Error):
    """A defect of vantage itself."""


def not_pickled(what: str, fix: str) -> Error:
    """The error of what stays in its process."""
    return InputError("input", "not-applicable", f"{what} cannot be pickled or copied", "", fix)


_CLASSES: dict[str, type[Error]] = {
    "input": InputError,
    "output": OutputError,
    "cancelled": CancelledError,
    "internal": InternalError,
}


def make(kind: str, code: str, problem: str, where: str, fix: str, object: int | None) -> Error:
    """The error of that kind, with its own class."""
    return _CLASSES[kind](kind, code, problem, where, fix, object)


def input_error(code: str, problem: str, where: str, fix: str) -> Error:
    """For what the Python part of vantage checks itself."""
    return make("input", code, problem, where, fix, None)
