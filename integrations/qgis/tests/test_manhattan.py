"""The algorithms on a real map, in another CRS than the scene's: their layers are what the Python package says, and lie on
the map where they should.

    VANTAGE_SHARED=... PYTHONPATH=build/python QT_QPA_PLATFORM=offscreen python3 integrations/qgis/tests/test_manhattan.py
"""

import pathlib
import tempfile
import unittest

import numpy as np
from qgis.core import (QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCoordinateTransformContext, QgsGeometry,
                       QgsPointXY, QgsRasterLayer)
from qgis.PyQt.QtGui import QColor

import manhattan
import support
import vantage as vt
from support import corners_of, layer, run


def nearest(places, others):
    """Of each place the distance to the nearest of the others."""
    return np.array([np.linalg.norm(others - place, axis=1).min() for place in places])


def geometry_of(cut):
    """Of a vantage.Slice, in its own coordinates."""
    return QgsGeometry.fromMultiPolygonXY([[[QgsPointXY(x, y) for x, y in [*ring.tolist(), ring[0].tolist()]] for ring in rings]
                                           for rings in cut.polygons])


@unittest.skipUnless(manhattan.MAP.is_file(), f"needs {manhattan.MAP}: set VANTAGE_SHARED to the folder that holds data/")
class Manhattan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.results, _ = manhattan.run_all(cls.folder)
        cls.scene = vt.Scene.from_osm(manhattan.MAP)
        # What is asked, in vantage's own words: it converts the corners itself.
        triangle = vt.Target(outline=manhattan.TARGET)
        cls.mission = vt.Mission.of(cls.scene, triangle, max_range=manhattan.RANGE_M, crs="EPSG:4326",
                                    navigation=vt.Navigation(altitude=manhattan.HEIGHTS_M))
        cls.result = cls.mission.run()
        cls.to_frame = QgsCoordinateTransform(manhattan.UTM, QgsCoordinateReferenceSystem.fromProj(cls.scene.crs),
                                              QgsCoordinateTransformContext())

    def in_frame(self, corners):
        """(n, 3) of UTM, in the scene's frame."""
        moved = [self.to_frame.transform(x, y) for x, y in corners[:, :2].tolist()]
        return np.column_stack([[(one.x(), one.y()) for one in moved], corners[:, 2]])

    def test_facets_lie_within_a_millimetre_of_the_volume(self):
        made = self.results["volume"]
        self.assertAlmostEqual(made["VOLUME_M3"] / self.result.volume_m3, 1, places=6)
        self.assertEqual(made["FACET_COUNT"], len(self.result.faces))
        self.assertEqual(made["FACETS"].crs(), manhattan.UTM)
        corners = np.concatenate([corners_of(row.geometry()) for row in made["FACETS"].getFeatures()])
        back = self.in_frame(np.unique(corners, axis=0))
        self.assertLess(nearest(back, self.result.vertices).max(), 1e-3)
        self.assertLess(nearest(self.result.vertices, back).max(), 1e-3)

    def test_slices_are_those_of_vantage_in_utm(self):
        made = self.results["volume"]["SLICES"]
        made.setSubsetString("")
        for row in made.getFeatures():
            cut = self.result.slice(row["z_m"])
            self.assertAlmostEqual(row["area_m2"] / cut.area_m2, 1, places=6)
            wanted = geometry_of(cut.to_crs(manhattan.UTM.authid()))
            self.assertLess(row.geometry().symDifference(wanted).area(), 1e-3 * wanted.length())

    def test_points_see_what_vantage_says(self):
        rows = list(self.results["query"]["OUTPUT"].getFeatures())
        places = self.in_frame(np.concatenate([corners_of(row.geometry()) for row in rows]))
        answers = self.mission.query(places)
        sure = ~(np.abs(answers.margin_m) < 0.02)  # the tolerance of the range, and of the corners
        inside = np.array([row["inside"] for row in rows])
        np.testing.assert_array_equal(inside[sure], answers.inside[sure])
        np.testing.assert_array_equal(inside[sure], self.result.volume.contains(places)[sure])
        self.assertTrue(inside.any() and sure.mean() > 0.9)
        for row, hidden in zip(rows, answers.blocked_by):
            if hidden and row["blocked_by"]:
                self.assertTrue(set(hidden) & set(row["blocked_by"].split("; ")))

    def test_cells_of_the_raster_see_the_share_that_vantage_says(self):
        raster = QgsRasterLayer(self.results["share"]["OUTPUT"])
        self.assertEqual(raster.crs(), manhattan.UTM)
        block = raster.dataProvider().block(1, raster.extent(), raster.width(), raster.height())
        values = np.frombuffer(bytes(block.data()), "<f8")
        x = raster.extent().xMinimum() + (np.arange(raster.width()) + 0.5) * 5
        y = raster.extent().yMaximum() - (np.arange(raster.height()) + 0.5) * 5
        centres = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        places = self.in_frame(np.column_stack([centres, np.full(len(centres), manhattan.Z_M)]))
        self.assertLess(np.abs(values - self.mission.fraction(places)).max(), 1e-6)
        self.assertTrue((values == 1).any() and (values == 0).any())

    def test_the_flight_sees_all_and_is_no_shorter_than_its_bound(self):
        made = self.results["flight"]
        positions = self.in_frame(np.concatenate([corners_of(row.geometry()) for row in made["WAYPOINTS"].getFeatures()]))
        check = vt.check(vt.Mission.read(self.folder / "tour.yaml"), positions)
        self.assertEqual(made["SEEN_COUNT"], 3)
        self.assertTrue(all(target.seen for target in check.targets))
        self.assertAlmostEqual(check.length_m, made["LENGTH_M"], places=3)
        self.assertTrue(0 < made["BOUND_M"] <= made["LENGTH_M"])

    def test_the_map_shows_each_layer_where_it_is(self):
        image, settings = manhattan.draw(self.results, self.folder / "map.png")
        pixel = settings.mapToPixel()

        def colour_at(x, y):
            at = pixel.transform(x, y)
            return QColor(image.pixel(round(at.x()), round(at.y()))).name()

        degrees = QgsCoordinateTransform(QgsCoordinateReferenceSystem("EPSG:4326"), manhattan.UTM, QgsCoordinateTransformContext())
        middle = degrees.transform(*np.mean(manhattan.TARGET, axis=0).tolist())
        self.assertEqual(colour_at(middle.x(), middle.y()), manhattan.COLOURS["target"])
        seen = {"inside": 0, "outside": 0}
        for row in self.results["query"]["OUTPUT"].getFeatures():
            point = row.geometry().constGet()
            name = "inside" if row["inside"] else "outside"
            at = settings.extent().contains(QgsPointXY(point.x(), point.y()))
            seen[name] += at and colour_at(point.x(), point.y()) == manhattan.COLOURS[name]
        # The target lies over some.
        self.assertGreaterEqual(seen["inside"], self.results["query"]["INSIDE_COUNT"] - 3)
        self.assertGreater(seen["outside"], 500)


