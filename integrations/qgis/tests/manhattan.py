#!/usr/bin/env python3
"""The four algorithms on an extract of OpenStreetMap about the Empire State Building, and a map of their layers.

    VANTAGE_SHARED=... PYTHONPATH=build/python QT_QPA_PLATFORM=offscreen python3 integrations/qgis/tests/manhattan.py MAP.png

Prints what each algorithm took.
"""

import math
import pathlib
import sys
import tempfile
import time

import numpy as np
from qgis.core import (QgsCategorizedSymbolRenderer, QgsColorRampShader, QgsCoordinateReferenceSystem, QgsFillSymbol,
                       QgsLineSymbol, QgsMapRendererParallelJob, QgsMapSettings, QgsMarkerSymbol, QgsRasterLayer,
                       QgsRasterShader, QgsRectangle, QgsRendererCategory, QgsSingleBandPseudoColorRenderer,
                       QgsSingleSymbolRenderer)
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor, QFont, QPainter

import support
from support import Feedback, QgsVectorLayer, layer, run

MAP = support.SHARED / "data" / "osm" / "empire-state-600m.osm.pbf"
UTM = QgsCoordinateReferenceSystem("EPSG:32618")
# A triangle of 30 m on Fifth Avenue.
TARGET = [(-73.9849436, 40.7481646), (-73.9847714, 40.7484009), (-73.9845884, 40.7481693)]
RANGE_M, HEIGHTS_M, Z_M = 250.0, (3.0, 400.0), 60.0
TOUR = f"""scene: {{osm: '{MAP}'}}
targets:
  - {{name: south, center: [40.746578, -73.986018], width: 12, length: 12}}
  - {{name: north, center: [40.749818, -73.983642], width: 12, length: 12}}
  - {{name: east, center: [40.748062, -73.983625], width: 8, length: 8}}
sensor: {{max_range: 90}}
navigation: {{altitude: {{agl: [20, 300]}}}}
tour: {{vehicle: {{kind: multirotor, speed: 8}}, clearance: 5, time_limit: 10}}
"""
COLOURS = {"inside": "#0072b2", "outside": "#d55e00", "target": "#c41230", "slice": "#0072b2"}


def target_layer():
    """The target, in degrees."""
    ring = ", ".join(f"{x!r} {y!r}" for x, y in [*TARGET, TARGET[0]])
    return layer("Polygon", [f"POLYGON(({ring}))"], "EPSG:4326", name=["Fifth Avenue"])


def request():
    """The parameters of what is asked."""
    return {"SCENE": MAP, "TARGETS": target_layer(), "RANGE": RANGE_M, "LOWEST": HEIGHTS_M[0], "HIGHEST": HEIGHTS_M[1],
            "TARGET_NAME_FIELD": "name"}


def points_layer(step_m=20):
    """A grid at 60 m, in UTM, about the target."""
    x, y = np.meshgrid(np.arange(585500, 586001, step_m), np.arange(4511000, 4511501, step_m))
    return layer("PointZ", [f"POINT Z({a} {b} {Z_M})" for a, b in zip(x.ravel().tolist(), y.ravel().tolist())], UTM.authid())


def run_all(folder):
    """The results of each algorithm by its name, and the seconds that it took."""
    mission = pathlib.Path(folder) / "tour.yaml"
    mission.write_text(TOUR)
    asked = {
        "volume": {**request(), "CRS": UTM, "SLICE_HEIGHTS": f"20;{Z_M};120"},
        "query": {**request(), "POINTS": points_layer()},
        "share": {**request(), "CRS": UTM, "Z": Z_M, "CELL": 5, "OUTPUT": str(pathlib.Path(folder) / "share.tif")},
        "flight": {"MISSION": mission, "CRS": UTM, "BOUND": True},
    }
    results, seconds = {}, {}
    for name, parameters in asked.items():
        begin = time.monotonic()
        results[name] = run(name, Feedback(), **parameters)
        seconds[name] = time.monotonic() - begin
    return results, seconds


def _styled(made, symbol):
    made.setRenderer(QgsSingleSymbolRenderer(symbol))
    return made


def _layers(results):
    """What is drawn, the topmost first."""
    target = _styled(target_layer(), QgsFillSymbol.createSimple({"color": COLOURS["target"], "outline_style": "no"}))
    points = results["query"]["OUTPUT"]
    points.setRenderer(QgsCategorizedSymbolRenderer("inside", [
        QgsRendererCategory(flag, QgsMarkerSymbol.createSimple(
            {"color": COLOURS[name], "size": "1.4", "outline_style": "no"}), name)
        for flag, name in ((True, "inside"), (False, "outside"))]))
    flight = _styled(results["flight"]["LEGS"], QgsLineSymbol.createSimple({"color": "black", "width": "0.7"}))
    cut = results["volume"]["SLICES"]
    cut.setSubsetString(f"z_m = {Z_M}")
    _styled(cut, QgsFillSymbol.createSimple({"style": "no", "outline_color": COLOURS["slice"], "outline_width": "0.8"}))
    houses = QgsVectorLayer(f"{MAP}|layername=multipolygons|subset=building is not null", "houses", "ogr")
    _styled(houses, QgsFillSymbol.createSimple({"color": "120,120,126,110", "outline_color": "90,90,96", "outline_width": "0.15"}))
    share = QgsRasterLayer(results["share"]["OUTPUT"], "share")
    ramp = QgsColorRampShader(0, 1)
    ramp.setColorRampItemList([QgsColorRampShader.ColorRampItem(0, QColor("#ffffff")),
                               QgsColorRampShader.ColorRampItem(1, QColor("#f0c24b"))])
    shader = QgsRasterShader()
    shader.setRasterShaderFunction(ramp)
    share.setRenderer(QgsSingleBandPseudoColorRenderer(share.dataProvider(), 1, shader))
    return [target, points, flight, cut, houses, share]


def draw(results, file):
    """Writes the map. Returns the image, and its settings, which know where a place is on it."""
    settings = QgsMapSettings()
    layers = _layers(results)
    assert all(one.isValid() for one in layers)
    settings.setLayers(layers)
    settings.setDestinationCrs(UTM)
    settings.setOutputSize(QSize(1000, 1000))
    settings.setOutputDpi(120)
    settings.setBackgroundColor(QColor("white"))
    settings.setExtent(QgsRectangle(585480, 4510980, 586020, 4511520))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    image = job.renderedImage()
    painter = QPainter(image)
    painter.setFont(QFont("DejaVu Sans", 9))
    painter.fillRect(0, 972, 290, 28, QColor("white"))
    painter.drawText(8, 992, "Map data © OpenStreetMap contributors")
    painter.end()
    assert image.save(str(file))
    return image, settings


def main():
    with tempfile.TemporaryDirectory() as folder:
        results, seconds = run_all(folder)
        draw(results, sys.argv[1])
    for name, took in seconds.items():
        numbers = {key: value for key, value in results[name].items() if isinstance(value, (int, float))}
        print(f"{name}: {took:.2f} s", {key: round(value, 1) for key, value in numbers.items()})
    assert all(math.isfinite(took) for took in seconds.values())


if __name__ == "__main__":
    main()
    support.quit_now(0)
