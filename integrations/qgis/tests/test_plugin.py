"""The plugin in a real QGIS, without a screen: its layers are what the Python package says.

    VANTAGE_SHARED=... PYTHONPATH=build/python QT_QPA_PLATFORM=offscreen python3 integrations/qgis/tests/test_plugin.py
"""

import configparser
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
from qgis.core import (NULL, QgsApplication, QgsCoordinateReferenceSystem, QgsCoordinateTransform,
                       QgsCoordinateTransformContext, QgsProcessingAlgRunnerTask, QgsProcessingContext,
                       QgsProcessingOutputLayerDefinition, QgsProcessingUtils, QgsProject, QgsRasterLayer)

import support
import vantage as vt
from support import FOLDER, PROJECT, TOWN, Feedback, QgsProcessingException, QgsVectorLayer, corners_of, layer, processing, run
from vantage_processing.places import LOCAL, text_of

UTM = "EPSG:32632"


def to_frame(xy, crs, scene):
    """(n, 2) positions of a CRS in the frame, one by one, by QGIS."""
    transform = QgsCoordinateTransform(QgsCoordinateReferenceSystem(crs), QgsCoordinateReferenceSystem.fromProj(scene.crs),
                                       QgsCoordinateTransformContext())
    moved = [transform.transform(*row) for row in np.asarray(xy).tolist()]
    return np.array([(one.x(), one.y()) for one in moved])


def distance_to_line(place, corners):
    """Of a position from a line through corners, in space."""
    sides = np.diff(corners, axis=0)
    lengths = np.maximum((sides ** 2).sum(axis=1), 1e-30)
    along = np.clip(((place - corners[:-1]) * sides).sum(axis=1) / lengths, 0, 1)
    return np.linalg.norm(corners[:-1] + along[:, None] * sides - place, axis=1).min()


class Checked(unittest.TestCase):
    def refused(self, name, feedback=None, **parameters):
        """What an algorithm says when it refuses. QGIS makes a QgsProcessingException of defects too, with a traceback."""
        with self.assertRaises(QgsProcessingException, msg=str(parameters)) as told:
            run(name, feedback, **parameters)
        self.assertNotIn("Traceback", str(told.exception))
        return str(told.exception)


class Described(unittest.TestCase):
    def test_the_metadata_has_what_qgis_asks_for(self):
        read = configparser.ConfigParser()
        read.read(FOLDER / "vantage_processing" / "metadata.txt")
        general = read["general"]
        for key in ("name", "qgisMinimumVersion", "description", "about", "version", "author"):
            self.assertTrue(general[key], key)
        self.assertEqual(general["hasProcessingProvider"], "yes")
        self.assertTrue((FOLDER / "vantage_processing" / general["icon"]).is_file())
        version = re.search(r'VANTAGE_VERSION "([^"]+)"', (PROJECT / "include" / "vantage" / "version.h").read_text())[1]
        self.assertEqual(general["version"], version)

    def test_every_parameter_has_a_help_text_and_lengths_their_unit(self):
        algorithms = support.PLUGIN.provider.algorithms()
        self.assertEqual(sorted(one.name() for one in algorithms), ["flight", "query", "share", "volume"])
        for algorithm in algorithms:
            self.assertTrue(algorithm.shortDescription())
            self.assertFalse(algorithm.icon().isNull())
            for one in algorithm.parameterDefinitions():
                self.assertTrue(one.help(), f"{algorithm.name()} {one.name()}")
                self.assertIn(one.help(), algorithm.shortHelpString())
                if one.type() == "number":
                    self.assertIn("(m)", one.description(), one.name())


