"""Pictures of results by pyvista (the extra `plot`), registered with `_render`."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from . import _render
from ._extras import require
from ._mesh import poly_data
from ._requests import Path
from ._result import Result

COLORS = {"scene": "#4c78a8", "range": "#e0b84c", "target_plane": "#9d9d9d", "navigation": "#54a24b", "sensor": "#b279a2"}
"""Of facets, by the kind of their cause."""

LABELS = {"scene": "view hidden", "range": "out of range", "target_plane": "behind the target",
          "navigation": "limit of flight", "sensor": "limit of the sensor"}

TARGET = "#e45756"


def _add_legend(plotter: Any, labels: list[str], colors: list[str]) -> None:
    entries = [["target", TARGET], *map(list, zip(labels, colors))]
    plotter.add_legend(entries, bcolor="white", face="rectangle", size=(0.2, 0.035 * len(entries)))


@_render.plot.register(Result)
def plot(result: Result, path: Path | None = None, *, scene: bool = True, size: tuple[int, int] = (1200, 900),
         opacity: float = 0.4) -> Any:
    """Scene, target and volume. With `path` a PNG, off screen; else a window, or a view to turn in a notebook.

    Args:
        result: what to draw.
        path: where to write a PNG.
        scene: whether to draw the scene.
        size: pixels, width and height.
        opacity: of the volume, 0 to 1.

    Returns:
        what pyvista's `Plotter.show` returns.
    """
    plotter = require("pyvista", "plot").Plotter(off_screen=path is not None, window_size=list(size))
    if scene:
        plotter.add_mesh(result.scene.to_pyvista(), color="#d9d9d9")
    for part in result.mission.target_parts:
        if len(part) < 3:
            plotter.add_points(np.array(part), color=TARGET, point_size=12, render_points_as_spheres=True)
            continue
        fan = np.array([[0, k, k + 1] for k in range(1, len(part) - 1)], np.uint32)
        actor = plotter.add_mesh(poly_data(part, fan), color=TARGET)
        actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0, -2)  # in front of what it lies on
    kinds = np.array([cause.kind for cause in result.causes] or ["scene"])[np.array(result.cause_of, np.int64)]
    drawn = []
    for kind, color in COLORS.items():
        chosen = result.faces[kinds == kind] if len(kinds) else result.faces[:0]
        if len(chosen):
            drawn.append(kind)
            plotter.add_mesh(poly_data(result.vertices, chosen), color=color, opacity=opacity)
    if result.scene.attribution:  # the licence of the scene's data asks for it
        plotter.add_text(result.scene.attribution, position="lower_left", font_size=8, color="black")
    _add_legend(plotter, [LABELS[kind] for kind in drawn], [COLORS[kind] for kind in drawn])
    bounds = result.volume.bounds
    if bounds is not None:
        plotter.view_isometric()
        plotter.reset_camera(bounds=[value for axis in range(3) for value in bounds[:, axis]])
        plotter.camera_set = True  # else showing it would look at all of the scene
    if path is not None:
        return plotter.show(screenshot=os.fspath(path), auto_close=True)
    return plotter.show()
