"""The plugin: adds the provider, and says once where the package vantage is missing."""

from qgis.core import Qgis, QgsApplication

from . import engine
from .provider import Provider


class Plugin:
    """What QGIS loads and unloads."""

    def __init__(self, iface):
        self.iface = iface
        self.provider = None

    def initProcessing(self):  # noqa: N802
        """Adds the provider; qgis_process calls nothing else."""
        if self.provider is None:
            self.provider = Provider()
            QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):  # noqa: N802
        self.initProcessing()
        if engine.PROBLEM and self.iface is not None:
            self.iface.messageBar().pushMessage("vantage", engine.PROBLEM, level=Qgis.Warning, duration=0)

    def unload(self):
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
