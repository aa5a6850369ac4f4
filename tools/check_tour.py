#!/usr/bin/env python3
"""Checks that no tour through some regions is shorter than a certificate says. Needs Python 3.8 and nothing else.

    python3 check_tour.py tour.cert

All is decided with whole numbers and fractions; nothing of the program that found the bound is used or believed. Of a
region only its mesh counts, of that only the corners of its triangles. What is checked, for a proof by insertion:

 1. Let stops lie in convex hulls, in a given order. For any vectors u_k, not longer than 1, of the legs between them the
    way is at least the sum over stops of the least (u_(k-1) - u_k) . v over the corners v of the hull: Cauchy and Schwarz.
 2. The tree begins with three regions (closed tours), or the first one (and the last): any tour visits them in this order.
    "insert" puts a region behind each stop; "cut" takes the two parts of a stop's cell on the sides of a plane. So the
    children cover all tours of the parent. Leaving out stops makes no way longer. The least leaf is a bound.

For a proof by pairs: with vectors u_ij = -u_ji a tour is at least the sum over its regions i of
c_i(j, k) = min over v of (u_ij + u_ik) . v, j and k its neighbours. For any numbers p, d, and s >= 0 of sets, that is at least
the sum of min over j, k of (c_i(j, k) - p_ij - p_ik), of 2 d_i, of 2 s, and over edges of min(0, p_ij + p_ji - d_i - d_j - the s
of the sets that the edge leaves): a tour has two edges at each region and leaves each set twice. "edge" fixes an edge to be in
the tour, then not to be.

That the regions hold all that is to be visited their files say ("vantage region: outer" or "given"); a file of a computed
volume, which lies inside, is refused. Exit code: 0 accepted, 1 refused, 2 a file that cannot be read."""

import argparse, hashlib, json, math, re, struct, sys  # noqa: E401
from fractions import Fraction
from pathlib import Path

UNIT = 1 << 30  # of vectors
BITS = 90  # of lengths, at least: points of cuts are rounded to 2^-90 m
LARGEST = 1e9  # metres
HEADER = re.compile(rb"ply\nformat binary_little_endian 1\.0\ncomment vantage region: (outer|given)\nelement vertex "
                    rb"([1-9][0-9]{0,9})\nproperty double x\nproperty double y\nproperty double z\nelement face "
                    rb"([1-9][0-9]{0,9})\nproperty list uchar int vertex_indices\nend_header\n")
FLOAT = {float, int}
CERTIFICATE = {"format": str, "bound_m": FLOAT, "closed": bool, "first": {int, type(None)}, "last": {int, type(None)},
               "regions": list, "proof": dict}
REGION = {"name": str, "kind": str, "dwell_m": FLOAT, "file?": str, "hash?": str, "at?": list}
PROOF = {"kind": str, "tree": list, "root?": list, "vectors?": list}

class Refused(Exception):
    """The certificate does not prove what it says."""

class Unreadable(Exception):
    """A file is not what it should be."""

def demand(holds, problem):
    if not holds:
        raise Refused(problem)

def is_number(value):
    return type(value) in FLOAT

def are_whole(values, least, most):
    return type(values) is list and all(type(v) is int and least <= v <= most for v in values)

def check_form(value, form, what):
    forms = {key.rstrip("?"): of for key, of in form.items()}
    of = lambda f: f if isinstance(f, set) else {f}  # noqa: E731
    if (type(value) is not dict or any(key[-1] != "?" and key not in value for key in form) or
            any(key not in forms or type(v) not in of(forms[key]) for key, v in value.items())):
        raise Unreadable(f"{what}: a key too many, too few, or of another kind")

def whole(text):
    if len(text) > 20:
        raise ValueError("a number with too many digits")
    return int(text)

def finite(text):
    value = float(text) if len(text) < 40 else math.inf
    if not math.isfinite(value):
        raise ValueError("a number that no double holds")
    return value

