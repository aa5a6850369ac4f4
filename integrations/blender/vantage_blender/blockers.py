# SPDX-License-Identifier: GPL-3.0-or-later
"""What may hide the target: objects of the view layer as triangles, modifiers and instances applied, in metres."""

from typing import NamedTuple

import numpy as np

from .package import AddonError

VOLUME = "vantage_volume"
"""The property of volumes, objects and meshes: they hide nothing."""

SURFACES = ("MESH", "CURVE", "SURFACE", "FONT", "META")


class Blockers(NamedTuple):
    """The triangles, in the order of Blender's objects."""

    vertices: np.ndarray  # (n, 3) float64, metres
    faces: np.ndarray  # (m, 3) uint32
    object_of: np.ndarray  # (m,) uint32, an index into names
    names: list
    shown: list  # of `shown_objects`, when they were read

    def equals(self, other):
        return self is other or (
            other is not None and self.names == other.names and
            all(np.array_equal(mine, theirs) for mine, theirs in zip(self[:3], other[:3])))


def shown_objects(depsgraph, unit_m, collection=None, without=None):
    """Which objects may hide, and where they are: what tells whether one was hidden, moved, or taken out of a collection.
    It does not tell whether a mesh was changed."""
    return [unit_m, *((owner.name_full, thing.original.name_full, tuple(map(tuple, instance.matrix_world)))
                      for instance, thing, owner in _instances(depsgraph, collection, without))]


def _instances(depsgraph, collection, without):
    """(instance, its evaluated object, the object of the file that shows it); each holds until the next one."""
    allowed = None if collection is None else {thing.name_full for thing in collection.all_objects}
    for instance in depsgraph.object_instances:
        thing = instance.object
        owner = (instance.parent if instance.is_instance else thing).original
        if (thing.type in SURFACES and instance.show_self and owner != without and VOLUME not in thing and
                (allowed is None or owner.name_full in allowed)):
            yield instance, thing, owner


def reduced_objects(depsgraph, collection=None, without=None):
    """Names of objects that hide less here than when they are rendered, as the viewport shows a part of them alone:
    particles by their percentage, modifiers that are off in the viewport, or in Edit Mode while the object is edited,
    and levels of subdivision."""
    allowed = None if collection is None else {thing.name_full for thing in collection.all_objects}
    looked_at, found = set(), []
    for instance in depsgraph.object_instances:  # also emitters that are not shown themselves
        thing = instance.object.original
        owner = instance.parent.original if instance.is_instance else thing
        if owner == without or VOLUME in owner or (allowed is not None and owner.name_full not in allowed):
            continue
        for one in (owner, thing):
            if one.name_full not in looked_at:
                looked_at.add(one.name_full)
                if _is_reduced(one, depsgraph.scene.render):
                    found.append(one.name_full)
    return sorted(found)


def _is_reduced(thing, rendering):
    for modifier in thing.modifiers:
        is_shown = modifier.show_viewport and (thing.mode != "EDIT" or modifier.show_in_editmode)
        if modifier.show_render and (not is_shown or _is_coarser(modifier, rendering)):
            return True
    for settings in (system.settings for system in thing.particle_systems):
        if settings.render_type in ("OBJECT", "COLLECTION"):
            is_new = hasattr(settings, "child_percent")  # its name since Blender 4
            shown = settings.child_percent if is_new else settings.child_nbr
            if settings.display_percentage < 100 or (
                    settings.child_type != "NONE" and shown < settings.rendered_child_count):
                return True
    return False


def _is_coarser(modifier, rendering):
    if modifier.type not in ("SUBSURF", "MULTIRES"):
        return False
    shown, rendered = modifier.levels, modifier.render_levels
    if rendering.use_simplify:
        shown = min(shown, rendering.simplify_subdivision)
        rendered = min(rendered, rendering.simplify_subdivision_render)
    return shown < rendered


def gather(depsgraph, unit_m, collection=None, without=None):
    """The objects that are visible in the viewport, but for volumes and the object `without`.

    `collection`: only what is in it or in a collection inside of it. `unit_m`: metres in a unit of Blender.
    """
    known, points, triangles, owners, names = {}, [], [], [], {}
    count = 0
    for instance, thing, owner in _instances(depsgraph, collection, without):
        # Geometry nodes show meshes that are of no object as the object that has the nodes.
        key = (thing.original.name_full, thing.data.as_pointer())
        if key not in known:
            known[key] = _triangles(thing)
        local, corners = known[key]
        if not len(corners):
            continue
        matrix = np.array(instance.matrix_world)
        world = (local @ matrix[:3, :3].T + matrix[:3, 3]) * unit_m
        if not np.isfinite(world).all():
            number = int(np.flatnonzero(~np.isfinite(world).all(axis=1))[0])
            raise AddonError(f"vertex {number} of '{thing.name}' has coordinates that are no numbers",
                             "delete the vertex, or leave the object out: hide it, or choose a collection without it")
        points.append(world)
        triangles.append(corners + np.uint32(count))
        owners.append(np.full(len(corners), len(names), np.uint32))
        names[_free_name(owner.name_full if owner == thing.original else f"{owner.name_full}/{key[0]}", names)] = None
        count += len(local)
    if not triangles:
        where = f"the collection '{collection.name}'" if collection is not None else "the scene"
        raise AddonError(f"{where} has no visible mesh that may hide the target",
                         "show the buildings, or choose their collection")
    return Blockers(np.concatenate(points), np.concatenate(triangles), np.concatenate(owners), list(names),
                    shown_objects(depsgraph, unit_m, collection, without))


def _free_name(name, taken):
    number, free = 1, name
    while free in taken:
        number += 1
        free = f"{name} #{number}"
    return free


def _triangles(thing):
    """The vertices (n, 3) of an evaluated object in its own axes, and its triangles (m, 3)."""
    mesh = thing.to_mesh()
    if mesh is None:  # a curve without a surface
        return np.empty((0, 3)), np.empty((0, 3), np.uint32)
    try:
        mesh.calc_loop_triangles()
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        return points.reshape(-1, 3).astype(np.float64), corners.reshape(-1, 3).astype(np.uint32)
    finally:
        thing.to_mesh_clear()
