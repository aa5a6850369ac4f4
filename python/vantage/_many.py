"""Volumes of many targets in one scene."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, Union, overload

import numpy as np

from . import _core
from ._checks import choice, thread_count
from ._errors import Error, make
from ._progress import Listener, Progress, listener
from ._render import html
from ._requests import Navigation, Sensor, Target, keys_of
from ._result import Mission, Result, asked, resolved
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
        return html(self)


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
    return _one_by_one(scene, found, request, threads, progress, goes_on=True)


def _all_or_none(scene: Scene, found: list[Target | Error], request: dict[str, Any], threads: int,
                 progress: Progress) -> list[Result]:
    wrong = next((one for one in found if isinstance(one, Error)), None)
    if wrong is not None:
        raise _with_advice(wrong, len(found))
    targets = [one for one in found if isinstance(one, Target)]
    try:
        mission = resolved(scene, targets, _names(range(len(found))), is_one=False, combine="each", progress=progress, **request)
        if mission._core.count == len(targets):
            return mission.run_each(threads=threads, progress=progress)
        # Of some targets several faces are meant: each target has one volume all the same.
        return _one_by_one(scene, found, request, threads, progress, goes_on=False).good
    except Error as error:
        raise _with_advice(error, len(found)) from None


def _with_advice(error: Error, count: int) -> Error:
    """How to get the others."""
    if count < 2 or not _is_of_target(error):
        return error
    fix = f"{error.fix}; or pass errors='collect' for what becomes of each" if error.fix else "pass errors='collect'"
    return make(error.kind, error.code, error.problem, error.where, fix, error.object)


def _one_by_one(scene: Scene, found: list[Target | Error], request: dict[str, Any], threads: int, progress: Progress, *,
                goes_on: bool) -> Results:
    """A result or an error for each. `goes_on`: else the first error is raised, before any volume is computed."""
    told = listener(progress)
    made: list[Result | Error | None] = [None] * len(found)

    def keep(number: int, error: Error) -> None:
        if not goes_on or not _is_of_target(error):
            raise error
        made[number] = error

    _check_limits(scene, request, _checking(told, 0, 0))
    together: list[int] = []
    alone: list[int] = []
    for number, one in enumerate(found):
        checking = _checking(told, number / len(found), (number + 1) / len(found))
        if checking is not None and checking("", 0) is False:
            raise make("cancelled", "cancelled", "cancelled while checking targets", "", "", None)
        if isinstance(one, Error):
            made[number] = one
            continue
        try:
            count = _volumes_of(scene, one, number, request, checking, prepares=not goes_on)
        except Error as error:
            keep(number, error)
        else:
            (together if count == 1 else alone).append(number)

    mission = _mission_of(scene, found, together, request, told, keep)
    if mission is not None:
        made_together: list[Result | Error] = (list(mission._try_each(threads, told)) if goes_on else
                                               list(mission.run_each(threads=threads, progress=told)))
        for number, attempt in zip(together, made_together):
            if isinstance(attempt, Error):
                keep(number, attempt)
            else:
                made[number] = attempt
    for number in alone:  # several faces, all of which must be seen
        try:
            one_alone = resolved(scene, _targets(found, [number]), _names([number]), is_one=True, progress=told, **request)
            made[number] = one_alone.run(threads=threads, progress=told)
        except Error as error:
            keep(number, error)
    return Results(one for one in made if one is not None)


def _mission_of(scene: Scene, found: list[Target | Error], together: list[int], request: dict[str, Any], told: Listener,
                keep: Callable[[int, Error], None]) -> Mission | None:
    """The mission of those targets, which are right by themselves. What is wrong with one all the same is kept, and the
    target taken out of `together`."""
    while together:
        try:
            return resolved(scene, _targets(found, together), _names(together), is_one=False, combine="each", progress=told,
                            **request)
        except Error as error:
            match = re.match(r"targets\[(\d+)\]", error.where)
            if not match or int(match[1]) not in together:
                raise
            keep(int(match[1]), error)
            together.remove(int(match[1]))
    return None


def _volumes_of(scene: Scene, target: Target, number: int, request: dict[str, Any], told: Listener, *, prepares: bool) -> int:
    """How many volumes a target has: one, or of several faces one for each. Raises what is wrong with where it is."""
    without_limits = {**request, "navigation": None}
    text, _ = asked(scene, [target], _names([number]), is_one=True, combine="each", **without_limits)
    return text.call(lambda: _core.check(scene._core, text.text(), NAME, [], prepares, told))


def _check_limits(scene: Scene, request: dict[str, Any], told: Listener) -> None:
    """Raises what is wrong with the sensor and the limits, which all targets share: asked with a target that is right."""
    text, meshes = asked(scene, [_stand_in(scene, request)], [_STAND_IN], is_one=True, **request)
    try:
        text.call(lambda: _core.check(scene._core, text.text(), NAME, meshes, False, told))
    except Error as error:
        if not error.where.startswith(_STAND_IN):
            raise


_STAND_IN = "target that stands for all"


def _stand_in(scene: Scene, request: dict[str, Any]) -> Target:
    """A triangle at the scene's origin; a point for sensors that want one."""
    sensor = request["sensor"]
    keys = keys_of(sensor, Sensor, "sensor") if sensor is not None else {}
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float64)
    place = scene.georeference
    if place is not None and isinstance(request["crs"], str):
        try:
            corners = _core.to_crs(place, request["crs"], corners)
        except Error:
            pass  # no CRS: the check says so
    return Target(point=corners[0]) if {"vlos", "link"} & set(keys) else Target(vertices=corners)


def _checking(told: Listener, begin: float, end: float) -> Listener:
    """What a check tells: the stage is that of all checks, and the fraction a part of theirs."""
    if told is None:
        return None
    return lambda _, fraction: told("checking targets", begin + (end - begin) * fraction)


def _targets(found: list[Target | Error], numbers: Sequence[int]) -> list[Target]:
    return [one for one in (found[number] for number in numbers) if isinstance(one, Target)]


def _names(numbers: Iterable[int]) -> list[str]:
    return [f"targets[{number}]" for number in numbers]


def _is_of_target(error: Error) -> bool:
    """Whether it is about one target, and not about what all share."""
    return error.kind == "input" and error.where.startswith("targets[")


__all__ = ["Results", "compute_many"]
