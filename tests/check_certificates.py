#!/usr/bin/env python3
"""Tests of tools/check_certificate.py: right certificates are accepted, and none that was tampered with.

    check_certificates.py VANTAGE      # the program
"""

import copy
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared" / "data"
sys.path.insert(0, str(ROOT / "tools"))
import check_certificate as checker  # noqa: E402

VANTAGE = ""
SQUARE = "vertices: [[-2, -2, 0.1], [2, -2, 0.1], [2, 2, 0.1], [-2, 2, 0.1]]"


def block(low, high, first, name="block"):
    """A box of an OBJ file, of twelve triangles; `first` is the number of its first vertex."""
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    lines = [f"o {name}"] + [f"v {x} {y} {z}" for x, y, z in corners]
    for a, b, c, d in quads:
        lines += [f"f {a + first} {b + first} {c + first}", f"f {a + first} {c + first} {d + first}"]
    return lines


def city(seed=1, blocks=7, scale=1.0, origin=(0.0, 0.0, 0.0)):
    """A ground and blocks round a clearing."""
    numbers = random.Random(seed)
    place = lambda p: [o + scale * x for o, x in zip(origin, p)]  # noqa: E731
    lines = ["o ground"] + ["v {} {} {}".format(*place(p)) for p in
                            [(-60, -60, 0), (60, -60, 0), (60, 60, 0), (-60, 60, 0)]] + ["f 1 2 3", "f 1 3 4"]
    for i in range(blocks):
        x, y = 0, 0
        while max(abs(x), abs(y)) < 9:
            x, y = numbers.uniform(-45, 45), numbers.uniform(-45, 45)
        low, high = (x, y, 0), (x + numbers.uniform(2, 7), y + numbers.uniform(2, 7), numbers.uniform(3, 20))
        lines += block(place(low), place(high), 5 + 8 * i)
    return "\n".join(lines) + "\n"


def write_ply(path, vertices, triangles, objects=None, comments=()):
    """As vantage writes it."""
    extra = "property uint object\n" if objects is not None else ""
    header = "ply\nformat binary_little_endian 1.0\n" + "".join(f"comment {c}\n" for c in comments)
    header += f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
    header += f"element face {len(triangles)}\nproperty list uchar int vertex_indices\n{extra}end_header\n"
    pack = checker.struct.pack
    rows = b"".join(pack("<3d", *v) for v in vertices)
    for i, triangle in enumerate(triangles):
        rows += pack("<B3i", 3, *triangle) + (pack("<I", objects[i]) if objects is not None else b"")
    path.write_bytes(header.encode() + rows)


