#!/usr/bin/env python3
"""Draws the pictures of ../theory.md as SVG, from the formulas that the text gives. No packages needed.

    draw.py        writes blocker.svg, star.svg and octahedral_map.svg beside itself
"""

import math
import pathlib

HERE = pathlib.Path(__file__).parent
RED, BLUE, GREY, DARK = "#d61e28", "#346ebe", "#8a8f98", "#1d2b45"


class Drawing:
    """An SVG whose coordinates are the picture's own, y up."""

    def __init__(self, left, bottom, right, top, scale):
        self.left, self.top, self.scale = left, top, scale
        self.width, self.height = (right - left) * scale, (top - bottom) * scale
        self.parts = []

    def at(self, p):
        return f"{(p[0] - self.left) * self.scale:.1f},{(self.top - p[1]) * self.scale:.1f}"

    def polygon(self, points, fill, opacity=1.0, stroke="none"):
        self.parts.append(f'<polygon points="{" ".join(map(self.at, points))}" fill="{fill}" '
                          f'fill-opacity="{opacity}" stroke="{stroke}" stroke-width="1.5"/>')

    def line(self, points, stroke, width=1.5, dash=""):
        style = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<polyline points="{" ".join(map(self.at, points))}" fill="none" stroke="{stroke}" '
                          f'stroke-width="{width}"{style}/>')

    def dot(self, p, fill):
        x, y = self.at(p).split(",")
        self.parts.append(f'<circle cx="{x}" cy="{y}" r="3.5" fill="{fill}"/>')

    def text(self, p, words, fill=DARK, anchor="start", size=15):
        x, y = self.at(p).split(",")
        self.parts.append(f'<text x="{x}" y="{y}" fill="{fill}" text-anchor="{anchor}" font-size="{size}" '
                          f'font-family="Helvetica, Arial, sans-serif">{words}</text>')

    def write(self, name):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width:.0f}" height="{self.height:.0f}" '
                f'viewBox="0 0 {self.width:.0f} {self.height:.0f}">\n<rect width="100%" height="100%" fill="white"/>\n')
        (HERE / name).write_text(head + "\n".join(self.parts) + "\n</svg>\n", encoding="utf-8")


# The scene in section: the target on the line z = 0, walls and a roof as segments.
TARGET = (-2.0, 2.0)
SEGMENTS = [((3.6, 0.0), (3.6, 2.4)), ((-4.6, 0.0), (-4.6, 1.2)), ((-2.6, 4.2), (-0.8, 4.6))]
RANGE = 9.0


def planes(segment):
    """(m, h) with m . o >= h >= m . t, touching both, in section: through a point of each, or along the segment."""
    found = []
    targets = [(TARGET[0], 0.0), (TARGET[1], 0.0)]
    pairs = [(o, t) for o in segment for t in targets] + [segment]
    for a, b in pairs:
        m = (a[1] - b[1], b[0] - a[0])
        size = math.hypot(*m)
        if size < 1e-12:
            continue
        for sign in (1, -1):
            n = (sign * m[0] / size, sign * m[1] / size)
            h = n[0] * a[0] + n[1] * a[1]
            separates = all(n[0] * o[0] + n[1] * o[1] >= h - 1e-9 for o in segment)
            separates = separates and all(n[0] * t[0] + n[1] * t[1] <= h + 1e-9 for t in targets)
            if separates and h > 1e-9:
                found.append((n[0] / h, n[1] / h))
    return found


def gauge(x, z, segments=SEGMENTS):
    """The greatest inverse depth along a unit direction, and whether it is the range's."""
    ranges = []
    for t in TARGET:
        root = math.sqrt((x * t) ** 2 + RANGE**2 - t**2)
        ranges.append(1 / (x * t + root))
    greatest, by_range = max(ranges), True
    for segment in segments:
        least = min(g[0] * x + g[1] * z for g in planes(segment))
        if least > greatest:
            greatest, by_range = least, False
    return greatest, by_range


def boundary(segments=SEGMENTS, count=3600):
    points = []
    for i in range(count + 1):
        angle = math.pi * i / count
        x, z = math.cos(angle), math.sin(angle)
        value, _ = gauge(x, z, segments)
        points.append((x / value, z / value))
    return thinned(points)


def thinned(points, tolerance=0.003):
    """Without the points that the straight line between the ones kept stands for (to a tenth of a pixel)."""
    kept, start = [points[0]], 0
    for end in range(2, len(points)):
        a, b = points[start], points[end]
        d = (b[0] - a[0], b[1] - a[1])
        size = math.hypot(*d)
        if any(abs(d[0] * (p[1] - a[1]) - d[1] * (p[0] - a[0])) > tolerance * size for p in points[start + 1:end]):
            start = end - 1
            kept.append(points[start])
    return kept + points[-1:]


def ground_and_target(drawing, left, right):
    drawing.line([(left, 0), (right, 0)], GREY, 1)
    drawing.line([(TARGET[0], 0), (TARGET[1], 0)], RED, 5)
    drawing.dot((0, 0), RED)
    drawing.text((-0.12, -0.55), "c", RED)
    drawing.text((TARGET[0] - 0.1, -0.55), "T", RED, "end")


