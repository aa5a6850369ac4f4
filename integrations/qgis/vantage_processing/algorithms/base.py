"""What all algorithms have in common."""

from qgis.core import (NULL, QgsCoordinateReferenceSystem, QgsFeature, QgsFeatureSink, QgsField, QgsFields,
                       QgsProcessingAlgorithm, QgsProcessingException, QgsProcessingParameterDefinition)
from qgis.PyQt.QtCore import QVariant
from qgis.PyQt.QtGui import QIcon

from .. import engine

TYPES = {str: QVariant.String, float: QVariant.Double, int: QVariant.Int, bool: QVariant.Bool}


def fields_of(columns):
    """QgsFields of names and Python types."""
    fields = QgsFields()
    for name, kind in columns.items():
        fields.append(QgsField(name, TYPES[kind]))
    return fields


class VantageAlgorithm(QgsProcessingAlgorithm):
    """Named, described and run in the same way.

    NAME, TITLE, SUMMARY, HELP: its id, its name in the toolbox, a line on it, and what it does.
    """

    NAME = TITLE = SUMMARY = HELP = ""

    def name(self):
        return self.NAME

    def displayName(self):  # noqa: N802
        return self.TITLE

    def shortDescription(self):  # noqa: N802
        return self.SUMMARY

    def shortHelpString(self):  # noqa: N802
        shown = [one for one in self.parameterDefinitions() if not one.isDestination()]
        rows = "".join(f"<li><b>{one.description()}</b>: {one.help()}</li>" for one in shown)
        written = "".join(f"<li><b>{one.description()}</b>: {one.help()}</li>"
                          for one in self.parameterDefinitions() if one.isDestination())
        return f"<p>{self.HELP}</p><h3>Parameters</h3><ul>{rows}</ul><h3>Results</h3><ul>{written}</ul>"

    def icon(self):
        from ..provider import ICON

        return QIcon(ICON)

    def createInstance(self):  # noqa: N802
        return type(self)()

    def canExecute(self):  # noqa: N802
        return not engine.PROBLEM, engine.PROBLEM

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        if engine.PROBLEM:
            raise QgsProcessingException(engine.PROBLEM)
        with engine.told():
            return self.run_in_vantage(parameters, context, feedback)

    def run_in_vantage(self, parameters, context, feedback):
        """What the algorithm does. Errors of vantage become QgsProcessingException."""
        raise NotImplementedError

    # ---- parameters

    def add(self, parameter, text, *, advanced=False):
        """Adds a parameter with its help text."""
        parameter.setHelp(text)
        if advanced:
            parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        self.addParameter(parameter)

    def number(self, parameters, name, context):
        """A number that may be absent: then None."""
        return self.parameterAsDouble(parameters, name, context) if is_given(parameters, name) else None

    # ---- results

    def write(self, parameters, name, context, layer, features):
        """Writes features (pairs of a geometry and values) to a sink, if it is asked for. Only now the file is made.

        Args:
            layer: (fields, kind of geometry, CRS).

        Returns:
            {name: the layer}, or nothing.
        """
        rows = []
        for geometry, values in features:
            feature = QgsFeature(layer[0])
            feature.setGeometry(geometry)
            feature.setAttributes(values)
            rows.append(feature)
        sink, made = self.parameterAsSink(parameters, name, context, *layer)
        if sink is None:
            if is_given(parameters, name):
                raise QgsProcessingException(self.invalidSinkError(parameters, name))
            return {}
        if not sink.addFeatures(rows, QgsFeatureSink.FastInsert):
            raise QgsProcessingException(f"{self.parameterDefinition(name).description()}: not all could be written: "
                                         f"{sink.lastError()}")
        return {name: made}


def is_given(parameters, name):
    """Whether a parameter has a value: dialogs give empty ones too."""
    value = parameters.get(name)
    if isinstance(value, QgsCoordinateReferenceSystem):
        return value.isValid()
    return not (value is None or value == NULL or value == "")
