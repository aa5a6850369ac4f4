# SPDX-License-Identifier: GPL-3.0-or-later
"""A small city, as arrays and as objects of Blender, made of one list of boxes."""

import bpy
import numpy as np

BOX_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def box_corners(low, high):
    (x0, y0, z0), (x1, y1, z1) = low, high
    return [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0), (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]


def add(name, corners, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def boxes(count, seed=7):
    """count x count buildings, 20 m apart, with an open square in the middle: (low, high) each."""
    draw = np.random.default_rng(seed)
    found = []
    for row in range(count):
        for column in range(count):
            x, y = 20 * (column - (count - 1) / 2), 20 * (row - (count - 1) / 2)
            if max(abs(x), abs(y)) > 15:
                height = round(float(draw.uniform(5, 25)), 1)
                found.append(((x - 6, y - 6, 0), (x + 6, y + 6, height)))
    return found


def build(count=5, unit=1.0):
    """Clears the file and builds the city; `unit`: units of Blender in a metre. The ground is 4 x 4 quads."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.context.view_layer.update()
    half = 10 * count + 20
    steps = np.linspace(-half, half, 5)
    ground = [(x * unit, y * unit, 0) for y in steps for x in steps]
    quads = [(5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5) for j in range(4) for i in range(4)]
    add("ground", ground, quads)
    for number, (low, high) in enumerate(boxes(count)):
        add(f"house {number}", np.multiply(box_corners(low, high), unit).tolist(), BOX_FACES)
    bpy.context.view_layer.update()


def add_square(unit=1.0, half=8.0, z=0.0):
    """A drawn target of 2 x 2 quads that form one square; returns the object."""
    steps = (-half, 0, half)
    corners = [(x * unit, y * unit, z * unit) for y in steps for x in steps]
    return add("square", corners, [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)])


def select_faces(thing, numbers):
    """In Object Mode, as Edit Mode leaves it."""
    bpy.context.view_layer.objects.active = thing
    flags = np.zeros(len(thing.data.polygons), bool)
    flags[list(numbers)] = True
    for domain in (thing.data.vertices, thing.data.edges):
        domain.foreach_set("select", np.zeros(len(domain), bool))
    thing.data.polygons.foreach_set("select", flags)


def write_many(count):
    """One mesh of about `count` triangles: a wide city of boxes; returns how many it has."""
    side = int(np.ceil(np.sqrt(count / 12)))
    points, faces = [], []
    draw = np.random.default_rng(3)
    heights = draw.uniform(4, 20, (side, side))
    for row in range(side):
        for column in range(side):
            x, y = 18.0 * (column - side / 2), 18.0 * (row - side / 2)
            if max(abs(x), abs(y)) < 20:
                continue
            faces += [[corner + len(points) for corner in face] for face in BOX_FACES]
            points += box_corners((x - 5, y - 5, 0), (x + 5, y + 5, heights[row, column]))
    add("many", points, faces)
    return 2 * len(faces)
