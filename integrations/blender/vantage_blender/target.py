# SPDX-License-Identifier: GPL-3.0-or-later
"""The target: the marked faces of an object, or all of them, as convex polygons in metres."""

from typing import NamedTuple

import bmesh
import numpy as np

from .package import AddonError

MARK = "vantage_target"
"""The attribute of faces that belong to the target; it stays with them when the mesh is edited."""

PLANE_M = 1e-4
"""Faces are of one plane if no corner is farther from it; at 1 km single precision is off by half of this."""

GAP_M = 1e-4
"""Faces make a convex polygon if they fill their convex hull but for strips that are narrower. The target is the hull: it
becomes larger by such strips, never smaller."""


class Polygon(NamedTuple):
    """A part of the target."""

    name: str
    corners: np.ndarray  # (n, 3) float64, metres, counter-clockwise seen from the front
    front: np.ndarray  # (3,), of length 1: the normal of the faces


def mark_selected_faces(target):
    """Marks the selected faces of an object as its target, and takes other marks away. Returns how many they are."""
    if target is None or target.type != "MESH":
        raise AddonError("no mesh is active", "select the object, or faces of it in Edit Mode")
    if target.library or target.data.library:
        raise AddonError(f"'{target.name}' is linked from another file, where its faces cannot be marked",
                         "make it local, or draw a target in this file")
    if target.mode == "EDIT":
        mesh = bmesh.from_edit_mesh(target.data)
        flags = [face.select for face in mesh.faces]
    else:
        flags = np.zeros(len(target.data.polygons), bool)
        target.data.polygons.foreach_get("select", flags)
    if not any(flags):
        raise AddonError(f"no face of '{target.name}' is selected", "select faces of one plane in Edit Mode (Tab, then 3)")
    if target.mode == "EDIT":
        layer = mesh.faces.layers.int.get(MARK) or mesh.faces.layers.int.new(MARK)
        for face in mesh.faces:
            face[layer] = int(face.select)
        bmesh.update_edit_mesh(target.data, loop_triangles=False, destructive=False)
    else:
        attribute = target.data.attributes.get(MARK) or target.data.attributes.new(MARK, "INT", "FACE")
        attribute.data.foreach_set("value", np.asarray(flags, np.int32))
        target.data.update()
    return int(np.count_nonzero(flags))


def polygons_of(target, all_faces, depsgraph, unit_m):
    """The parts of the target, modifiers applied, in metres of the world."""
    if target is None:
        raise AddonError("there is no target", "select faces in Edit Mode and press 'Use Selected Faces', or draw one")
    matrix = np.array(target.evaluated_get(depsgraph).matrix_world)
    linear = matrix[:3, :3]
    if abs(np.linalg.det(linear)) < 1e-30:
        raise AddonError(f"the target '{target.name}' has a scale of 0", "give it another scale")
    to_front = np.linalg.inv(linear).T
    evaluated = target.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        points, faces = _faces_of(target, mesh, all_faces)
        normals = np.array([mesh.polygons[face].normal[:] for face, _ in faces], np.float64) @ to_front.T
    finally:
        evaluated.to_mesh_clear()
    world = (points @ linear.T + matrix[:3, 3]) * unit_m
    used = np.concatenate([corners for _, corners in faces])
    if not np.isfinite(world[used]).all():
        raise AddonError(f"the target '{target.name}' has a vertex whose coordinates are no numbers",
                         "delete the vertex, or the modifier that moves it there")
    lengths = np.linalg.norm(normals, axis=1)
    if not (lengths > 0).all():
        number = faces[int(np.argmin(lengths))][0]
        raise AddonError(f"face {number} of the target '{target.name}' has no area",
                         "remove it: Mesh > Clean Up > Degenerate Dissolve")
    return _merged(target.name, world, faces, normals / lengths[:, None])


def _faces_of(target, mesh, all_faces):
    """The vertices (n, 3), and the faces of the target as (number, vertex numbers)."""
    count = len(mesh.polygons)
    flags = np.ones(count, np.int32)
    if not all_faces:
        attribute = mesh.attributes.get(MARK)
        if attribute is None or len(attribute.data) != count:
            raise AddonError(f"no face of '{target.name}' is marked as the target",
                             "select faces in Edit Mode and press 'Use Selected Faces'")
        attribute.data.foreach_get("value", flags)
    faces = [(int(number), np.array(mesh.polygons[int(number)].vertices)) for number in np.flatnonzero(flags)]
    if not faces:
        raise AddonError(f"the target '{target.name}' has no faces",
                         "select faces in Edit Mode and press 'Use Selected Faces'")
    points = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    return points.reshape(-1, 3), faces


def _merged(name, world, faces, normals):
    """Neighbouring faces of one plane as one polygon where that is convex, else each by itself."""
    polygons = []
    for group in _groups(world, faces, normals):
        corners = _convex_polygon(world, [faces[i][1] for i in group], normals[group[0]])
        if corners is not None:
            polygons.append(Polygon(_called(name, [faces[i][0] for i in group]), corners, normals[group[0]]))
            continue
        for i in group:
            corners = _convex_polygon(world, [faces[i][1]], normals[i])
            # One that is not convex goes as it is: vantage says at which corner.
            polygons.append(Polygon(_called(name, [faces[i][0]]), world[faces[i][1]] if corners is None else corners,
                                    normals[i]))
    return polygons


def _called(name, numbers):
    return f"{name}, face {numbers[0]}" + (f" and {len(numbers) - 1} more" if len(numbers) > 1 else "")


def _groups(world, faces, normals):
    """Faces that are joined by vertices and of one plane: lists of indices into `faces`."""
    around = {}
    for i, (_, corners) in enumerate(faces):
        for corner in corners:
            around.setdefault(int(corner), []).append(i)
    is_free = np.ones(len(faces), bool)
    for first in range(len(faces)):
        if not is_free[first]:
            continue
        is_free[first] = False
        group = [first]
        for i in group:  # grows while it is walked
            for other in (other for corner in faces[i][1] for other in around[int(corner)]):
                heights = (world[faces[other][1]] - world[faces[first][1][0]]) @ normals[first]
                if is_free[other] and normals[other] @ normals[first] > 0.9 and np.abs(heights).max() <= PLANE_M:
                    is_free[other] = False
                    group.append(other)
        yield group


def _convex_polygon(world, faces, normal):
    """The convex hull of coplanar faces, counter-clockwise; None where they don't fill it."""
    used = np.unique(np.concatenate(faces))
    axis = np.eye(3)[int(np.argmin(np.abs(normal)))]
    u = np.cross(normal, axis)
    u /= np.linalg.norm(u)
    origin = world[used[0]]
    flat = (world - origin) @ np.stack([u, np.cross(normal, u)]).T
    hull = _hull(flat, used)
    if len(hull) < 3:
        return None
    area = sum(_area(flat[corners]) for corners in faces)
    around = flat[hull]
    length = np.linalg.norm(around - np.roll(around, -1, axis=0), axis=1).sum()
    if abs(_area(around) - area) > GAP_M * length:
        return None
    return world[hull]


def _area(points):
    x, y = (points - points[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _hull(flat, numbers):
    """Corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    order = sorted(numbers.tolist(), key=lambda i: (flat[i, 0], flat[i, 1]))
    halves = []
    for chain in (order, order[::-1]):
        half = []
        for i in chain:
            while len(half) > 1 and _turn(flat[half[-2]], flat[half[-1]], flat[i]) <= 0:
                half.pop()
            half.append(i)
        halves += half[:-1]
    return halves


def _turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
