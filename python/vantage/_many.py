"""Volumes of many targets in one scene."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any, Literal, Union, overload

from . import _core
from ._checks import choice, thread_count
from ._errors import Error, make
from ._progress import Progress, listener
from ._requests import Navigation, Sensor, Target
from ._result import Mission, Result, asked
from ._scene import Scene, checked_scene
from ._shapes import AnyTarget, listed
from ._text import NAME


class Results(list[Union[Result, Error]]):
    """What became of many targets, in their order: a `Result` each, or the `Error` that says why there is none.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> square, bent = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], [[0, 0, 0], [9, 0, 0], [9, 9, 0], [8, 1, 0]]
        >>> results = vt.compute_many(ground, [square, bent], max_range=50, errors="collect")
        >>> results
        <vantage.Results: 1 result, 1 error (target-not-convex)>
        >>> [round(one.volume_m3, -3) for one in results.good], list(results.errors)
        ([195000.0], [1])
    """

    @property
    def good(self) -> list[Result]:
        """The results alone, in their order."""
        return [one for one in self if isinstance(one, Result)]

    @property
    def errors(self) -> dict[int, Error]:
        """The errors alone, by the index of their target."""
        return {number: one for number, one in enumerate(self) if isinstance(one, Error)}

    def __repr__(self) -> str:
        good, errors = len(self.good), self.errors
        text = f"{good} result{'' if good == 1 else 's'}"
        if errors:
            counts = Counter(one.code for one in errors.values()).most_common()
            each = ", ".join(code if count == len(errors) else f"{count} {code}" for code, count in counts)
            text += f", {len(errors)} error{'' if len(errors) == 1 else 's'} ({each})"
        return f"<vantage.Results: {text}>"

    def _repr_html_(self) -> str:
        from ._html import of_results

        return of_results(self)


@overload
def compute_many(scene: Scene, targets: Iterable[AnyTarget], *, max_range: float | None = None,
                 sensor: Sensor | Mapping[str, Any] | None = None, navigation: Navigation | Mapping[str, Any] | None = None,
                 crs: str | None = None, method: str = "exact", tolerance: float | None = None,
                 spheres: Mapping[str, Any] | None = None, work_limit: float | None = None,
                 errors: Literal["raise"] = "raise", threads: int = 0, progress: Progress = None) -> list[Result]: ...
@overload
def compute_many(scene: Scene, targets: Iterable[AnyTarget], *, max_range: float | None = None,
                 sensor: Sensor | Mapping[str, Any] | None = None, navigation: Navigation | Mapping[str, Any] | None = None,
                 crs: str | None = None, method: str = "exact", tolerance: float | None = None,
                 spheres: Mapping[str, Any] | None = None, work_limit: float | None = None, errors: Literal["collect"],
                 threads: int = 0, progress: Progress = None) -> Results: ...
def compute_many(scene: Scene, targets: Iterable[AnyTarget], *, max_range: float | None = None,
                 sensor: Sensor | Mapping[str, Any] | None = None, navigation: Navigation | Mapping[str, Any] | None = None,
                 crs: str | None = None, method: str = "exact", tolerance: float | None = None,
                 spheres: Mapping[str, Any] | None = None, work_limit: float | None = None,
                 errors: Literal["raise", "collect"] = "raise", threads: int = 0, progress: Progress = None) -> list[Result] | Results:
    """A volume for each of many targets in one scene, several at once on all cores. Arguments as of `compute`, and:

    Args:
        targets: a list of what `compute` takes as a target, or a GeoSeries or GeoDataFrame, of which each row is one.
        errors: what becomes of a target that is wrong, such as one that a tree stands on. "raise": its error is raised, and
            there are no results. "collect": it has its error in the place of a result, and the others are computed. What is
            wrong with all of them, such as a sensor, is always raised.

    Returns:
        a list with one entry for each target, in their order. With errors="collect" a `Results`, which has `good`, the
        results alone, and `errors`, the errors by the index of their target; `vt.fewest_positions` takes it as it is.

    Raises:
        Error: as `compute`.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> square = [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]]
        >>> beside = [[20, 0, 0], [29, 0, 0], [29, 9, 0], [20, 9, 0]]
        >>> [result.outcome for result in vt.compute_many(ground, [square, beside], max_range=50)]
        ['computed', 'computed']
    """
    choice(errors, "errors", ("raise", "collect"))
    thread_count(threads)
    checked_scene(scene)
    found = listed(targets, scene, crs)
    request: dict[str, Any] = {"max_range": max_range, "sensor": sensor, "navigation": navigation, "crs": crs,
                               "method": method, "tolerance": tolerance, "spheres": spheres, "work_limit": work_limit}
    if not found:
        return Results() if errors == "collect" else []
    if errors == "raise":
        return _all_or_none(scene, found, request, threads, progress)
    return _collected(scene, found, request, threads, progress)


def _all_or_none(scene: Scene, found: list[Target | Error], request: dict[str, Any], threads: int,
                 progress: Progress) -> list[Result]:
    wrong = next((one for one in found if isinstance(one, Error)), None)
    if wrong is not None:
        raise _with_advice(wrong, len(found))
    targets = [one for one in found if isinstance(one, Target)]
    try:
        mission = Mission.of(scene, targets, combine="each", argument="targets", progress=progress, **request)
        if mission._core.count == len(targets):
            return mission.run_each(threads=threads, progress=progress)
    except Error as error:
        raise _with_advice(error, len(found)) from None
    # Of some targets several faces are meant: each target has one volume all the same.
    results = _collected(scene, found, request, threads, progress)
    for one in results:
        if isinstance(one, Error):
            raise _with_advice(one, len(found))
    return results.good


def _with_advice(error: Error, count: int) -> Error:
    """How to get the others."""
    if count < 2 or error.kind != "input" or not error.where.startswith("targets["):
        return error
    fix = f"{error.fix}; or pass errors='collect' for what becomes of each" if error.fix else "pass errors='collect'"
    return make(error.kind, error.code, error.problem, error.where, fix, error.object)


def _collected(scene: Scene, found: list[Target | Error], request: dict[str, Any], threads: int,
               progress: Progress) -> Results:
    told = listener(progress)
    made: list[Result | Error | None] = [None] * len(found)
    together: list[int] = []
    alone: list[int] = []
    without_limits = {**request, "navigation": None}
    for number, one in enumerate(found):
        if told is not None and told("checking targets", number / len(found)) is False:
            raise make("cancelled", "cancelled", "cancelled while checking targets", "", "", None)
        if isinstance(one, Error):
            made[number] = one
            continue
        try:
            text, _ = asked(scene, [one], combine="each", argument=f"targets[{number}]", is_one=True, **without_limits)
            count = text.told(lambda: _core.check(scene._core, text.text(), NAME))
        except Error as error:
            made[number] = _of_target(error)
        else:
            (together if count == 1 else alone).append(number)
    if together:
        chosen = [one for one in (found[number] for number in together) if isinstance(one, Target)]
        mission = Mission.of(scene, chosen, combine="each", argument="targets", progress=told, **request)
        for number, attempt in zip(together, mission._try_each(threads, told)):
            made[number] = attempt
    for number in alone:  # several faces, all of which must be seen
        one = found[number]
        assert isinstance(one, Target)
        try:
            made[number] = Mission.of(scene, one, progress=told, **request).run(threads=threads, progress=told)
        except Error as error:
            made[number] = _of_target(_at(error, number))
    return Results(one for one in made if one is not None)


def _at(error: Error, number: int) -> Error:
    where = error.where.replace("target", f"targets[{number}]", 1) if error.where.startswith("target") else error.where
    return make(error.kind, error.code, error.problem, where, error.fix, error.object)


def _of_target(error: Error) -> Error:
    """Raises what is not about this target alone."""
    if error.kind != "input" or not error.where.startswith("targets["):
        raise error
    return error


__all__ = ["Results", "compute_many"]
