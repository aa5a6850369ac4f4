#!/usr/bin/env python3
"""Tests of tools/check_tour.py: right certificates are accepted, and none that was tampered with.

    check_tours.py [VANTAGE]      # with the program: 'vantage verify-tour' must come to the same verdicts

The certificates are made here, by hand: weak ones, but right. test_tour_bound_certificate.cpp has those of vantage.
"""

import copy
import hashlib
import itertools
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import check_tour as checker  # noqa: E402

VANTAGE = ""
UNIT = 1 << 30
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
BOXES = [((0, 0, 0), (2, 2, 2)), ((30, 0, 1), (33, 2, 4)), ((32, 28, 0), (35, 30, 3)), ((1, 31, 0), (4, 34, 2)),
         ((14, 40, 5), (17, 43, 9))]


def box(low, high):
    vertices = [tuple(float((low, high)[i >> k & 1][k]) for k in range(3)) for i in range(8)]
    return vertices, [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]


def ply(vertices, triangles, comment="vantage region: outer"):
    header = (f"ply\nformat binary_little_endian 1.0\ncomment {comment}\nelement vertex {len(vertices)}\n"
              f"property double x\nproperty double y\nproperty double z\nelement face {len(triangles)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    return (header.encode() + b"".join(struct.pack("<3d", *v) for v in vertices) +
            b"".join(struct.pack("<B3i", 3, *t) for t in triangles))


def hash_of(vertices, triangles):
    """docs/hashes.md, of a volume."""
    digest = hashlib.sha256(b"vantage volume 1\n" + struct.pack("<Q", len(triangles)))
    for triangle in triangles:
        digest.update(struct.pack("<9d", *(x + 0.0 for c in triangle for x in vertices[c])))
    return digest.hexdigest()


def towards(a, b):
    """The unit vector, in whole numbers, not longer than 1."""
    difference = [y - x for x, y in zip(a, b)]
    length = math.sqrt(sum(x * x for x in difference))
    return [int(0.999999999 * UNIT * x / length) for x in difference] if length else [0, 0, 0]


def least(region, u):
    """Of u . v over the corners of a box, or of a place."""
    if "at" in region:
        return sum(a * b for a, b in zip(u, region["at"]))
    low, high = BOXES[int(region["name"][1:])]
    return sum(min(x * a, x * b) for x, a, b in zip(u, low, high))


def pairs_by_hand(certificate, leaf, inside, outside):
    """The formula of docs/theory.md, in doubles and term by term."""
    regions, rows = certificate["regions"], certificate["proof"]["vectors"][leaf[1]]
    origin, (p, d, sets), n = certificate["proof"]["origin"], leaf[2:], len(rows)

    def u(i, j):
        return [x / UNIT for x in rows[i][3 * j:3 * j + 3]] if j < i else [-x for x in u(j, i)]

    def cost(i, j, k):
        if i >= len(regions):
            return 0
        both = [a + b for a, b in zip(u(i, j), u(i, k))]
        stay = regions[i]["dwell_m"]
        of = least(regions[i], u(i, j)) + least(regions[i], u(i, k)) + stay if stay else least(regions[i], both)
        return of - sum(a * b for a, b in zip(both, origin))

    total = sum(2 * x for x in d) + sum(2 * s for s, _ in sets)
    for i in range(n):
        beside = [j for j in range(n) if j != i and {i, j} not in outside]
        pairs = [(j, k) for j in beside for k in beside if j < k]
        pairs = [q for q in pairs if all(next(iter(e - {i})) in q for e in inside if i in e)]
        total += min(cost(i, j, k) - p[i][j] - p[i][k] for j, k in pairs)
        for j in range(i):
            left = p[i][j] + p[j][i] - d[i] - d[j] - sum(s for s, of in sets if len({i, j} & set(of)) == 1)
            total += 0 if {i, j} in outside else left if {i, j} in inside else min(0, left)
    return total


def middle(i):
    return [(a + b) / 2 for a, b in zip(*BOXES[i])]


