# SPDX-License-Identifier: GPL-3.0-or-later
"""The volume as an object of Blender: a material for each kind of cause, and the cause of each face as an attribute."""

import json

import bpy
import mathutils
import numpy as np

from .blockers import VOLUME
from .package import AddonError

CAUSE = "vantage_cause"
"""The attribute of faces: an index into the list that the object's property `vantage_causes` has as JSON."""

MATERIALS = {  # red, green, blue, opacity: those of vantage's pictures and GLB files
    "scene": (0, 114, 178, 0.5),
    "range": (230, 159, 0, 0.25),
    "target_plane": (128, 128, 134, 0.6),
    "navigation": (0, 158, 115, 0.4),
    "sensor": (204, 121, 167, 0.4),
    "target": (196, 18, 48, 1.0),
}


def show(result, scene, unit_m):
    """Puts a result into the scene's volume object. Returns how far a vertex was moved by single precision, metres."""
    volume = _volume_object(scene)
    if volume.mode == "EDIT":
        raise AddonError("the volume is being edited", "leave Edit Mode (Tab) first")
    exact = np.array(result.vertices) / unit_m
    # The origin in the middle: coordinates are small, and so is the rounding.
    origin = np.zeros(3) if not len(exact) else ((exact.min(axis=0) + exact.max(axis=0)) / 2).astype(np.float32)
    local = (exact - origin).astype(np.float32)
    volume.matrix_world = mathutils.Matrix.Translation(origin.tolist())
    causes = result.causes
    kinds = [kind for kind in MATERIALS if any(cause.kind == kind for cause in causes)]
    _fill(volume.data, local, np.array(result.faces, np.int32), np.array(result.cause_of, np.int32),
          np.array([kinds.index(cause.kind) for cause in causes], np.int32), kinds)
    moved = np.linalg.norm(local.astype(np.float64) + origin - exact, axis=1).max() * unit_m if len(exact) else 0.0
    volume["vantage_causes"] = json.dumps(
        [{"kind": one.kind, "name": one.name, "area_m2": one.area_m2, "is_object": one.object is not None}
         for one in causes], ensure_ascii=False)
    volume["vantage_volume_m3"] = result.volume_m3
    volume["vantage_outcome"] = result.outcome
    volume["vantage_rounding_m"] = float(moved)
    return float(moved)


def clear(scene):
    """Empties the volume object: what it shows no longer holds. Returns False where it cannot: it is being edited."""
    volume = scene.vantage.volume
    if volume is None or volume.type != "MESH" or VOLUME not in volume:
        return True
    if volume.mode == "EDIT":
        return False
    volume.data.clear_geometry()
    volume["vantage_causes"] = "[]"
    volume["vantage_volume_m3"] = 0.0
    volume["vantage_outcome"] = ""
    return True


def causes_of(volume):
    """The list that `show` wrote; empty where there is none."""
    return json.loads(volume.get("vantage_causes", "[]")) if volume is not None else []


def _volume_object(scene):
    volume = scene.vantage.volume
    if volume is None or volume.type != "MESH" or VOLUME not in volume or volume.name not in scene.objects:
        volume = bpy.data.objects.new("Vantage volume", bpy.data.meshes.new("Vantage volume"))
        volume[VOLUME] = volume.data[VOLUME] = True
        scene.collection.objects.link(volume)
        scene.vantage.volume = volume
    return volume


def _fill(mesh, points, faces, cause_of, kind_of, kinds):
    """points (n, 3) float32, faces (m, 3), cause_of (m,); kind_of: the material of each cause."""
    mesh.clear_geometry()
    mesh.materials.clear()
    for kind in kinds:
        mesh.materials.append(material_of(kind))
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.loops.add(3 * len(faces))
    mesh.loops.foreach_set("vertex_index", faces.ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(faces), 3, dtype=np.int32))
    if bpy.app.version < (4, 0, 0):  # later it follows from the starts
        mesh.polygons.foreach_set("loop_total", np.full(len(faces), 3, np.int32))
    if len(faces):
        mesh.polygons.foreach_set("material_index", kind_of[cause_of])
        mesh.attributes.new(CAUSE, "INT", "FACE").data.foreach_set("value", cause_of)
    mesh.update(calc_edges=True)


def material_of(kind):
    """Of a kind of cause, or of a target that was drawn. One that is there stays as its user made it."""
    name = f"Vantage {kind}"
    material = bpy.data.materials.get(name)
    if material is not None:
        return material
    *colour, opacity = MATERIALS[kind]
    shade = [_linear(one / 255) for one in colour]
    material = bpy.data.materials.new(name)
    material.diffuse_color = (*shade, opacity)
    material.use_nodes = True
    material.blend_method = "BLEND"
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = (*shade, 1)
            node.inputs["Roughness"].default_value = 0.9
            node.inputs["Alpha"].default_value = opacity
    return material


def _linear(value):
    """Of a component in sRGB."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
