# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of run.py: how the volume follows changes, and what is written to files."""

import json
import os
import pathlib
import subprocess
import tempfile
import time
from unittest import mock

import bpy
import bmesh
import mathutils

import city
from support import OPTIONS, Case, computation, live, volume_mesh


class Live(Case):
    def test_it_follows_the_target_and_keeps_the_scene(self):
        square = self.use_square()
        self.settings.live = True
        self.follow()
        volume, prepared, shown = self.settings.volume, computation.shared.prepared_count, live.follower.shown_count
        before = volume["vantage_volume_m3"]
        square.location.x = 3
        bpy.context.view_layer.update()
        self.assertIsNotNone(live.follower.due)
        self.follow()
        self.assertNotEqual(volume["vantage_volume_m3"], before)
        self.assertEqual(live.follower.shown_count, shown + 1)
        self.assertEqual(computation.shared.prepared_count, prepared)
        moved = volume["vantage_volume_m3"]
        hiding = next(one["name"] for one in volume_mesh.causes_of(volume) if one["name"].startswith("house"))
        bpy.data.objects[hiding].location.z = 10
        bpy.context.view_layer.update()
        self.follow()
        self.assertNotEqual(volume["vantage_volume_m3"], moved)
        self.assertEqual(computation.shared.prepared_count, prepared + 1)
        self.assertEqual(volume["vantage_volume_m3"], self.compute()["vantage_volume_m3"])

    def test_it_follows_what_hides(self):
        square = self.use_square()
        self.settings.live = True
        self.follow()
        volume = self.settings.volume
        hiding = [bpy.data.objects[one["name"]] for one in volume_mesh.causes_of(volume) if one["name"].startswith("house")]
        chosen = bpy.data.collections.new("chosen")
        changes = [lambda: hiding[0].hide_set(True), lambda: hiding[0].hide_set(False),
                   lambda: (hiding[1].data.transform(mathutils.Matrix.Scale(0.3, 4, (0, 0, 1))),
                            hiding[1].data.update()),
                   lambda: setattr(hiding[2], "hide_viewport", True), lambda: setattr(square, "location", (1, 0, 0)),
                   lambda: bpy.data.objects.remove(hiding[3]), lambda: setattr(self.settings, "collection", chosen)]
        chosen.objects.link(bpy.data.objects["ground"])
        for number, change in enumerate(changes):
            before = volume["vantage_volume_m3"]
            change()
            bpy.context.view_layer.update()
            self.follow()
            with self.subTest(number=number):
                self.assertNotEqual(volume["vantage_volume_m3"], before)
                live.follower.due = None
                followed = volume["vantage_volume_m3"]
                self.assertEqual(self.compute()["vantage_volume_m3"], followed)

    def test_it_follows_vertices_in_edit_mode_and_limits(self):
        square = self.use_square()
        self.settings.live = True
        self.follow()
        volume = self.settings.volume
        before = volume["vantage_volume_m3"]
        bpy.context.view_layer.objects.active = square
        bpy.ops.object.mode_set(mode="EDIT")
        work = bmesh.from_edit_mesh(square.data)
        for vertex in work.verts:
            vertex.co.x *= 0.5
        bmesh.update_edit_mesh(square.data)
        bpy.context.view_layer.update()
        self.follow()
        self.assertGreater(volume["vantage_volume_m3"], before)
        bpy.ops.object.mode_set(mode="OBJECT")
        narrow = volume["vantage_volume_m3"]
        self.settings.max_range = 50
        self.follow()
        self.assertLess(volume["vantage_volume_m3"], narrow)

    def test_it_follows_an_animation(self):
        square = self.use_square()
        square.keyframe_insert("location", frame=1)
        square.location.x = 3
        square.keyframe_insert("location", frame=11)
        bpy.context.scene.frame_set(1)
        self.settings.live = True
        self.follow()
        seen = [self.settings.volume["vantage_volume_m3"]]
        for frame in (6, 11):
            bpy.context.scene.frame_set(frame)
            self.follow()
            seen.append(self.settings.volume["vantage_volume_m3"])
        self.assertEqual(len(set(seen)), 3)

    def test_an_error_takes_the_volume_away(self):
        square = self.use_square()
        self.settings.live = True
        self.follow()
        square.data.vertices[0].co.z = 5
        square.data.update()
        square.data.update_tag()
        bpy.context.view_layer.update()
        self.settings.all_faces = False
        self.follow()
        self.assertEqual(len(self.settings.volume.data.polygons), 0)
        self.assertTrue(live.follower.status)

    def test_it_comes_to_rest(self):
        self.use_square()
        self.settings.live = True
        self.follow()
        shown = live.follower.shown_count
        for _ in range(3):
            bpy.context.view_layer.update()
            self.follow()
        self.assertEqual(live.follower.shown_count, shown)

    def test_without_it_the_panel_knows_of_changes(self):
        square = self.use_square()
        self.compute()
        bpy.context.view_layer.update()
        live.follower.is_stale = False
        square.location.x = 1
        bpy.context.view_layer.update()
        self.assertTrue(live.follower.is_stale)


    def house_that_hides(self):
        return bpy.data.objects[next(one["name"] for one in volume_mesh.causes_of(self.settings.volume)
                                     if one["name"].startswith("house"))]

    def test_a_change_that_is_not_followed_makes_the_volume_old(self):
        follower = live.follower
        other = bpy.data.scenes.new("other")
        self.addCleanup(bpy.data.scenes.remove, other)

        def in_another_scene():
            with bpy.context.temp_override(scene=other):
                self.follow()

        def off_while_it_runs():
            time.sleep(2 * live.DELAY_S)
            live.tick()
            self.assertIsNotNone(follower.job)
            self.settings.live = False

        leave = [lambda: setattr(self.settings, "live", False), off_while_it_runs, lambda: self.settings.property_unset("live"),
                 in_another_scene]
        for number, way in enumerate(leave):
            with self.subTest(number=number):
                city.build()
                self.use_square()
                self.compute()
                self.settings.live = True
                self.follow()
                self.assertFalse(follower.is_stale)
                before = self.settings.volume["vantage_volume_m3"]
                self.house_that_hides().location.z = 10
                bpy.context.view_layer.update()
                self.assertIsNotNone(follower.due)
                way()
                self.follow()
                self.assertEqual(self.settings.volume["vantage_volume_m3"], before)
                self.assertTrue(follower.is_stale)
                self.settings.live = False
                self.compute()
                self.assertFalse(follower.is_stale)

    def test_a_volume_that_is_edited_is_old_after_a_change(self):
        square = self.use_square()
        self.compute()
        self.settings.live = True
        self.follow()
        bpy.context.view_layer.objects.active = self.settings.volume
        bpy.ops.object.mode_set(mode="EDIT")
        square.location.x = 3
        bpy.context.view_layer.update()
        self.follow()
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertTrue(live.follower.is_stale)

    def test_an_export_does_not_lose_what_is_computed(self):
        square = self.use_square()
        self.compute()
        self.settings.live = True
        self.follow()
        before = self.settings.volume["vantage_volume_m3"]
        square.location.x = 3
        bpy.context.view_layer.update()
        time.sleep(2 * live.DELAY_S)
        live.tick()
        self.assertIsNotNone(live.follower.job)
        with tempfile.TemporaryDirectory() as folder:
            bpy.ops.vantage.export_mission(filepath=os.path.join(folder, "m.yaml"))
        self.follow()
        self.assertNotEqual(self.settings.volume["vantage_volume_m3"], before)


