# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what is asked as a mission file, and the scene beside it, so that `vantage compute` gives the same volume."""

import os
import pathlib
import shutil
import tempfile

from . import computation, package

OWN = b"# vantage "
"""How OBJ files of scenes begin that vantage wrote."""


def scene_file_of(mission_file):
    return pathlib.Path(mission_file).with_suffix(".scene.obj")


def export(inputs, mission_file):
    """Writes the mission and its scene, both or none. Returns the scene's file.

    OBJ keeps all digits of the coordinates; GLB would round them, and then the volume is another one.
    """
    vt = package.load()
    mission_file = pathlib.Path(mission_file)
    scene_file = scene_file_of(mission_file)
    if not mission_file.parent.is_dir():
        raise package.AddonError(f"there is no folder '{mission_file.parent}'", "choose a folder that exists")
    if mission_file.is_dir():
        raise package.AddonError(f"'{mission_file}' is a folder", "give the mission another name")
    _refuse_foreign(scene_file)
    scene = computation.shared.scene_of(inputs.blockers)
    try:
        with tempfile.TemporaryDirectory(prefix=".vantage-", dir=mission_file.parent) as name:
            folder = pathlib.Path(name)
            scene.save(folder / scene_file.name)
            read = vt.Scene.from_mesh(folder / scene_file.name)
            if read.hash != scene.hash:
                raise package.AddonError("the scene is another one when it is read again: nothing was written",
                                         "please report this as a defect")
            text = computation.mission_of(read, inputs).text(folder)
            (folder / mission_file.name).write_text(text, encoding="utf-8")
            _put_both(folder, scene_file, mission_file)
    except OSError as error:
        raise package.AddonError(f"'{mission_file}' cannot be written: {error.strerror or error}",
                                 "choose another folder, or make room") from None
    return scene_file


def _put_both(folder, scene_file, mission_file):
    """Moves two files from `folder`, on the same disk, to their places. If the second one fails, the first is as it was."""
    before = folder / "before.obj"
    has_before = scene_file.exists()
    if has_before:
        shutil.copy2(scene_file, before)
    os.replace(folder / scene_file.name, scene_file)
    try:
        os.replace(folder / mission_file.name, mission_file)
    except OSError:
        if has_before:
            os.replace(before, scene_file)
        else:
            scene_file.unlink()
        raise


def _refuse_foreign(scene_file):
    try:
        with open(scene_file, "rb") as there:
            is_own = there.read(len(OWN)) == OWN
    except FileNotFoundError:
        return
    except OSError as error:
        raise package.AddonError(f"'{scene_file}' cannot be read: {error.strerror or error}",
                                 "give the mission another name") from None
    if not is_own:
        raise package.AddonError(f"'{scene_file}' is there, and vantage did not write it",
                                 "give the mission another name, or move that file away")