class Tours(unittest.TestCase):
    radius = 0.0

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.file = self.folder / "tour.cert"

    def regions(self, dwell=0.0):
        listed = []
        for i, (low, high) in enumerate(BOXES):
            mesh = box(low, high)
            (self.folder / f"r{i}.ply").write_bytes(ply(*mesh))
            listed.append({"name": f"r{i}", "kind": "outer", "dwell_m": dwell, "file": f"r{i}.ply",
                           "hash": hash_of(*mesh)})
        return listed

    def write(self, certificate):
        """With the largest bound that is proved."""
        certificate["bound_m"] = 0.0
        self.put(certificate)
        certificate["bound_m"] = self.proved()
        self.put(certificate)
        self.assertGreater(certificate["bound_m"], 30)

    def put(self, certificate):
        self.file.write_text(json.dumps(certificate), encoding="ascii")

    def proved(self):
        """Rounded down to a double."""
        certificate = json.loads(self.file.read_text(encoding="ascii"))
        tour = checker.Tour(certificate, self.folder)
        of = {"insertion": checker.check_insertion, "pairs": checker.check_pairs}
        exact = Fraction(of[certificate["proof"]["kind"]](tour, certificate["proof"]), UNIT << tour.bits)
        number = float(exact)
        return number if Fraction(number) <= exact else math.nextafter(number, -math.inf)

    def certificate(self, regions, proof, **more):
        return {"format": "vantage tour certificate 2", "bound_m": 0.0, "turn_radius_m": self.radius, "closed": True,
                "first": None, "last": None, "regions": regions, "proof": proof, **more}

    def leaf(self, stops, closed=True, dwell=False):
        """`stops`: points, each as often as its region has points."""
        legs = list(zip(stops, stops[1:] + stops[:1] * closed))
        return ["leaf", [x for a, b in legs for x in towards(a, b)]]

    def insertion(self):
        """Four regions by insertion, the fifth cut on the way."""
        order = [[0, 3, 1, 2], [0, 1, 3, 2], [0, 1, 2, 3]]
        tree = [["insert", 3]]
        for stops in order:
            tree += [["cut", stops.index(3), [0, 1, 0], 32.5], self.leaf([middle(s) for s in stops]),
                     ["cut", 0, [1, 1, 0], 100.0], ["empty"], self.leaf([middle(s) for s in stops])]
        self.write(self.certificate(self.regions()[:4], {"kind": "insertion", "root": [0, 1, 2], "tree": tree}))

    def open_with_dwell(self, within=(0, 0, 0)):
        """`within`: the vector of the stretch in each region."""
        regions = self.regions(dwell=8.0)[1:3] + [{"name": "home", "kind": "point", "dwell_m": 0.0, "at": [0.5, 1, 1]}]
        home = [0.5, 1, 1]
        one, two = middle(1), middle(2)
        tree = [["insert", 0], ["insert", 1], self.leaf([home, two, two, one, one], False),
                self.leaf([home, one, one, two, two], False)]
        for leaf in tree[2:]:
            leaf[1][3:6], leaf[1][9:12] = within, within
        self.write(self.certificate(regions, {"kind": "insertion", "root": [2], "tree": tree}, closed=False, first=2))

    def pairs(self, opened=False, dwell=0.0):
        regions, count = self.regions(dwell), len(BOXES)
        at = [middle(i) for i in range(count)]
        if opened:
            regions.append({"name": "home", "kind": "point", "dwell_m": 0.0, "at": [15, 15, 0]})
            at.append([15, 15, 0])
            count += 2
        vector = lambda i, j: towards(at[j], at[i]) if i < len(at) else [0, 0, 0]  # noqa: E731
        rows = [[x for j in range(i) for x in vector(i, j)] for i in range(count)]
        origin = [16.0, 20.0, 2.0]

        def p(i, j):
            if i == j or max(i, j) >= len(at):
                return 0.0
            u = [x / UNIT for x in towards(at[j], at[i])]
            return round(sum(a * (b - o) for a, b, o in zip(u, at[i], origin)) * 1024) / 1024

        table = [[p(i, j) for j in range(count)] for i in range(count)]
        d = [0.0 if opened and i == count - 1 else 10.0 for i in range(count)]
        leaf = ["leaf", 0, table, d, [[0.5, [0, 1]], [0.25, [2, 3, 4]]]]
        tree = [["edge", 0, 2], leaf, copy.deepcopy(leaf)]
        proof = {"kind": "pairs", "origin": origin, "vectors": [rows], "tree": tree}
        self.write(self.certificate(regions, proof, **({"closed": False, "first": 5} if opened else {})))

    def accepted(self):
        """The bound, where both judges accept; neither may accept what the other refuses."""
        verdict = self.verdict_of_the_program()
        try:
            bound = checker.check(self.file, lambda line: None)
        except (checker.Refused, checker.Unreadable):
            self.assertIn(verdict, (None, 1, 2))
            raise
        self.assertIn(verdict, (None, 0))
        return bound

    def verdict_of_the_program(self):
        if not VANTAGE:
            return None
        run = subprocess.run([VANTAGE, "verify-tour", str(self.file), "-q"], capture_output=True, text=True,
                             timeout=60, check=False)
        self.assertIn(run.returncode, (0, 1, 2), run.stderr)
        self.assertEqual(run.returncode == 2, run.stderr.startswith("vantage: "), run.stderr)
        return run.returncode

    def refused(self, change, why="", kind=checker.Refused):
        """After `change` of the certificate; afterwards all is as it was."""
        kept = {path: path.read_bytes() for path in self.folder.iterdir()}
        certificate = json.loads(self.file.read_text(encoding="ascii"))
        before = copy.deepcopy(certificate)
        change(certificate)
        if json.dumps(certificate) != json.dumps(before):
            self.put(certificate)
        self.assertTrue(kept != {path: path.read_bytes() for path in self.folder.iterdir()}, "nothing was changed")
        with self.assertRaisesRegex(kind, why):
            self.accepted()
        for path in self.folder.iterdir():
            path.unlink()
        for path, data in kept.items():
            path.write_bytes(data)

    def both(self, change, why=""):
        self.refused(change, why, (checker.Refused, checker.Unreadable))

    # ---- what is right ------------------------------------------------------

    def test_right_ones_are_accepted(self):
        makes = (self.insertion, self.open_with_dwell, self.pairs, lambda: self.pairs(True),
                 lambda: self.pairs(False, 3.0))
        for make, self.radius in itertools.product(makes, (0.0, 2.5, 300.0)):
            make()
            bound = json.loads(self.file.read_text(encoding="ascii"))["bound_m"]
            self.assertEqual(self.accepted(), Fraction(bound))
            run = subprocess.run([sys.executable, str(ROOT / "tools" / "check_tour.py"), str(self.file)], text=True,
                                 capture_output=True, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.refused(lambda c: c.update(bound_m=math.nextafter(c["bound_m"], math.inf)), "less is proved")

    def test_pairs_by_hand(self):
        for opened, dwell in ((False, 0.0), (True, 0.0), (False, 3.0), (True, 3.0)):
            self.pairs(opened, dwell)
            certificate = json.loads(self.file.read_text(encoding="ascii"))
            edge, one, other = certificate["proof"]["tree"]
            ends = [{5, 6}] if opened else []
            one[2][0][2] -= 4.0  # dear, but fixed
            for sets in ([], one[4], [[1.5, [1, 2]]]):
                one[4] = other[4] = sets
                self.put(certificate)
                expected = min(pairs_by_hand(certificate, one, ends + [{0, 2}], []),
                               pairs_by_hand(certificate, other, ends, [{0, 2}]))
                self.assertAlmostEqual(self.proved(), expected, 6)
                tour, both = checker.Tour(certificate, self.folder), []
                check = checker.leaf_of_pairs
                checker.leaf_of_pairs = lambda *of, check=check, both=both: both.append(check(*of)) or both[-1]
                checker.check_pairs(tour, certificate["proof"])
                checker.leaf_of_pairs = check
                self.assertAlmostEqual(float(Fraction(both[0], UNIT << tour.bits)),
                                       pairs_by_hand(certificate, one, ends + [{0, 2}], []), 6)

    def test_insertion_by_hand(self):
        """Of the open tour: home, two points in each of two regions."""
        for within in ((0, 0, 0), (UNIT // 2, 0, 0), (UNIT // 3, -UNIT // 2, UNIT // 5)):
            self.open_with_dwell(within)
            certificate, bounds = json.loads(self.file.read_text(encoding="ascii")), []
            for leaf, order in zip(certificate["proof"]["tree"][2:], ([2, 1, 1, 0, 0], [2, 0, 0, 1, 1])):
                u = [[0, 0, 0]] + [[x / UNIT for x in leaf[1][k:k + 3]] for k in range(0, 12, 3)] + [[0, 0, 0]]
                ways = [[a - b for a, b in zip(before, behind)] for before, behind in zip(u, u[1:])]
                bounds.append(sum(least(certificate["regions"][r], w) for r, w in zip(order, ways)) +
                              sum(8 * (1 - math.sqrt(sum(x * x for x in u[k]))) for k in (2, 4)))
            self.assertAlmostEqual(self.proved(), min(bounds), 6)

    def three(self, radius):
        """A leaf alone: a closed tour of three regions. Returns its vectors."""
        self.radius = radius
        leaf = self.leaf([middle(s) for s in (0, 1, 2)])
        self.write(self.certificate(self.regions()[:3], {"kind": "insertion", "root": [0, 1, 2], "tree": [leaf]}))
        return [leaf[1][k:k + 3] for k in (0, 3, 6)]

    def test_turning_by_hand(self):
        vectors = self.three(0.0)
        without, regions = self.proved(), json.loads(self.file.read_text(encoding="ascii"))["regions"]
        cost = lambda a: a - math.sin(a)  # noqa: E731
        level = [[x / UNIT for x in v[:2]] + [0] for v in vectors]
        rooms = [least(regions[(k + 1) % 3], u) + least(regions[k], [-x for x in u]) for k, u in enumerate(level)]
        for radius in (0.5, 3.0, 10.0, 40.0, 1000.0):
            self.three(radius)
            expected = 0
            for k in range(3):
                one, other = level[k - 1], level[k]
                sizes = math.hypot(*one), math.hypot(*other)
                angle = math.acos(sum(a * b for a, b in zip(one, other)) / sizes[0] / sizes[1])
                costs = [2 * cost(angle / 2)] + [cost(min(angle, rooms[i] / radius / 2)) for i in (k - 1, k)]
                expected += min(sizes) * radius * min(costs)
            self.assertLessEqual(self.proved() - without, expected + 1e-9)
            self.assertGreater(self.proved() - without, 0.93 * expected)  # series end
            self.refused(lambda c: c.update(turn_radius_m=c["turn_radius_m"] * (0.99 if radius < 4 else 3)), "less is")
            self.refused(lambda c: c.update(turn_radius_m=0), "less is proved")
            self.refused(lambda c: c.update(turn_radius_m=-c["turn_radius_m"]), "negative length")
            self.both(lambda c: c.pop("turn_radius_m"))
            self.both(lambda c: c.update(turn_radius_m="3"))
            self.both(lambda c: c.update(turn_radius_m=float("nan")))

    def test_turning_needs_every_home(self):
        """At a home a flight begins in another direction than it ends in: where it is no stop, that may be anywhere."""
        self.three(0.0)
        without = self.proved()
        self.three(3.0)
        self.assertGreater(self.proved(), without + 1)
        home = {"name": "home", "kind": "point", "dwell_m": 0.0, "at": [1, 1, 1]}
        self.refused(lambda c: c["regions"].append(home), "less is proved")
        self.refused(lambda c: (c["regions"].append(home), c.update(bound_m=without + 1e-6)), "less is proved")
        certificate = json.loads(self.file.read_text(encoding="ascii"))
        certificate["regions"].append(home)
        self.write(certificate)
        self.assertEqual(self.proved(), without)
        self.assertEqual(self.accepted(), Fraction(without))
        certificate["proof"] = {"kind": "insertion", "root": [3, 1, 2],
                                "tree": [["leaf", self.leaf([[1, 1, 1], middle(1), middle(2)])[1]]]}
        certificate["turn_radius_m"] = 0.0
        self.write(certificate)
        without = self.proved()
        certificate["turn_radius_m"] = 3.0
        self.write(certificate)
        self.assertGreater(self.accepted(), without + 1)

    def test_bounds_are_below_tours(self):
        """Random points of the boxes in random orders."""
        numbers = random.Random(20261126)
        for make, count in ((self.insertion, 4), (self.pairs, 5)):
            make()
            bound = float(self.accepted())
            for _ in range(2000):
                order = numbers.sample(range(count), count)
                points = [[numbers.uniform(a, b) for a, b in zip(*BOXES[i])] for i in order]
                self.assertGreater(sum(map(math.dist, points, points[1:] + points[:1])), bound)

    def test_cells_hold_what_they_should(self):
        """Random planes: no point of the box that is on their sides lies below the cell's least, in any direction."""
        numbers = random.Random(20261127)
        self.insertion()
        tour = checker.Tour(json.loads(self.file.read_text(encoding="ascii")), self.folder)
        for _ in range(60):
            cell, planes = tour.cells[numbers.randrange(4)], []
            low, high = BOXES[cell.region]
            for _ in range(numbers.randrange(1, 5)):
                normal = numbers.choice([(1, 0, 0), (0, 1, 0), (1, -1, 0), (0, 1, 1), (1, 1, 1)])
                inside = [numbers.uniform(a, b) for a, b in zip(low, high)]
                offset, side = checker.dot(normal, inside), numbers.randrange(2)
                planes.append((normal, offset, side))
                cell = cell.cut(normal, tour.whole(offset))[side]
            for polygon in cell.polygons:  # its corners, which were rounded
                for corner in polygon:
                    for u in ((1, 0, 0), (-1, 0, 0), (0, 0, 1), (-3, 5, -7)):
                        self.assertGreaterEqual(checker.dot(u, corner), cell.least(u) * corner[3])
            for _ in range(200):
                point = [numbers.uniform(a, b) for a, b in zip(low, high)]
                if all((checker.dot(n, point) >= o) == (side == 0) for n, o, side in planes):
                    u = tuple(numbers.randrange(-UNIT, UNIT) for _ in range(3))
                    self.assertGreaterEqual(checker.dot(u, tuple(map(tour.whole, point))), cell.least(u))

    def test_points_of_cuts_are_rounded_down(self):
        triangle = checker.Cell(0, [[(0, 0, 0, 1), (3, 1, 0, 1), (3, 0, 0, 1)]], False)
        below = triangle.cut((1, 0, 0), 2)[1]  # its highest corner is (2, 2/3, 0)
        for u in ((0, -1, 0), (0, -7, 0), (1, -9, 2)):
            exact = min(Fraction(checker.dot(u, c), c[3]) for p in below.polygons for c in p)
            self.assertLessEqual(below.least(u), exact)

    # ---- what was tampered with ---------------------------------------------

    def test_claims(self):
        self.insertion()
        self.refused(lambda c: c.update(bound_m=c["bound_m"] + 1e-9), "less is proved")
        self.refused(lambda c: c.update(bound_m=1e300))
        for number in ("NaN", "Infinity", "1e999", "true", '"1"', "[1]"):
            text = self.file.read_text(encoding="ascii")
            begin = text.index('"bound_m": ') + len('"bound_m": ')
            self.file.write_text(text[:begin] + number + text[text.index(",", begin):], encoding="ascii")
            with self.assertRaises((checker.Refused, checker.Unreadable)):
                self.accepted()
            self.file.write_text(text, encoding="ascii")

    def test_form(self):
        self.insertion()
        self.refused(lambda c: c.update(format="vantage tour certificate 1"), "another version")
        self.refused(lambda c: c.update(more=1), "keys")
        self.both(lambda c: c.pop("first"))
        self.both(lambda c: c["proof"].pop("root"))
        self.both(lambda c: c["proof"].update(kind="belief"))
        self.refused(lambda c: c["proof"].update(more=[]), "keys")
        self.refused(lambda c: c["regions"][0].update(at=[0, 0, 0]), "keys")
        self.refused(lambda c: c["regions"][0].update(name=["r0"]), "no text", checker.Unreadable)
        self.refused(lambda c: c["regions"][0].update(name=None), "no text", checker.Unreadable)
        self.both(lambda c: c.update(closed=1))
        self.both(lambda c: c.update(regions=[]))
        text = self.file.read_text(encoding="ascii")
        self.file.write_text(text.replace('"closed": true', '"closed": true, "closed": true'), encoding="ascii")
        with self.assertRaisesRegex(checker.Refused, "twice"):
            self.accepted()
        self.file.write_text(text[:-3], encoding="ascii")
        with self.assertRaises(checker.Unreadable):
            self.accepted()

    def test_tours(self):
        """A bound of closed tours is none of open ones, and so on."""
        self.insertion()
        self.refused(lambda c: c.update(closed=False, first=0), "an end is no place")
        self.refused(lambda c: c.update(closed=False), "ends that it cannot have")
        self.refused(lambda c: c.update(first=0), "ends that it cannot have")
        self.refused(lambda c: c["regions"].append(c["regions"][0] | {"name": "again", "dwell_m": -1.0}), "negative")
        self.open_with_dwell()
        self.refused(lambda c: c["proof"].update(root=[0]), "begin")
        self.refused(lambda c: c["proof"].update(root=[]), "begin")
        self.refused(lambda c: c.update(first=0), "an end is no place")
        self.refused(lambda c: c.update(last=2), "both ends")
        self.refused(lambda c: c.update(closed=True, first=None), "three regions")
        self.refused(lambda c: c["regions"][0].update(dwell_m=7.0), "less is proved")
        self.refused(lambda c: c["regions"][1].update(dwell_m=0.0), "another number of legs")
        self.refused(lambda c: c["regions"][2].update(at=[3.5, 1, 1]), "less is proved")
        self.both(lambda c: c["regions"][2].update(at=[float("nan"), 1, 1]))
        self.both(lambda c: c["regions"][2].update(at=[1, 1]))

    def test_vectors(self):
        self.insertion()

        def longer(c):
            numbers = c["proof"]["tree"][2][1]
            numbers[0:3] = [int(1.001 * x) for x in numbers[0:3]]

        self.refused(longer, "longer than 1")
        self.refused(lambda c: c["proof"]["tree"][2][1].__setitem__(0, UNIT + 1), "longer than 1")
        self.refused(lambda c: [n[1].reverse() for n in c["proof"]["tree"] if n[0] == "leaf"], "less is proved")
        self.refused(lambda c: c["proof"]["tree"][2][1].pop(), "three numbers")
        leaf = lambda c: c["proof"]["tree"][2]  # noqa: E731
        self.refused(lambda c: leaf(c).__setitem__(1, leaf(c)[1][:-3]), "number of legs")
        self.refused(lambda c: leaf(c).__setitem__(1, leaf(c)[1] + [0, 0, 0]), "number of legs")
        self.both(lambda c: c["proof"]["tree"][2][1].__setitem__(0, 0.5))
        self.both(lambda c: c["proof"]["tree"][2][1].__setitem__(0, True))
        self.both(lambda c: c["proof"]["tree"][2].__setitem__(1, "leaf"))

    def test_trees(self):
        self.insertion()
        tree = lambda c: c["proof"]["tree"]  # noqa: E731
        self.refused(lambda c: tree(c).pop(), "too early")
        self.refused(lambda c: tree(c).append(tree(c)[-1]), "too many")
        self.refused(lambda c: tree(c).clear(), "too early")
        self.refused(lambda c: tree(c).__setitem__(0, ["insert", 2]), "that is there")
        self.both(lambda c: tree(c).__setitem__(0, ["insert", 4]))
        self.both(lambda c: tree(c).__setitem__(0, ["insert", True]))
        self.refused(lambda c: c["proof"].update(root=[0, 1, 1]), "begin")
        self.refused(lambda c: c["proof"].update(root=[0, 1]), "begin")
        self.refused(lambda c: c["proof"].update(root=[3, 1, 2]), "that is there")
        self.refused(lambda c: tree(c).__setitem__(2, ["empty"]), "is not")
        self.both(lambda c: tree(c).__setitem__(2, ["skip"]))
        self.both(lambda c: tree(c).__setitem__(2, []))
        self.refused(lambda c: tree(c)[1].__setitem__(2, [0, 0, 0]), "no plane")
        self.refused(lambda c: tree(c)[1].__setitem__(2, [0, 2, 0]), "no plane")
        self.both(lambda c: tree(c)[1].__setitem__(1, 7))
        self.both(lambda c: tree(c)[1].__setitem__(3, float("nan")))
        self.refused(lambda c: tree(c)[3].__setitem__(3, 1.0), "is not")  # what was empty no longer is
        self.both(lambda c: tree(c)[4].append(1))
        # A stay may begin on one side of a plane and end on the other.
        self.refused(lambda c: c["regions"][3].update(dwell_m=8.0), "stays is cut")

    def test_meshes(self):
        self.insertion()
        low, high = BOXES[1]
        smaller = box(low, (high[0], high[1], high[2] - 1))
        larger = box((low[0] - 3, low[1], low[2]), high)
        put = lambda *mesh, **how: (self.folder / "r1.ply").write_bytes(ply(*mesh, **how))  # noqa: E731
        self.refused(lambda c: put(*smaller), "not the region")
        self.refused(lambda c: put(*larger), "not the region")
        self.refused(lambda c: c["regions"][1].update(hash="0" * 64), "not the region")
        self.refused(lambda c: put(*larger) and c["regions"][1].update(hash=hash_of(*larger)), "less is proved")
        self.refused(lambda c: put(*box(low, high), comment='vantage volume: {"method": "exact"}'), "computed volume")
        self.refused(lambda c: put(*box(low, high), comment="vantage region: given"), "another kind")
        self.refused(lambda c: c["regions"][1].update(kind="given"), "another kind")
        self.refused(lambda c: c["regions"][1].update(kind="inner"), "no bound can be over")
        self.refused(lambda c: c["regions"][1].update(file="../r1.ply"), "another folder")
        self.refused(lambda c: c["regions"][1].update(file="/r1.ply"), "another folder")
        self.refused(lambda c: c["regions"][1].update(file="gone.ply"), "no mesh", checker.Unreadable)
        self.refused(lambda c: put(*box(low, high), comment="of somebody"), "no mesh", checker.Unreadable)
        data = (self.folder / "r1.ply").read_bytes()
        self.refused(lambda c: (self.folder / "r1.ply").write_bytes(data[:-1]), "size", checker.Unreadable)
        vertices, triangles = box(low, high)
        self.refused(lambda c: put(vertices, triangles[:-1] + [(0, 1, 8)]), "no triangle")
        self.refused(lambda c: put(vertices, triangles[:-1] + [(0, 1, -1)]), "no triangle")
        self.refused(lambda c: put(vertices[:-1] + [(math.nan, 0, 0)], triangles), "not finite")
        self.refused(lambda c: put(vertices[:-1] + [(1e300, 0, 0)], triangles), "too large")
        # A vertex that no triangle has changes nothing, as it is in no hash.
        put(vertices + [(-5.0, -5.0, -5.0)], triangles)
        self.accepted()

    def test_pairs(self):
        for opened in (False, True):
            self.pairs(opened)
            proof = lambda c: c["proof"]  # noqa: E731
            leaf = lambda c: c["proof"]["tree"][2]  # noqa: E731
            self.refused(lambda c: leaf(c)[2][0].__setitem__(1, leaf(c)[2][0][1] + 5), "less is proved")
            self.refused(lambda c: leaf(c)[3].__setitem__(0, leaf(c)[3][0] + 100), "less is proved")
            self.refused(lambda c: leaf(c)[3].__setitem__(0, leaf(c)[3][0] - 100), "less is proved")
            self.refused(lambda c: leaf(c)[4][0].__setitem__(0, -0.5), "less than 0")
            self.refused(lambda c: leaf(c)[4][0].__setitem__(1, []), "no set")
            self.refused(lambda c: leaf(c)[4][0].__setitem__(1, list(range(len(leaf(c)[3])))), "no set")
            self.both(lambda c: leaf(c)[4][0].__setitem__(1, [99]))
            self.both(lambda c: leaf(c).__setitem__(1, 1))
            self.both(lambda c: leaf(c)[2].pop())
            self.both(lambda c: leaf(c)[2][0].pop())
            self.both(lambda c: leaf(c)[3].append(0))
            self.both(lambda c: leaf(c)[3].__setitem__(0, None))
            self.refused(lambda c: proof(c)["tree"].pop(), "too early")
            self.refused(lambda c: proof(c)["tree"].append(leaf(c)), "too many")
            self.refused(lambda c: proof(c)["tree"].__setitem__(0, ["edge", 2, 0]), "no edge")
            self.refused(lambda c: proof(c)["tree"].__setitem__(0, ["edge", 2, 2]), "no edge")
            self.both(lambda c: proof(c)["tree"].__setitem__(0, ["edge", 0, 99]))
            self.both(lambda c: proof(c)["tree"].__setitem__(1, ["leap"]))
            self.refused(lambda c: proof(c)["origin"].__setitem__(0, 0.0), "less is proved")
            self.both(lambda c: proof(c)["origin"].pop())
            self.refused(lambda c: proof(c)["vectors"][0][1].__setitem__(slice(0, 3), [0, 0, 0]), "less is proved")
            self.refused(lambda c: proof(c)["vectors"][0][1].__setitem__(0, 2 * UNIT), "longer than 1")
            self.both(lambda c: proof(c)["vectors"][0][2].__setitem__(slice(0, 3), []))
            self.both(lambda c: proof(c)["vectors"][0].pop())
        self.refused(lambda c: proof(c)["vectors"][0][6].__setitem__(0, 1), "everywhere")

    def test_garbage(self):
        """Whatever is changed, the answer is one of three, and never a bound that is larger."""
        seed = 20261128
        print("seed", seed)
        numbers = random.Random(seed)
        for make, self.radius in ((self.insertion, 4.0), (self.open_with_dwell, 0.0), (lambda: self.pairs(True), 1.0)):
            make()
            bound = self.accepted()
            kept = {path: path.read_bytes() for path in self.folder.iterdir()}
            for _ in range(150):
                path = numbers.choice([self.file, *sorted(kept)])
                data = bytearray(kept[path])
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
                    after = self.accepted()
                    before, now = json.loads(kept[self.file]), json.loads(self.file.read_text(encoding="ascii"))
                    about = lambda c: ([{**r, "name": ""} for r in c["regions"]], c["turn_radius_m"])  # noqa: E731
                    if about(before) == about(now):
                        self.assertLess(after, bound + 1)
                except (checker.Refused, checker.Unreadable):
                    pass
                path.write_bytes(kept[path])


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        VANTAGE = sys.argv.pop(1)
    unittest.main()