class Volumes(Checked):
    @classmethod
    def setUpClass(cls):
        cls.result = vt.Mission.read(TOWN / "mission.yaml").run()

    def test_facets_are_those_of_the_volume_in_the_frame(self):
        feedback = Feedback()
        made = run("volume", feedback, MISSION=TOWN / "mission.yaml")
        facets = list(made["FACETS"].getFeatures())
        self.assertEqual(len(facets), len(self.result.faces))
        self.assertEqual(made["FACET_COUNT"], len(facets))
        self.assertEqual(made["VOLUME_M3"], self.result.volume_m3)
        corners = np.array([corners_of(one.geometry()) for one in facets])
        np.testing.assert_array_equal(corners, self.result.vertices[self.result.faces[:, [0, 1, 2, 0]]])
        causes = [self.result.causes[number] for number in self.result.cause_of]
        self.assertEqual([(one["cause_kind"], one["cause_name"], one["cause_id"], one["object_kind"]) for one in facets],
                         [(one.kind, one.name, one.source_id, one.object_kind) for one in causes])
        self.assertAlmostEqual(sum(one["area_m2"] for one in facets), self.result.area_m2, places=6)
        for cause in self.result.causes:
            areas = [one["area_m2"] for one in facets if (one["cause_kind"], one["cause_name"]) == (cause.kind, cause.name)]
            self.assertAlmostEqual(sum(areas), cause.area_m2, places=6)
        self.assertTrue(any(self.result.scene.attribution in text for text in feedback.told))

    def test_in_a_thread_of_its_own_as_the_toolbox_runs_it_and_with_a_style(self):
        project, context, feedback, ended = QgsProject.instance(), QgsProcessingContext(), Feedback(), []
        context.setProject(project)
        algorithm = QgsApplication.processingRegistry().createAlgorithmById("vantage:volume")
        task = QgsProcessingAlgRunnerTask(algorithm, {
            "MISSION": str(TOWN / "mission.yaml"),
            "FACETS": QgsProcessingOutputLayerDefinition("TEMPORARY_OUTPUT", project)}, context, feedback)
        task.executed.connect(lambda is_good, results: ended.append((is_good, results)))
        QgsApplication.taskManager().addTask(task)
        begin = time.monotonic()
        while not ended and time.monotonic() - begin < 120:
            QgsApplication.processEvents()
        is_good, results = ended[0]
        self.assertTrue(is_good, feedback.warned)
        self.assertEqual(results["FACET_COUNT"], len(self.result.faces))
        made = QgsProcessingUtils.mapLayerFromString(results["FACETS"], context)
        context.layersToLoadOnCompletion()[results["FACETS"]].postProcessor().postProcessLayer(made, context, feedback)
        coloured = {category.value() for category in made.renderer().categories()}
        self.assertLessEqual({cause.kind for cause in self.result.causes}, coloured)

    def test_facets_in_another_crs_are_within_a_millimetre(self):
        facets = run("volume", MISSION=TOWN / "mission.yaml", CRS=QgsCoordinateReferenceSystem(UTM))["FACETS"]
        self.assertEqual(facets.crs().authid(), UTM)
        corners = np.concatenate([corners_of(one.geometry()) for one in facets.getFeatures()])
        expected = self.result.vertices[self.result.faces[:, [0, 1, 2, 0]]].reshape(-1, 3)
        back = to_frame(corners[:, :2], UTM, self.result.scene)
        self.assertLess(np.abs(back - expected[:, :2]).max(), 1e-3)
        np.testing.assert_array_equal(corners[:, 2], expected[:, 2])

    def test_slices_are_those_of_the_volume(self):
        heights = [10.0, 20.0, 30.5, 500.0]
        for crs in ("", UTM):
            parameters = {"CRS": QgsCoordinateReferenceSystem(crs)} if crs else {}
            slices = run("volume", MISSION=TOWN / "mission.yaml", SLICE_HEIGHTS="10; 20 30.5;500", **parameters)["SLICES"]
            rows = list(slices.getFeatures())
            self.assertEqual([row["z_m"] for row in rows], heights)
            for row, z in zip(rows, heights):
                cut = self.result.slice(z)
                self.assertEqual(row["area_m2"], cut.area_m2)
                parts = list(row.geometry().constParts())
                self.assertEqual(len(parts), len(cut.polygons))
                if cut.empty:
                    continue
                wanted = (cut.to_crs(crs) if crs else cut).polygons
                rings = np.concatenate([np.concatenate([ring, ring[:1]]) for polygon in wanted for ring in polygon])
                corners = corners_of(row.geometry())
                self.assertLess(np.abs(corners[:, :2] - rings).max(), 1e-3)
                self.assertTrue((corners[:, 2] == z).all())
                if not crs:
                    self.assertAlmostEqual(row.geometry().area(), cut.area_m2, places=6)

    def test_targets_of_a_layer_in_degrees_are_those_of_python(self):
        scene = vt.Scene.from_osm(TOWN / "town.osm", center=(48, 11), radius=120)
        square = [(-5.0, -4.0), (6.0, -4.0), (6.0, 5.0), (-5.0, 5.0)]
        frame, degrees = QgsCoordinateReferenceSystem.fromProj(scene.crs), QgsCoordinateReferenceSystem("EPSG:4326")
        there = QgsCoordinateTransform(frame, degrees, QgsCoordinateTransformContext())
        places = [there.transform(*corner) for corner in [*square, square[0]]]
        wkt = "POLYGON((" + ", ".join(f"{one.x():.15f} {one.y():.15f}" for one in places) + "))"
        targets = layer("Polygon", [wkt, wkt], "EPSG:4326", name=["low", "high"], height=[1.0, 9.0])
        asked = {"SCENE": TOWN / "town.osm", "CENTER": "11,48", "RADIUS": 120, "TARGETS": targets, "RANGE": 60,
                 "TARGET_NAME_FIELD": "name", "TARGET_Z_FIELD": "height", "COMBINE": 2, "LOWEST": 5, "HIGHEST": 40,
                 "HEIGHTS_FROM": 1, "CLEARANCE": 2}
        made = run("volume", **asked)
        total = 0.0
        for name, z in (("low", 1.0), ("high", 9.0)):
            alone = vt.compute(scene, vt.Target(vertices=[[x, y, z] for x, y in square]), max_range=60,
                               navigation=vt.Navigation(altitude={"agl": (5, 40)}, clearance=2))
            count = sum(row["target"] == name for row in made["FACETS"].getFeatures())
            self.assertGreater(count, 0)
            total += alone.volume_m3
        self.assertAlmostEqual(made["VOLUME_M3"] / total, 1, places=6)

    def test_upright_targets_and_scenes_without_a_place(self):
        plaza = PROJECT / "examples" / "plaza" / "plaza.obj"
        wall = "POLYGON Z((-5 -12 2, 5 -12 2, 5 -12 8, -5 -12 8, -5 -12 2))"
        feedback = Feedback()
        made = run("volume", feedback, SCENE=plaza, TARGETS=layer("PolygonZ", [wall]), RANGE=40)
        expected = vt.compute(vt.Scene.from_mesh(plaza), [[-5, -12, 2], [5, -12, 2], [5, -12, 8], [-5, -12, 8]], max_range=40)
        self.assertEqual(made["VOLUME_M3"], expected.volume_m3)
        self.assertEqual((made["FACETS"].crs().description(), made["FACETS"].crs().isGeographic()), (LOCAL, False))
        with tempfile.TemporaryDirectory() as scratch:  # results can be asked about
            file = pathlib.Path(scratch) / "targets.gpkg"
            processing.run("native:savefeatures", {"INPUT": made["FACETS"], "OUTPUT": str(file)})
            points = QgsVectorLayer(str(file))
            centres = processing.run("native:extractvertices", {"INPUT": points, "OUTPUT": "memory:"})["OUTPUT"]
            answered = run("query", SCENE=plaza, TARGETS=layer("PolygonZ", [wall]), RANGE=40, POINTS=centres)["OUTPUT"]
        margins = [abs(row["margin_m"]) for row in answered.getFeatures() if isinstance(row["margin_m"], float)]
        self.assertLess(np.median(margins), 0.01)  # corners of the volume are on its border
        run("share", SCENE=plaza, TARGETS=layer("PolygonZ", [wall]), RANGE=40, Z=5, EXTENT="-20,20,-30,-15",
            OUTPUT="TEMPORARY_OUTPUT")
        self.refused("share", SCENE=plaza, TARGETS=layer("PolygonZ", [wall]), RANGE=40, Z=5, EXTENT="-20,20,-30,-15 [EPSG:32632]",
                     OUTPUT="TEMPORARY_OUTPUT")
        self.assertTrue(feedback.warned)
        self.refused("volume", SCENE=plaza, TARGETS=layer("PolygonZ", [wall], UTM), RANGE=40)
        self.refused("volume", SCENE=plaza, TARGETS=layer("PolygonZ", [wall]), RANGE=40, CRS=QgsCoordinateReferenceSystem(UTM))

    def test_slices_have_holes(self):
        plate = "".join(f"v {x} {y} 15\n" for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)))  # over the target
        square = layer("PolygonZ", ["POLYGON Z((-5 -4 0, 6 -4 0, 6 5 0, -5 5 0, -5 -4 0))"])
        with tempfile.TemporaryDirectory() as scratch:
            scene = pathlib.Path(scratch) / "plate.obj"
            scene.write_text(plate + "f 1 2 3 4\n")
            made = run("volume", SCENE=scene, TARGETS=square, RANGE=60, SLICE_HEIGHTS="17")
            cut = vt.compute(vt.Scene.from_mesh(scene), [[-5, -4, 0], [6, -4, 0], [6, 5, 0], [-5, 5, 0]], max_range=60).slice(17)
        self.assertEqual([len(rings) for rings in cut.polygons], [2])
        row = next(made["SLICES"].getFeatures())
        self.assertAlmostEqual(row.geometry().area(), cut.area_m2, places=6)
        self.assertEqual(len(corners_of(row.geometry())), sum(len(ring) + 1 for ring in cut.polygons[0]))

    def test_heights_above_a_ground_that_is_not_at_zero(self):
        ground = "o ground\n" + "".join(f"v {x} {y} 7\n" for x, y in ((-99, -99), (99, -99), (99, 99), (-99, 99)))
        square = layer("Polygon", ["POLYGON((-5 -4, 6 -4, 6 5, -5 5, -5 -4))"])
        with tempfile.TemporaryDirectory() as scratch:
            scene = pathlib.Path(scratch) / "meadow.obj"
            scene.write_text(ground + "f 1 2 3 4\n")
            for level, lowest in ((0, 10.0), (1, 17.0)):
                made = run("volume", SCENE=scene, TARGETS=square, RANGE=60, LOWEST=10, HIGHEST=20, HEIGHTS_FROM=level)
                corners = np.concatenate([corners_of(row.geometry()) for row in made["FACETS"].getFeatures()])
                self.assertAlmostEqual(corners[:, 2].min(), lowest)
                self.assertAlmostEqual(corners[:, 2].max(), lowest + 10)

    def test_an_empty_volume_says_why(self):
        square = layer("Polygon", ["POLYGON((-5 -4, 6 -4, 6 5, -5 5, -5 -4))"])
        feedback = Feedback()
        made = run("volume", feedback, SCENE=PROJECT / "examples" / "plaza" / "plaza.obj", TARGETS=square, RANGE=1)
        self.assertEqual((made["FACET_COUNT"], made["FACETS"].featureCount()), (0, 0))
        self.assertTrue(any("empty" in text for text in feedback.warned))


