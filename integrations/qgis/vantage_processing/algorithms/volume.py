"""Visibility volumes as layers: their facets, and slices at heights."""

import math
import struct

import numpy as np
from qgis.core import (QgsGeometry, QgsLineString, QgsMultiPolygon, QgsPolygon, QgsProcessing, QgsProcessingException,
                       QgsProcessingOutputNumber, QgsProcessingParameterCrs, QgsProcessingParameterFeatureSink,
                       QgsProcessingParameterString, QgsWkbTypes)

from ..engine import Progress, stop_if_canceled, tell_notes
from ..places import name_of
from ..styles import ByCause
from .base import VantageAlgorithm, fields_of
from .request import add_request, read_request

FACETS = {"target": str, "facet": int, "cause_kind": str, "cause_name": str, "cause_id": str, "object_kind": str,
          "area_m2": float, "cause_area_m2": float}
SLICES = {"target": str, "z_m": float, "area_m2": float}
_TRIANGLE = struct.pack("<BIII", 1, 1003, 1, 4)  # WKB: a Polygon Z of one ring of four corners


class VolumeAlgorithm(VantageAlgorithm):
    NAME = "volume"
    TITLE = "Visibility volume"
    SUMMARY = "The positions from which all of a target is visible, as 3D facets and as slices at heights"
    HELP = ("Every position from which nothing hides any part of the target, within the range and the limits: a closed surface "
            "of triangles. Each facet says what bounds the volume there. Slices are the positions at one height.")

    def initAlgorithm(self, configuration=None):  # noqa: N802
        add_request(self, combine=("all", "any", "each"))
        self.add(QgsProcessingParameterString("SLICE_HEIGHTS", "Heights of slices (m)", optional=True),
                 "Metres above the zero of the scene's heights, with semicolons or blanks between them: 20; 40; 60.")
        add_crs(self)
        self.add(QgsProcessingParameterFeatureSink("FACETS", "Facets of the volume", QgsProcessing.TypeVectorPolygon,
                                                   optional=True),
                 "PolygonZ, a triangle each, counter-clockwise seen from outside; z is metres above the zero of the scene's "
                 "heights. target; facet: its number in the volume; cause_kind: scene, range, target_plane, navigation or "
                 "sensor; cause_name, cause_id and object_kind of what bounds the volume there; area_m2 of the facet; "
                 "cause_area_m2: of all facets of that cause.")
        self.add(QgsProcessingParameterFeatureSink("SLICES", "Slices of the volume", QgsProcessing.TypeVectorPolygon,
                                                   optional=True),
                 "MultiPolygonZ, one for each target and height: target, z_m, area_m2 in the scene's frame. Without heights "
                 "there are none.")
        self.addOutput(QgsProcessingOutputNumber("VOLUME_M3", "Volume (m³), of all targets"))
        self.addOutput(QgsProcessingOutputNumber("FACET_COUNT", "Number of facets"))

    def run_in_vantage(self, parameters, context, feedback):
        heights = heights_of(self.parameterAsString(parameters, "SLICE_HEIGHTS", context))
        progress = Progress(feedback)
        mission, frame = read_request(self, parameters, context, progress)
        crs = frame.chosen(self.parameterAsCrs(parameters, "CRS", context))
        results = mission.run_each(progress=progress)
        stop_if_canceled(feedback)
        tell_scene(feedback, mission.scene, crs)
        for result in results:
            tell_notes(feedback, result.notes)
            if result.empty:
                feedback.pushWarning(f"{result.mission.target_name}: the volume is empty: {result.reason}")
        facets, slices = list(_facets(results, frame, crs)), list(_slices(results, heights, frame, crs))
        out = self.write(parameters, "FACETS", context, (fields_of(FACETS), QgsWkbTypes.PolygonZ, crs), facets)
        if "FACETS" in out and context.willLoadLayerOnCompletion(out["FACETS"]):
            context.layerToLoadOnCompletionDetails(out["FACETS"]).setPostProcessor(ByCause.kept())
        if heights:
            out |= self.write(parameters, "SLICES", context, (fields_of(SLICES), QgsWkbTypes.MultiPolygonZ, crs), slices)
        return out | {"VOLUME_M3": sum(result.volume_m3 for result in results),
                      "FACET_COUNT": sum(len(result.faces) for result in results)}


def add_crs(algorithm):
    """The parameter of the results' CRS."""
    algorithm.add(QgsProcessingParameterCrs("CRS", "CRS of the results", optional=True),
                  "Empty: the scene's own frame, an azimuthal equidistant projection about its origin in metres, in which "
                  "coordinates stay as vantage computed them. Heights are not converted: they stay metres above the zero of the "
                  "scene's heights.")


def heights_of(text):
    """The numbers of a text: "20; 40 60"."""
    heights = []
    for word in text.replace(";", " ").split():
        try:
            heights.append(float(word))
        except ValueError:
            heights.append(math.nan)
        if not math.isfinite(heights[-1]):
            raise QgsProcessingException(f"SLICE_HEIGHTS: {word!r} is not a height.\n  what to do: write metres with semicolons "
                                         "or blanks between them and decimal points, such as 20; 40; 62.5")
    return heights


def tell_scene(feedback, scene, crs):
    """Where the results lie, and whom maps of them have to name."""
    place = scene.georeference
    if place is None:
        feedback.pushWarning("It is not known where on the earth the scene lies: the results have a "
                             f"local CRS ({crs.description()}), in its metres.")
    else:
        feedback.pushInfo(f"Results are in {name_of(crs)}; heights are metres above the zero of the scene"
                          + (f" ({place.vertical})" if place.vertical else ""))
    if scene.attribution:
        feedback.pushInfo(f"Maps of it have to name: {scene.attribution}")


def _facets(results, frame, crs):
    for result in results:
        if result.empty:
            continue
        vertices, faces, target = result.vertices, result.faces, result.mission.target_name
        xy = frame.out_of(vertices[:, :2], crs, "the volume")
        corners = np.column_stack([xy, vertices[:, 2]])[faces[:, [0, 1, 2, 0]]]
        sides = vertices[faces]
        areas = np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1) / 2
        causes = result.causes
        for number, (ring, cause, area) in enumerate(zip(corners, result.cause_of.tolist(), areas.tolist())):
            of = causes[cause]
            geometry = QgsGeometry()
            geometry.fromWkb(_TRIANGLE + ring.astype("<f8").tobytes())
            yield geometry, [target, number, of.kind, of.name, of.source_id, of.object_kind, area, of.area_m2]


def _slices(results, heights, frame, crs):
    for result in results:
        for z in heights:
            cut = result.slice(z)
            whole = QgsMultiPolygon()
            for rings in cut.polygons:
                polygon = QgsPolygon()
                for number, ring in enumerate(rings):
                    xy = frame.out_of(np.concatenate([ring, ring[:1]]), crs, "the slice")
                    line = QgsLineString(xy[:, 0].tolist(), xy[:, 1].tolist(), [z] * len(xy))
                    polygon.addInteriorRing(line) if number else polygon.setExteriorRing(line)
                whole.addGeometry(polygon)
            yield QgsGeometry(whole), [result.mission.target_name, z, cut.area_m2]
