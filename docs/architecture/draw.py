#!/usr/bin/env python3
"""Draws modules.svg: the modules of src/, and the main ways in which they use each other. No packages needed."""

import pathlib

MODULES = {  # name: (left, top, width, what it does)
    "include/vantage": (20, 14, 1020, "the public API: values, and functions that take and return them"),
    "cli": (20, 104, 1020, "scene, inspect, compute, query, verify, compare, render, ...: parse, run, print"),
    "app": (20, 194, 400, "mission files, their run, reports, files"),
    "simplify": (440, 194, 110, "fewer facets"),
    "prove": (565, 194, 110, "every facet"),
    "query": (690, 194, 100, "points"),
    "verify": (805, 194, 110, "rays (Embree)"),
    "picture": (930, 194, 110, "(Cairo)"),
    "maps/city": (20, 284, 320, "maps to solids on the ground (Clipper)"),
    "spheres": (360, 284, 240, "the method of the paper"),
    "exact": (620, 284, 180, "the engine (CDT)"),
    "depth": (820, 284, 220, "depth images (OpenGL)"),
    "maps/osm": (20, 374, 150, "maps (libosmium)"),
    "maps/terrain": (190, 374, 150, "heights (GDAL)"),
    "solid": (360, 374, 240, "booleans (Manifold), cuts"),
    "target": (620, 374, 180, "frame, lift, range"),
    "io": (20, 464, 215, "mesh formats (zlib, Draco)"),
    "tiles": (250, 464, 90, "3D Tiles"),
    "arrangement": (360, 464, 240, "many solids at once"),
    "scene": (620, 464, 420, "weld, merge, hierarchy"),
    "geo": (20, 554, 210, "where on the earth (PROJ)"),
    "camera": (250, 554, 150, "cameras by name"),
    "sensor": (420, 554, 240, "limits of the sensor, for points"),
    "options": (680, 554, 130, "of maps, devices"),
    "request": (850, 554, 190, "keys, once each"),
    "core": (20, 644, 1020, "geometry, errors, progress, threads (oneTBB), whole files"),
}
USES = [("cli", "app"), ("cli", "query"), ("cli", "verify"), ("cli", "picture"), ("cli", "prove"),
        ("cli", "simplify"), ("app", "maps/city"), ("app", "spheres"),
        ("query", "exact"), ("picture", "depth"), ("maps/city", "maps/osm"), ("maps/city", "maps/terrain"),
        ("spheres", "solid"), ("solid", "arrangement"), ("exact", "target"), ("depth", "scene"), ("target", "scene"), ("io", "geo"), ("tiles", "geo"),
        ("io", "camera"), ("scene", "core"), ("geo", "core"), ("camera", "core"),
        ("options", "core"), ("request", "core")]
HEIGHT = 58
# Whose files for one limit each lie together, besides those of solid.
LIMITS = ("prove", "query", "verify")


def box(name):
    left, top, width, what = MODULES[name]
    fill = "#eef2f9" if name != "include/vantage" else "#fdf1e2"
    return (f'<rect x="{left}" y="{top}" width="{width}" height="{HEIGHT}" rx="7" fill="{fill}" stroke="#346ebe"/>'
            f'<text x="{left + 12}" y="{top + 25}" font-size="16" font-weight="bold">{name}</text>'
            f'<text x="{left + 12}" y="{top + 45}" font-size="13" fill="#4a5260">{what}</text>')


def rooms():
    """The rooms of limits, a dashed frame round those whose files are in them."""
    boxes = [MODULES[name] for name in LIMITS]
    left, top = min(b[0] for b in boxes) - 7, boxes[0][1] - 7
    width = max(b[0] + b[2] for b in boxes) + 7 - left
    return (f'<rect x="{left}" y="{top}" width="{width}" height="{HEIGHT + 32}" rx="9" fill="none" stroke="#9a5b13" '
            f'stroke-dasharray="5 4"/>'
            f'<text x="{left + 8}" y="{top + HEIGHT + 25}" font-size="13" fill="#9a5b13">limits: a room each</text>')


def arrow(upper, lower):
    """From the bottom of one module to the top of another, over the middle of what they share."""
    left = max(MODULES[upper][0], MODULES[lower][0])
    right = min(MODULES[name][0] + MODULES[name][2] for name in (upper, lower))
    x, y0, y1 = (left + right) / 2, MODULES[upper][1] + HEIGHT, MODULES[lower][1] - 2
    return f'<line x1="{x}" y1="{y0}" x2="{x}" y2="{y1}" stroke="#1d2b45" stroke-width="1.6" marker-end="url(#tip)"/>'


def main():
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="1060" height="720" viewBox="0 0 1060 720" '
             'font-family="Helvetica, Arial, sans-serif" fill="#1d2b45">',
             '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" '
             'orient="auto">'
             '<path d="M0,0 L8,4 L0,8 z" fill="#1d2b45"/></marker></defs>',
             '<rect width="100%" height="100%" fill="white"/>']
    parts += [rooms()] + [box(name) for name in MODULES]
    parts += [arrow(*call) for call in USES]
    (pathlib.Path(__file__).parent / "modules.svg").write_text("\n".join(parts) + "\n</svg>\n", encoding="utf-8")


if __name__ == "__main__":
    main()