def each_key_once(pairs):
    if len(dict(pairs)) != len(pairs):
        raise ValueError("a key twice")
    return dict(pairs)

def read_certificate(path):
    try:
        text = path.read_text(encoding="ascii") if path.is_file() else ""
        value = json.loads(text, object_pairs_hook=each_key_once, parse_int=whole, parse_float=finite,
                           parse_constant=finite)
    except (OSError, ValueError, RecursionError, MemoryError) as error:
        raise Unreadable(f"{path}: {type(error).__name__}: {error}") from error
    check_form(value, CERTIFICATE, "the certificate")
    for region in value["regions"]:
        check_form(region, REGION, "a region")
    check_form(value["proof"], PROOF, "the proof")
    return value

def read_mesh(path, kind, said):
    """The triangles as nine numbers each, of the binary PLY files that vantage writes beside certificates."""
    try:
        data = path.read_bytes() if path.is_file() else b""
    except OSError as error:
        raise Unreadable(f"{path}: {error}") from error
    header = HEADER.match(data)
    if not header:
        demand(b"vantage volume: " not in data[:4096], f"{path}: is a computed volume, which lies inside: no bound")
        raise Unreadable(f"{path}: is no mesh of a region")
    demand(header[1].decode() == kind, f"{path}: is a region of another kind")
    vertices, faces = int(header[2]), int(header[3])
    middle = header.end() + 24 * vertices
    if len(data) != middle + 13 * faces:
        raise Unreadable(f"{path}: its size is not the one that its header says")
    places = list(struct.iter_unpack("<3d", data[header.end():middle]))
    if not all(abs(x) <= LARGEST for p in places for x in p):
        raise Unreadable(f"{path}: a coordinate is not finite or too large")
    digest, triangles = hashlib.sha256(b"vantage volume 1\n" + struct.pack("<Q", faces)), []
    for count, *corners in struct.iter_unpack("<B3i", data[middle:]):
        if count != 3 or not all(0 <= c < vertices for c in corners):
            raise Unreadable(f"{path}: a face is no triangle of its vertices")
        numbers = [x + 0.0 for c in corners for x in places[c]]
        digest.update(struct.pack("<9d", *numbers))
        triangles.append(numbers)
    demand(digest.hexdigest() == said, f"{path}: the region is not the one that the certificate is about")
    return triangles

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

class Corners:
    """Points with whole coordinates, asked for the least of direction . point; in boxes, so that most are left out."""

    def __init__(self, points, rounded):
        self.points, self.rounded, self.known = sorted(set(points)), rounded, {}
        self.root = self.build(self.points) if self.points else None

    def build(self, points):
        box = [min(p[k] for p in points) for k in range(3)] + [max(p[k] for p in points) for k in range(3)]
        if len(points) <= 6:
            return box, points, None
        axis = max(range(3), key=lambda k: box[k + 3] - box[k])
        points = sorted(points, key=lambda p: p[axis])
        half = len(points) // 2
        return box, self.build(points[:half]), self.build(points[half:])

    def least(self, direction):
        """In units of length times those of vectors."""
        demand(self.points, "a part of a region is empty")
        if direction not in self.known:
            best = dot(direction, self.points[0])
            x, y, z = direction
            a, b, c = (0 if d >= 0 else 3 for d in direction)
            stack = [self.root]
            while stack:
                box, first, second = stack.pop()
                if x * box[a] + y * box[1 + b] + z * box[2 + c] >= best:
                    continue
                if second is None:
                    best = min(best, min(dot(direction, p) for p in first))
                else:
                    stack += [first, second]
            # A point that was rounded lies within one unit in each coordinate.
            self.known[direction] = best - (sum(map(abs, direction)) if self.rounded else 0)
        return self.known[direction]