class Export(Case):
    def test_the_program_computes_the_same_bytes(self):
        self.use_square()
        self.settings.use_heights, self.settings.clearance = True, 0.3
        self.settings.ground = bpy.data.objects["ground"]
        bpy.data.objects["house 4"].name = 'Haus "4", Büro / Süd'
        self.compute()
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            bpy.ops.vantage.export_mission(filepath=str(folder / "m.yaml"))
            bpy.ops.vantage.save_volume(filepath=str(folder / "ours.ply"))
            self.assertEqual(sorted(one.name for one in folder.iterdir()),
                             ["m.scene.obj", "m.yaml", "ours.ply", "ours.report.json"])
            subprocess.run([OPTIONS.vantage, "compute", folder / "m.yaml", "-o", folder / "theirs.ply"], check=True,
                           stdout=subprocess.DEVNULL)
            self.assertEqual((folder / "ours.ply").read_bytes(), (folder / "theirs.ply").read_bytes())
            report = json.loads((folder / "theirs.report.json").read_text())
            self.assertEqual(report["volume_m3"], self.settings.volume["vantage_volume_m3"])
            self.assertEqual(live.follower.result.prove()["verdict"], "proved")

    def test_files_of_others_stay(self):
        self.use_square()
        with tempfile.TemporaryDirectory() as name:
            other = pathlib.Path(name, "m.scene.obj")
            other.write_text("v 0 0 0\n")
            self.assertIn("m.scene.obj", self.refused(bpy.ops.vantage.export_mission, filepath=str(other.parent / "m.yaml")))
            self.assertEqual([one.name for one in other.parent.iterdir()], [other.name])
            self.assertEqual(other.read_text(), "v 0 0 0\n")
        self.refused(bpy.ops.vantage.export_mission, filepath=str(pathlib.Path(name, "m.yaml")))

    def test_both_files_or_none(self):
        square = self.use_square()
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            mission, scene = folder / "m.yaml", folder / "m.scene.obj"
            bpy.ops.vantage.export_mission(filepath=str(mission))
            before = {file.name: file.read_bytes() for file in (mission, scene)}
            square.location.x = 1
            bpy.data.objects["house 3"].location.z = 5

            def fails(source, to, replace=os.replace):
                if str(to) == str(mission):
                    raise PermissionError(1, "Operation not permitted")
                replace(source, to)

            with mock.patch("os.replace", fails):
                self.assertIn("m.yaml", self.refused(bpy.ops.vantage.export_mission, filepath=str(mission)))
                self.assertEqual({file.name: file.read_bytes() for file in folder.iterdir()}, before)
                mission.unlink(), scene.unlink()
                self.refused(bpy.ops.vantage.export_mission, filepath=str(mission))
            self.assertEqual(list(folder.iterdir()), [])
            mission.mkdir()
            scene.write_bytes(before["m.scene.obj"])
            self.assertIn("m.yaml", self.refused(bpy.ops.vantage.export_mission, filepath=str(mission)))
            self.assertEqual(scene.read_bytes(), before["m.scene.obj"])

    def test_nothing_is_saved_before_a_volume_is_computed(self):
        self.refused(bpy.ops.vantage.save_volume, filepath=os.path.join(tempfile.gettempdir(), "none.ply"))


    def test_an_old_volume_is_not_saved(self):
        self.use_square()
        self.compute()
        house = bpy.data.objects["house 3"]
        changes = [lambda: setattr(house, "location", (0, 0, 5)), lambda: house.hide_set(True),
                   lambda: setattr(self.settings, "max_range", 50)]
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "volume.ply")
            for change in changes:
                bpy.ops.vantage.save_volume(filepath=file)
                saved = pathlib.Path(file).read_bytes()
                change()
                self.refused(bpy.ops.vantage.save_volume, filepath=file)
                self.assertEqual(pathlib.Path(file).read_bytes(), saved)
                self.assertTrue(live.follower.is_stale)
                self.compute()