class Queries(Checked):
    def test_fields_are_the_answers_and_agree_with_the_volume(self):
        mission = vt.Mission.read(TOWN / "mission.yaml")
        rng = np.random.default_rng(20261129)
        points = np.column_stack([rng.uniform(-100, 100, (1500, 2)), rng.uniform(0, 70, 1500)])
        made = run("query", MISSION=TOWN / "mission.yaml", SHARE=True,
                   POINTS=layer("PointZ", [f"POINT Z({x!r} {y!r} {z!r})" for x, y, z in points.tolist()], inside=["mine"] * 1500))
        rows = list(made["OUTPUT"].getFeatures())
        answers, result = mission.query(points), mission.run()
        inside = np.array([row["inside_2"] for row in rows])
        np.testing.assert_array_equal(inside, answers.inside)
        np.testing.assert_array_equal(inside, result.contains(points))
        self.assertEqual(made["INSIDE_COUNT"], inside.sum())
        self.assertTrue(0 < inside.sum() < len(inside))
        far = ~(np.abs(answers.margin_m) < 2 * result.volume.tolerance_m)
        np.testing.assert_array_equal(inside[far], result.volume.contains(points)[far])
        shares = mission.fraction(points)
        for number, row in enumerate(rows):
            self.assertEqual(row["inside"], "mine")
            self.assertEqual(row["blocked_by"], "; ".join(answers.blocked_by[number]))
            self.assertEqual(row["outside_of"], "; ".join(answers.outside_of[number]))
            self.assertEqual((row["out_of_range"], row["behind_target"]),
                             (answers.out_of_range[number], answers.behind_target[number]))
            if np.isfinite(answers.margin_m[number]):
                self.assertEqual(row["margin_m"], answers.margin_m[number])
            self.assertEqual(row["share"], shares[number])

    def test_heights_come_from_a_field_or_a_number_and_places_from_degrees(self):
        mission = vt.Mission.read(TOWN / "mission.yaml")
        x, y = mission.scene.position(48.0001, 11.0002)
        for height in ({"Z": 22.0}, {"Z_FIELD": "flown"}):
            points = layer("Point", ["POINT(11.0002 48.0001)"], "EPSG:4326", flown=[22.0])
            row = next(run("query", MISSION=TOWN / "mission.yaml", POINTS=points, **height)["OUTPUT"].getFeatures())
            self.assertAlmostEqual(row["margin_m"], mission.query([[x, y, 22]]).margin_m[0], places=3)
        for wrong in ({}, {"Z": 1.0, "Z_FIELD": "flown"}):
            self.refused("query", MISSION=TOWN / "mission.yaml", POINTS=points, **wrong)

    def test_no_points_and_heights_that_are_missing(self):
        made = run("query", MISSION=TOWN / "mission.yaml", POINTS=layer("PointZ", []))
        self.assertEqual((made["INSIDE_COUNT"], made["OUTPUT"].featureCount()), (0, 0))
        without = layer("Point", ["POINT(0 0)"], flown=[None])
        self.assertIn("feature 1", self.refused("query", MISSION=TOWN / "mission.yaml", POINTS=without, Z_FIELD="flown"))

    def test_a_point_that_is_none_is_named(self):
        for kind, wkt in (("MultiPointZ", "MULTIPOINT Z((0 0 9), (1 1 9))"), ("PointZ", "POINT Z EMPTY"), ("PointZ", "")):
            self.assertIn("feature 1", self.refused("query", MISSION=TOWN / "mission.yaml", POINTS=layer(kind, [wkt])))