class Cell:
    """What of a region lies on some sides of planes. Polygons have corners (x, y, z, w), for the point (x, y, z) / w."""

    def __init__(self, region, polygons, rounded):
        self.region, self.polygons, self.parts = region, polygons, {}
        self.is_empty = not polygons
        self.corners = Corners([tuple(x // c[3] for x in c[:3]) for p in polygons for c in p], rounded)

    def cut(self, normal, offset):
        """Above the plane and below it."""
        key = (normal, offset)
        if key not in self.parts:
            self.parts[key] = [Cell(self.region, [p for p in (self.clip(p, normal, offset, side) for p in self.polygons) if p],
                                    True) for side in (1, -1)]
        return self.parts[key]

    @staticmethod
    def clip(polygon, normal, offset, side):
        kept, over = [], [side * (dot(normal, c) - offset * c[3]) for c in polygon]
        for i, a in enumerate(polygon):
            b, at_a, at_b = polygon[i - 1], over[i], over[i - 1]
            if (at_a > 0 > at_b) or (at_a < 0 < at_b):
                corner = [x * abs(at_b) + y * abs(at_a) for x, y in zip(a, b)]
                kept.append(tuple(x // math.gcd(*corner) for x in corner))
            if at_a >= 0:
                kept.append(a)
        return kept

class Tour:
    """What the certificate is about, in whole numbers of 2^-bits metres."""

    def __init__(self, certificate, folder):
        demand(certificate["format"] == "vantage tour certificate 1", "the certificate is of another version")
        self.closed, self.first, self.last = (certificate[key] for key in ("closed", "first", "last"))
        self.regions = certificate["regions"]
        soups = [self.read(region, folder) for region in self.regions]
        demand(soups, "there are no regions")
        self.bits = max([BITS] + [x.as_integer_ratio()[1].bit_length() - 1 for s in soups for t in s for x in t])
        self.cells = []
        for number, soup in enumerate(soups):
            corners = [tuple(map(self.whole, t)) for t in soup]
            polygons = [[c[i:i + 3] + (1,) for i in range(0, len(c), 3)] for c in corners]
            self.cells.append(Cell(number, polygons, False))
        self.dwell = [self.whole(r["dwell_m"]) for r in self.regions]
        demand(all(d >= 0 for d in self.dwell), "a stay of negative length")
        ends = [e for e in (self.first, self.last) if e is not None]
        demand(are_whole(ends, 0, len(soups) - 1) and len(set(ends)) == len(ends), "an end is no region")
        demand(not ends if self.closed else self.first is not None, "the ends are not those of such a tour")
        demand(all(self.regions[e]["kind"] == "point" and not self.dwell[e] for e in ends), "an end is no place")

    def whole(self, number):
        top, bottom = float(number).as_integer_ratio()
        demand(bottom.bit_length() - 1 <= self.bits, "a number is too fine")
        return top << (self.bits - bottom.bit_length() + 1)

    @staticmethod
    def read(region, folder):
        if region["kind"] == "point":
            demand("file" not in region and "hash" not in region, "a place has no mesh")
            at = region.get("at", [])
            demand(len(at) == 3 and all(is_number(x) and abs(x) <= LARGEST for x in at), "a place is no three numbers")
            return [[float(x) for x in at]]
        demand(region["kind"] in ("outer", "given"), "a region of a kind that no bound can be over")
        demand("at" not in region and "file" in region and "hash" in region, "a region without a mesh")
        demand(re.fullmatch(r"[\w.-]+", region["file"], re.ASCII), "a mesh lies in another folder")
        return read_mesh(folder / region["file"], region["kind"], region["hash"])

def vectors_of(numbers):
    demand(are_whole(numbers, -UNIT, UNIT) and len(numbers) % 3 == 0, "a vector is no three whole numbers")
    vectors = [tuple(numbers[i:i + 3]) for i in range(0, len(numbers), 3)]
    demand(all(dot(v, v) <= UNIT * UNIT for v in vectors), "a vector is longer than 1")
    return vectors

def leaf_bound(tour, stops, vectors):
    """Of the shortest way through the stops; a stop with a dwell is two points, with a leg of that length between."""
    points, stays = [], []  # of the leg behind each point: the length that it counts in any case
    for cell in stops:
        dwell = tour.dwell[cell.region]
        points += [cell, cell] if dwell else [cell]
        stays += [dwell, 0] if dwell else [0]
    legs = len(points) if tour.closed and len(points) > 1 else len(points) - 1
    demand(len(vectors) == legs, "there are vectors for another number of legs")
    zero, total = (0, 0, 0), 0
    for k, cell in enumerate(points if legs else []):
        before = vectors[k - 1] if k or tour.closed else zero
        behind = vectors[k] if k < legs else zero
        total += cell.corners.least(tuple(a - b for a, b in zip(before, behind)))
    for vector, stay in zip(vectors, stays):
        if stay:
            total += stay * max(0, UNIT - 1 - math.isqrt(dot(vector, vector)))
    return total

def check_insertion(tour, proof):
    """The least bound of the leaves."""
    root = proof.get("root")
    demand(are_whole(root, 0, len(tour.cells) - 1) and len(set(root)) == len(root), "the root is no list of regions")
    if tour.closed:
        demand(len(root) == min(3, len(tour.cells)), "a closed tour begins with three regions")
    else:
        demand(root == [e for e in (tour.first, tour.last) if e is not None], "an open tour begins with its ends")
    waiting, least = [[tour.cells[r] for r in root]], None
    for node in proof["tree"]:
        demand(waiting, "the tree has too many nodes")
        stops = waiting.pop()
        kind = node[0] if type(node) is list and node else None
        if kind == "leaf" and len(node) == 2:
            bound = leaf_bound(tour, stops, vectors_of(node[1]))
            least = bound if least is None else min(least, bound)
        elif kind == "insert" and len(node) == 2:
            demand(are_whole(node[1:], 0, len(tour.cells) - 1), "no such region")
            demand(all(s.region != node[1] for s in stops), "a region is inserted that is there")
            places = len(stops) - (1 if not tour.closed and tour.last is not None else 0)
            waiting += [stops[:i] + [tour.cells[node[1]]] + stops[i:] for i in range(places, 0, -1)]
        elif kind == "cut" and len(node) == 4:
            demand(are_whole(node[1:2], 0, len(stops) - 1), "no such stop")
            demand(are_whole(node[2], -1, 1) and len(node[2]) == 3 and any(node[2]) and is_number(node[3]), "no plane")
            above, below = stops[node[1]].cut(tuple(node[2]), tour.whole(node[3]))
            waiting += [stops[:node[1]] + [half] + stops[node[1] + 1:] for half in (below, above)]
        else:
            demand(kind == "empty" and len(node) == 1, "a node of no known kind")
            demand(any(s.is_empty for s in stops), "a part of a region is said to be empty")
    demand(not waiting and least is not None, "the tree ends too early")
    return Fraction(least, UNIT << tour.bits)

def check_pairs(tour, proof):
    """The least bound of the leaves. An open tour is closed by a place beside its ends that is everywhere."""
    count, rows = len(tour.cells) + (not tour.closed), proof.get("vectors")
    demand(count >= 3 and type(rows) is list and len(rows) == count, "there are vectors for another number of regions")
    rows = [vectors_of(row) for row in rows]
    demand(all(len(row) == i for i, row in enumerate(rows)), "there are vectors for another number of pairs")
    demand(tour.closed or not any(map(any, rows[-1])), "vectors to everywhere are not 0")
    u = lambda i, j: rows[i][j] if j < i else tuple(-x for x in rows[j][i])  # noqa: E731

    def cost(i, j, k):
        if i == len(tour.cells):
            return 0
        corners, stay = tour.cells[i].corners, tour.dwell[i]
        if stay:
            return corners.least(u(i, j)) + corners.least(u(i, k)) + stay * UNIT
        return corners.least(tuple(a + b for a, b in zip(u(i, j), u(i, k))))

    def bound(inside, outside, p, d, sets):
        total = sum(2 * x for x in d) + sum(2 * s for s, _ in sets)
        for i in range(count):
            beside = [j for j in range(count) if j != i and (min(i, j), max(i, j)) not in outside]
            must = {j for j in beside if (min(i, j), max(i, j)) in inside}
            pairs = [cost(i, j, k) - p[i][j] - p[i][k] for j in beside for k in beside if j < k and must <= {j, k}]
            if not pairs:
                return None  # no tour has these edges
            total += min(pairs)
            for j in range(i):
                left = p[i][j] + p[j][i] - d[i] - d[j] - sum(s for s, of in sets if (i in of) != (j in of))
                total += left if (j, i) in inside else 0 if (j, i) in outside else min(0, left)
        return total

    def dual(numbers):
        demand(type(numbers) is list and len(numbers) == count and all(map(is_number, numbers)), "numbers too few or too many")
        return [tour.whole(x) * UNIT for x in numbers]

    ends = [] if tour.closed else [e for e in (tour.first, tour.last) if e is not None]
    waiting, least = [({(e, count - 1) for e in ends}, set())], None
    for node in proof["tree"]:
        demand(waiting and type(node) is list and node, "the tree has too many nodes")
        inside, outside = waiting.pop()
        if node[0] == "edge" and len(node) == 3:
            demand(are_whole(node[1:], 0, count - 1) and node[1] < node[2], "no such edge")
            edge = {tuple(node[1:])}
            waiting += [(inside, outside | edge), (inside | edge, outside)]
        else:
            demand(node[0] == "leaf" and len(node) == 4, "a node of no known kind")
            demand(type(node[1]) is list and len(node[1]) == count and type(node[3]) is list, "numbers too few or too many")
            for entry in node[3]:
                demand(type(entry) is list and len(entry) == 2 and is_number(entry[0]) and entry[0] >= 0, "a set with less than 0")
                demand(are_whole(entry[1], 0, count - 1) and 0 < len(set(entry[1])) < count, "no set of regions")
            sets = [(tour.whole(s) * UNIT, set(of)) for s, of in node[3]]
            here = bound(inside, outside, [dual(row) for row in node[1]], dual(node[2]), sets)
            least = here if least is None or (here is not None and here < least) else least
    demand(not waiting and least is not None, "the tree ends too early")
    return Fraction(least, UNIT << tour.bits)

def check(path, say=print):
    """Returns the bound that is proved, in metres, as a fraction."""
    certificate = read_certificate(path)
    tour, proof = Tour(certificate, path.parent), certificate["proof"]
    demand(proof["kind"] in ("insertion", "pairs"), "a proof of no known kind")
    proved = (check_insertion if proof["kind"] == "insertion" else check_pairs)(tour, proof)
    claimed = Fraction(certificate["bound_m"])
    demand(claimed <= max(0, proved), f"only {float(proved):.9g} m are proved, not {float(claimed):.9g} m")
    for region, stay in zip(tour.regions, tour.dwell):
        say(f"{region['kind']:5} {region['name']}" + (f": {region['dwell_m']} m in it alone, no view shared" if stay else ""))
    say(f"accepted: no {'closed' if tour.closed else 'open'} tour of these {len(tour.regions)} is shorter than "
        f"{float(claimed):.6f} m ({proof['kind']}, {len(proof['tree'])} nodes)")
    return proved

def main():
    parser = argparse.ArgumentParser(description="Checks a bound of tours.")
    parser.add_argument("certificate", type=Path)
    try:
        check(parser.parse_args().certificate)
    except Refused as problem:
        print(f"refused: {problem}")
        return 1
    except Unreadable as problem:
        print(f"{problem}", file=sys.stderr)
        return 2
    return 0

if __name__ == "__main__":
    sys.exit(main())
