"""The provider: what stands under "vantage" in the Processing toolbox."""

import os

from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from . import engine
from .algorithms.flight import FlightAlgorithm
from .algorithms.query import QueryAlgorithm
from .algorithms.share import ShareAlgorithm
from .algorithms.volume import VolumeAlgorithm

ICON = os.path.join(os.path.dirname(__file__), "icon.svg")


class Provider(QgsProcessingProvider):
    """Its algorithms are there without the package vantage too; then they say how to install it, and do not run."""

    def id(self):
        return "vantage"

    def name(self):
        return "vantage"

    def longName(self):  # noqa: N802
        return f"vantage {engine.vt.__version__}" if engine.vt else "vantage (the Python package is missing)"

    def icon(self):
        return QIcon(ICON)

    def svgIconPath(self):  # noqa: N802
        return ICON

    def warningMessage(self):  # noqa: N802
        return engine.PROBLEM

    def loadAlgorithms(self):  # noqa: N802
        for algorithm in (VolumeAlgorithm, QueryAlgorithm, ShareAlgorithm, FlightAlgorithm):
            self.addAlgorithm(algorithm())