class Certificates(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.certificate = self.folder / "volume.cert"

    def run_vantage(self, *arguments, also=0):
        result = subprocess.run([VANTAGE, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, check=False, env=os.environ | {"VANTAGE_PROGRESS": "never"})
        self.assertIn(result.returncode, (0, also), result.stdout)

    def make(self, target=SQUARE, more="", max_range=50, obj=None, sensor="", **options):
        (self.folder / "city.obj").write_text(obj or city(), encoding="utf-8")
        mission = f"scene: {{mesh: city.obj}}\n{target if target.startswith('target') else 'target: {' + target + '}'}\n"
        mission += f"sensor: {{{sensor or f'max_range: {max_range}'}}}\n{more}"
        (self.folder / "mission.yaml").write_text(mission, encoding="utf-8")
        self.prove(self.folder / "mission.yaml", **options)

    def prove(self, mission, *options, also=0):
        self.run_vantage("compute", str(mission), "-q", "-o", "volume.ply")
        self.run_vantage("prove", str(mission), "volume.ply", "-q", "--certificate", "volume.cert", *options, also=also)

    def accepted(self, **options):
        lines = []
        checker.check(self.certificate, lines.append, **options)
        return lines

    def read(self):
        return json.loads(self.certificate.read_text(encoding="utf-8"))

    def refused_after(self, change, why=""):
        """`change` alters the certificate; afterwards all is as it was."""
        kept = self.certificate.read_text(encoding="utf-8")
        certificate = self.read()
        change(certificate)
        self.assertNotEqual(certificate, self.read(), "nothing was changed")
        self.certificate.write_text(json.dumps(certificate), encoding="utf-8")
        with self.assertRaises((checker.Refused, checker.Unreadable)) as caught:
            self.accepted()
        self.certificate.write_text(kept, encoding="utf-8")
        self.assertIn(why, str(caught.exception))

    def forge(self, name, change):
        """A mesh changed by somebody who mends the hashes and takes out what the volume says of itself."""
        with_statement = {p: p.read_bytes() for p in self.folder.iterdir() if p.suffix in (".ply", ".cert")}
        mesh = checker.Mesh(self.folder / name)
        change(mesh)
        is_scene = name.endswith("scene.ply")
        write_ply(self.folder / name, mesh.vertices, mesh.triangles, mesh.objects if is_scene else None)
        volume = checker.Mesh(self.folder / "volume.ply")
        if volume.comments:
            write_ply(self.folder / "volume.ply", volume.vertices, volume.triangles)
        certificate = self.read()
        certificate["scene"]["hash"] = checker.Mesh(self.folder / "volume.scene.ply").hash(b"scene")
        certificate["volume"]["hash"] = checker.Mesh(self.folder / "volume.ply").hash(b"volume")
        self.certificate.write_text(json.dumps(certificate), encoding="utf-8")
        return with_statement

    def refused_with(self, name, change, why=""):
        kept = self.forge(name, change)
        with self.assertRaises((checker.Refused, checker.Unreadable)) as caught:
            self.accepted()
        for path, data in kept.items():
            path.write_bytes(data)
        self.assertIn(why, str(caught.exception))


class Accepted(Certificates):
    def test_a_city(self):
        self.make(more="navigation: {altitude: [5, 30]}\n")
        lines = self.accepted()
        self.assertIn("accepted: sight, range, front, altitude from [None, None, 5.0] to [None, None, 30.0]", lines[-3])
        self.assertNotIn("names none", "".join(lines))

    def test_at_all_sizes_and_places(self):
        for scale, origin in [(1e-4, (0, 0, 0)), (1, (5e5, 5.4e6, 100)), (100, (-1e6, 2e6, 0))]:
            corners = [[o + scale * x for o, x in zip(origin, p)] for p in [(-2, -2, .5), (2, -1.5, .5), (1, 2, .5)]]
            with self.subTest(scale=scale):
                self.make(f"vertices: {corners}", obj=city(2, 8, scale, origin), max_range=40 * scale)
                self.accepted()

    def test_kinds_of_targets(self):
        for target in ["vertices: [[-3, 0, 2], [3, 1, 2], [3, 1, 6], [-3, 0, 6]]", "point: [0, 0, 4]",
                       "point: [1, 2, 4], front: [1, 2, 3]", "vertices: [[-2, -2, 1], [3, -2, 2], [0, 3, 3]]"]:
            with self.subTest(target=target):
                self.make(target)
                self.accepted()

    def test_parts_and_several_targets(self):
        parts = "parts: [[[-4, 0, 1], [-2, 0, 1], [-3, 2, 1]], [[2, 0, 1], [4, 0, 1], [3, 2, 1]]]"
        self.make(parts)
        self.assertEqual(len(self.accepted()), 2 * 2 + 3)
        self.make(f"targets:\n  - {{{SQUARE}}}\n  - {{vertices: [[0, 3, 2], [2, 3, 2], [1, 3, 4]]}}\ncombine: all")
        self.assertEqual(len(self.accepted()), 2 * 2 + 3)

    def test_targets_that_were_raised(self):
        """Above the surface that they lie on, which is not plane."""
        for scale, target in [(1, SQUARE), (1e-3, SQUARE), (1, "point: [0.3, 0.2, 0.1]"), (40, SQUARE),
                              (1, "point: [0.3, 0.2, 0.1], front: [0.1, 0, 1]")]:
            numbers, low = random.Random(7), 1e-3 * min(1, scale)
            places = [(x, y, 0.1 * scale + numbers.uniform(-low, low)) for x in range(-8, 9, 2) for y in range(-8, 9, 2)]
            roof = ["o roof"] + [f"v {x * scale} {y * scale} {z}" for x, y, z in places]
            for i in range(8):
                for a in range(9 * i + 1, 9 * i + 9):
                    roof += [f"f {a} {a + 9} {a + 10}", f"f {a} {a + 10} {a + 1}"]
            scene = roof + block((12 * scale, -5 * scale, 0), (14 * scale, 5 * scale, 12 * scale), 82)
            corners = checker.re.sub(r"-?[0-9][0-9.]*", lambda n: str(float(n[0]) * scale), target)
            with self.subTest(scale=scale, target=target):
                self.make(corners, obj="\n".join(scene) + "\n", max_range=50 * scale)
                header = (self.folder / "volume.ply").read_bytes().split(b"end_header")[0]
                said = json.loads(b"".join(line[24:] for line in header.split(b"\n") if b"vantage volume: " in line))
                self.assertGreater(said["lift_m"][0], 1e-5 * min(1, scale))
                self.accepted()

    def test_a_map(self):
        """It has a place on the earth, and names that are not ASCII."""
        town = (ROOT / "examples" / "town" / "town.osm").read_text(encoding="utf-8")
        self.assertIn('k="name" v="', town)
        (self.folder / "town.osm").write_text(town.replace('k="name" v="', 'k="name" v="Stra\u00dfe '), encoding="utf-8")
        mission = (ROOT / "examples" / "town" / "mission.yaml").read_text(encoding="utf-8")
        (self.folder / "mission.yaml").write_text(mission, encoding="utf-8")
        self.prove(self.folder / "mission.yaml")
        header = (self.folder / "volume.ply").read_bytes().split(b"end_header")[0]
        self.assertIn(b"comment vantage georeference:", header)
        self.assertIn("Stra\u00dfe".encode(), header)
        self.accepted()

    def test_a_scene_that_is_far_away(self):
        self.make(obj="\n".join(block((500, 500, 0), (510, 510, 9), 1)) + "\n")
        self.accepted()

    def test_a_real_city(self):
        mission = ROOT / "docs" / "gallery" / "charlotte.yaml"
        if not (SHARED / "charlotte").is_dir():
            self.skipTest("there is no ../shared/data")
        self.prove(mission)
        self.accepted()
        self.assertLess(self.certificate.stat().st_size, (self.folder / "volume.ply").stat().st_size)

    def test_a_range_of_pixels(self):
        """The header then has no max_range_m."""
        self.make(sensor="camera: {model: sony_a7r_iv_35mm}, pixel: {size: 0.005, kind: perpendicular}",
                  also=4)  # the orientations of the camera may stay open
        self.assertNotIn(b'"max_range_m"', (self.folder / "volume.ply").read_bytes())
        reach = self.read()["max_range_m"]
        self.accepted()
        self.refused_after(lambda c: c.update(max_range_m=1.01 * reach), "a shorter range")
        self.refused_after(lambda c: c.update(max_range_m=1e300), "a shorter range")
        self.refused_after(lambda c: c.update(max_range_m=0.99 * reach), "beyond the range")

    def test_a_proof_of_less(self):
        """The certificate is as it should be, but says little."""
        self.make()
        self.prove(self.folder / "mission.yaml", "--shrink", "0.01")
        with self.assertRaisesRegex(checker.Refused, "out of range"):
            self.accepted()
        self.assertIn("less 0.01 of the distance", self.accepted(most_shrink=0.01)[-2])
        tool = [sys.executable, str(ROOT / "tools" / "check_certificate.py"), str(self.certificate)]
        codes = [subprocess.run(tool + more, capture_output=True, check=False).returncode
                 for more in ([], ["--most-shrink", "0.01"], ["--most-shrink", "1"])]
        self.assertEqual(codes, [1, 0, 1])

    def test_it_is_the_same_each_time(self):
        self.make()
        first = self.certificate.read_bytes()
        self.make()
        self.assertEqual(first, self.certificate.read_bytes())

    def test_the_program(self):
        self.make()
        tool = [sys.executable, str(ROOT / "tools" / "check_certificate.py")]
        run = lambda: subprocess.run(tool + [str(self.certificate)], capture_output=True, text=True, check=False)  # noqa: E731
        self.assertEqual((run().returncode, run().stderr), (0, ""))
        text = self.certificate.read_text(encoding="utf-8")
        self.certificate.write_text(text.replace('"shrink":1e-06', '"shrink":0'), encoding="utf-8")
        self.assertEqual(run().returncode, 1)
        self.certificate.write_text(text[:len(text) // 2], encoding="utf-8")
        self.assertEqual(run().returncode, 2)
        self.assertNotIn("Traceback", run().stderr)


class Tampered(Certificates):
    """Each change is by somebody who wants a wrong volume to pass."""

    def setUp(self):
        super().setUp()
        self.make(more="navigation: {altitude: [0, 30]}\n")
        self.accepted()

    def part(self, change, why=""):
        """`change` gets a part with its steps and facets as lists; a plane is a list of three numbers."""
        def change_lists(certificate):
            part = certificate["parts"][0]
            steps = checker.re.findall(checker.STEP, part["steps"])
            part["steps"] = [[int(n, 36) for n in s[1:-1].split(",")] if s[0] == "(" else s for s in steps]
            part["facets"] = [int(n, 36) for n in part["facets"].split()]
            change(part)
            part["steps"] = "".join(s if isinstance(s, str) else f"({','.join(map(self.digits, s))})"
                                    for s in part["steps"])
            part["facets"] = " ".join(map(self.digits, part["facets"]))

        self.refused_after(change_lists, why)

    def digits(self, number):
        """To the base of 36."""
        text, rest = "", abs(number)
        while rest or not text:
            text, rest = "0123456789abcdefghijklmnopqrstuvwxyz"[rest % 36] + text, rest // 36
        return "-" * (number < 0) + text

    def planes(self, part):
        """Where new planes are among the steps."""
        return [i for i, step in enumerate(part["steps"]) if isinstance(step, list)]

    def test_planes(self):
        def change_plane(index, change):
            def change_part(part):
                at = self.planes(part)[index]
                part["steps"][at] = change(part["steps"][at])
            return change_part

        def another(part):
            first, last = self.planes(part)[0], self.planes(part)[-1]
            part["steps"][last] = part["steps"][first]

        for change in (change_plane(3, lambda n: [-x for x in n]), change_plane(-1, lambda n: n[1:] + n[:1]),
                       change_plane(0, lambda n: [0, 0, 0]), another):
            self.part(change, "a plane does not separate")
        self.part(change_plane(0, lambda n: n[:2]), "between the steps")
        self.part(change_plane(0, lambda n: n + [-1]), "between the steps")
        self.refused_after(lambda c: c["parts"][0].update(steps=c["parts"][0]["steps"].replace(",", ",.", 1)),
                           "between the steps")

    def test_steps(self):
        def all_known(part):
            part["steps"] = ["0" if s == checker.DESCEND else s for s in part["steps"]]

        self.part(all_known)
        self.part(lambda p: p.update(steps=[checker.NOTHING] * len(p["steps"])), "is left out")
        self.part(lambda p: p.update(steps=[checker.LEAVE] * 4 * len(p["facets"])), "without a plane")
        self.part(lambda p: p.update(steps=p["steps"][:-1]), "end too early")
        self.part(lambda p: p["steps"].append("0"), "more steps")
        self.part(lambda p: p.update(steps=[]), "end too early")
        self.part(lambda p: p["steps"].__setitem__(0, "7"), "not known")
        self.part(lambda p: p["steps"].insert(1, "x"), "between the steps")

    def test_facets(self):
        self.part(lambda p: p["facets"].pop(), "a facet is left out")
        self.part(lambda p: p["facets"].__setitem__(5, p["facets"][6]), "a facet is named twice")
        self.part(lambda p: p["facets"].__setitem__(0, 10**6), "does not have")
        self.part(lambda p: p["facets"].append(10**6), "does not have")
        self.part(lambda p: p["facets"].reverse())
        self.part(lambda p: p.update(facets=[], steps=[]), "a facet is left out")

    def test_targets(self):
        larger = [[2 * p[0], 2 * p[1], p[2]] for p in self.read()["parts"][0]["target"]]
        self.part(lambda p: p.update(target=larger), "target is not the volume's")
        self.part(lambda p: p.update(shift_m=1.0), "target is not the volume's")
        self.part(lambda p: p.update(corners=[[x / 2 for x in c] for c in p["corners"]]), "smaller than the target")
        self.part(lambda p: p.update(corners=p["corners"][:3]), "smaller than the target")
        self.part(lambda p: p.update(corners=[[0, 0, 0]] * 4), "no area")
        self.part(lambda p: p.update(corners=[[-9, 0, 0], [9, 0, 0]] * 2), "no area")
        self.part(lambda p: p.update(corners=[c[:2] + [-1] for c in p["corners"]]), "stated plane")
        self.part(lambda p: p.update(normal=[0, 0, -1]), "does not look")
        self.part(lambda p: p.update(normal=[0, 0.1, 0.995]))
        self.part(lambda p: p.update(centre=[-1e8, 0, 0.1]))
        self.part(lambda p: p.update(centre=[3, 0, 0.1], corners=[[x - 3, y, z] for x, y, z in p["corners"]]),
                  "centre is not in the target")
        self.part(lambda p: p["centre"].__setitem__(2, p["centre"][2] + 9e-4), "the plane is moved")
        self.part(lambda p: p.update(corners=p["corners"] + [[-1e15, 0, 0]], cut_height_m=0.1), "than rounding needs")
        self.part(lambda p: p.update(normal=[0, 0, 1e-9]), "unit length")
        self.part(lambda p: p.update(cut_height_m=1.0), "left out than rounding needs")
        self.part(lambda p: p.update(cut_height_m=-1.0), "left out than rounding needs")
        self.part(lambda p: p.update(cut_height_m=None), "only a point")
        self.part(lambda p: p["centre"].__setitem__(2, 50.0))
        self.part(lambda p: p["centre"].__setitem__(0, 1.0))

    def test_a_tilted_target(self):
        """The cut with it, so that more of the scene is left out at one end. The volume begins high over the target."""
        self.make(more="navigation: {altitude: [5, 30]}\n")
        for tilt in (9e-7, 1e-9, 1e-11):
            def change(part, tilt=tilt):
                part["normal"] = [tilt, 0, (1 - tilt**2)**0.5]
                part["corners"] = [[x, y, -tilt * x] for x, y, _ in part["corners"]]
            self.part(change, "stated side")

    def test_what_is_stated(self):
        self.refused_after(lambda c: c.update(shrink=0))
        self.refused_after(lambda c: c.update(shrink=-1e-5), "out of range")
        self.refused_after(lambda c: c.update(shrink=1), "out of range")
        for shrink in (0.999999, 0.0011):  # what was proved of more is true of less
            self.refused_after(lambda c, shrink=shrink: c.update(shrink=shrink), "out of range")
        self.refused_after(lambda c: c.update(max_range_m=40), "beyond the range")
        self.refused_after(lambda c: c.update(rounding_m=100), "was not rounded so much")
        self.refused_after(lambda c: c["boxes"][0]["max"].__setitem__(2, 29), "outside of altitude")
        self.refused_after(lambda c: c["boxes"][0]["min"].__setitem__(2, 1), "outside of altitude")
        self.refused_after(lambda c: c.update(parts=[]))
        self.refused_after(lambda c: c.update(format="vantage certificate 2"), "another version")
        self.refused_after(lambda c: c.update(mission_hash="0" * 64), "another mission")
        self.refused_after(lambda c: c["scene"].update(hash="0" * 64), "the scene is not")
        self.refused_after(lambda c: c["volume"].update(hash="0" * 64), "the volume is not")
        self.refused_after(lambda c: c["volume"].update(file="gone.ply"), "gone.ply")
        self.refused_after(lambda c: c["volume"].update(file="../volume.ply"), "another folder")
        self.refused_after(lambda c: c["boxes"].append({"name": "clearance", "min": 3 * [None], "max": 3 * [None]}),
                           "is no box")
        self.refused_after(lambda c: c.update(max_range_m=51), "a shorter range")
        self.refused_after(lambda c: c.update(max_range_m="50"), "garbled")
        self.refused_after(lambda c: c.update(max_range_m=10**400), "garbled")
        self.refused_after(lambda c: c["volume"].update(file="volume.scene.ply"), "the volume is not")
        self.refused_after(lambda c: c.pop("boxes"), "garbled")
        self.refused_after(lambda c: c.update(shrink="much"), "garbled")
        self.refused_after(lambda c: c.pop("mission_hash"), "garbled")
        self.refused_after(lambda c: c["parts"][0]["centre"].__setitem__(0, float("nan")))

    def test_another_scene(self):
        def add(mesh):  # a triangle over the target
            first = len(mesh.vertices)
            mesh.vertices += [(-1.0, -1.0, 3.0), (1.0, -1.0, 3.0), (0.0, 1.0, 3.0)]
            mesh.triangles.append((first, first + 1, first + 2))
            mesh.objects.append(0)

        def grow(mesh):
            mesh.vertices = [(x, y, 1.5 * z) for x, y, z in mesh.vertices]

        self.refused_with("volume.scene.ply", add)
        self.refused_with("volume.scene.ply", grow)
        self.refused_with("volume.scene.ply", lambda m: m.triangles.pop(20) and m.objects.pop(20))
        shutil.copy(self.folder / "volume.ply", self.folder / "volume.scene.ply")
        with self.assertRaisesRegex(checker.Refused, "the scene is not"):
            self.accepted()

    def test_another_volume(self):
        def scaled(factor):
            def change(mesh):
                centre = self.read()["parts"][0]["centre"]
                mesh.vertices = [tuple(c + factor * (x - c) for x, c in zip(v, centre)) for v in mesh.vertices]
            return change

        def far_vertex_out(mesh):
            i = max(range(len(mesh.vertices)), key=lambda v: sum(x * x for x in mesh.vertices[v]))
            mesh.vertices[i] = tuple(1.01 * x for x in mesh.vertices[i])

        def shell(mesh):  # a second one, inside out and beside it
            first = len(mesh.vertices)
            mesh.vertices += [(x + 200, y, z) for x, y, z in mesh.vertices]
            mesh.triangles += [(a + first, c + first, b + first) for a, b, c in mesh.triangles]

        kept = self.forge("volume.ply", lambda mesh: None)
        self.assertIn("names none", "".join(self.accepted()))  # what was forged is in order but for the change
        for path, data in kept.items():
            path.write_bytes(data)
        self.refused_with("volume.ply", scaled(1.000002))
        self.refused_with("volume.ply", far_vertex_out)
        self.refused_with("volume.ply", lambda m: m.triangles.pop(), "not closed")
        self.refused_with("volume.ply", lambda m: m.triangles.clear(), "no triangles")
        self.refused_with("volume.ply", shell)
        data = (self.folder / "volume.ply").read_bytes()
        (self.folder / "volume.ply").write_bytes(data[:-40])
        with self.assertRaisesRegex(checker.Unreadable, "cut short"):
            self.accepted()

    def test_what_a_volume_cannot_say_of_itself(self):
        """The header is not in the hash: it is believed as far as that does no harm."""
        volume = self.folder / "volume.ply"
        kept, certificate = volume.read_bytes(), self.certificate.read_text(encoding="utf-8")

        def refused(old, new, change, why):
            self.assertIn(old, kept)
            volume.write_bytes(kept.replace(old, new, 1))
            self.refused_after(change, why)
            volume.write_bytes(kept)
            self.assertEqual(self.certificate.read_text(encoding="utf-8"), certificate)

        def lift_by(by):
            def change(certificate):
                part = certificate["parts"][0]
                part["shift_m"] += by
                part["centre"][2] += by
            return change

        refused(b"rounding_m 0\n", b"rounding_m 1000\n", lambda c: c.update(rounding_m=1000), "cannot be rounded")
        lift = b'"lift_m":[0.0]'
        step = max(abs(x) for v in checker.Mesh(volume).vertices for x in v) * 2**-53
        refused(b"rounding_m 0\n", b"rounding_m %r\n" % (17 * step), lambda c: c.update(rounding_m=17 * step),
                "cannot be rounded")
        refused(lift, b'"lift_m":[1.0]', lambda c: c["parts"][0].update(shift_m=1.0), "stated plane")
        refused(lift, b'"lift_m":[2.0e-3]', lift_by(2e-3), "behind the target")
        refused(lift, b'"lift_m":[-2.0e-3]', lift_by(-2e-3), "lowered")
        refused(lift, b'"lift_m":[]', lambda c: c["parts"].append(c["parts"][0]), "parts are not")
        refused(b"element face", b"element vertex 0\nproperty double x\nelement face", lambda c: c.update(shrink=2e-6), "PLY")
        header, rows = kept.split(b"end_header\n", 1)
        count = len(checker.Mesh(volume).vertices)
        named, with_one = b"element vertex %d\n" % count, b"element vertex %d\n" % (count + 1)
        self.assertIn(named, header)
        one_far_away = (header.replace(named, with_one).replace(b"rounding_m 0\n", b"rounding_m 1e-6\n") +
                        b"end_header\n" + rows[:24 * count] + checker.struct.pack("<3d", 9e8, 0, 0) + rows[24 * count:])
        refused(kept, one_far_away, lambda c: c.update(rounding_m=1e-6), "cannot be rounded")  # no triangle has it
        refused(b"vertex_indices", b"vertex_index", lambda c: c.update(shrink=2e-6), "PLY")
        refused(b"property double y", b"property double x", lambda c: c.update(shrink=2e-6), "PLY")

    def test_vertices_that_no_triangle_has(self):
        """They are in no hash: whoever appends some may not raise the target with them, nor widen a tolerance."""
        self.make(more="navigation: {altitude: [5, 30]}\n")

        def append(name, places):
            path = self.folder / name
            data, count = path.read_bytes(), len(checker.Mesh(path).vertices)
            header, rows = data.split(b"end_header\n", 1)
            header = header.replace(b"element vertex %d\n" % count, b"element vertex %d\n" % (count + len(places)))
            more = b"".join(checker.struct.pack("<3d", *p) for p in places)
            path.write_bytes(header + b"end_header\n" + rows[:24 * count] + more + rows[24 * count:])

        def lift(by):
            volume = self.folder / "volume.ply"
            said = volume.read_bytes()
            self.assertIn(b'"lift_m":[0.0]', said)
            volume.write_bytes(said.replace(b'"lift_m":[0.0]', b'"lift_m":[%r]' % by))
            certificate = self.read()
            certificate["parts"][0]["shift_m"] += by
            certificate["parts"][0]["centre"][2] += by
            self.certificate.write_text(json.dumps(certificate), encoding="utf-8")

        stairs = [(50.0, 50.0, 0.1 + i * 9e-7) for i in range(3000)]
        kept = {path: path.read_bytes() for path in self.folder.iterdir()}
        for name in ("volume.ply", "volume.scene.ply"):
            for places, by, why in [([(9e8, 0.0, 0.0)], 0, ""), (stairs, 0, ""), ([(9e8, 0.0, 0.0)], 6e-6, "raised by more"),
                                    (stairs, 1.99e-3, "raised by more"), ([(1e14, 0.0, 0.0)], 0, "larger than 1e9")]:
                with self.subTest(name=name, vertices=len(places), lift=by):
                    append(name, places)
                    if by:
                        lift(by)
                    if why:
                        with self.assertRaisesRegex((checker.Refused, checker.Unreadable), why):
                            self.accepted()
                    else:
                        self.accepted()
                for path, data in kept.items():
                    path.write_bytes(data)

    def test_garbage(self):
        """Whatever is changed, the answer is one of three."""
        seed = 20261122
        print("seed", seed)
        numbers = random.Random(seed)
        texts = {p: p.read_bytes() for p in (self.certificate, self.folder / "volume.ply",
                                             self.folder / "volume.scene.ply")}
        answers = {"accepted": 0, "refused": 0, "unreadable": 0}
        for _ in range(120):
            path = numbers.choice(list(texts))
            data = bytearray(texts[path])
            for _ in range(numbers.choice([1, 1, 2, 10])):
                at = numbers.randrange(len(data))
                kind = numbers.randrange(4)
                if kind == 0:
                    data[at] = numbers.randrange(256)
                elif kind == 1:
                    del data[at:at + numbers.randrange(1, 20)]
                elif kind == 2:
                    data[at:at] = data[numbers.randrange(len(data)):][:numbers.randrange(1, 20)]
                else:
                    data[at] = ord(numbers.choice("0123456789-[]{},.\"enul"))
            path.write_bytes(data)
            try:
                before = copy.deepcopy(json.loads(texts[self.certificate]))
                self.accepted()
                answers["accepted"] += 1
                after = self.read()
                for key in ("scene", "volume", "mission_hash"):
                    self.assertEqual(before[key], after[key])
                self.assertLessEqual(before["shrink"], after["shrink"])
                self.assertLessEqual(after["shrink"], checker.MOST_SHRINK)
                self.assertEqual(before["max_range_m"], after["max_range_m"])
            except checker.Refused:
                answers["refused"] += 1
            except checker.Unreadable:
                answers["unreadable"] += 1
            path.write_bytes(texts[path])
        print(answers)
        self.assertGreater(min(answers["refused"], answers["unreadable"]), 10)


if __name__ == "__main__":
    VANTAGE = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
