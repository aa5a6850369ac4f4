# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the add-on, inside Blender (or a Python that has bpy):

    blender -b --factory-startup --python integrations/blender/tests/run.py [-- --zip FILE] [--vantage PROGRAM] [TEST ...]

With --zip that file is installed, as a user does; tests/run.sh gives Blender a folder of its own for this. The package
`vantage` must be importable (PYTHONPATH=build/python), and --vantage names the program that exported missions run with.
"""

import os
import pathlib
import re
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import bpy  # noqa: E402  (as a module it brings bmesh)
import addon_utils  # noqa: E402
import bmesh  # noqa: E402
import numpy as np  # noqa: E402
import vantage as vt  # noqa: E402

import city  # noqa: E402
from support import ADDON, OPTIONS, Case, blockers, live, package, target, volume_mesh  # noqa: E402
from live_and_files import Export, Live  # noqa: E402, F401


def api_scene(count=5):
    """The city as arrays, from the same boxes, without Blender."""
    half = 10 * count + 20
    steps = np.linspace(-half, half, 5)
    points = [(x, y, 0.0) for y in steps for x in steps]
    quads = [(0, (5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5)) for j in range(4) for i in range(4)]
    for number, (low, high) in enumerate(city.boxes(count)):
        quads += [(number + 1, tuple(len(points) + corner for corner in face)) for face in city.BOX_FACES]
        points += city.box_corners(low, high)
    faces, of = [], []
    for number, (a, b, c, d) in quads:
        faces += [(a, b, c), (a, c, d)]
        of += [number, number]
    names = ["ground"] + [f"house {number}" for number in range(max(of))]
    return vt.Scene.from_arrays(np.float32(points).astype(float), faces, object_of=of, objects=names)


def world_of(volume, unit_m=1.0):
    points = np.empty(3 * len(volume.data.vertices), np.float32)
    volume.data.vertices.foreach_get("co", points)
    return (points.reshape(-1, 3).astype(float) + np.array(volume.matrix_world)[:3, 3]) * unit_m


def triangles_of(volume):
    corners = np.empty(len(volume.data.loops), np.int32)
    volume.data.loops.foreach_get("vertex_index", corners)
    return corners.reshape(-1, 3)


def measured_m3(points, faces):
    a, b, c = (points[faces[:, k]] - points.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def open_edges(mesh):
    work = bmesh.new()
    work.from_mesh(mesh)
    found = sum(len(edge.link_faces) != 2 for edge in work.edges)
    work.free()
    return found


def causes_at(volume):
    """The cause of each face, and the list of causes."""
    of = np.empty(len(volume.data.polygons), np.int32)
    volume.data.attributes[volume_mesh.CAUSE].data.foreach_get("value", of)
    return of, volume_mesh.causes_of(volume)


class Volumes(Case):
    def test_selected_faces_give_the_volume_of_the_api(self):
        square = city.add_square()
        city.select_faces(square, range(4))
        bpy.ops.vantage.use_selected_faces()
        self.settings.target_hides = False
        self.settings.max_range = 60
        self.settings.use_heights = True
        self.settings.min_height, self.settings.max_height = 1, 40
        volume = self.compute()
        corners = live.follower.shown.polygons[0].corners
        self.assertEqual({tuple(one) for one in corners}, {(-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0)})
        expected = vt.compute(api_scene(), vt.Target(vertices=corners, front=[0, 0, 1]), max_range=60, navigation=vt.Navigation(altitude=(1, 40)))
        self.assertEqual(live.follower.result.volume.hash, expected.volume.hash)
        self.assertEqual(open_edges(volume.data), 0)
        self.assertFalse(volume.data.validate())
        self.assertEqual(len(volume.data.polygons), len(expected.faces))
        self.assertAlmostEqual(measured_m3(world_of(volume), triangles_of(volume)) / expected.volume_m3, 1, delta=1e-6)
        moved = np.linalg.norm(world_of(volume) - expected.vertices, axis=1).max()
        self.assertAlmostEqual(moved, volume["vantage_rounding_m"], delta=1e-12)
        self.assertLess(moved, 1e-5)

    def test_materials_and_attributes_tell_the_causes(self):
        self.use_square()
        volume = self.compute()
        of, causes = causes_at(volume)
        for polygon, cause in zip(volume.data.polygons, of):
            name = volume.data.materials[polygon.material_index].name
            self.assertEqual(name, "Vantage " + causes[cause]["kind"])
        kinds = {one["kind"] for one in causes}
        self.assertEqual(len(volume.data.materials), len(kinds))
        self.assertLessEqual({"scene", "range"}, kinds)
        hiding = {one["name"] for one in causes if one["is_object"]}
        self.assertTrue(hiding)
        self.assertLessEqual(hiding, {thing.name for thing in bpy.data.objects})
        name = min(hiding)
        bpy.ops.vantage.select_cause(name=name)
        self.assertEqual([thing.name for thing in bpy.context.selected_objects], [name])

    def test_a_drawn_rectangle_is_a_target(self):
        bpy.context.scene.cursor.location = (0, 0, 0)
        self.assertEqual(bpy.ops.vantage.draw_target(width=16, length=16), {"FINISHED"})
        drawn = self.compute()["vantage_volume_m3"]
        bpy.data.objects.remove(self.settings.target)
        self.use_square()
        self.assertAlmostEqual(self.compute()["vantage_volume_m3"] / drawn, 1, delta=1e-9)

    def test_a_roof_is_seen_from_above_it(self):
        house = bpy.data.objects["house 3"]
        city.select_faces(house, [1])
        bpy.ops.vantage.use_selected_faces()
        volume = self.compute()
        roof = max(corner[2] for corner in house.bound_box)
        self.assertGreaterEqual(world_of(volume)[:, 2].min(), roof - 1e-5)

    def test_other_units_give_the_same_volume(self):
        self.use_square()
        expected = self.compute()["vantage_volume_m3"]
        city.build(unit=100)
        bpy.context.scene.unit_settings.scale_length = 0.01
        self.use_square(unit=100)
        volume = self.compute()
        self.assertAlmostEqual(volume["vantage_volume_m3"] / expected, 1, delta=1e-5)
        self.assertAlmostEqual(measured_m3(world_of(volume, 0.01), triangles_of(volume)) / expected, 1, delta=1e-5)

    def test_modifiers_instances_and_matrices_hide(self):
        self.use_square()
        free = self.compute()["vantage_volume_m3"]
        wall = city.add("wall", city.box_corners((-1, -1, 0), (1, 1, 20)), city.BOX_FACES)
        wall.location = (10, 0, 0)
        array = wall.modifiers.new("array", "ARRAY")
        array.count, array.use_relative_offset, array.use_constant_offset = 3, False, True
        array.constant_offset_displace = (0, 4, 0)
        with_modifier = self.compute()["vantage_volume_m3"]
        self.assertLess(with_modifier, free)
        wall.modifiers.remove(array)
        group = bpy.data.collections.new("walls")
        group.objects.link(wall)
        wall.users_collection[0].objects.unlink(wall)
        if "walls" in [one.name for one in wall.users_collection]:
            for y in (0, 4, 8):
                empty = bpy.data.objects.new(f"empty {y}", None)
                empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", group, (0, y, 0)
                bpy.context.collection.objects.link(empty)
        self.assertAlmostEqual(self.compute()["vantage_volume_m3"] / with_modifier, 1, delta=1e-9)

    def test_instances_of_geometry_nodes_hide(self):
        self.use_square()
        free = self.compute()["vantage_volume_m3"]
        places = [(10, 0, 10), (10, 4, 10), (10, 8, 10)]
        boxes = [city.add(f"box {x} {y}", city.box_corners((x - 1, y - 1, 0), (x + 1, y + 1, 20)), city.BOX_FACES)
                 for x, y, _ in places]
        expected = self.compute()["vantage_volume_m3"]
        self.assertLess(expected, free)
        for box in boxes:
            bpy.data.objects.remove(box)
        # Corners of a triangle become places of a box that belongs to no object.
        points = city.add("points", [(x + 0.01 * number, y, z) for number, (x, y, z) in enumerate(places)], [(0, 1, 2)])
        nodes = bpy.data.node_groups.new("boxes", "GeometryNodeTree")
        if bpy.app.version < (4, 0, 0):
            nodes.inputs.new("NodeSocketGeometry", "Geometry"), nodes.outputs.new("NodeSocketGeometry", "Geometry")
        else:
            nodes.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
            nodes.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        start, end, box, spread, join = (nodes.nodes.new(kind) for kind in (
            "NodeGroupInput", "NodeGroupOutput", "GeometryNodeMeshCube", "GeometryNodeInstanceOnPoints", "GeometryNodeJoinGeometry"))
        box.inputs["Size"].default_value = (2, 2, 20)
        for source, sink in ((start.outputs[0], spread.inputs["Points"]), (box.outputs[0], spread.inputs["Instance"]),
                             (spread.outputs[0], join.inputs[0]), (start.outputs[0], join.inputs[0]),
                             (join.outputs[0], end.inputs[0])):
            nodes.links.new(source, sink)
        points.modifiers.new("boxes", "NODES").node_group = nodes
        volume = self.compute()["vantage_volume_m3"]
        self.assertEqual(sum("points" in name for name in live.follower.shown.blockers.names), 4)
        self.assertAlmostEqual(volume / expected, 1, delta=0.02)  # the triangle hides, too, between the boxes

    def reduced(self):
        """Names in the panel's notes after Compute."""
        self.compute()
        notes = [line for line in live.follower.status if line.startswith("note")]
        return sorted(name for line in notes for name in re.findall("'([^']+)'", line))

    def test_what_the_viewport_leaves_out_is_told(self):
        self.use_square()
        self.assertEqual(self.reduced(), [])
        wall = city.add("wall", city.box_corners((9, -1, 0), (11, 1, 20)), city.BOX_FACES)
        array = wall.modifiers.new("array", "ARRAY")
        array.show_viewport = False
        self.assertEqual(self.reduced(), ["wall"])
        array.show_render = False
        self.assertEqual(self.reduced(), [])
        array.show_viewport, array.show_render, array.show_in_editmode = True, True, False
        self.assertEqual(self.reduced(), [])
        bpy.context.view_layer.objects.active = wall
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertEqual(self.reduced(), ["wall"])
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.reduced(), [])

    def test_levels_of_subdivision_that_the_viewport_leaves_out_are_told(self):
        self.use_square()
        wall = city.add("wall", city.box_corners((9, -1, 0), (11, 1, 20)), city.BOX_FACES)
        smooth = wall.modifiers.new("smooth", "SUBSURF")
        smooth.levels, smooth.render_levels = 1, 2
        self.assertEqual(self.reduced(), ["wall"])
        smooth.levels = 2
        self.assertEqual(self.reduced(), [])
        rendering = bpy.context.scene.render
        rendering.use_simplify, rendering.simplify_subdivision = True, 1
        self.assertEqual(self.reduced(), ["wall"])
        rendering.simplify_subdivision_render = 1
        self.assertEqual(self.reduced(), [])
        rendering.use_simplify = False
        smooth.levels, smooth.show_render = 1, False
        self.assertEqual(self.reduced(), [])

    def test_particles_that_the_viewport_leaves_out_are_told(self):
        self.use_square()
        tree = city.add("tree", city.box_corners((60, 60, 0), (61, 61, 9)), city.BOX_FACES)
        ground = bpy.data.objects["ground"]
        ground.modifiers.new("trees", "PARTICLE_SYSTEM")
        settings = ground.particle_systems[0].settings
        settings.render_type, settings.instance_object, settings.count = "OBJECT", tree, 40
        settings.frame_start = settings.frame_end = 0
        self.assertEqual(self.reduced(), [])
        settings.child_type, settings.rendered_child_count = "SIMPLE", 100
        self.assertEqual(self.reduced(), ["ground"])
        settings.rendered_child_count = 1
        self.assertEqual(self.reduced(), [])
        settings.child_type, settings.display_percentage = "NONE", 10
        self.assertEqual(self.reduced(), ["ground"])
        ground.show_instancer_for_viewport, settings.display_percentage = False, 0
        self.assertEqual(self.reduced(), ["ground"])
        chosen = bpy.data.collections.new("chosen")
        bpy.context.scene.collection.children.link(chosen)
        chosen.objects.link(bpy.data.objects["house 3"])
        self.settings.collection = chosen
        self.assertEqual(self.reduced(), [])

    def test_a_collection_chooses_what_hides(self):
        self.use_square()
        everything = self.compute()["vantage_volume_m3"]
        chosen = bpy.data.collections.new("chosen")
        bpy.context.scene.collection.children.link(chosen)
        chosen.objects.link(bpy.data.objects["ground"])
        self.settings.collection = chosen
        self.assertGreater(self.compute()["vantage_volume_m3"], everything)

    def test_hidden_objects_hide_nothing(self):
        self.use_square()
        before = self.compute()["vantage_volume_m3"]
        for thing in bpy.data.objects:
            if thing.name.startswith("house"):
                thing.hide_set(True)
        self.assertGreater(self.compute()["vantage_volume_m3"], before)

    def test_limits_and_cameras(self):
        self.use_square()
        whole = self.compute()["vantage_volume_m3"]
        limits = [{"min_range": 20}, {"use_incidence": True, "incidence": 30}, {"clearance": 3, "ground": bpy.data.objects["ground"]},
                  {"use_heights": True, "min_height": 10, "max_height": 30, "ground": bpy.data.objects["ground"]},
                  {"camera": "fov", "fov": (30, 20)}, {"camera": "model", "camera_model": vt.cameras()[0]["name"], "pixel_size": 0.02}]
        for limit in limits:
            with self.subTest(limit=limit):
                bpy.context.scene.property_unset("vantage")
                self.settings.target, self.settings.all_faces, self.settings.target_hides = bpy.data.objects["square"], True, False
                for name, value in limit.items():
                    setattr(self.settings, name, value)
                limited = self.compute()["vantage_volume_m3"]
                self.assertLess(limited, 0.99 * whole)
                self.assertGreater(limited, 0)

    def test_several_parts_are_all_seen(self):
        self.use_square()
        one = self.compute()["vantage_volume_m3"]
        corners = [(-8, -8, 0), (-2, -8, 0), (-2, -2, 0), (-8, -2, 0), (2, 2, 0), (8, 2, 0), (8, 8, 0), (2, 8, 0)]
        self.settings.target = city.add("pair", corners, [(0, 1, 2, 3), (4, 5, 6, 7)])
        self.assertGreater(self.compute()["vantage_volume_m3"], one)
        self.assertEqual(len(live.follower.shown.polygons), 2)