def blocker():
    drawing = Drawing(-3.2, -1.0, 10.2, 7.2, 62)
    o = ((2.6, 1.6), (4.4, 1.8))
    t = ((TARGET[0], 0.0), (TARGET[1], 0.0))

    def beyond(a, b, length):  # from b on, away from a
        d = (b[0] - a[0], b[1] - a[1])
        return b[0] + length * d[0], b[1] + length * d[1]

    upper, lower = beyond(t[1], o[0], 3.1), beyond(t[0], o[1], 0.9)
    drawing.polygon([o[0], upper, (lower[0], upper[1]), lower, o[1]], BLUE, 0.22)
    for target_end, end, tip in ((t[1], o[0], upper), (t[0], o[1], lower)):
        drawing.line([target_end, end], GREY, 1.2, "5,4")
        drawing.line([end, tip], BLUE, 2.2)
    drawing.line(o, DARK, 5)
    ground_and_target(drawing, -3, 10)
    on, seen = (3.4, 1.6 + 0.8 / 9), (-1.0, 0.0)
    p = beyond(seen, on, 0.75)
    drawing.dot(p, DARK)
    drawing.text((p[0] + 0.15, p[1] + 0.05), "o + s (o - t)")
    drawing.line([p, seen], DARK, 1.2, "2,3")
    drawing.dot(on, DARK)
    drawing.text((on[0] - 0.05, on[1] + 0.2), "o")
    drawing.dot(seen, DARK)
    drawing.text((seen[0] - 0.05, -0.55), "t")
    drawing.text((2.4, 1.6), "O", anchor="end", size=18)
    drawing.text((7.3, 5.0), "B(O)", BLUE, size=22)
    drawing.text((3.5, 5.4), "g &#183; x = 1", BLUE, "end")
    drawing.text((2.55, 3.0), "corner of O, edge of T", GREY, "end", 13)
    drawing.text((6.7, 2.0), "edge of O, corner of T", GREY, "start", 13)
    drawing.text((3.5, 1.3), "plane of O", GREY, "start", 13)
    drawing.write("blocker.svg")


def star():
    drawing = Drawing(-9.9, -1.0, 9.9, 9.7, 44)
    for segment in SEGMENTS:
        shadow = boundary([segment])
        whole = boundary([])
        drawing.polygon(whole + shadow[::-1], BLUE, 0.10)
    curve = boundary()
    drawing.polygon(curve, "#ee9632", 0.28, DARK)
    ground_and_target(drawing, -9.5, 9.5)
    for segment in SEGMENTS:
        drawing.line(segment, DARK, 5)
    for degrees in (20, 52, 76, 97, 121, 150, 168):
        x, z = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        value, _ = gauge(x, z)
        drawing.line([(0, 0), (x / value, z / value)], GREY, 1, "4,4")
        drawing.dot((x / value, z / value), DARK)
    x, z = math.cos(math.radians(52)), math.sin(math.radians(52))
    drawing.text((0.62 * x * RANGE - 0.2, 0.62 * z * RANGE + 0.1), "1 / gauge(d)", DARK, "end")
    drawing.text((-7.9, 6.4), "range", "#b96a10")
    drawing.text((3.3, 1.35), "V(T)", "#b96a10", "end", 20)
    drawing.write("star.svg")


def octahedral_map():
    """The octahedral map seen from above, with the planes of a wall and of a pole: straight in each quadrant."""
    drawing = Drawing(-1.25, -1.2, 1.25, 1.2, 230)
    drawing.polygon([(1, 0), (0, 1), (-1, 0), (0, -1)], "#f4f6fa", 1, DARK)
    drawing.line([(-1, 0), (1, 0)], GREY, 1, "4,4")
    drawing.line([(0, -1), (0, 1)], GREY, 1, "4,4")
    for degrees in (15, 30, 45, 60, 75):  # circles of equal elevation
        points = []
        for i in range(361):
            a, e = math.radians(i), math.radians(degrees)
            x, y, z = math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)
            s = abs(x) + abs(y) + z
            points.append((x / s, y / s))
        drawing.line(points, "#d5d9e0", 1)
    for corners in ([(3, -2.5, 0), (3, 4, 0), (3, 4, 2.5), (3, -2.5, 2.5)],
                    [(-2, -1.4, 0), (-1.4, -2, 0), (-1.4, -2, 5), (-2, -1.4, 5)]):
        outline = []
        for i, a in enumerate(corners):
            b = corners[(i + 1) % len(corners)]
            for k in range(60):
                p = [u + (v - u) * k / 60 for u, v in zip(a, b)]
                s = abs(p[0]) + abs(p[1]) + p[2]
                outline.append((p[0] / s, p[1] / s))
        drawing.polygon(outline, BLUE, 0.28, BLUE)
    drawing.text((0.03, 0.03), "up")
    drawing.text((1.03, -0.02), "x")
    drawing.text((0.02, 1.05), "y")
    drawing.text((0.56, 0.52), "horizon |a| + |b| = 1", DARK, "start", 13)
    drawing.text((0.42, -0.13), "a wall", BLUE, "end", 13)
    drawing.text((-0.5, -0.2), "a tower", BLUE, "end", 13)
    drawing.write("octahedral_map.svg")


if __name__ == "__main__":
    blocker()
    star()
    octahedral_map()
