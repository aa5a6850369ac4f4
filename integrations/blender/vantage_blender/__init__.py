# SPDX-FileCopyrightText: the authors of vantage
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Add-ons run inside Blender, which is under the GPL, so this folder is under the GPL, version 3 or later (LICENSE beside
# this file). The package `vantage` that it calls stays under Apache-2.0, which version 3 of the GPL allows. Nothing of
# this folder is part of vantage's libraries, program or package.
"""Visibility volumes of faces, in Blender: the panel "Vantage" of the sidebar of the 3D view (docs/blender.md)."""

bl_info = {
    "name": "Vantage",
    "description": "Every position from which whole faces can be seen, as a closed mesh",
    "author": "the authors of vantage",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Vantage",
    "category": "Mesh",
}

from . import live, operators, package, panel, settings


def register():
    for part in (package, settings, operators, panel, live):
        part.register()


def unregister():
    for part in (live, panel, operators, settings, package):
        part.unregister()
