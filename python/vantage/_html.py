"""Tables for notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._result import Result


def table(title: str, rows: list[tuple[str, str]]) -> str:
    """A title and two columns."""
    body = "".join(f"<tr><th style='text-align:left'>{escape(name)}</th><td style='text-align:left'>{escape(value)}</td></tr>"
                   for name, value in rows)
    return f"<table><caption style='text-align:left'><b>{escape(title)}</b></caption>{body}</table>"


def of_result(result: Result) -> str:
    """The numbers of a result, and its largest causes."""
    if result.empty:
        return table(result.mission.target_name, [("outcome", result.outcome), ("reason", result.reason)])
    total = sum(cause.area_m2 for cause in result.causes) or 1
    largest = sorted(result.causes, key=lambda cause: -cause.area_m2)[:5]
    rows = [("volume", f"{result.volume_m3:,.0f} m³"), ("surface", f"{result.area_m2:,.0f} m²"),
            ("facets", f"{len(result.faces):,}"), ("range", f"{result.mission.range_m:g} m"),
            ("bounded by", ", ".join(f"{c.name} {100 * c.area_m2 / total:.0f} %" for c in largest))]
    rows += [("note", note.text) for note in result.notes]
    return table(result.mission.target_name, rows)
