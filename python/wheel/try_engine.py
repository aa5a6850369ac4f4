"""Tries a package of the engine alone, for Windows or macOS: the import, a first volume, its proof, files with names of all
characters, files that take the place of others, and errors. The exit code is 1 where something is not as it should be.

    python3 python/wheel/try_engine.py
"""

from __future__ import annotations

import pathlib
import sys
import tempfile
import time

started = time.perf_counter()
import numpy as np

import vantage as vt

imported = time.perf_counter() - started
HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = next(folder / "examples" for folder in (HERE, *HERE.parents) if (folder / "examples").is_dir())
SQUARE = [[-12, -9, 0], [8, -11, 0], [11, 0, 0], [4, 10, 0], [-13, 8, 0]]


def code_of(action) -> str:
    """That of the error that it raises."""
    try:
        action()
    except vt.Error as error:
        return error.code
    return ""


def main() -> int:
    scene = vt.Scene.from_mesh(EXAMPLES / "plaza" / "plaza.obj")
    result = vt.compute(scene, SQUARE, max_range=70, navigation=vt.Navigation(altitude=(3, 50)))
    first = time.perf_counter() - started
    found: dict[str, bool] = {"proved": result.prove()["verdict"] == "proved"}
    answers = result.query([[0, 0, 30], [0, 0, -5]])
    found["query"] = [bool(one) for one in answers.inside] == [True, False]
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder) / "größe 字"
        place.mkdir()
        file = place / "volume ж.ply"
        for _ in range(2):  # the second takes the place of the first
            result.save(file)
        again = vt.Volume.read(file)
        found["read back"] = np.array_equal(again.vertices, result.vertices) and np.array_equal(again.faces, result.faces)
        found["nothing is left beside"] = sorted(one.name for one in place.iterdir()) == ["volume ж.ply", "volume ж.report.json"]
        found["several files"] = bool(result.save(place / "a.obj", place / "b.glb"))
        found["missing file"] = code_of(lambda: vt.Scene.from_mesh(place / "none.obj")) == "file-not-found"
        found["missing folder"] = code_of(lambda: result.save(place / "none" / "a.ply")) == "output-folder-missing"
        found["a folder is no file"] = code_of(lambda: result.save(place)) != ""
    long = {"max_range": 70, "visible": 0.7, "cells": 8}  # so that it is asked before it has ended
    found["cancelled"] = code_of(lambda: vt.compute(scene, SQUARE, sensor=long, progress=lambda *_: False)) == "cancelled"
    found["parts that are not there"] = code_of(result.verify) == "component-missing" == code_of(vt.devices)
    for name, is_right in found.items():
        print(f"{'ok   ' if is_right else 'WRONG'} {name}")
    print(f"import {imported:.2f} s, first volume {first:.2f} s; Python {sys.version.split()[0]}, numpy {np.__version__}")
    return 0 if all(found.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
