"""Which points see the target, and what hides it from the others."""

import numpy as np
from qgis.core import (QgsProcessing, QgsProcessingException, QgsProcessingOutputNumber,
                       QgsProcessingParameterBoolean, QgsProcessingParameterFeatureSink,
                       QgsProcessingParameterFeatureSource, QgsProcessingParameterField,
                       QgsProcessingParameterNumber, QgsProcessingUtils, QgsWkbTypes)

from ..engine import Progress, stop_if_canceled, tell_notes
from .base import VantageAlgorithm, fields_of, is_given
from .request import add_request, read_request
from .volume import tell_scene

ANSWERS = {"inside": bool, "margin_m": float, "blocked_by": str, "out_of_range": bool, "behind_target": bool,
           "outside_of": str}


class QueryAlgorithm(VantageAlgorithm):
    NAME = "query"
    TITLE = "Which points see the target"
    SUMMARY = "For each point: whether it sees all of the target, how far it is from the border, and what hides the target"
    HELP = ("Asks the scene itself, not a mesh of the volume: exact. The points keep their geometry, their CRS and their "
            "fields.")

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add(QgsProcessingParameterFeatureSource("POINTS", "Points", [QgsProcessing.TypeVectorPoint]),
                 "Viewpoints. Their z is metres above the zero of the scene's heights, unless a height is given below. Without a "
                 "CRS the layer is taken to be in the scene's frame.")
        self.add(QgsProcessingParameterNumber("Z", "Height of the points (m)", QgsProcessingParameterNumber.Double,
                                              optional=True),
                 "Metres above the zero of the scene's heights, for all points. Empty: their own z.")
        self.add(QgsProcessingParameterField("Z_FIELD", "Field with the height of each point (m)", None, "POINTS",
                                             QgsProcessingParameterField.Numeric, optional=True),
                 "The same, for each point: metres above the zero of the scene's heights.")
        add_request(self, combine=("all", "any"))
        self.add(QgsProcessingParameterBoolean("SHARE", "Also which share of the target is seen", defaultValue=False),
                 "Adds the field share: which part of the target's area is seen, 0 to 1, by line of sight alone.")
        self.add(QgsProcessingParameterFeatureSink("OUTPUT", "Points with answers", QgsProcessing.TypeVectorPoint),
                 "The points, with inside: whether all of the target is visible, in range, and the point within the limits; "
                 "margin_m: metres to the border of the volume along the line to the target's centre, negative outside, empty "
                 "where there is no border on that line; blocked_by: objects that hide some of the target; out_of_range; "
                 "behind_target: the target is seen from its front alone; outside_of: limits that are broken. Fields that the "
                 "layer has already get a number: inside_2.")
        self.addOutput(QgsProcessingOutputNumber("INSIDE_COUNT", "Number of points that see all of the target"))

    def run_in_vantage(self, parameters, context, feedback):
        source = self.parameterAsSource(parameters, "POINTS", context)
        if source is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, "POINTS"))
        progress = Progress(feedback)
        mission, frame = read_request(self, parameters, context, progress)
        features, places = self._places(parameters, context, source, frame)
        tell_notes(feedback, mission.notes)
        tell_scene(feedback, mission.scene, source.sourceCrs() if source.sourceCrs().isValid() else frame.crs)
        answers = mission.query(places, progress=progress)
        shares = None
        if self.parameterAsBool(parameters, "SHARE", context):
            shares = mission.fraction(places, progress=progress).tolist()
        stop_if_canceled(feedback)
        added = fields_of(ANSWERS if shares is None else {**ANSWERS, "share": float})
        fields = QgsProcessingUtils.combineFields(source.fields(), added)
        rows = ((feature.geometry(), [*feature.attributes(), *_values(answers, number),
                                      *([] if shares is None else [shares[number]])])
                for number, feature in enumerate(features))
        out = self.write(parameters, "OUTPUT", context, (fields, source.wkbType(), source.sourceCrs()), rows)
        return out | {"INSIDE_COUNT": int(answers.inside.sum())}

    def _places(self, parameters, context, source, frame):
        """The features, and where they are in the frame: (n, 3)."""
        z_field = self.parameterAsString(parameters, "Z_FIELD", context)
        z_of_all = self.number(parameters, "Z", context)
        if z_field and is_given(parameters, "Z"):
            raise QgsProcessingException("Both Z and Z_FIELD are given.\n  what to do: give one of them")
        if not z_field and z_of_all is None and not QgsWkbTypes.hasZ(source.wkbType()):
            raise QgsProcessingException("The points have no z, and no height is given.\n  what to do: give Z, or the field of "
                                         "the layer that has the heights, Z_FIELD")
        features, rows = list(source.getFeatures()), []
        for feature in features:
            point = _only_point(feature)
            z = point.z() if z_of_all is None else z_of_all
            if z_field:
                value = feature[z_field]
                z = float(value) if isinstance(value, (int, float)) else float("nan")
            if not np.isfinite(z):
                raise QgsProcessingException(f"Points, feature {feature.id()}: it has no height.\n  what to do: fill it in, or "
                                             "leave the point out")
            rows.append((point.x(), point.y(), z))
        places = np.array(rows, float).reshape(-1, 3)
        places[:, :2] = frame.into(places[:, :2], source.sourceCrs(), "the layer of points")
        return features, places


def _only_point(feature):
    parts = list(feature.geometry().vertices())
    if len(parts) != 1:
        raise QgsProcessingException(f"Points, feature {feature.id()}: it has {len(parts)} points.\n  what to do: run 'Multipart "
                                     "to singleparts' on the layer, and leave out what has no geometry")
    return parts[0]


def _values(answers, number):
    """Of one point, as in ANSWERS; without a border on the line the margin is empty."""
    margin = float(answers.margin_m[number])
    return [bool(answers.inside[number]), margin if np.isfinite(margin) else None, "; ".join(answers.blocked_by[number]),
            bool(answers.out_of_range[number]), bool(answers.behind_target[number]), "; ".join(answers.outside_of[number])]
