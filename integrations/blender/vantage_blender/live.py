# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows changes: a handler notes them, a timer reads the scene and hands it to a thread, and shows what comes back.

Blender's data is touched in Blender's thread alone. A change waits DELAY_S for others; while a volume is computed the next
one waits, so the volume follows a drag as fast as it can be computed.
"""

import threading
import time

import bpy
from bpy.app.handlers import persistent

from . import computation, package, volume_mesh
from .blockers import VOLUME

DELAY_S = 0.05
TICK_S = 0.02


class Follower:
    """The state of `Live`, of one scene at a time."""

    def __init__(self):
        self.forget()
        self.shown_count = 0  # these two count how often
        self.read_count = 0

    def forget(self):
        self.scene_name = ""
        self.due = None
        self.job = None
        self.shown = None  # the Inputs of the volume that is shown
        self.result = None  # the vantage.Result
        self.is_stale = False  # what is shown is of before the last change, and nothing will replace it by itself
        self.status = []
        self.blockers = None
        self.is_scene_known = False  # no object but the target has changed since the blockers were read

    def request(self, scene, only_target=False):
        if scene.name != self.scene_name:  # what was shown, and what runs, is of another one
            self.shown, self.result, self.is_stale, self.status = None, None, False, []
        self.scene_name = scene.name
        self.is_scene_known = self.is_scene_known and only_target
        if self.due is None:
            self.due = time.monotonic() + DELAY_S
        if not bpy.app.timers.is_registered(tick):
            bpy.app.timers.register(tick, first_interval=DELAY_S)

    def tick(self):
        """One step. Returns the seconds to the next one, or None where nothing is left to do."""
        if self.job is not None and not self.job.is_alive():
            job, self.job = self.job, None
            self._show(job)
        if self.due is not None and self.job is None and time.monotonic() >= self.due:
            self.due = None
            self._start()
        return TICK_S if self.job is not None or self.due is not None else None

    def _scene(self):
        scene = bpy.data.scenes.get(self.scene_name)
        return scene if scene is not None and scene.vantage.live else None

    def _start(self):
        scene = self._scene()
        if scene is None or scene != bpy.context.scene:  # of another one nothing is evaluated
            self.leave()
            return
        try:
            package.load()
            depsgraph = bpy.context.evaluated_depsgraph_get()  # may tell of changes that were not evaluated yet
            known = self.blockers if self.is_scene_known else None
            inputs = computation.read_inputs(scene, depsgraph, known)
            self.read_count += inputs.blockers is not known
            self.blockers, self.is_scene_known = inputs.blockers, True
        except package.AddonError as error:
            self._fail(scene, error)
            return
        if inputs.equals(self.shown):
            self.is_stale = False
            return
        self.job = Job(inputs, scene.name)
        self.job.start()

    def _show(self, job):
        scene = self._scene()
        if scene is None or scene.name != job.scene_name:
            self.leave()
            return
        if job.error is not None:
            self._fail(scene, job.error)
        else:
            try:
                self.note(scene, job.result, job.inputs, volume_mesh.show(job.result, scene, job.inputs.unit_m))
            except package.AddonError as error:
                self.leave()
                self.status = str(error).splitlines()
        _redraw()

    def leave(self):
        """A change is not followed: what is shown stays, and is told to be old."""
        self.is_stale = self.shown is not None
        _redraw()

    def wait(self):
        """For a computation that runs; what it found is shown by the next step."""
        if self.job is not None:
            self.job.join()

    def finish(self):
        """Waits for a computation that runs, and drops it: what is asked now is newer."""
        if self.job is not None:
            self.job.join()
            self.job = None
            self.leave()

    def note(self, scene, result, inputs, moved_m):
        """What was shown, for the panel."""
        self.scene_name, self.shown, self.result, self.is_stale = scene.name, inputs, result, False
        self.shown_count += 1
        self.status = status_of(result, moved_m) + notes_of(inputs)

    def _fail(self, scene, error):
        self.shown, self.result, self.status = None, None, package.message_of(error).splitlines()
        self.is_stale = not volume_mesh.clear(scene)  # it would claim what no longer holds
        _redraw()


class Job(threading.Thread):
    """One computation, of inputs that nobody changes."""

    def __init__(self, inputs, scene_name):
        super().__init__(daemon=True)
        self.inputs, self.scene_name, self.result, self.error = inputs, scene_name, None, None

    def run(self):
        try:
            self.result = computation.shared.run(self.inputs)
            self.result.volume_m3  # measured here, not in Blender's thread
        except Exception as error:  # it must reach the panel, whatever it is
            self.error = error


def status_of(result, moved_m):
    if result.empty:
        return [f"No position sees all of the target ({result.outcome}).", *result.reason.splitlines()]
    lines = [f"{result.volume_m3:,.1f} m3, {len(result.faces):,} facets",
             f"shown in single precision: corners moved by up to {moved_m * 1000:.2g} mm"]
    return lines + [f"note: {note.text}" for note in result.notes]


def notes_of(inputs, most=5):
    """What to know of the scene that was read."""
    if not inputs.reduced:
        return []
    more = len(inputs.reduced) - most
    names = ", ".join(f"'{name}'" for name in inputs.reduced[:most]) + (f" and {more} more" if more > 0 else "")
    return [f"note: what the viewport leaves out hides nothing here. It shows less than is rendered of {names}"]


follower = Follower()


def request(scene, is_sure=True, only_target=False):
    """Asks for a new volume where `Live` is on; else notes that what is shown is of something else, if that is sure."""
    if scene.vantage.live:
        follower.request(scene, only_target)
    elif follower.shown is not None and is_sure and scene.name == follower.scene_name:
        follower.is_stale = True


def switched(settings, context):
    if settings.live:
        follower.request(context.scene)
    elif follower.due is not None or follower.job is not None:
        follower.leave()


def tick():
    return follower.tick()


def _redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _is_moved(update):
    thing = update.id
    return (isinstance(thing, bpy.types.Object) and VOLUME not in thing and
            (update.is_updated_geometry or update.is_updated_transform))


@persistent
def after_update(scene, depsgraph):
    """Blender calls it after changes."""
    settings = scene.vantage
    moved = [update.id.original for update in depsgraph.updates if _is_moved(update)]
    if moved:
        request(scene, only_target=not settings.target_hides and all(thing == settings.target for thing in moved))
    # Of objects that are hidden, or leave a collection, Blender tells no more than of a selection.
    elif any(isinstance(update.id, (bpy.types.Collection, bpy.types.Scene)) for update in depsgraph.updates):
        request(scene, is_sure=False, only_target=True)


@persistent
def after_frame(scene, *_):
    """Blender names no object that is animated."""
    request(scene)


@persistent
def after_undo(scene, *_):
    """The volume's mesh is as it was then, too: it need not be that of the target."""
    if follower.shown is not None:
        follower.shown, follower.result = None, None
        follower.status = ["Undone: the volume may be of something else."]
    request(scene)


@persistent
def after_load(_file, *_):
    follower.forget()


def _handlers():
    handlers = bpy.app.handlers
    return [(handlers.depsgraph_update_post, after_update), (handlers.load_post, after_load),
            (handlers.frame_change_post, after_frame), (handlers.undo_post, after_undo), (handlers.redo_post, after_undo)]


def register():
    for called, handler in _handlers():
        called.append(handler)


def unregister():
    for called, handler in _handlers():
        called.remove(handler)
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)
