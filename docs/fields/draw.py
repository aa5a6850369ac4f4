#!/usr/bin/env python3
"""Draws the picture of ../python-fields.md: the share of the gallery's target in Munich that is seen, at 61 m above the
ground, and the surface of 80 %.

    PYTHONPATH=build/python draw.py        writes munich.png beside this file; needs matplotlib and pyvista

The scene is looked for in ../shared beside the checkout, or where VANTAGE_SHARED says.
"""

import os
import pathlib

import matplotlib
import numpy as np
import pyvista

import vantage as vt

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", HERE.parents[2] / "shared"))
SQUARE = np.array([[-5, -112, 0], [25, -112, 0], [22, -97, 0], [-8, -97, 0]])
BOX = ((-150, -250, 0), (170, 50, 150))
HEIGHT = 61


def draw_surface(scene, field, axes):
    surface = field.vantage.contour(0.8)
    plotter = pyvista.Plotter(off_screen=True, window_size=(1400, 1200))
    near = scene.to_pyvista().clip_box((BOX[0][0], BOX[1][0], BOX[0][1], BOX[1][1], -5, 200), invert=False)
    plotter.add_mesh(near, color="#d9d9d9")
    plotter.add_mesh(pyvista.PolyData(SQUARE + [0, 0, 0.3], [4, 0, 1, 2, 3]), color="#e45756")
    plotter.add_mesh(surface.to_pyvista(), color="#4c78a8", opacity=0.45, smooth_shading=True)
    plotter.camera_position = [(480, -560, 400), (10, -105, 45), (0, 0, 1)]
    axes.imshow(plotter.screenshot(return_img=True))
    axes.set_title("from inside this surface 80 % of it is seen")
    axes.axis("off")


def main():
    scene = vt.Scene.from_mesh(SHARED / "data/mesh/munich_merged.ply")
    field = vt.fraction_field(scene, SQUARE, BOX, 2)
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(13, 5.6), layout="constrained")
    flat = field.sel(z=HEIGHT, method="nearest")
    flat.plot.imshow(ax=left, vmin=0, vmax=1, cmap="viridis", cbar_kwargs={"label": "share of the square that is seen"})
    left.fill(SQUARE[:, 0], SQUARE[:, 1], fill=False, edgecolor="#e45756", linewidth=2)
    left.set(aspect="equal", title=f"at z = {float(flat.z):g} m", xlabel="x, m", ylabel="y, m")
    draw_surface(scene, field, right)
    figure.savefig(HERE / "munich.png", dpi=110)
    print(field.attrs["voxels_evaluated"], "of", field.size, "voxels were looked from")


if __name__ == "__main__":
    main()
