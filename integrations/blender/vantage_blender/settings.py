# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel asks for; kept in the scene, so in the .blend file. Lengths are metres, whatever unit Blender shows."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, PointerProperty, StringProperty

from . import live


def _changed(_settings, context):
    live.request(context.scene, only_target=True)


def _is_mesh(_settings, thing):
    return thing.type == "MESH"


def _metres(name, default, description, low=0.0, **more):
    return FloatProperty(name=f"{name} (m)", default=default, min=low, max=1e9, precision=2, description=description,
                         update=_changed, **more)


class VantageSettings(bpy.types.PropertyGroup):
    target: PointerProperty(type=bpy.types.Object, name="Target", poll=_is_mesh, update=_changed,
                            description="The object that has the faces to be seen")
    all_faces: BoolProperty(name="All its faces", default=False, update=_changed,
                            description="Not only those that were selected as the target: all of the object")
    target_hides: BoolProperty(name="It hides, too", default=True, update=_changed,
                               description="The target's object is one of those that may hide it, as the building that it "
                                           "is a roof of. Off for a polygon that was drawn to be seen")
    sides: EnumProperty(name="Seen from", update=_changed, items=[
        ("front", "Front", "From the side that the faces' normals point to"),
        ("both", "Either side", "From one side or from the other")])
    offset: _metres("Offset", 0.0, "Moves the target along its normals", low=-1e9)

    collection: PointerProperty(type=bpy.types.Collection, name="What hides", update=_changed,
                                description="Objects of this collection may hide the target. Empty: all visible ones")

    max_range: _metres("Distance", 100.0, "The largest, from the camera to every point of the target", low=0.001)
    min_range: _metres("Nearest", 0.0, "The smallest distance, from the camera to every point of the target. 0: none")
    use_incidence: BoolProperty(name="Slant of the view", default=False, update=_changed)
    incidence: FloatProperty(name="Largest (degrees)", default=60.0, min=0.01, max=89.99, update=_changed,
                             description="Between the target's normal and the line to the camera")
    visible: FloatProperty(name="Share seen", default=1.0, min=0.001, max=1.0, update=_changed,
                           description="Of the target's area. 1: all of it")

    use_heights: BoolProperty(name="Heights", default=False, update=_changed)
    min_height: _metres("Lowest", 2.0, "Of the camera", low=-1e9)
    max_height: _metres("Highest", 120.0, "Of the camera", low=-1e9)
    ground: PointerProperty(type=bpy.types.Object, name="Ground", update=_changed,
                            description="Heights are measured from this object, and no clearance is kept from it. Empty: "
                                        "heights are z")
    clearance: _metres("Clearance", 0.0, "How far the camera stays from all but the ground. 0: none")

    camera: EnumProperty(name="Camera", update=_changed, items=[
        ("none", "None", "Any camera that can turn to the target"),
        ("fov", "Angles of view", "The target must fit into one picture"),
        ("model", "Model", "A camera of the list of `vantage cameras`")])
    fov: FloatVectorProperty(name="Angles (degrees)", size=2, default=(60.0, 45.0), min=0.1, max=179.0, update=_changed,
                             description="Horizontal and vertical")
    camera_model: StringProperty(name="Model", default="", update=_changed,
                                 description="A name that `vantage cameras` lists: dji_mavic_3e")
    pixel_size: _metres("Pixel", 0.0, "How much of the target one pixel may cover. 0: any", step=1)

    live: BoolProperty(name="Live", default=False, update=live.switched,
                       description="Compute again whenever the target, what hides it, or a limit changes")
    volume: PointerProperty(type=bpy.types.Object, name="Volume", description="The object that shows the result")


def register():
    bpy.utils.register_class(VantageSettings)
    bpy.types.Scene.vantage = PointerProperty(type=VantageSettings)


def unregister():
    del bpy.types.Scene.vantage
    bpy.utils.unregister_class(VantageSettings)