class Faces(unittest.TestCase):
    """How faces become polygons."""

    def merged(self, corners, faces):
        normals = []
        for face in faces:
            a, b, c = (np.array(corners[i], float) for i in face[:3])
            normals.append(np.cross(b - a, c - a) / np.linalg.norm(np.cross(b - a, c - a)))
        return target._merged("x", np.array(corners, float), [(i, np.array(face)) for i, face in enumerate(faces)],
                              np.array(normals))

    def test_coplanar_neighbours_become_one_polygon(self):
        turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
        steps = [(x, y, 0) for y in range(4) for x in range(4)]
        quads = [(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4) for j in range(3) for i in range(3)]
        corners = (np.array(steps) @ turn * 30 + 400).astype(np.float32)
        merged = self.merged(corners.tolist(), quads)
        self.assertEqual(len(merged), 1)
        self.assertAlmostEqual(abs(target._area((merged[0].corners @ turn.T)[:, :2])), 8100, delta=1)
        self.assertGreater(np.cross(*np.diff(merged[0].corners[:3], axis=0)) @ merged[0].front, 0)

    def test_others_stay_by_themselves(self):
        ell = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0), (0, 2, 0), (1, 2, 0)]
        self.assertEqual(len(self.merged(ell, [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6)])), 3)
        roof = [(0, 0, 0), (4, 0, 0), (4, 2, 1), (0, 2, 1), (4, 4, 0), (0, 4, 0)]
        self.assertEqual(len(self.merged(roof, [(0, 1, 2, 3), (3, 2, 4, 5)])), 2)


