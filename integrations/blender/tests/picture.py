# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the picture of docs/blender.md with Cycles (no display is needed), about half a minute of one core:

    PYTHONPATH=build/python blender -b --factory-startup --python integrations/blender/tests/picture.py -- docs/blender/volume.png
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import addon_utils  # noqa: E402
import bpy  # noqa: E402
import mathutils  # noqa: E402

import city  # noqa: E402


def paint(thing, name, colour):
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = 0.9
    thing.data.materials.append(material)


def light(scene):
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (0.7, 0.2, 0.5)
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (1, 1, 1, 1), 0.6


def main():
    addon_utils.enable("vantage_blender", default_set=True)
    scene, asked = bpy.context.scene, bpy.context.scene.vantage
    city.build()
    square = city.add_square(z=0.02)
    asked.target, asked.all_faces, asked.target_hides, asked.max_range = square, True, False, 70
    asked.use_heights, asked.min_height, asked.max_height, asked.ground = True, 3, 50, bpy.data.objects["ground"]
    bpy.ops.vantage.compute()
    for thing in bpy.data.objects:
        if thing.name.startswith("house"):
            paint(thing, "wall", (0.5, 0.5, 0.48))
    paint(bpy.data.objects["ground"], "earth", (0.3, 0.31, 0.28))
    paint(square, "target", (0.8, 0.02, 0.02))
    light(scene)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    camera.location, camera.data.lens = (75, -110, 165), 40
    camera.rotation_euler = (mathutils.Vector((0, 0, 14)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.camera = camera
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 24, False
    scene.cycles.transparent_max_bounces, scene.cycles.max_bounces = 32, 4
    scene.render.resolution_x, scene.render.resolution_y = 900, 600
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = str(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).resolve())
    bpy.ops.render.render(write_still=True)


main()
