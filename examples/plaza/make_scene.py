#!/usr/bin/env python3
"""Writes plaza.obj, the town square of the examples: z up, metres, the square's middle at the origin, x to the east.

    python3 make_scene.py > plaza.obj

The same bytes every time; no packages needed. Faces run counter-clockwise seen from outside.
"""

import math


class Obj:
    """Wavefront OBJ text, an object at a time."""

    def __init__(self):
        self.lines = ["# A little town square, made by make_scene.py: z up, metres, x to the east."]
        self.vertices = 0

    def add(self, name, vertices, faces):
        """`faces` hold indices into `vertices`, counted from 0. An object may be added in several parts."""
        if name is not None:
            self.lines.append(f"o {name}")
        self.lines += ["v " + " ".join(number(c) for c in vertex) for vertex in vertices]
        self.lines += ["f " + " ".join(str(self.vertices + corner + 1) for corner in face) for face in faces]
        self.vertices += len(vertices)


def number(value):
    """At most four decimals, so that sines and cosines print alike on every machine."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def box(x, y, z):
    """A box between (low, high) pairs."""
    vertices = [(x[i], y[j], z[k]) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, faces


def gabled(x, y, eaves, ridge, along):
    """A house with a gabled roof; the ridge runs along 'x' or 'y'."""
    (x0, x1), (y0, y1) = x, y
    base = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    if along == "x":
        tops = [(x0, (y0 + y1) / 2, ridge), (x1, (y0 + y1) / 2, ridge)]
        faces = [(0, 1, 5, 4), (2, 3, 7, 6), (3, 0, 4, 8, 7), (1, 2, 6, 9, 5), (4, 5, 9, 8), (6, 7, 8, 9)]
    else:
        tops = [((x0 + x1) / 2, y0, ridge), ((x0 + x1) / 2, y1, ridge)]
        faces = [(1, 2, 6, 5), (3, 0, 4, 7), (0, 1, 5, 8, 4), (2, 3, 7, 9, 6), (5, 6, 9, 8), (7, 4, 8, 9)]
    vertices = [(a, b, 0) for a, b in base] + [(a, b, eaves) for a, b in base] + tops
    return vertices, [(3, 2, 1, 0)] + faces


def spire(x, y, eaves, top):
    """A tower with a pyramid for a roof."""
    (x0, x1), (y0, y1) = x, y
    base = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    vertices = [(a, b, 0) for a, b in base] + [(a, b, eaves) for a, b in base]
    vertices.append(((x0 + x1) / 2, (y0 + y1) / 2, top))
    walls = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    roof = [(4 + i, 4 + (i + 1) % 4, 8) for i in range(4)]
    return vertices, [(3, 2, 1, 0)] + walls + roof


def prism(centre, radius, z, sides):
    """An upright prism: a pole, a fountain's basin."""
    ring = [2 * math.pi * (i + 0.5) / sides for i in range(sides)]
    vertices = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a), h) for h in z for a in ring]
    walls = [(i, (i + 1) % sides, sides + (i + 1) % sides, sides + i) for i in range(sides)]
    return vertices, [tuple(reversed(range(sides))), tuple(range(sides, 2 * sides))] + walls


def main():
    obj = Obj()
    obj.add("ground", [(-80, -70, 0), (80, -70, 0), (80, 70, 0), (-80, 70, 0)], [(0, 1, 2, 3)])

    # North: the town hall and its clock tower.
    obj.add("town_hall", *gabled((-18, 16), (20, 33), 11, 16, "x"))
    obj.add("clock_tower", *spire((16, 21), (20, 25), 19, 25))
    # East: the church, its tower towards the square.
    obj.add("church_nave", *gabled((30, 58), (-8, 5), 10, 17, "x"))
    obj.add("church_tower", *spire((23, 30), (-5, 2), 26, 38))
    # West: a row of houses, and the gate between two of them: a passage below, a room above.
    obj.add("house_linden", *gabled((-36, -24), (9, 19), 8, 12, "y"))
    obj.add("gate_north_pier", *box((-33, -25), (7, 9), (0, 8)))
    obj.add("gate_south_pier", *box((-33, -25), (1, 3), (0, 8)))
    obj.add("gate_room", *box((-33, -25), (3, 7), (4.5, 8)))
    obj.add("house_baker", *gabled((-36, -24), (-9, 1), 9, 13, "y"))
    obj.add("house_smith", *gabled((-35, -24), (-19, -9), 7, 11, "y"))
    # South: two blocks, joined by a footbridge over the lane between them.
    obj.add("inn", *gabled((-20, -3), (-34, -20), 10, 15, "x"))
    obj.add("guild_house", *box((2, 20), (-33, -20), (0, 14)))
    obj.add("footbridge", *box((-3, 2), (-26, -23), (6, 9)))
    # Behind: higher houses of the town, some of them seen over the roofs.
    obj.add("tenement_west", *box((-60, -44), (-14, 16), (0, 20)))
    obj.add("tenement_north", *box((-14, 20), (42, 54), (0, 24)))
    obj.add("grain_silo", *prism((34, -38), 6, (0, 22), 12))
    # On the square: a market roof on six columns, a fountain, a flag pole.
    obj.add("market_roof", *box((11, 19), (8, 18), (4, 4.4)))
    for x in (11.3, 18.7):
        for y in (8.3, 13, 17.7):
            obj.add(None, *box((x - 0.2, x + 0.2), (y - 0.2, y + 0.2), (0, 4)))
    obj.add("fountain", *prism((15, -13), 2.5, (0, 0.8), 8))
    obj.add(None, *prism((15, -13), 0.3, (0.8, 3), 8))
    obj.add("flag_pole", *prism((-16, -13), 0.12, (0, 11), 6))
    print("\n".join(obj.lines))


if __name__ == "__main__":
    main()
