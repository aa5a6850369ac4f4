"""Pictures of flights: height over distance, and when what is seen. By matplotlib (the extra `plot`), registered
with `_render`."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _core, _render
from ._check import FlightCheck, Span
from ._checks import path as checked_path, shown, whole
from ._errors import input_error
from ._extras import require
from ._flight import Numbers
from ._requests import Path

COLORS = {"seen": "#54a24b", "inside": "#54a24b", "linked": "#72b7b2", "hidden": "#4c78a8", "out_of_range": "#e0b84c",
          "behind": "#9d9d9d", "limit": "#b279a2", "outside": "#9d9d9d", "broken": "#e45756"}
"""As the facets of volumes have them, by the kind of their cause."""

LABELS = {"seen": "seen whole", "inside": "inside the volume", "linked": "linked", "hidden": "view hidden",
          "out_of_range": "out of range", "behind": "behind the target", "limit": "limit of the sensor",
          "outside": "outside the volume", "broken": "limit of flight broken"}

_SAMPLES = 1500
"""Places along the flight where the ground is asked for: more than a picture has pixels."""

_STRIP, _REASON = 0.8, 0.26
"""Heights of a target's strip, and of the bar in it that tells why it is not seen; strips are 1 apart."""

_MOST_NAME = 28
"""Letters of a target's name."""

_PIXELS_PER_INCH = 100


def _figure(path: Path | None, size: Any) -> Any:
    if not isinstance(size, (tuple, list)) or len(size) != 2:
        raise input_error("wrong-type", f"size is {shown(size)}", "size", "pass width and height: (1200, 800)")
    inches = [whole(one, f"size[{i}]", 100, 20_000) / _PIXELS_PER_INCH for i, one in enumerate(size)]
    if path is None:
        return require("matplotlib.pyplot", "plot").figure(figsize=inches, dpi=_PIXELS_PER_INCH, layout="constrained")
    return require("matplotlib.figure", "plot").Figure(figsize=inches, dpi=_PIXELS_PER_INCH, layout="constrained")


def _ground(check: FlightCheck) -> tuple[Numbers, Numbers] | None:
    """Along the flight, z of the ground; NaN where there is none."""
    length = check.length_m
    at = np.unique(np.concatenate([check.flight.at_m, np.linspace(0, length, _SAMPLES)])) if length > 0 else np.zeros(1)
    z = _core.ground_under(check.mission._core, np.ascontiguousarray(check.flight.at(at)))
    return None if z is None or np.isnan(z).all() else (at, np.array(z))


def _draw_heights(axes: Any, check: FlightCheck) -> None:
    along, z = check.flight.at_m, check.flight.positions[:, 2]
    ground = _ground(check)
    if ground is not None:
        at, levels = ground
        low, high = float(min(np.nanmin(levels), z.min())), float(max(np.nanmax(levels), z.max()))
        base = low - 0.05 * (high - low) - 1
        axes.fill_between(at, base, levels, color="#d9d9d9", label="ground", linewidth=0)
        axes.plot(at, levels, color="#9d9d9d", linewidth=1)
    axes.plot(along, z, color="#222222", linewidth=1.5, label="flight", marker="o" if len(z) <= 60 else None, markersize=3)
    if check.tube_m > 0:
        axes.fill_between(along, z - check.tube_m, z + check.tube_m, color="#4c78a8", alpha=0.25, linewidth=0, label="tube")
    for number, limit in enumerate(check.broken):
        for span in limit.spans:
            part = check.flight.between(span.begin_m, span.end_m)
            places = [span.begin_m, *along[(along > span.begin_m) & (along < span.end_m)], span.end_m][:len(part)]
            axes.plot(places, part[:, 2], color=COLORS["broken"], linewidth=3, marker="|")
        axes.plot([], [], color=COLORS["broken"], linewidth=3, label=LABELS["broken"] if number == 0 else None)
    near = check.nearest
    if near is not None:
        axes.plot([near.at_m], [near.position[2]], marker="v", color=COLORS["broken"], linestyle="none",
                  label=f"nearest: {_short(near.object or 'the scene')}, {near.distance_m:.1f} m")
    axes.set_ylabel("z, m")
    axes.margins(x=0)
    if ground is not None:
        axes.set_ylim(bottom=base)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize="small")
    axes.grid(True, color="#eeeeee")


def _bars(spans: list[Span], least_m: float) -> list[tuple[float, float]]:
    """Begin and length; what is too short to be seen, such as a stay, is drawn as wide as a line."""
    return [(span.begin_m, max(span.length_m, least_m)) for span in spans]


def _draw_strips(axes: Any, check: FlightCheck) -> None:
    least_m = 0.003 * check.length_m or 1.0
    used: dict[str, None] = {}
    rows = [(target.name, target.seen, target.not_seen, "inside" if target.is_volume else "seen") for target in check.targets]
    rows += [(f"link: {link.name}", link.linked, link.reasons, "linked") for link in check.links]
    for row, (_, good, reasons, state) in enumerate(rows):
        axes.broken_barh([(0, check.length_m or 1.0)], (row - _STRIP / 2, _STRIP), color="#f2f2f2", linewidth=0)
        for kind in ("out_of_range", "behind", "outside", "limit", "hidden"):
            for reason in reasons:
                if reason.kind == kind:
                    axes.broken_barh(_bars(reason.spans, 0), (row - _REASON / 2, _REASON), color=COLORS[kind], linewidth=0)
                    used[kind] = None
        if good:
            axes.broken_barh(_bars(good, least_m), (row - _STRIP / 2, _STRIP), color=COLORS[state], linewidth=0)
            used[state] = None
    for kind in COLORS:
        if kind in used:
            axes.broken_barh([], (0, 0), color=COLORS[kind], label=LABELS[kind])
    axes.set_yticks(range(len(rows)), [_short(name) for name, *_ in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)  # the first one on top
    axes.set_xlabel("distance along the flight, m")
    axes.margins(x=0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize="small")


def _short(name: str) -> str:
    plain = name.replace("$", r"\$")  # matplotlib would set formulas
    return plain if len(plain) <= _MOST_NAME else plain[:_MOST_NAME - 3] + "..."


@_render.plot.register(FlightCheck)
def plot(check: FlightCheck, path: Path | None = None, *, size: tuple[int, int] = (1200, 800)) -> Any:
    """What `FlightCheck.plot` does."""
    file = None if path is None else checked_path(path)
    figure = _figure(path, size)
    strips = max(1, len(check.targets) + len(check.links))
    over, under = figure.subplots(2, 1, sharex=True, height_ratios=[1, min(3.0, 0.12 * strips + 0.1)])
    _draw_heights(over, check)
    _draw_strips(under, check)
    duration = "" if np.isnan(check.duration_s) else f", {check.duration_s:,.0f} s"
    told = "not judged as a whole" if check.not_judged else (
        "keeps what is asked" if check.passes else f"{len(check.failures)} of what is asked not kept")
    over.set_title(f"{check.length_m:,.0f} m{duration}: {told}", loc="left", fontsize="medium")
    if check.mission.scene.attribution:  # the licence of the scene's data asks for it
        figure.text(0.995, 0.005, check.mission.scene.attribution, ha="right", va="bottom", fontsize=7, color="#777777")
    if file is not None:
        figure.savefig(file)
    return figure