class Shares(Checked):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.file = pathlib.Path(scratch.name) / "share.tif"

    def cells(self):
        """Values and centres of the cells."""
        raster = QgsRasterLayer(str(self.file), "share")
        self.assertTrue(raster.isValid())
        provider, extent = raster.dataProvider(), raster.extent()
        block = provider.block(1, extent, raster.width(), raster.height())
        values = np.frombuffer(bytes(block.data()), "<f8").reshape(raster.height(), raster.width())
        x = extent.xMinimum() + (np.arange(raster.width()) + 0.5) * raster.rasterUnitsPerPixelX()
        y = extent.yMaximum() - (np.arange(raster.height()) + 0.5) * raster.rasterUnitsPerPixelY()
        return raster, values, np.stack(np.meshgrid(x, y), axis=-1)

    def test_cells_are_what_their_middles_see(self):
        mission = vt.Mission.read(TOWN / "mission.yaml")
        for crs, limits in ((UTM, False), ("", True)):
            parameters = {"CRS": QgsCoordinateReferenceSystem(crs)} if crs else {}
            run("share", MISSION=TOWN / "mission.yaml", Z=20, CELL=3, LIMITS=limits, OUTPUT=self.file, **parameters)
            raster, values, centres = self.cells()
            flat = centres.reshape(-1, 2)
            places = np.column_stack([to_frame(flat, crs, mission.scene) if crs else flat, np.full(len(flat), 20.0)])
            expected = np.array(mission.fraction(places))
            if limits:
                answers = mission.query(places)
                expected[answers.out_of_range | answers.behind_target | [bool(one) for one in answers.outside_of]] = 0
                self.assertTrue((expected[np.abs(flat).max(axis=1) > 110] == 0).all())
            np.testing.assert_allclose(values.ravel(), expected, atol=1e-7)
            self.assertTrue((values == 1).any() and (values == 0).any() and ((values > 0) & (values < 1)).any())
            self.assertEqual(raster.crs().authid() if crs else raster.crs().isValid(), crs or True)

    def test_cells_whose_size_is_no_binary_number(self):
        run("share", MISSION=TOWN / "mission.yaml", Z=20, CELL=0.37, OUTPUT=self.file, EXTENT="-60.1,37.3,-50.7,41.9")
        raster, values, centres = self.cells()
        self.assertEqual((raster.width(), raster.height()), (264, 251))  # of more than one piece
        mission = vt.Mission.read(TOWN / "mission.yaml")
        places = np.column_stack([centres.reshape(-1, 2), np.full(values.size, 20.0)])
        np.testing.assert_allclose(values.ravel(), mission.fraction(places), atol=1e-9)

    def test_a_raster_that_was_there_survives_what_fails(self):
        self.file.write_bytes(b"before")
        wrong = [{"CRS": QgsCoordinateReferenceSystem("EPSG:4326")}, {"CELL": 1e-3}, {"EXTENT": "5,5,5,5"},
                 {"OUTPUT": str(self.file)[:-4] + ".nothing"}, {"MISSION": "absent.yaml"}]
        for change in wrong:
            self.refused("share", **{"MISSION": TOWN / "mission.yaml", "Z": 20, "CELL": 3, "OUTPUT": self.file, **change})
        for stage in (1, 3):
            self.refused("share", Feedback(stop_in=stage), MISSION=TOWN / "mission.yaml", Z=20, CELL=0.25, OUTPUT=self.file)
        self.assertEqual(self.file.read_bytes(), b"before")
        self.assertEqual(os.listdir(self.file.parent), [self.file.name])


    def test_a_full_disk_is_told_and_costs_nothing(self):
        self.file.write_bytes(b"before")
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
        try:
            self.refused("share", MISSION=TOWN / "mission.yaml", Z=20, CELL=2, OUTPUT=self.file)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        self.assertEqual(self.file.read_bytes(), b"before")