CITY = support.SHARED / "data" / "cityjson" / "delft.city.json"


@unittest.skipUnless(CITY.is_file(), f"needs {CITY}: set VANTAGE_SHARED to the folder that holds data/")
class Delft(unittest.TestCase):
    def test_a_city_model_in_its_own_crs(self):
        scene, crs = vt.Scene.from_mesh(CITY), "EPSG:28992"
        middle, z = scene.bounds.mean(axis=0)[:2], float(scene.bounds[1, 2]) + 2  # a deck above all roofs
        square = middle + np.array([[-6, -4], [6, -4], [6, 4], [-6, 4]])
        place = scene.georeference
        there = vt.Slice([[square]], z, place, scene.crs).to_crs(crs).polygons[0][0]
        ring = ", ".join(f"{x!r} {y!r} {z!r}" for x, y in [*there.tolist(), there[0].tolist()])
        made = run("volume", SCENE=CITY, TARGETS=layer("PolygonZ", [f"POLYGON Z(({ring}))"], crs), RANGE=50,
                   CRS=QgsCoordinateReferenceSystem(crs), SLICE_HEIGHTS=f"{z + 10}")
        result = vt.compute(scene, np.column_stack([square, np.full(4, z)]), max_range=50)
        # PROJ's way into this CRS and back is off by 0.4 mm.
        self.assertAlmostEqual(made["VOLUME_M3"] / result.volume_m3, 1, places=5)
        wanted = geometry_of(result.slice(z + 10).to_crs(crs))
        made_there = next(made["SLICES"].getFeatures()).geometry()
        self.assertLess(made_there.symDifference(wanted).area(), 1e-3 * wanted.length())


if __name__ == "__main__":
    ended = unittest.main(exit=False, verbosity=2)
    support.quit_now(0 if ended.result.wasSuccessful() else 1)
