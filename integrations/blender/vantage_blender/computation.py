# SPDX-License-Identifier: GPL-3.0-or-later
"""From what Blender shows to a result of vantage. `Inputs` are read in Blender's thread; what follows needs no Blender."""

from typing import NamedTuple

import numpy as np

from . import blockers, package, target


class Inputs(NamedTuple):
    """All that a volume depends on, in metres."""

    blockers: blockers.Blockers
    polygons: list  # of target.Polygon
    sides: str
    offset: float
    sensor: dict  # keys of vt.Sensor
    navigation: dict  # keys of vt.Navigation
    unit_m: float
    reduced: list  # names, of `blockers.reduced_objects`

    def equals(self, other):
        return (other is not None and self[2:] == other[2:] and self.blockers.equals(other.blockers) and
                len(self.polygons) == len(other.polygons) and
                all(a.name == b.name and np.array_equal(a.corners, b.corners) and np.array_equal(a.front, b.front)
                    for a, b in zip(self.polygons, other.polygons)))


def unit_of(scene):
    """Metres in one unit of Blender."""
    return 1.0 if scene.unit_settings.system == "NONE" else scene.unit_settings.scale_length


def read_inputs(scene, depsgraph, known=None):
    """Raises AddonError where something is missing or no number. `known`: blockers that were read before, where no mesh has
    changed since; they are taken if all objects are where they were."""
    settings, unit_m = scene.vantage, unit_of(scene)
    polygons = target.polygons_of(settings.target, settings.all_faces, depsgraph, unit_m)
    which = (depsgraph, unit_m, settings.collection, None if settings.target_hides else settings.target)
    is_known = known is not None and known.shown == blockers.shown_objects(*which)
    found = known if is_known else blockers.gather(*which)
    return Inputs(found, polygons, settings.sides, settings.offset, _sensor(settings), _navigation(settings, found.names),
                  unit_m, blockers.reduced_objects(depsgraph, *which[2:]))


def _sensor(settings):
    keys = {"max_range": settings.max_range}
    if settings.min_range > 0:
        keys["min_range"] = settings.min_range
    if settings.use_incidence:
        keys["incidence"] = settings.incidence
    if settings.visible < 1:
        keys["visible"] = settings.visible
    if settings.camera == "fov":
        keys["fov"] = list(settings.fov)
    elif settings.camera == "model":
        keys["camera"] = {"model": settings.camera_model}
    if settings.pixel_size > 0:
        keys["pixel"] = {"size": settings.pixel_size}
    return {key: _decimal(value) for key, value in keys.items()}


def _navigation(settings, names):
    keys = {}
    if settings.use_heights:
        heights = _decimal([settings.min_height, settings.max_height])
        keys["altitude"] = heights if settings.ground is None else {"agl": heights}
    if settings.clearance > 0:
        keys["clearance"] = _decimal(settings.clearance)
    if settings.ground is not None and keys:
        name = settings.ground.name_full
        if name not in names:
            raise package.AddonError(f"the ground '{name}' is not among the objects that may hide the target",
                                     "show it and take it into the collection, or choose no ground")
        keys["ground"] = name
    return keys


def _decimal(value):
    """Settings are in single precision: of 0.3 it is 0.300000012. The shortest decimal that means the same there is what was
    typed."""
    if isinstance(value, list):
        return [_decimal(one) for one in value]
    return float(str(np.float32(value))) if isinstance(value, float) else value


class Computation:
    """Computes, and keeps the scene of the last call: it is prepared anew only where what hides has changed."""

    def __init__(self):
        self._blockers, self._scene = None, None
        self.prepared_count = 0  # how often a scene was prepared

    def scene_of(self, found, progress=None):
        vt = package.load()
        if not found.equals(self._blockers):
            scene = vt.Scene.from_arrays(found.vertices, found.faces, object_of=found.object_of, objects=found.names)
            scene.prepare(progress)
            self._blockers, self._scene = found, scene
            self.prepared_count += 1
        return self._scene

    def run(self, inputs, progress=None):
        """The vantage.Result. Raises vantage.Error."""
        return mission_of(self.scene_of(inputs.blockers, progress), inputs, progress).run(progress=progress)


def mission_of(scene, inputs, progress=None):
    vt = package.load()
    more = {"sides": inputs.sides} if inputs.sides != "front" else {}
    if inputs.offset:
        more["offset"] = _decimal(inputs.offset)
    parts = [vt.Target(name=one.name, vertices=one.corners, front=one.front.tolist(), **more) for one in inputs.polygons]
    return vt.Mission.of(scene, parts[0] if len(parts) == 1 else parts, sensor=inputs.sensor,
                         navigation=inputs.navigation or None, progress=progress)


shared = Computation()
"""Of this session of Blender."""