class Flights(Checked):
    def test_a_new_flight_sees_all_and_reads_back_from_its_plan(self):
        with tempfile.TemporaryDirectory() as scratch:
            plan = pathlib.Path(scratch) / "tour.plan"
            made = run("flight", MISSION=TOWN / "tour.yaml", BOUND=True, PLAN_OUT=plan)
            again = run("flight", MISSION=TOWN / "tour.yaml", PLAN=plan)
            utm = run("flight", MISSION=TOWN / "tour.yaml", PLAN=plan, CRS=QgsCoordinateReferenceSystem(UTM))
        legs = [corners_of(row.geometry()) for row in made["LEGS"].getFeatures()]
        positions = np.concatenate([legs[0][:1], *(leg[1:] for leg in legs)])
        for one, following in zip(legs, legs[1:]):
            np.testing.assert_array_equal(one[-1], following[0])
        waypoints = np.array([corners_of(row.geometry())[0] for row in made["WAYPOINTS"].getFeatures()])
        np.testing.assert_array_equal(waypoints, positions)
        mission = vt.Mission.read(TOWN / "tour.yaml")
        check = vt.check(mission, positions)
        self.assertEqual(made["SEEN_COUNT"], len(check.targets))
        self.assertTrue(all(target.seen for target in check.targets))
        self.assertAlmostEqual(made["LENGTH_M"], check.length_m, places=6)
        self.assertLessEqual(made["BOUND_M"], made["LENGTH_M"])
        for row in made["STRETCHES"].getFeatures():
            if row["state"] == "seen":
                spans = next(one for one in check.targets if one.name == row["target"]).seen_m
                self.assertLess(np.abs(spans - [row["begin_m"], row["end_m"]]).sum(axis=1).min(), 1e-6)
        self.assertIsNone(again["BOUND_M"])
        self.assertEqual(again["SEEN_COUNT"], made["SEEN_COUNT"])
        flown = np.array([corners_of(row.geometry())[0] for row in again["WAYPOINTS"].getFeatures()])
        # Plans have degrees with seven decimals: about a centimetre.
        self.assertLess(max(distance_to_line(place, positions) for place in flown), 0.03)
        there = np.array([corners_of(row.geometry())[0] for row in utm["WAYPOINTS"].getFeatures()])
        self.assertLess(np.abs(to_frame(there[:, :2], UTM, mission.scene) - flown[:, :2]).max(), 1e-3)

    def test_sees_names_what_the_mission_sees_from_there(self):
        made = run("flight", MISSION=TOWN / "tour.yaml")
        mission, named = vt.Mission.read(TOWN / "tour.yaml"), 0
        scene = mission.scene
        square = vt.Mission.of(scene, vt.Target(osm="Market Square"), max_range=50,
                               navigation=vt.Navigation(altitude={"agl": (5, 60)}))
        for row in made["WAYPOINTS"].getFeatures():
            if "market square" in row["sees"].split("; "):
                named += 1
                self.assertTrue(square.query(corners_of(row.geometry())).inside[0])
        self.assertGreater(named, 0)


