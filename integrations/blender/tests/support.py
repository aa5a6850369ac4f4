# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on, installed in this Blender as the options of run.py say; and what its tests have in common."""

import argparse
import importlib
import pathlib
import sys
import time
import unittest

import bpy
import addon_utils

import city

HERE = pathlib.Path(__file__).resolve().parent

PARSER = argparse.ArgumentParser()
PARSER.add_argument("--zip")
PARSER.add_argument("--vantage", default=str(HERE.parents[2] / "build" / "bin" / "vantage"))
PARSER.add_argument("tests", nargs="*")
OPTIONS = PARSER.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def enable():
    """Installs the zip, or takes the sources. Returns the name of the add-on's module."""
    if not OPTIONS.zip:
        sys.path.insert(0, str(HERE.parent))
        name = "vantage_blender"
    elif bpy.app.version >= (4, 2, 0):
        bpy.ops.extensions.package_install_files(filepath=OPTIONS.zip, repo="user_default", enable_on_install=False)
        name = "bl_ext.user_default.vantage_blender"
    else:
        bpy.ops.preferences.addon_install(filepath=OPTIONS.zip, overwrite=True)
        name = "vantage_blender"
    module = addon_utils.enable(name, default_set=True)
    assert module is not None, name
    assert module.__file__.startswith(str(HERE.parent)) != bool(OPTIONS.zip), module.__file__
    return name


ADDON = enable()
blockers, computation, live, package, target, volume_mesh = (
    importlib.import_module(f"{ADDON}.{name}")
    for name in ("blockers", "computation", "live", "package", "target", "volume_mesh"))


class Case(unittest.TestCase):
    def setUp(self):
        live.after_load("")
        bpy.context.scene.unit_settings.scale_length = 1.0
        bpy.context.scene.property_unset("vantage")
        city.build()

    @property
    def settings(self):
        return bpy.context.scene.vantage

    def use_square(self, **more):
        square = city.add_square(**more)
        self.settings.target, self.settings.all_faces, self.settings.target_hides = square, True, False
        return square

    def compute(self):
        self.assertEqual(bpy.ops.vantage.compute(), {"FINISHED"})
        return self.settings.volume

    def refused(self, operator, **arguments):
        """The one message of an operator that is cancelled."""
        with self.assertRaises(RuntimeError) as raised:
            operator(**arguments)
        message = str(raised.exception)
        self.assertEqual(message.count("Error:"), 1, message)
        self.assertNotIn("Traceback", message)
        return message

    def follow(self):
        """What the timers do in a Blender with windows, until nothing is left."""
        end = time.monotonic() + 60
        while live.tick() is not None:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.005)
