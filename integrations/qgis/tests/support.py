"""QGIS without a screen, with the plugin loaded from the checkout; and what tests need of it."""

import os
import pathlib
import sys

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
FOLDER = pathlib.Path(__file__).resolve().parent.parent
PROJECT = FOLDER.parent.parent
sys.path[:0] = ["/usr/share/qgis/python/plugins", str(FOLDER)]

import numpy as np  # noqa: E402
from qgis.core import (QgsApplication, QgsFeature, QgsGeometry, QgsProcessingException,  # noqa: E402, F401
                       QgsProcessingFeedback, QgsVectorLayer)

_APPLICATION = QgsApplication([], False)
_APPLICATION.initQgis()
import processing  # noqa: E402
from processing.core.Processing import Processing  # noqa: E402

Processing.initialize()
import vantage_processing  # noqa: E402

PLUGIN = vantage_processing.classFactory(None)
PLUGIN.initProcessing()
TOWN = PROJECT / "examples" / "town"
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", PROJECT.parent / "shared"))


class Feedback(QgsProcessingFeedback):
    """Keeps what it is told. `stop_at`: cancels when so much of a stage is done, in percent."""

    def __init__(self, stop_in=None):
        super().__init__()
        self.told, self.warned, self.stages, self.stop_in = [], [], [], stop_in

    def pushInfo(self, text):  # noqa: N802
        self.told.append(text)

    def pushWarning(self, text):  # noqa: N802
        self.warned.append(text)

    def reportError(self, text, fatal=False):  # noqa: N802
        self.warned.append(text)

    def setProgressText(self, text):  # noqa: N802
        self.stages.append(text)
        if self.stop_in is not None and len(self.stages) >= self.stop_in:
            self.cancel()


def run(name, feedback=None, **parameters):
    """What an algorithm returns; layers in memory unless it is said otherwise."""
    definition = QgsApplication.processingRegistry().algorithmById(f"vantage:{name}")
    for one in definition.parameterDefinitions():
        if one.type() == "sink":
            parameters.setdefault(one.name(), "memory:")
    plain = {key: str(value) if isinstance(value, pathlib.Path) else value for key, value in parameters.items()}
    return processing.run(definition.id(), plain, feedback=feedback or Feedback())


def layer(kind, shapes, crs="", **columns):
    """A layer in memory of WKT, with columns of numbers or texts."""
    fields = "".join(f"&field={name}:{'string' if isinstance(values[0], str) else 'double'}" for name, values in columns.items())
    made = QgsVectorLayer(f"{kind}?crs={crs}{fields}", "made", "memory")
    rows = []
    for number, wkt in enumerate(shapes):
        row = QgsFeature(made.fields())
        row.setGeometry(QgsGeometry.fromWkt(wkt))
        row.setAttributes([values[number] for values in columns.values()])
        rows.append(row)
    assert made.dataProvider().addFeatures(rows)[0]
    return made


def corners_of(geometry):
    """(n, 3): all its vertices."""
    return np.array([(one.x(), one.y(), one.z()) for one in geometry.vertices()])


def quit_now(status):
    """QGIS may crash while Python takes it down: it is not taken down."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