def city_in(crs, at_deg, file):
    """An OBJ of a plain and a tower in a CRS, about a place. Returns the scene, and where its middle is in the CRS."""
    plain = [(x, y, 0.0) for x, y in ((-90, -90), (90, -90), (90, 90), (-90, 90))]
    tower = [(x, y, z) for z in (0.0, 30.0) for x, y in ((10, -6), (18, -6), (18, 6), (10, 6))]
    faces = [(0, 1, 2, 3), (8, 9, 10, 11), (4, 5, 9, 8), (5, 6, 10, 9), (6, 7, 11, 10), (7, 4, 8, 11)]
    about = QgsCoordinateTransform(QgsCoordinateReferenceSystem("EPSG:4326"), QgsCoordinateReferenceSystem(crs),
                                   QgsCoordinateTransformContext()).transform(at_deg[1], at_deg[0])
    corners = np.array(plain + tower) + np.round([about.x(), about.y(), 0])
    file.write_text("".join("v {:.17g} {:.17g} {:.17g}\n".format(*corner) for corner in corners) +
                    "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces))
    return vt.Scene.from_mesh(file, crs=text_of(QgsCoordinateReferenceSystem(crs))), np.round([about.x(), about.y()])


class Datums(Checked):
    """Between old datums and WGS 84 there are several operations: layers must go the way of the scene's file."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.file = pathlib.Path(scratch.name) / "city.obj"

    def test_a_layer_in_the_crs_of_the_mesh_lies_where_it_lies_in_the_mesh(self):
        square = np.array([(-5, -4), (6, -4), (6, 5), (-5, 5), (-5, -4)])
        for crs, at_deg in (("EPSG:23030", (40.4, -3.7)), ("EPSG:23032", (45.46, 9.19)), (UTM, (48.0, 11.0))):
            scene, middle = city_in(crs, at_deg, self.file)
            wkt = "POLYGON((" + ", ".join(f"{x} {y}" for x, y in square + middle) + "))"
            asked = {"SCENE": self.file, "SCENE_CRS": QgsCoordinateReferenceSystem(crs), "RANGE": 60, "TARGET_Z": 1,
                     "TARGETS": layer("Polygon", [wkt], crs)}
            # The tower's corners are in the file, so where the mesh lies is known without any conversion of positions.
            tower = scene.vertices[scene.vertices[:, 2] == 30]
            points = layer("PointZ", [f"POINT Z({x + middle[0]} {y + middle[1]} 30)" for x, y in ((10, -6), (18, 6))], crs)
            made = run("volume", CRS=QgsCoordinateReferenceSystem(crs), **asked)
            answers = list(run("query", POINTS=points, **asked)["OUTPUT"].getFeatures())
            mission = vt.Mission.of(scene, [[*xy, 1.0] for xy in (square[:4] + middle).tolist()], max_range=60, crs=crs)
            expected = mission.run()
            with self.subTest(crs=crs):
                self.assertAlmostEqual(made["VOLUME_M3"] / expected.volume_m3, 1, places=9)
                corners = [tower[tower[:, :2].sum(axis=1).argmin()], tower[tower[:, :2].sum(axis=1).argmax()]]
                for row, margin in zip(answers, mission.query(corners).margin_m):
                    self.assertAlmostEqual(row["margin_m"], margin, places=5)
                # The wall x = 10 bounds the volume: its facets lie there in the file's coordinates.
                facets = [corners_of(row.geometry()) - [*middle, 0] for row in made["FACETS"].getFeatures()]
                self.assertLess(min(np.abs(facet[:, 0] - 10).max() for facet in facets), 5e-3)

    def test_an_origin_in_the_crs_of_the_layer(self):
        crs, plaza = "EPSG:23030", PROJECT / "examples" / "plaza" / "plaza.obj"
        _, middle = city_in(crs, (40.4, -3.7), self.file)
        square = layer("Polygon", ["POLYGON((-5 -4, 6 -4, 6 5, -5 5, -5 -4))"])
        points = layer("PointZ", ["POINT Z({} {} 20)".format(*middle)], crs)
        made = run("query", SCENE=plaza, ORIGIN="{},{} [{}]".format(*middle, crs), TARGETS=square, TARGET_Z=1, RANGE=60,
                   POINTS=points)["OUTPUT"]
        mission = vt.Mission.of(vt.Scene.from_mesh(plaza), [[-5, -4, 1], [6, -4, 1], [6, 5, 1], [-5, 5, 1]], max_range=60)
        margin = next(made.getFeatures())["margin_m"]
        self.assertAlmostEqual(margin, mission.query([[0, 0, 20]]).margin_m[0], delta=5e-3)

    def test_results_across_the_antimeridian_are_refused_where_the_crs_ends_there(self):
        plaza = PROJECT / "examples" / "plaza" / "plaza.obj"
        square = layer("Polygon", ["POLYGON((-5 -4, 6 -4, 6 5, -5 5, -5 -4))"])
        asked = {"SCENE": plaza, "ORIGIN": "180,-16.8", "TARGETS": square, "TARGET_Z": 1, "RANGE": 60}
        raster = {"Z": 20, "OUTPUT": self.file.with_suffix(".tif")}
        for name, crs, more in (("volume", "EPSG:4326", {}), ("volume", "EPSG:3857", {}), ("share", "EPSG:3857", raster)):
            self.assertIn("antimeridian", self.refused(name, CRS=QgsCoordinateReferenceSystem(crs), **asked, **more))
        for crs in ("EPSG:32760", "EPSG:3832"):
            made = run("volume", CRS=QgsCoordinateReferenceSystem(crs), SLICE_HEIGHTS="20", **asked)
            extent = made["SLICES"].getFeature(1).geometry().boundingBox()
            self.assertTrue(90 < extent.width() < 130, extent.width())

    def test_a_crs_that_its_user_made_is_passed_on_as_text(self):
        """In a profile of its own: QGIS writes such CRSs there."""
        text = ("import sys, pathlib, tempfile, support\n"
                "from qgis.core import QgsCoordinateReferenceSystem as Crs\n"
                "from test_plugin import city_in, layer\n"
                "crs = Crs.fromProj('+proj=tmerc +lat_0=40 +lon_0=-3 +k=1 +x_0=500 +y_0=900 +ellps=intl '\n"
                "                   '+towgs84=-87,-98,-121 +units=m +type=crs')\n"
                "assert crs.saveAsUserCrs('mine') > 0\n"
                "mine = Crs('USER:100000')\n"
                "assert mine.isValid() and mine.authid() == 'USER:100000', mine.authid()\n"
                "square = [(-5, -4), (6, -4), (6, 5), (-5, 5), (-5, -4)]\n"
                "with tempfile.TemporaryDirectory() as scratch:\n"
                "    file = pathlib.Path(scratch) / 'city.obj'\n"
                "    scene, middle = city_in(mine, (40.001, -3.001), file)\n"
                "    targets = layer('Polygon', ['POLYGON((' + ', '.join(f'{x + middle[0]} {y + middle[1]}'\n"
                "                                                       for x, y in square) + '))'])\n"
                "    targets.setCrs(mine)\n"
                "    made = support.run('volume', SCENE=file, SCENE_CRS=mine, CRS=mine, TARGETS=targets, TARGET_Z=1, RANGE=60)\n"
                "    extent = made['FACETS'].extent()\n"
                "    assert made['FACETS'].crs() == mine\n"
                "    assert extent.contains(*map(float, middle)) and extent.width() < 130, extent.toString()\n"
                "support.quit_now(0)\n")
        with tempfile.TemporaryDirectory() as profile:
            environment = {**os.environ, "QGIS_CUSTOM_CONFIG_PATH": profile, "HOME": profile,
                           "PYTHONPATH": os.pathsep.join([os.environ["PYTHONPATH"], str(FOLDER / "tests")])}
            ran = subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, timeout=120)
        self.assertEqual(ran.returncode, 0, ran.stderr)


class Refused(Checked):
    def test_errors_of_vantage_reach_the_user_whole(self):
        with tempfile.TemporaryDirectory() as scratch:
            mission = pathlib.Path(scratch) / "mission.yaml"
            mission.write_text("scene: {osm: absent.osm}\ntarget: {point: [0, 0, 9]}\nsensor: {max_range: 9}\n")
            before = pathlib.Path(scratch) / "facets.gpkg"
            before.write_bytes(b"before")
            with self.assertRaises(vt.Error) as expected:
                vt.Mission.read(mission)
            self.assertEqual(self.refused("volume", MISSION=mission, FACETS=before), str(expected.exception))
            elsewhere = QgsCoordinateReferenceSystem.fromProj("+proj=gnom +lat_0=-48 +lon_0=-169")  # the other half of the earth
            self.refused("volume", MISSION=TOWN / "mission.yaml", FACETS=before, CRS=elsewhere)
            self.assertEqual(before.read_bytes(), b"before")

    def test_what_does_not_go_together(self):
        square = layer("Polygon", ["POLYGON((-5 -4, 6 -4, 6 5, -5 5, -5 -4))"])
        plaza = PROJECT / "examples" / "plaza" / "plaza.obj"
        good = {"SCENE": plaza, "TARGETS": square, "RANGE": 40}
        wrong = [{}, {**good, "RANGE": None}, {**good, "MISSION": TOWN / "mission.yaml"}, {**good, "LOWEST": 3},
                 {**good, "CENTER": "11,48"}, {**good, "SLICE_HEIGHTS": "10; high"}, {**good, "TARGETS": layer("Polygon", [])},
                 {**good, "TARGETS": layer("Polygon", [""])}, {**good, "TARGET_Z": 1, "TARGET_Z_FIELD": "z"}]
        run("volume", **good)
        for parameters in wrong:
            self.refused("volume", **parameters)

    def test_what_dialogs_leave_empty_is_not_given(self):
        empty = {"SCENE": NULL, "TARGETS": None, "SCENE_CRS": QgsCoordinateReferenceSystem(), "CENTER": "", "RANGE": None,
                 "TARGET_Z_FIELD": NULL, "CRS": QgsCoordinateReferenceSystem()}
        self.assertGreater(run("volume", MISSION=TOWN / "mission.yaml", **empty)["FACET_COUNT"], 0)

    def test_cancelling_stops(self):
        points = layer("PointZ", ["POINT Z(0 0 9)"])
        for name, more in (("volume", {}), ("query", {"POINTS": points}), ("share", {"Z": 20}), ("flight", {})):
            mission = TOWN / ("tour.yaml" if name == "flight" else "mission.yaml")
            with tempfile.TemporaryDirectory() as scratch:
                more = {**more, "OUTPUT": pathlib.Path(scratch) / "share.tif"} if name == "share" else more
                feedback = Feedback()
                feedback.cancel()
                self.refused(name, feedback, MISSION=mission, **more)
                self.assertEqual(os.listdir(scratch), [])
        feedback = Feedback(stop_in=1)  # in the middle of a call
        self.refused("flight", feedback, MISSION=TOWN / "tour.yaml")
        self.assertEqual(len(feedback.stages), 1)

    def test_without_the_package_one_message_says_how_to_install_it(self):
        text = ("import os, support\n"
                "from qgis.core import QgsApplication\n"
                "provider = QgsApplication.processingRegistry().providerById('vantage')\n"
                "states = [one.canExecute() for one in provider.algorithms()]\n"
                "assert len(states) == 4 and not any(can for can, _ in states), states\n"
                "assert {why for _, why in states} == {provider.warningMessage()}, states\n"
                "try:\n    support.run('volume', MISSION='x.yaml')\n"
                "except support.QgsProcessingException as error:\n    print('TOLD', error)\n"
                "print(provider.warningMessage())\n"
                "support.quit_now(0)\n")
        with tempfile.TemporaryDirectory() as other:
            (pathlib.Path(other) / "vantage.py").write_text("raise ImportError('not here')\n")
            for path in (other, ""):
                environment = {**os.environ, "PYTHONPATH": os.pathsep.join([path, str(FOLDER / "tests")])}
                if not path:
                    environment["PYTHONPATH"] = str(FOLDER / "tests")
                ran = subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, timeout=120)
                self.assertEqual(ran.returncode, 0, ran.stderr)
                self.assertIn("pip install", ran.stdout)
                self.assertIn("TOLD", ran.stdout)


if __name__ == "__main__":
    ended = unittest.main(exit=False, verbosity=2)
    support.quit_now(0 if ended.result.wasSuccessful() else 1)
