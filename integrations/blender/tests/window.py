# SPDX-License-Identifier: GPL-3.0-or-later
"""A test of Live in a Blender with a window, where timers run and the target is dragged by the mouse:

    xvfb-run -a blender --factory-startup --enable-event-simulate --python integrations/blender/tests/window.py \
      -- [--picture FILE.png]

It prints what it saw, and ends with exit code 0 if all of it is right.
"""

import argparse
import os
import pathlib
import sys
import time
import traceback

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import addon_utils  # noqa: E402
import bmesh  # noqa: E402
import bpy  # noqa: E402
import mathutils  # noqa: E402

import city  # noqa: E402

PARSER = argparse.ArgumentParser()
PARSER.add_argument("--picture")
OPTIONS = PARSER.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
WAIT_S = 120

bpy.context.preferences.view.show_splash = False
addon_utils.enable("vantage_blender", default_set=True)
from vantage_blender import live  # noqa: E402


def settings():
    return bpy.context.scene.vantage


def volume_m3():
    return settings().volume["vantage_volume_m3"]


def is_idle():
    return live.follower.due is None and live.follower.job is None


def only_our_panels():
    """The tab of the sidebar cannot be chosen in 3.4: the panels of the others go."""
    for panel in list(bpy.types.Panel.__subclasses__()):
        is_of_sidebar = (getattr(panel, "bl_space_type", ""), getattr(panel, "bl_region_type", "")) == ("VIEW_3D", "UI")
        if is_of_sidebar and getattr(panel, "bl_category", "") != "Vantage" and panel.is_registered:
            bpy.utils.unregister_class(panel)


def view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area, next(region for region in area.regions if region.type == "WINDOW")


def story():
    """Yields what it waits for; an assertion ends it."""
    window, area, region = view()
    city.build()
    square = city.add_square()
    only_our_panels()
    space = area.spaces[0]
    space.show_region_ui = True
    space.region_3d.view_distance, space.region_3d.view_location = 190, (0, 0, 12)
    space.region_3d.view_rotation = mathutils.Euler((0.95, 0, 0.6)).to_quaternion()
    now = settings()
    now.target, now.all_faces, now.target_hides, now.max_range = square, True, False, 70
    now.use_heights, now.min_height, now.max_height, now.ground = True, 3, 50, bpy.data.objects["ground"]
    now.live = True
    yield lambda: live.follower.shown_count > 0 and is_idle()
    first = volume_m3()
    assert first > 0
    if OPTIONS.picture:
        bpy.context.view_layer.objects.active = None  # else Blender shows its own panel of it
        yield lambda: True
        bpy.ops.screen.screenshot(filepath=OPTIONS.picture)

    with bpy.context.temp_override(window=window, area=area, region=region):
        for thing in bpy.context.selected_objects:
            thing.select_set(False)
        square.select_set(True)
        bpy.context.view_layer.objects.active = square
        bpy.ops.ed.undo_push(message="before the drag")
    yield is_idle
    shown, read = live.follower.shown_count, live.follower.read_count
    x, y = region.x + region.width // 3, region.y + region.height // 2
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    window.event_simulate(type="G", value="PRESS", x=x, y=y)
    window.event_simulate(type="G", value="RELEASE", x=x, y=y)
    yield lambda: True
    seen = set()
    for step in range(1, 6):
        window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x + 3 * step, y=y)
        yield lambda: live.follower.shown_count >= shown + step and is_idle()
        seen.add(volume_m3())
    assert len(seen) == 5, seen  # while the mouse button has not been pressed
    window.event_simulate(type="LEFTMOUSE", value="PRESS", x=x + 15, y=y)
    window.event_simulate(type="LEFTMOUSE", value="RELEASE", x=x + 15, y=y)
    yield is_idle
    dragged = volume_m3()
    assert dragged in seen and dragged != first
    read = live.follower.read_count - read
    print(f"window: the volume followed {len(seen)} moves of the mouse, and the scene was read {read} times: "
          f"{first:.0f} m3 to {dragged:.0f} m3")

    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.ed.undo()
    yield lambda: live.follower.shown is not None and is_idle()
    assert bpy.data.objects["square"].location.length < 1e-6, bpy.data.objects["square"].location
    assert volume_m3() == first, (volume_m3(), first)
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.ed.redo()
    yield lambda: live.follower.shown is not None and is_idle()
    assert volume_m3() == dragged, (volume_m3(), dragged)
    print("window: undo and redo gave the volumes of then")

    square = bpy.data.objects["square"]
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.context.view_layer.objects.active = square
        bpy.ops.object.mode_set(mode="EDIT")
        work = bmesh.from_edit_mesh(square.data)
        for vertex in work.verts:
            vertex.co.y *= 0.5
        bmesh.update_edit_mesh(square.data)
    yield lambda: volume_m3() > dragged and is_idle()
    print("window: the volume followed vertices in Edit Mode")


class Teller:
    """Runs the story in Blender's timer."""

    def __init__(self):
        self.story, self.until, self.since = story(), lambda: True, time.monotonic()

    def __call__(self):
        try:
            if self.until():
                self.until, self.since = next(self.story), time.monotonic()
            elif time.monotonic() - self.since > WAIT_S:
                raise AssertionError(f"nothing happened for {WAIT_S} s: {live.follower.status}")
        except StopIteration:
            self.end(0)
        except Exception:
            traceback.print_exc(file=sys.stdout)
            self.end(1)
        return 0.05

    @staticmethod
    def end(code):
        sys.stdout.flush()
        os._exit(code)


bpy.app.timers.register(Teller(), first_interval=1, persistent=True)
