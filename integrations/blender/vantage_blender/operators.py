# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons of the panel. What is wrong is reported with the message of the error."""

import bpy
from bpy.props import FloatProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import computation, live, mission_file, package, target, volume_mesh


def _guarded(work):
    """An operator's `execute` that reports errors of vantage, and of what Blender has, by their message."""
    def execute(self, context):
        try:
            return work(self, context)
        except Exception as error:
            if not (isinstance(error, package.AddonError) or package.is_of_vantage(error)):
                raise
            self.report({"ERROR"}, package.message_of(error))
        return {"CANCELLED"}
    return execute


def _inputs(context):
    package.load()
    return computation.read_inputs(context.scene, context.evaluated_depsgraph_get())


def _warn(operator, inputs):
    for note in live.notes_of(inputs):
        operator.report({"WARNING"}, note)


class VANTAGE_OT_use_selected_faces(bpy.types.Operator):
    """The selected faces of the active object become the target. Faces of one plane that form a convex polygon are one
part of it; of several parts, all must be seen"""
    bl_idname = "vantage.use_selected_faces"
    bl_label = "Use Selected Faces"
    bl_options = {"REGISTER", "UNDO"}

    def _execute(self, context):
        count = target.mark_selected_faces(context.active_object)
        settings = context.scene.vantage
        settings.target, settings.all_faces, settings.target_hides = context.active_object, False, True
        self.report({"INFO"}, f"{count} faces of '{context.active_object.name}' are the target")
        return {"FINISHED"}

    execute = _guarded(_execute)


class VANTAGE_OT_draw_target(bpy.types.Operator):
    """Adds a rectangle at the 3D cursor that is the target, and hides nothing. Drag it, or its corners in Edit Mode"""
    bl_idname = "vantage.draw_target"
    bl_label = "Draw a Rectangle"
    bl_options = {"REGISTER", "UNDO"}

    width: FloatProperty(name="Width (m)", default=10.0, min=0.001, max=1e6)
    length: FloatProperty(name="Length (m)", default=10.0, min=0.001, max=1e6)

    def _execute(self, context):
        if context.mode != "OBJECT":
            raise package.AddonError("an object is being edited", "leave Edit Mode (Tab) first")
        unit_m = computation.unit_of(context.scene)
        x, y = self.width / 2 / unit_m, self.length / 2 / unit_m
        mesh = bpy.data.meshes.new("Target")
        mesh.from_pydata([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [], [(0, 1, 2, 3)])
        drawn = bpy.data.objects.new("Target", mesh)
        drawn.matrix_world = context.scene.cursor.matrix
        mesh.materials.append(volume_mesh.material_of("target"))
        context.collection.objects.link(drawn)
        for other in context.selected_objects:
            other.select_set(False)
        drawn.select_set(True)
        context.view_layer.objects.active = drawn
        settings = context.scene.vantage
        settings.target, settings.all_faces, settings.target_hides = drawn, True, False
        return {"FINISHED"}

    execute = _guarded(_execute)


class VANTAGE_OT_compute(bpy.types.Operator):
    """Computes every position from which the whole target is seen"""
    bl_idname = "vantage.compute"
    bl_label = "Compute"
    bl_options = {"REGISTER", "UNDO"}

    def _execute(self, context):
        follower = live.follower
        follower.finish()
        inputs = _inputs(context)
        manager = context.window_manager
        manager.progress_begin(0, 1)
        try:
            result = computation.shared.run(inputs, lambda _stage, fraction: manager.progress_update(fraction))
        finally:
            manager.progress_end()
        follower.note(context.scene, result, inputs, volume_mesh.show(result, context.scene, inputs.unit_m))
        if result.empty:
            self.report({"WARNING"}, "\n".join(follower.status))
        else:
            self.report({"INFO"}, follower.status[0])
        _warn(self, inputs)
        return {"FINISHED"}

    execute = _guarded(_execute)


class VANTAGE_OT_export_mission(bpy.types.Operator, ExportHelper):
    """Writes a mission file, and the scene as OBJ beside it: `vantage compute` then gives the same volume"""
    bl_idname = "vantage.export_mission"
    bl_label = "Export Mission"
    filename_ext = ".yaml"
    filter_glob: StringProperty(default="*.yaml", options={"HIDDEN"})

    def _execute(self, context):
        live.follower.wait()
        inputs = _inputs(context)
        scene_file = mission_file.export(inputs, bpy.path.abspath(self.filepath))
        _warn(self, inputs)
        self.report({"INFO"}, f"wrote {self.filepath} and {scene_file.name}")
        return {"FINISHED"}

    execute = _guarded(_execute)


class VANTAGE_OT_save_volume(bpy.types.Operator, ExportHelper):
    """Writes the volume as it was computed, in double precision, with its report: the file of `vantage compute`"""
    bl_idname = "vantage.save_volume"
    bl_label = "Save Volume"
    filename_ext = ".ply"
    filter_glob: StringProperty(default="*.ply", options={"HIDDEN"})

    def _execute(self, context):
        follower = live.follower
        result = follower.result
        if result is None or follower.scene_name != context.scene.name:
            raise package.AddonError("there is no volume of this session", "press Compute first")
        # Blender does not tell of all changes: what is asked now is compared itself.
        inputs = _inputs(context)
        if not inputs.equals(follower.shown):
            follower.leave()
            raise package.AddonError("something has changed since the volume was computed: it is not saved",
                                     "press Compute, or wait for Live, and save it then")
        result.save(bpy.path.abspath(self.filepath))
        _warn(self, inputs)
        self.report({"INFO"}, f"wrote {self.filepath}")
        return {"FINISHED"}

    execute = _guarded(_execute)


class VANTAGE_OT_select_cause(bpy.types.Operator):
    """Selects the object that hides the target behind these faces of the volume"""
    bl_idname = "vantage.select_cause"
    bl_label = "Select What Hides"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty()

    def _execute(self, context):
        found = context.scene.objects.get(self.name)
        if found is None:
            raise package.AddonError(f"there is no object '{self.name}'", "press Compute: the scene has changed")
        if context.mode != "OBJECT":
            raise package.AddonError("an object is being edited", "leave Edit Mode (Tab) first")
        for other in context.selected_objects:
            other.select_set(False)
        found.select_set(True)
        context.view_layer.objects.active = found
        return {"FINISHED"}

    execute = _guarded(_execute)


CLASSES = (VANTAGE_OT_use_selected_faces, VANTAGE_OT_draw_target, VANTAGE_OT_compute, VANTAGE_OT_export_mission,
           VANTAGE_OT_save_volume, VANTAGE_OT_select_cause)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