class Hostile(Case):
    def test_no_selection(self):
        square = city.add_square()
        city.select_faces(square, [])
        self.assertIn("square", self.refused(bpy.ops.vantage.use_selected_faces))
        self.refused(bpy.ops.vantage.compute)
        bpy.context.view_layer.objects.active = None
        self.refused(bpy.ops.vantage.use_selected_faces)
        self.settings.target = square
        self.assertIn("square", self.refused(bpy.ops.vantage.compute))

    def test_a_face_that_is_not_planar(self):
        self.settings.target, self.settings.all_faces = city.add("bent", [(0, 0, 0), (4, 0, 0), (4, 4, 1), (0, 4, 0)], [(0, 1, 2, 3)]), True
        self.assertIn("bent, face 0", self.refused(bpy.ops.vantage.compute))

    def test_a_face_that_is_not_convex(self):
        self.settings.target, self.settings.all_faces = city.add("arrow", [(0, 0, 0), (4, 0, 0), (1, 1, 0), (0, 4, 0)], [(0, 1, 2, 3)]), True
        self.assertIn("arrow, face 0", self.refused(bpy.ops.vantage.compute))

    def test_faces_of_no_area_and_objects_without_size(self):
        thin = city.add("thin", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
        self.settings.target, self.settings.all_faces = thin, True
        self.assertIn("thin", self.refused(bpy.ops.vantage.compute))
        self.use_square().scale = (0, 1, 1)
        self.refused(bpy.ops.vantage.compute)

    def test_a_target_inside_a_building(self):
        low, high = city.boxes(5)[0]
        x, y = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
        # Partly inside: refused. Wholly inside: the positions inside of the same walls, and none outside.
        square = self.use_square(half=8, z=2)
        square.location = (x, y, 0)
        self.assertIn("house 0", self.refused(bpy.ops.vantage.compute))
        square.scale = (0.25, 0.25, 1)
        volume = self.compute()
        points = world_of(volume)
        self.assertTrue((points.min(axis=0) >= np.subtract(low, 1e-4)).all() and (points.max(axis=0) <= np.add(high, 1e-4)).all())

    def test_no_numbers(self):
        self.use_square()
        bpy.data.objects["house 5"].data.vertices[2].co.x = float("nan")
        self.assertIn("house 5", self.refused(bpy.ops.vantage.compute))
        bpy.data.objects["square"].data.vertices[2].co.x = float("nan")
        self.assertIn("square", self.refused(bpy.ops.vantage.compute))

    def test_nothing_that_hides_and_no_mesh(self):
        self.use_square()
        self.settings.collection = bpy.data.collections.new("empty")
        self.assertIn("empty", self.refused(bpy.ops.vantage.compute))

    def test_limits_that_contradict(self):
        self.use_square()
        self.settings.min_range, self.settings.max_range = 90, 80
        self.refused(bpy.ops.vantage.compute)
        self.settings.min_range, self.settings.camera, self.settings.camera_model = 0, "model", "none of them"
        self.assertIn("none of them", self.refused(bpy.ops.vantage.compute))

    def test_walls_that_no_position_sees_at_once(self):
        house = bpy.data.objects["house 3"]
        city.select_faces(house, [2, 4])
        bpy.ops.vantage.use_selected_faces()
        volume = self.compute()
        self.assertEqual((len(volume.data.polygons), volume["vantage_outcome"]), (0, "no_common_view"))

    def test_without_the_package(self):
        self.use_square()
        there = {name: sys.modules.pop(name) for name in list(sys.modules) if name.split(".")[0] == "vantage"}
        sys.modules["vantage"] = None
        try:
            self.assertIn("pip install", self.refused(bpy.ops.vantage.compute))
            self.assertEqual(os.path.dirname(os.path.dirname(package.python_program())), sys.base_prefix)
            self.assertTrue(package.load_problem())
        finally:
            del sys.modules["vantage"]
            sys.modules.update(there)
        self.compute()


class Speed(Case):
    def test_seconds_of_a_large_city(self):
        count = city.write_many(100_000)
        square = self.use_square()
        self.settings.live, self.settings.max_range = True, 300
        seconds = []
        read_before = live.follower.read_count
        for step in range(8):
            square.location.x = 0.5 * step
            start = time.perf_counter()
            bpy.context.view_layer.update()
            self.follow()
            seconds.append(time.perf_counter() - start)
        start = time.perf_counter()
        blockers.gather(bpy.context.evaluated_depsgraph_get(), 1.0)
        read = time.perf_counter() - start
        facets = len(self.settings.volume.data.polygons)
        print(f"speed: {count} triangles, Blender {bpy.app.version_string}: first {seconds[0]:.2f} s, then "
              f"{np.median(seconds[1:]):.2f} s for each move of the target ({facets} facets; {live.DELAY_S} s of it are the "
              f"delay); reading the scene, which a move does not need, {read:.2f} s")
        self.assertGreater(facets, 0)
        self.assertLessEqual(live.follower.read_count - read_before, 3)


class Registration(unittest.TestCase):
    def test_it_can_be_switched_off_and_on(self):
        addon_utils.disable(ADDON)
        self.assertFalse(hasattr(bpy.types.Scene, "vantage"))
        addon_utils.enable(ADDON)
        self.assertTrue(hasattr(bpy.types.Scene, "vantage"))


def main():
    loader = unittest.defaultTestLoader
    module = sys.modules[__name__]
    suite = loader.loadTestsFromNames(OPTIONS.tests, module) if OPTIONS.tests else loader.loadTestsFromModule(module)
    passed = unittest.TextTestRunner(verbosity=2, stream=sys.stdout).run(suite).wasSuccessful()
    sys.stdout.flush()
    os._exit(0 if passed else 1)  # bpy as a module may crash while it is taken down


main()
