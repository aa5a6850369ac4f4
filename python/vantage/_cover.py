"""Small exact combinatorial problems, by CP-SAT of OR-Tools (the extra `positions`)."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from ._extras import require

Sets = Iterable[Iterable[int]]

_OFTEN_S = 0.05
"""So often it is asked meanwhile whether to go on."""


class Clock:
    """How much of a time limit is left. `check` is called while the solver works, and may raise to stop it."""

    def __init__(self, limit_s: float, check: Callable[[], None] = lambda: None):
        self.end = time.monotonic() + limit_s
        self.check = check

    @property
    def left_s(self) -> float:
        return max(0.0, self.end - time.monotonic())

    @property
    def is_over(self) -> bool:
        return self.left_s == 0.0


class Cover(NamedTuple):
    """Some of the sets, which hold all elements."""

    chosen: list[int]
    is_least: bool
    """whether it is proved that no other choice costs less"""


def cp_model() -> Any:
    """The module ortools.sat.python.cp_model."""
    return require("ortools.sat.python.cp_model", "positions")


def _solve(model: Any, clock: Clock) -> tuple[Any, Any]:
    """Solver and status. One thread and a fixed seed: the same answer each time, but where time runs out."""
    solver = cp_model().CpSolver()
    solver.parameters.random_seed = 1
    solver.parameters.num_workers = 1
    solver.parameters.max_time_in_seconds = max(0.01, clock.left_s)
    solver.parameters.catch_sigint_signal = False  # it would take Ctrl-C away from Python, for good
    status: list[Any] = []
    done = threading.Event()

    def solve() -> None:
        try:
            status.append(solver.solve(model))
        except Exception as error:
            status.append(error)
        finally:
            done.set()

    # On a thread of its own: while this one waits, it hears of Ctrl-C, and stops the solver then. It waits for an event:
    # a `join` that is interrupted takes the thread for ended (CPython 3.11).
    threading.Thread(target=solve, name="vantage: CP-SAT", daemon=True).start()
    try:
        while not done.wait(_OFTEN_S):
            clock.check()
    finally:
        while not done.is_set():
            solver.stop_search()  # once may be too early: before it has begun
            done.wait(_OFTEN_S)
    if isinstance(status[0], Exception):
        raise status[0]
    return solver, status[0]


def least_cover(count: int, sets: Sequence[Iterable[int]], costs: Sequence[int], clock: Clock) -> Cover:
    """The choice of sets that holds all of range(count) and costs least. Each element must be in a set."""
    cp = cp_model()
    model = cp.CpModel()
    chosen = [model.new_bool_var(f"s{i}") for i in range(len(sets))]
    holders: list[list[int]] = [[] for _ in range(count)]
    for number, one in enumerate(sets):
        for element in one:
            holders[element].append(number)
    for of_element in holders:
        model.add_bool_or([chosen[number] for number in of_element])
    model.minimize(sum(cost * one for cost, one in zip(costs, chosen)))
    for number, taken in enumerate(_greedy(count, sets, costs)):
        model.add_hint(chosen[number], taken)
    solver, status = _solve(model, clock)
    if status not in (cp.OPTIMAL, cp.FEASIBLE):
        return Cover([i for i, taken in enumerate(_greedy(count, sets, costs)) if taken], False)
    return Cover([i for i, one in enumerate(chosen) if solver.value(one)], status == cp.OPTIMAL)


def _greedy(count: int, sets: Sequence[Iterable[int]], costs: Sequence[int]) -> list[bool]:
    """Whether each set is taken, if the one that holds most for its cost is always taken next."""
    held = [set(one) for one in sets]
    left, taken = set(range(count)), [False] * len(held)
    while left:
        best = max(range(len(held)), key=lambda i: (len(held[i] & left) / (costs[i] + 1e-9), -i))
        taken[best] = True
        left -= held[best]
    return taken


def most_apart(count: int, meeting: Sets, clock: Clock) -> list[int]:
    """A set of elements of which no two meet: the largest one, or what was found in time."""
    cp = cp_model()
    model = cp.CpModel()
    taken = [model.new_bool_var(f"t{i}") for i in range(count)]
    for pair in meeting:
        model.add_at_most_one([taken[i] for i in pair])
    model.maximize(sum(taken))
    solver, status = _solve(model, clock)
    if status not in (cp.OPTIMAL, cp.FEASIBLE):
        return [0] if count else []
    return [i for i in range(count) if solver.value(taken[i])]


def groups(count: int, number: int, conflicts: Sets, apart: Sequence[int],
           clock: Clock) -> list[list[int]] | bool | None:
    """All of range(count) in so many groups, none of which holds all of a conflict. False: there is no such division;
    None: time ran out. `apart`: elements of which each two are a conflict."""
    cp = cp_model()
    if number < len(apart):
        return False
    model = cp.CpModel()
    held = [[model.new_bool_var(f"h{i}_{g}") for g in range(number)] for i in range(count)]
    for row in held:
        model.add_exactly_one(row)
    for conflict in conflicts:
        members = list(conflict)
        for g in range(number):
            model.add_bool_or([~held[i][g] for i in members])
    for g, element in enumerate(apart):  # groups have no order
        model.add(held[element][g] == 1)
    solver, status = _solve(model, clock)
    if status == cp.INFEASIBLE:
        return False
    if status not in (cp.OPTIMAL, cp.FEASIBLE):
        return None
    return [[i for i in range(count) if solver.value(held[i][g])] for g in range(number)]


def most_together(count: int, conflicts: Sets, clock: Clock) -> tuple[list[int], bool]:
    """The most elements without all of a conflict, and whether no more are possible."""
    cp = cp_model()
    model = cp.CpModel()
    taken = [model.new_bool_var(f"t{i}") for i in range(count)]
    for conflict in conflicts:
        model.add_bool_or([~taken[i] for i in conflict])
    model.maximize(sum(taken))
    solver, status = _solve(model, clock)
    if status not in (cp.OPTIMAL, cp.FEASIBLE):
        return list(range(count)), False
    return [i for i in range(count) if solver.value(taken[i])], status == cp.OPTIMAL
