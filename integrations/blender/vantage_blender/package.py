# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package `vantage`: where it is looked for, and what to do where there is none."""

import importlib
import os
import sys

import bpy


class AddonError(Exception):
    """What is wrong in Blender, and what to do; printed as the errors of vantage are."""

    def __init__(self, problem, fix=""):
        super().__init__(problem + (f"\n  what to do: {fix}" if fix else ""))


IN_BLENDER = {
    "target-not-convex": "in Blender: split the face, Face > Triangulate Faces (Ctrl T), and mark the parts",
    "target-not-planar": "in Blender: Face > Triangulate Faces (Ctrl T), or Mesh > Clean Up > Make Planar Faces",
}
"""What mends an error of vantage here, by its code."""


def is_of_vantage(error):
    vt = sys.modules.get("vantage")
    return vt is not None and isinstance(error, vt.Error)


def message_of(error):
    """The error's own words, and what they mean in Blender."""
    more = IN_BLENDER.get(getattr(error, "code", None))
    return str(error) + (f"\n  {more}" if more else "")


class VantagePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    package_folder: bpy.props.StringProperty(
        name="Folder of the package", subtype="DIR_PATH",
        description="Where the folder `vantage` of the Python package lies, unless it is installed in Blender's Python")

    def draw(self, _context):
        self.layout.prop(self, "package_folder")
        for line in missing():
            self.layout.label(text=line)


def package_folder():
    addon = bpy.context.preferences.addons.get(__package__)
    return bpy.path.abspath(addon.preferences.package_folder) if addon and addon.preferences else ""


def load():
    """The package. Raises AddonError where it cannot be imported. Once it is there, threads may call this."""
    if sys.modules.get("vantage") is not None:
        return sys.modules["vantage"]
    folder = package_folder()
    if folder and os.path.isdir(folder) and folder not in sys.path:
        sys.path.insert(0, folder)
        importlib.invalidate_caches()
    try:
        return importlib.import_module("vantage")
    except ImportError as error:
        raise AddonError(f"the Python package vantage cannot be imported: {error}", install_command()) from None


def install_command():
    version = ".".join(map(str, sys.version_info[:2]))
    return (f"build its wheel for Python {version} (make wheel), run: \"{python_program()}\" -m pip install "
            "vantage-....whl, and start Blender again; or name the package's folder in the preferences of this add-on")


def python_program():
    """The Python whose packages Blender sees: its own, or in Debian the system's. `sys.executable` may be another one."""
    for name in (f"bin/python3.{sys.version_info[1]}", "bin/python.exe", "python.exe"):
        file = os.path.join(sys.base_prefix, *name.split("/"))
        if os.path.isfile(file):
            return file
    return sys.executable or "python3"


_looked_for = []
"""The problem that the last look found, with the folder it was of: drawing must not look again and again."""


def load_problem():
    """What is missing and how to install it; empty where the package is there."""
    try:
        load()
    except AddonError as error:
        return str(error)
    return ""


def missing():
    """The lines of `load_problem`, for what is drawn often: looked for once, and again when the folder changes."""
    if sys.modules.get("vantage") is not None:
        return []
    key = package_folder()
    if not _looked_for or _looked_for[0] != key:
        _looked_for[:] = [key, load_problem()]
    return _looked_for[1].splitlines()


def register():
    bpy.utils.register_class(VantagePreferences)


def unregister():
    bpy.utils.unregister_class(VantagePreferences)
