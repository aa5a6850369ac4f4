"""The classes of `vantage/_requests.py` have the keys of the mission file. VANTAGE_UPDATE_GOLDEN=1 writes them anew."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import re
import textwrap

import pytest

import vantage as vt
from vantage import _core

FILE = pathlib.Path(__file__).parents[1] / "vantage" / "_requests.py"
CLASSES = {"Target": "target", "Sensor": "sensor", "Navigation": "navigation", "TourSettings": "tour"}

ANNOTATIONS = {
    "number": "float", "whole": "int", "flag": "bool", "word": "str", "text": "str", "path": "Path", "vector": "Vector",
    "place": "Vector", "numbers": "Vector", "points": "npt.ArrayLike", "polygons": "Sequence[npt.ArrayLike]",
    "list": "Sequence[Any]", "map": "Mapping[str, Any]", "maps": "Sequence[Mapping[str, Any]]",
    "word_or_number": "str | float", "word_or_map": "str | Mapping[str, Any]", "text_or_number": "float | str",
    "numbers_or_map": "Vector | Mapping[str, Any]"}
UNITS = {"m": "metres"}
# What Python takes besides.
MORE = {("Sensor", "camera"): ("str | Mapping[str, Any]", "Or a name of `vt.cameras()` alone."),
        ("Navigation", "meshes"): ("Sequence[Any]", "Or a `vt.Volume`, or anything with `vertices` and `faces`.")}


def plain(text: str) -> str:
    """Without the links of Markdown, which lead elsewhere."""
    text = re.sub(r" ?\(\[(below|how|names)\]\([^)]*\)\)", "", text)
    text = re.sub(r" \[[^\]]*\]\([^)]*\)\.", "", text) if re.search(r"\. \[[^\]]*\]\([^)]*\)\.", text) else text
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)


def fields(section: str) -> dict[str, tuple[str, str]]:
    """Of each key of a section its annotation and its text, with those of the maps in it."""
    found: dict[str, tuple[str, str]] = {}
    for key in _core.mission_keys():
        if key["section"] != section or key["is_old"]:
            continue
        unit = UNITS.get(key["unit"], key["unit"])
        text = plain(key["text"])
        name, _, rest = key["path"].partition(".")
        if not rest:
            found[name] = (ANNOTATIONS[key["kind"]], (f"{unit}; " if unit else "") + text)
            continue
        kind, before = found.get(name, ("Mapping[str, Any]", ""))
        before = before or "a dictionary:"
        found[name] = (kind, f"{before} `{rest}`" + (f" ({unit})" if unit else "") + f": {text}")
    return found


def written(name: str) -> tuple[str, str]:
    """The attributes of the docstring, and the fields."""
    attributes, lines = "", ""
    for field, (annotation, text) in fields(CLASSES[name]).items():
        annotation, more = MORE.get((name, field), (annotation, ""))
        text = f"{text} {more}".rstrip()
        attributes += textwrap.fill(f"{field}: {text}", 127, initial_indent=" " * 8, subsequent_indent=" " * 12,
                                    break_long_words=False, break_on_hyphens=False) + "\n"
        lines += f"    {field}: {annotation} | None = None\n"
    return attributes, lines


def regions(source: str, name: str) -> tuple[re.Match[str], re.Match[str]]:
    start = source.index(f"class {name}(")
    attributes = re.compile(r"    Attributes:\n((?:        .*\n)+)").search(source, start)
    lines = re.compile(r'^    """\n\n((?:    \w+: .* = None\n)+)', re.MULTILINE).search(source, start)
    assert attributes and lines
    return attributes, lines


@pytest.mark.parametrize("name", CLASSES)
def test_classes_have_the_keys_of_the_mission_file(name: str) -> None:
    source = FILE.read_text(encoding="utf-8")
    attributes, lines = regions(source, name)
    new_attributes, new_lines = written(name)
    if os.environ.get("VANTAGE_UPDATE_GOLDEN"):
        source = source[:lines.start(1)] + new_lines + source[lines.end(1):]
        source = source[:attributes.start(1)] + new_attributes + source[attributes.end(1):]
        FILE.write_text(source, encoding="utf-8")
        return
    assert attributes[1] == new_attributes, "run it with VANTAGE_UPDATE_GOLDEN=1"
    assert lines[1] == new_lines, "run it with VANTAGE_UPDATE_GOLDEN=1"
    assert [field.name for field in dataclasses.fields(getattr(vt, name))] == list(fields(CLASSES[name]))
