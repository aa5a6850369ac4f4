#!/usr/bin/env python3
"""The fewest positions for targets in Munich: time, positions, bound. Half of the targets are squares of 8 m on the
ground, at random; the others are roofs, single triangles of the mesh.

    positions.py MESH [--targets 20 100] [--range 300] [--seed 1] [--picture FILE.png]

It needs the package `vantage` with the extras `positions` and, for the picture, `plot`. Each position is asked for by
the exact query, and the witnesses of the bound are tried with random points.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import vantage as vt
from vantage import _core

ALTITUDE = (20, 120)


def square(rng, bounds):
    x, y = rng.uniform(bounds[0][:2] / 2 + bounds[1][:2] / 2 - 400, bounds[0][:2] / 2 + bounds[1][:2] / 2 + 400)
    return [[x - 4, y - 4, 0.5], [x + 4, y - 4, 0.5], [x + 4, y + 4, 0.5], [x - 4, y + 4, 0.5]]


def roof(rng, corners):
    """A triangle that faces up, is above 8 m and has 30 m2 or more, near the middle."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1) / 2
    flat = np.abs(normals[:, 2]) / 2 > 0.8 * area
    middle = (corners.reshape(-1, 3).min(axis=0) + corners.reshape(-1, 3).max(axis=0)) / 2
    near = (np.abs(corners.mean(axis=1)[:, :2] - middle[:2]) < 400).all(axis=1)
    return corners[rng.choice(np.flatnonzero(flat & near & (area > 30) & (corners[:, :, 2].min(axis=1) > 8)))]


def draw(scene, count, max_range, rng):
    """As many results, none of them empty."""
    corners, results, refused = scene.vertices[scene.faces], [], 0
    while len(results) < count:
        is_roof = len(results) % 2 == 1
        target = vt.Target(vertices=roof(rng, corners) if is_roof else square(rng, scene.bounds),
                           offset=0.05 if is_roof else None)
        try:
            result = vt.compute(scene, target, max_range=max_range, navigation=vt.Navigation(altitude=ALTITUDE))
        except vt.Error:
            refused += 1
            continue
        if result.empty:
            refused += 1
        else:
            results.append(result)
    return results, refused


def check(answer, results, rng):
    """Positions by the exact query; the witnesses with points in each."""
    for target, position in enumerate(answer.assigned):
        assert results[target].contains(answer.positions[position]).all()
    points = np.concatenate([rng.uniform(*results[i].volume.bounds, (2000, 3)) for i in answer.necessary])
    seen = np.array([results[i].contains(points) for i in answer.necessary])
    assert seen.sum(axis=0).max() == 1
    return int(seen.any(axis=0).sum())


def attack(results, rng, count=2000):
    """Points that see a target and lie outside of its outer mesh: there must be none."""
    outside = asked = 0
    for result in results:
        corners = result.vertices[result.faces[rng.integers(len(result.faces), size=count)]]
        at = (corners * rng.dirichlet([1, 1, 1], count)[:, :, None]).sum(axis=1)
        centre = np.mean(result.mission.target_parts[0], axis=0)
        points = centre + (at - centre) * (1 + 10 ** rng.uniform(-9, -2, count) * rng.choice([-1, 1], count))[:, None]
        sees = result.contains(points)
        index = _core.SolidIndex(_core.outer_volume(result.mission._core, 0.0, 0.01, 0, None)[0])
        outside += int((index.depths(points)[sees] < 0).sum())
        asked += int(sees.sum())
    return outside, asked


def picture(answer, results, path):
    import pyvista

    from vantage._mesh import poly_data

    colors = ["#e45756", "#4c78a8", "#54a24b", "#b279a2", "#f58518", "#72b7b2", "#9d755d", "#ff9da6", "#eeca3b", "#1b9e77"]
    plotter = pyvista.Plotter(off_screen=True, window_size=[1200, 800])
    plotter.set_background("white")
    plotter.add_mesh(results[0].scene.to_pyvista(), color="#e6e3dd")
    used = np.concatenate([part for result in results for part in result.mission.target_parts] + [answer.positions])
    for target, position in enumerate(answer.assigned):
        color = colors[position % len(colors)]
        for part in results[target].mission.target_parts:
            fan = np.array([[0, k, k + 1] for k in range(1, len(part) - 1)], np.uint32)
            plotter.add_mesh(poly_data(np.array(part) + [0, 0, 0.4], fan), color=color)
            middle = np.mean(part, axis=0)
        plotter.add_mesh(pyvista.Line(answer.positions[position], middle), color=color, line_width=3)
    for number, position in enumerate(answer.positions):
        plotter.add_mesh(pyvista.Sphere(radius=9, center=position), color=colors[number % len(colors)])
    middle, size = (used.min(axis=0) + used.max(axis=0)) / 2, np.ptp(used, axis=0).max()
    plotter.camera_position = [middle + np.array([-0.45, -1.0, 1.05]) * size, middle, (0, 0, 1)]
    plotter.screenshot(path)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("mesh")
    arguments.add_argument("--targets", type=int, nargs="+", default=[20, 100])
    arguments.add_argument("--range", type=float, default=300)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--picture")
    given = arguments.parse_args()
    scene = vt.Scene.from_mesh(given.mesh).prepare()
    print(f"vantage {vt.__version__}, {scene}, range {given.range:g} m, altitude {ALTITUDE}, seed {given.seed}\n")
    print("| targets | facets | seconds | answer | disjoint | one position sees at most | outer meshes: points outside |")
    print("|---|---|---|---|---|---|---|")
    for count in given.targets:
        rng = np.random.default_rng(given.seed)
        results, _ = draw(scene, count, given.range, rng)
        begin = time.perf_counter()
        answer = vt.fewest_positions(results, time_limit_s=300)
        seconds = time.perf_counter() - begin
        check(answer, results, rng)
        outside, asked = attack(results, rng)
        most = f"{max(map(len, answer.sees))} found, {answer.greatest_depth} bound"
        text = f"{len(answer)} positions, {answer.lower_bound} necessary"
        print(f"| {count} | {sum(len(one.faces) for one in results):,} | {seconds:.1f} | {text} | {len(answer.necessary)} | "
              f"{most} | {outside} of {asked:,} |", flush=True)
        for note in answer.notes:
            print("\nnote:", note)
        if given.picture and count == given.targets[0]:
            picture(answer, results, given.picture)


if __name__ == "__main__":
    main()
