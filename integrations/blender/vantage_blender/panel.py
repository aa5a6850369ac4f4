# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Vantage" in the sidebar of the 3D view."""

import textwrap

import bpy

from . import live, package, volume_mesh

LINE = 28
"""Characters in a line of the sidebar; Blender's labels don't wrap."""

CAUSES = 12
"""How many causes are listed, largest first."""


def _say(layout, lines, icon="NONE"):
    column = layout.column(align=True)
    column.scale_y = 0.8
    for number, line in enumerate(part for one in lines for part in textwrap.wrap(one, LINE)):
        column.label(text=line, icon=icon if number == 0 else "BLANK1" if icon != "NONE" else "NONE")


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Vantage"


class VANTAGE_PT_main(_Panel, bpy.types.Panel):
    bl_idname = "VANTAGE_PT_main"
    bl_label = "Vantage"

    def draw(self, context):
        layout, settings = self.layout, context.scene.vantage
        layout.use_property_split = True
        layout.use_property_decorate = False
        if lines := package.missing():
            _say(layout, lines, "ERROR")
            return
        column = layout.column(align=True)
        column.operator("vantage.use_selected_faces", icon="FACESEL")
        column.operator("vantage.draw_target", icon="MESH_PLANE")
        layout.prop(settings, "target")
        layout.prop(settings, "all_faces")
        layout.prop(settings, "target_hides")
        layout.prop(settings, "collection")
        layout.prop(settings, "max_range")
        row = layout.row(align=True)
        row.use_property_split = False
        row.operator("vantage.compute", icon="HIDE_OFF")
        row.prop(settings, "live", toggle=True, icon="FILE_REFRESH")
        if live.follower.scene_name in ("", context.scene.name):
            _say(layout, live.follower.status, "INFO")
            if live.follower.is_stale:
                _say(layout, ["Something has changed since: press Compute."], "ERROR")
        column = layout.column(align=True)
        column.operator("vantage.export_mission", icon="EXPORT")
        column.operator("vantage.save_volume", icon="MESH_DATA")


class VANTAGE_PT_limits(_Panel, bpy.types.Panel):
    bl_label = "Limits"
    bl_parent_id = "VANTAGE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.vantage
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(settings, "min_range")
        layout.prop(settings, "use_heights")
        column = layout.column(align=True)
        column.active = settings.use_heights
        column.prop(settings, "min_height")
        column.prop(settings, "max_height")
        layout.prop(settings, "ground")
        layout.prop(settings, "clearance")
        layout.prop(settings, "use_incidence")
        column = layout.column()
        column.active = settings.use_incidence
        column.prop(settings, "incidence")
        layout.prop(settings, "visible")
        layout.prop(settings, "sides")
        layout.prop(settings, "offset")
        layout.prop(settings, "camera")
        if settings.camera == "fov":
            layout.prop(settings, "fov")
        elif settings.camera == "model":
            layout.prop(settings, "camera_model")
        layout.prop(settings, "pixel_size")


class VANTAGE_PT_causes(_Panel, bpy.types.Panel):
    bl_label = "What Bounds It"
    bl_parent_id = "VANTAGE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        causes = volume_mesh.causes_of(context.scene.vantage.volume)
        column = self.layout.column(align=True)
        for cause in sorted(causes, key=lambda one: -one["area_m2"])[:CAUSES]:
            row = column.row()
            text = f"{cause['name']}: {cause['area_m2']:,.0f} m2"
            if cause["is_object"]:
                row.operator("vantage.select_cause", text=text, icon="OBJECT_DATA").name = cause["name"]
            else:
                row.label(text=text, icon="BLANK1")
        if len(causes) > CAUSES:
            column.label(text=f"and {len(causes) - CAUSES} smaller ones")


CLASSES = (VANTAGE_PT_main, VANTAGE_PT_limits, VANTAGE_PT_causes)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
