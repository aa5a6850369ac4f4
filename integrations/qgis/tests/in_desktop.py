"""Run by QGIS itself (test_desktop.py): opens each algorithm's dialog, runs it there, and writes what came of it.

The environment says: VANTAGE_TOWN, the folder of the example; VANTAGE_TOLD, the JSON file to write.
"""

import json
import os
import time
import traceback

TOWN = os.environ["VANTAGE_TOWN"]
ASKED = {
    "volume": {"MISSION": f"{TOWN}/mission.yaml", "SLICE_HEIGHTS": "20"},
    "query": {"MISSION": f"{TOWN}/mission.yaml"},
    "share": {"MISSION": f"{TOWN}/mission.yaml", "Z": 20, "CELL": 5},
    "flight": {"MISSION": f"{TOWN}/tour.yaml"},
}
SECONDS = 120


def wait_until(is_done):
    from qgis.PyQt.QtWidgets import QApplication

    begin = time.monotonic()
    while not is_done() and time.monotonic() - begin < SECONDS:
        QApplication.processEvents()


def run_all(told):
    import processing
    from qgis.core import QgsFeature, QgsGeometry, QgsPoint, QgsProject, QgsVectorLayer
    from qgis.utils import iface, plugins

    told["is_loaded"] = "vantage_processing" in plugins
    told["messages"] = [item.text() for item in iface.messageBar().items() if "vantage" in item.text()]
    points = QgsVectorLayer("PointZ?crs=EPSG:4326", "points", "memory")
    row = QgsFeature()
    row.setGeometry(QgsGeometry(QgsPoint(11, 48, 20)))
    points.dataProvider().addFeatures([row])
    polygons = QgsVectorLayer("Polygon?crs=EPSG:4326", "polygons", "memory")  # may not be taken for targets
    QgsProject.instance().addMapLayers([points, polygons])
    told["ran"] = {}
    for name, parameters in ASKED.items():
        more = {"POINTS": points.id()} if name == "query" else {}
        dialog = processing.createAlgorithmDialog(f"vantage:{name}", {**parameters, **more})
        if dialog is None:
            continue
        dialog.show()
        can_run, _ = dialog.algorithm().canExecute()
        if can_run:
            before = len(QgsProject.instance().mapLayers())
            dialog.runAlgorithm()
            wait_until(lambda shown=dialog, count=before: shown.wasExecuted() and len(QgsProject.instance().mapLayers()) > count)
            told["ran"][name] = sorted(one.name() for one in QgsProject.instance().mapLayers().values())
        dialog.close()


def main():
    told = {}
    try:
        run_all(told)
    except Exception:  # QGIS would show it in a window and wait
        told["error"] = traceback.format_exc()
    with open(os.environ["VANTAGE_TOLD"], "w", encoding="utf-8") as out:
        json.dump(told, out)
    os._exit(0)


main()
