#!/usr/bin/env python3
"""Draws house.svg: the rooms of src/, and who calls whom. No packages needed."""

import pathlib

ROOMS = {  # name: (left, top, width, what it does)
    "include/vantage": (20, 14, 1020, "the public API: values, and functions that take and return them"),
    "cli": (20, 104, 1020, "scene, inspect, compute, query, verify, compare, render, ...: parse, run, print"),
    "mission": (20, 194, 560, "YAML to Mission, run it"),
    "query": (600, 194, 200, "point by point, no mesh"),
    "verify": (820, 194, 220, "shadow rays (Embree)"),
    "spheres": (420, 284, 240, "cube map, mesh, Algorithm 1"),
    "city": (20, 374, 380, "maps to solids on the ground (Clipper)"),
    "render": (420, 374, 180, "depth images, pictures"),
    "exact": (620, 374, 420, "blockers, envelope, mesh (CDT)"),
    "osm": (20, 464, 145, "maps (libosmium)"),
    "terrain": (180, 464, 140, "heights (GDAL)"),
    "solid": (340, 464, 700, "booleans (Manifold), cuts, measures, files, reports"),
    "scene": (20, 554, 1020, "files to Scene; weld, merge, hierarchy"),
    "geo": (20, 644, 340, "where on the earth (PROJ)"),
    "core": (380, 644, 320, "progress, and stopping"),
    "parallel": (720, 644, 320, "threads (oneTBB)"),
}
CALLS = [("cli", "mission"), ("cli", "verify"), ("cli", "query"), ("mission", "city"), ("mission", "spheres"),
         ("query", "exact"), ("spheres", "render"), ("spheres", "exact"), ("city", "osm"), ("city", "terrain"),
         ("city", "solid"), ("exact", "solid"), ("render", "solid"), ("osm", "scene"), ("terrain", "scene"),
         ("solid", "scene"), ("scene", "geo"), ("scene", "core"),
         ("scene", "parallel")]
HEIGHT = 58


def box(name):
    left, top, width, what = ROOMS[name]
    fill = "#eef2f9" if name != "include/vantage" else "#fdf1e2"
    return (f'<rect x="{left}" y="{top}" width="{width}" height="{HEIGHT}" rx="7" fill="{fill}" stroke="#346ebe"/>'
            f'<text x="{left + 12}" y="{top + 25}" font-size="16" font-weight="bold">{name}</text>'
            f'<text x="{left + 12}" y="{top + 45}" font-size="13" fill="#4a5260">{what}</text>')


def arrow(upper, lower):
    """From the bottom of one room to the top of another, over the middle of what they share."""
    left = max(ROOMS[upper][0], ROOMS[lower][0])
    right = min(ROOMS[room][0] + ROOMS[room][2] for room in (upper, lower))
    x, y0, y1 = (left + right) / 2, ROOMS[upper][1] + HEIGHT, ROOMS[lower][1] - 2
    return f'<line x1="{x}" y1="{y0}" x2="{x}" y2="{y1}" stroke="#1d2b45" stroke-width="1.6" marker-end="url(#tip)"/>'


def main():
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="1060" height="720" viewBox="0 0 1060 720" '
             'font-family="Helvetica, Arial, sans-serif" fill="#1d2b45">',
             '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" '
             'orient="auto">'
             '<path d="M0,0 L8,4 L0,8 z" fill="#1d2b45"/></marker></defs>',
             '<rect width="100%" height="100%" fill="white"/>']
    parts += [box(name) for name in ROOMS]
    parts += [arrow(*call) for call in CALLS]
    (pathlib.Path(__file__).parent / "house.svg").write_text("\n".join(parts) + "\n</svg>\n", encoding="utf-8")


if __name__ == "__main__":
    main()
