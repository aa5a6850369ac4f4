#!/usr/bin/env python3
"""Checks the certificate of a visibility volume. Needs Python 3.8 and nothing else.

    python3 check_certificate.py volume.cert

Every decision is made with whole numbers: the stored ones times a power of two. Nothing of the program that computed
the volume or the proof is used or believed. For each part of the target and a point c in it this is checked:

 1. The volume's mesh is closed: each edge is run as often one way as the other.
 2. It is moved towards c by a stated part of the distance, in doubles. Its facets are all in the certificate, but for
    those whose plane holds c.
 3. For each of them and every triangle of the scene, as far as that lies in front of the target, there is a plane with
    the facet, the polygon that is to be seen and c strictly on one side, and the triangle on the other.

Why that is enough: a ray from a point p that the volume winds round, away from c, ends where it does not. So it passes
through such a facet, in a point x at or behind p. By 3 nothing of the scene touches the hull of x and the polygon, so
nothing lies between p and the polygon. Planes are found for groups of facets and boxes of triangles at once; the boxes
are made here, from the scene. That the volume was made for this target, this range and this mission it says itself.
docs/proof.md has the format. Exit code: 0 accepted, 1 refused, 2 a file that cannot be read."""

import argparse, collections, hashlib, json, math, re, struct, sys  # noqa: E401
from fractions import Fraction
from pathlib import Path

MOST_FACETS = 256  # of the largest group that is tried at once
MOST_KNOWN = 16  # planes that are kept of a group
DESCEND, LEAVE, NOTHING, STEP = ">", "<", ".", r"[0-9a-f<>.]|\([^()]*\)"
VERTICAL = 1e-6  # a normal that points down no more than this is taken as it is
MOST_LIFT = 0.01  # metres that a target is raised by, at most
MOST_SHRINK = 1e-3  # more of the distance is left out only if that is asked for
ROUNDED = 16 * 2.0**-53  # of the largest coordinate: twice what writing a PLY moves a vertex (src/io/stored_mesh.cpp)
TILT = Fraction(3, 2 * 10**12)  # an axis within 1e-12 of the normal's other two numbers is taken for the normal
LEAST_BITS = 80  # of fractions: boxes round pieces outwards by one unit
SIZES = {"uchar": "B", "int": "i", "uint": "I", "float": "f", "double": "d"}

class Refused(Exception):
    """The certificate does not prove what it says."""

class Unreadable(Exception):
    """A file is not what it should be."""

def demand(holds, problem):
    if not holds:
        raise Refused(problem)

class Mesh:
    """A PLY file: binary, little-endian, triangles."""

    def __init__(self, path):
        self.path, self.comments, elements = path, [], []
        try:
            data = path.read_bytes()
            end = data.index(b"end_header\n")
            for line in data[:end].decode("utf-8", "replace").split("\n"):
                words = line.split()
                if line.startswith("comment "):
                    self.comments.append(line[8:])
                elif words[:1] == ["element"]:
                    elements.append((words[1], int(words[2]), []))
                elif words[:1] == ["property"]:
                    elements[-1][2].append(words[1:])
            if not data.startswith(b"ply\nformat binary_little_endian 1.0\n"):
                raise ValueError("not binary and little-endian")
            self.read_elements(data, end + len(b"end_header\n"), elements)
        except (OSError, struct.error, LookupError, ValueError, AttributeError) as error:
            raise Unreadable(f"{path}: is cut short, or no PLY of triangles as vantage writes it ({error})") from error

    def read_elements(self, data, at, elements):
        if [name for name, _, _ in elements] != ["vertex", "face"]:
            raise ValueError("not vertices and then faces")
        for name, count, properties in elements:
            names = [p[-1] for p in properties]
            if len(set(names)) != len(names) or any(p[0] == "list" for p in properties[name == "face":]):
                raise ValueError("a property twice, or a list too many")
            kinds = "".join(SIZES[p[1]] + "3" + SIZES[p[2]] if p[0] == "list" else SIZES[p[0]] for p in properties)
            row = struct.Struct("<" + kinds)
            rows = list(row.iter_unpack(data[at:at + count * row.size]))
            at += count * row.size
            if len(rows) != count:
                raise ValueError("too few rows")
            if name == "vertex":
                self.vertices = [tuple(r[names.index(axis)] for axis in "xyz") for r in rows]
            else:
                if properties[0][0] != "list" or names[0] != "vertex_indices" or any(r[0] != 3 for r in rows):
                    raise ValueError("not all faces are triangles")
                self.triangles = [r[1:4] for r in rows]
                at_object = names.index("object") + 3 if "object" in names else 0  # a list of three is four numbers
                self.objects = [r[at_object] if at_object else 0 for r in rows]
        if any(not 0 <= v < len(self.vertices) for t in self.triangles for v in t):
            raise ValueError("an index out of range")
        if not all(math.isfinite(x) for v in self.vertices for x in v):
            raise ValueError("a number that is not finite")

    def hash(self, kind):
        """docs/hashes.md"""
        digest = hashlib.sha256(b"vantage " + kind + b" 1\n" + struct.pack("<Q", len(self.triangles)))
        for triangle, of in zip(self.triangles, self.objects):
            numbers = [x + 0.0 for v in triangle for x in self.vertices[v]]
            digest.update(struct.pack("<9d", *numbers) + (struct.pack("<I", of) if kind == b"scene" else b""))
        return digest.hexdigest()

class Scale:
    """Numbers times 2^bits, so that all of the given ones are whole."""

    def __init__(self, points):
        self.bits = max([LEAST_BITS] + [x.as_integer_ratio()[1].bit_length() - 1 for p in points for x in p])

    def whole(self, number):
        top, bottom = float(number).as_integer_ratio()
        return top << (self.bits - bottom.bit_length() + 1)

    def point(self, numbers):
        return tuple(self.whole(x) for x in numbers)

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

def welded(mesh):
    """Triangles by vertices of which no two lie in one place; without those that have two corners in one."""
    number_of = {}
    number = [number_of.setdefault(v, len(number_of)) for v in mesh.vertices]
    triangles = [tuple(number[v] for v in t) for t in mesh.triangles]
    return list(number_of), {i: t for i, t in enumerate(triangles) if len(set(t)) == 3}

def check_closed(triangles):
    edges = collections.Counter(edge for a, b, c in triangles.values() for edge in ((a, b), (b, c), (c, a)))
    demand(edges, "the volume has no triangles")
    demand(all(edges[b, a] == count for (a, b), count in edges.items()), "the mesh of the volume is not closed")

def corners_in_front(triangle, normal, cut):
    """What of a triangle lies higher than the cut: (x, y, z, w), for the points (x, y, z) / w. Lines hide nothing."""
    if not any(cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]))):
        return []
    corners, over = [], [0 if cut is None else dot(normal, c) - cut for c in triangle]
    for i, a in enumerate(triangle):
        b, at_a, at_b = triangle[i - 2], over[i], over[i - 2]
        if at_a >= 0:
            corners.append(a + (1,))
        if (at_a >= 0) != (at_b >= 0):
            along = tuple(x * abs(at_b) + y * abs(at_a) for x, y in zip(a, b))
            corners.append(along + (abs(at_a) + abs(at_b),))
    return corners

class Node:
    """The corners of a piece of the scene, or a box that holds the children."""

    def __init__(self, corners, children):
        self.corners, self.children, self.box = corners, children, None
        boxes = [child.box for child in children if child.box]
        if corners or boxes:
            self.box = [min([c[k] // c[3] for c in corners] + [b[k] for b in boxes]) for k in range(3)]
            self.box += [max([-(-c[k] // c[3]) for c in corners] + [b[k + 3] for b in boxes]) for k in range(3)]

    def is_below(self, normal, low):
        if self.corners:
            return all(dot(normal, c) < low * c[3] for c in self.corners)
        return self.box is None or sum(n * self.box[k + 3 if n > 0 else k] for k, n in enumerate(normal)) < low

def tree_of(numbers, middles, pieces):
    """Halves by the widest axis. Which half a piece is in does not matter for what is proved, only for the steps."""
    if len(numbers) <= 2:
        return Node([], [pieces[i] for i in sorted(numbers)])
    spread = [max(middles[i][k] for i in numbers) - min(middles[i][k] for i in numbers) for k in range(3)]
    axis = spread.index(max(spread))
    numbers.sort(key=lambda i: (middles[i][axis], i))
    half = len(numbers) // 2
    return Node([], [tree_of(numbers[:half], middles, pieces), tree_of(numbers[half:], middles, pieces)])

class Replay:
    """Goes through the steps of a part, and believes none of them."""

    def __init__(self, part, points, triangles, target):
        self.facets, self.steps = [int(n, 36) for n in part["facets"].split()], re.findall(STEP, part["steps"])
        self.points, self.triangles, self.target, self.next, self.planes = points, triangles, target, 0, 0
        demand("".join(self.steps) == part["steps"], "what is between the steps is none")
        demand(all(i in triangles for i in self.facets), "a facet is named that the volume does not have")

    def groups(self, begin, end, root):
        if end - begin > MOST_FACETS:
            half = begin + (end - begin) // 2
            self.groups(begin, half, root)
            self.groups(half, end, root)
        elif end > begin:
            self.separate(begin, end, [root])

    def take(self):
        demand(self.next < len(self.steps), "the steps end too early")
        self.next += 1
        return self.steps[self.next - 1]

    def separate(self, begin, end, items):
        vertices = {v for i in self.facets[begin:end] for v in self.triangles[i]}
        hull = [self.points[v] for v in vertices] + self.target + [(0, 0, 0)]
        known, found, left, stack = {}, 0, [], items[::-1]
        while stack:
            item, step = stack.pop(), self.take()
            if step == NOTHING:
                demand(item.box is None, "a part of the scene is left out that lies in front of the target")
            elif step == DESCEND:
                demand(item.children, "a triangle is to be taken apart")
                stack.extend(reversed(item.children))
            elif step == LEAVE:
                left.append(item)
            else:
                number = found % MOST_KNOWN if step[0] == "(" else int(step, 16)
                if step[0] == "(":
                    normal = [int(n, 36) for n in step[1:-1].split(",")]
                    known[number] = (normal, min(dot(normal, p) for p in hull))
                    found += 1
                demand(number in known, "a step names a plane that is not known")
                demand(item.is_below(*known[number]), "a plane does not separate what it should")
        self.planes += found
        if left:
            demand(end - begin > 1, "a facet is left without a plane")
            half = begin + (end - begin) // 2
            self.separate(begin, half, left)
            self.separate(half, end, left)

def hull_of(points, normal):
    """The corners of what points span, seen against the normal, counter-clockwise (Andrew 1979)."""
    up = cross(normal, minus(points[1], points[0]))
    right, chain = cross(up, normal), []
    ordered = sorted(points, key=lambda p: (dot(right, p), dot(up, p)))
    for half in (ordered, ordered[::-1]):
        first = len(chain)
        for p in half:
            while len(chain) > first + 1 and dot(normal, cross(minus(chain[-1], chain[-2]), minus(p, chain[-2]))) <= 0:
                chain.pop()
            chain.append(p)
        chain.pop()
    return chain

def newell(points):
    """Normal of a polygon, of the length of twice its area."""
    fan = [cross(minus(a, points[0]), minus(b, points[0])) for a, b in zip(points[1:], points[2:])]
    return tuple(map(sum, zip(*fan))) if fan else (0, 0, 0)

def lies_in(polygon, normal, allowed, points):
    """Whether points lie in a convex polygon, seen against the normal, or as near to it as is allowed."""
    hull = hull_of(polygon, normal)
    demand(len(hull) >= 3, "a polygon has no area")
    sides = [(a, cross(minus(b, a), normal)) for a, b in zip(hull, hull[1:] + hull[:1])]
    return all(dot(out, minus(p, a)) <= allowed * math.isqrt(dot(out, out)) for a, out in sides for p in points)

def check_front(part, view, is_all_round):
    """That the normal is that of the target, but for rounding, on the side that is looked at (docs/proof.md)."""
    front = view.get("front") and [Fraction(x) for x in view["front"]]
    way, given = [Fraction(x) for x in part["normal"]], [[Fraction(x) for x in v] for v in part["target"]]
    demand(is_all_round == (len(given) == 1 and not front), "only a point without a front is seen from all sides")
    own = newell(given) if len(given) > 1 else front or way
    down = own[2] < -VERTICAL * math.hypot(*map(float, own)) and not view.get("front_by_order")
    own = [-x for x in own] if (dot(own, front) < 0 if front else down) else own
    sizes = [sum(map(abs, minus(v, given[0]))) for v in given]
    spread = (len(given) + 5) * sum(a * b for a, b in zip(sizes[1:], sizes[2:])) / 2**52  # twice what rounding can do
    largest, off = max(map(abs, own)), cross(own, way)
    allowed = min(TILT * largest + spread, largest / 10**6)
    demand(dot(own, way) > 0 and dot(off, off) <= allowed**2, "the target does not look to the stated side")

def check_target(part, scale, centre, normal, corners, allowed):
    """That the polygon is the target, moved by the stated shift. Numbers times 2^(2 bits); returns its corners."""
    shift, unit = scale.whole(part["shift_m"]), 1 << scale.bits
    given = [scale.point(v) for v in part["target"]]
    moved = [tuple((x - c) * unit + shift * n for x, c, n in zip(v, centre, normal)) for v in given]
    demand(abs(dot(normal, normal) - unit * unit) * 10**14 <= unit * unit, "the normal is not of unit length")
    if len(moved) == 1:
        demand(corners == [(0, 0, 0)] and dot(moved[0], moved[0]) <= (allowed * unit)**2, "the point is another one")
        return moved
    extent = math.isqrt(sum((max(axis) - min(axis))**2 for axis in zip(*moved)))
    flat = max(extent // 10**6, unit * unit // 1000)  # a target need not be flatter; the plane is that of the mean
    demand(all(abs(dot(normal, p)) <= flat * unit for p in moved), "the target does not lie in the stated plane")
    demand(abs(sum(dot(normal, p) for p in moved)) <= len(moved) * allowed * unit * unit, "the plane is moved")
    demand(all(abs(dot(normal, c)) <= allowed * unit for c in corners), "the polygon does not lie in the stated plane")
    demand(lies_in(moved, normal, allowed * unit, [(0, 0, 0)]), "the centre is not in the target")
    wide = [tuple(x * unit for x in c) for c in corners]
    demand(lies_in(wide, normal, allowed * unit, moved), "the polygon is smaller than the target")
    return moved

def check_part(part, view, certificate, scene, volume, middles):
    vertices, triangles = welded(volume)
    kept, centre = 1 - certificate["shrink"], part["centre"]
    shrunk = [tuple(kept * (x - c) for x, c in zip(v, centre)) for v in vertices]
    others = [centre, part["normal"], [part["shift_m"], part["cut_height_m"] or 0.0]]
    scale = Scale(scene.vertices + shrunk + part["target"] + part["corners"] + others)
    points = [scale.point(v) for v in shrunk]
    whole_centre, normal = scale.point(centre), scale.point(part["normal"])
    corners = [scale.point(c) for c in part["corners"]]
    unit = 1 << scale.bits
    largest = max(map(abs, centre)) + max(abs(x - c) for v in part["target"] for x, c in zip(v, centre))
    allowed_m = 2 * max(1e-9, 2.0**-49 * largest)
    allowed = math.ceil(Fraction(allowed_m) * unit)
    moved = check_target(part, scale, whole_centre, normal, corners, allowed)
    slack = allowed + math.ceil(Fraction(certificate["rounding_m"]) * unit)

    check_closed(triangles)
    used = {v for t in triangles.values() for v in t}
    reach = math.floor(Fraction(certificate["max_range_m"]) * unit) + slack
    for v in used:
        away = [minus(tuple(x * unit for x in points[v]), t) for t in moved]
        demand(all(dot(a, a) <= (reach * unit)**2 for a in away), "a vertex lies beyond the range")
    cut = part["cut_height_m"]
    check_front(part, view, cut is None)
    if cut is not None:
        demand(0 <= cut <= allowed_m, "more of the scene is left out than rounding needs")
        cut = scale.whole(cut) * unit
        demand(all(dot(normal, points[v]) >= -slack * unit for v in used), "a vertex lies behind the target")

    tested = {i for i, (a, b, c) in triangles.items() if dot(points[a], cross(points[b], points[c])) != 0}
    replay = Replay(part, points, triangles, corners)
    demand(set(replay.facets) >= tested, "a facet is left out")
    if scene.triangles:
        places = [minus(scale.point(v), whole_centre) for v in scene.vertices]
        pieces = [Node(corners_in_front([places[v] for v in t], normal, cut), []) for t in scene.triangles]
        replay.groups(0, len(replay.facets), tree_of(list(range(len(pieces))), middles, pieces))
    demand(replay.next == len(replay.steps), "there are more steps than the facets need")
    return len(tested), replay.planes

def check_box(box, volume, slack):
    demand(box["name"] in ("altitude", "keep_in"), "a limit is named that is no box")
    for k, axis in enumerate(zip(*{volume.vertices[v] for t in volume.triangles for v in t})):
        low, high = box["min"][k], box["max"][k]
        demand(low is None or Fraction(min(axis)) >= Fraction(low) - slack, f"a vertex is outside of {box['name']}")
        demand(high is None or Fraction(max(axis)) <= Fraction(high) + slack, f"a vertex is outside of {box['name']}")

def check_files(certificate, scene, volume):
    """Compares with what the volume says of itself; returns the target that each part is of."""
    demand(scene.hash(b"scene") == certificate["scene"]["hash"], "the scene is not the one of the certificate")
    demand(volume.hash(b"volume") == certificate["volume"]["hash"], "the volume is not the one of the certificate")
    rounded = [float(c.split()[2]) for c in volume.comments if c.startswith("vantage rounding_m ")]
    largest = max((abs(x) for t in volume.triangles for v in t for x in volume.vertices[v]), default=0)
    demand(certificate["rounding_m"] == 0 or certificate["rounding_m"] in rounded, "the volume was not rounded so much")
    demand(0 <= certificate["rounding_m"] <= ROUNDED * largest, "the volume's numbers cannot be rounded so much")
    pieces = [c[16:] for c in volume.comments if c.startswith("vantage volume: ")]
    if not pieces:
        return None
    said = json.loads("".join(pieces))  # what the volume says of itself
    demand(said.get("mission_hash", "") == certificate["mission_hash"], "the volume is of another mission")
    demand(said.get("scene_hash", "") == certificate["scene"]["hash"], "the volume is of another scene")
    sensor = said.get("sensor", {})
    pixels = sensor["pixel"]["size_m"] * sensor["camera"]["focal_px"] if "pixel" in sensor else math.inf
    reach = min(said.get("max_range_m", math.inf), pixels)
    demand(certificate["max_range_m"] <= reach < math.inf, "the volume has a shorter range, or none")
    views = [view[0] for view in said["views"]] if "views" in said else [said["target"]]
    parts = [(part, view) for view in views for part in view["parts"]]
    lifts = said["lift_m"]
    demand(len(parts) == len(lifts) == len(certificate["parts"]), "the parts are not those of the volume's target")
    demand(all(0 <= lift <= MOST_LIFT for lift in lifts), "the target was raised by more than that can be needed")
    stated = [(part, view["offset_m"] + lift) for (part, view), lift in zip(parts, lifts)]
    demand(stated == [(p["target"], p["shift_m"]) for p in certificate["parts"]], "the target is not the volume's")
    return [view for _, view in parts]

def number(value):
    """Of JSON; neither a text nor what no double holds."""
    return float(value) + 0 * value

def check(path, out=print, most_shrink=MOST_SHRINK):
    try:
        certificate = json.loads(path.read_text(encoding="utf-8"))
        if certificate["format"] != "vantage certificate 1":
            raise Unreadable(f"{path}: is a certificate of another version, {certificate['format']}")
        files = [certificate[kind]["file"] for kind in ("scene", "volume")]
        demand(all(Path(name).name == name for name in files), "a file lies in another folder")
        scene, volume = (Mesh(path.parent / name) for name in files)
        reach, shrink = number(certificate["max_range_m"]), number(certificate["shrink"])
        views = check_files(certificate, scene, volume)
        demand(0 <= shrink <= most_shrink < 1, f"a shrink of {shrink:g} is out of range: see --most-shrink")
        demand(certificate["parts"], "the certificate has no part")
        for box in certificate["boxes"]:
            check_box(box, volume, Fraction(certificate["rounding_m"]))
        middles = [[min(x) + max(x) for x in zip(*(scene.vertices[v] for v in t))] for t in scene.triangles]
        for i, part in enumerate(certificate["parts"]):
            view = views[i] if views else {"front": part["normal"] if part["cut_height_m"] is not None else None}
            facets, planes = check_part(part, view, certificate, scene, volume, middles)
            out(f"part {i + 1}: {facets} facets, {planes} planes, against {len(scene.triangles)} triangles")
            out(f"  {part['target']}, moved by {part['shift_m']} m along {part['normal']}")
        boxes = [f"{box['name']} from {box['min']} to {box['max']}" for box in certificate["boxes"]]
        out(f"accepted: {', '.join(['sight', 'range', 'front'] + boxes)},")
        out(f"of the volume less {shrink:g} of the distance to the target, rounded by {certificate['rounding_m']:g} m,")
        mission = certificate["mission_hash"] if views else "the volume names none; compare target and range yourself"
        out(f"within {reach:g} m. Mission: {mission}")
    except (OSError, LookupError, TypeError, ValueError, AttributeError, ArithmeticError, RecursionError) as error:
        raise Unreadable(f"{path}: is no certificate, cut short or garbled ({type(error).__name__}: {error})") from error

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Check the certificate of a visibility volume.")
    parser.add_argument("certificate", type=Path, help="with the two files that it names beside it")
    parser.add_argument("--most-shrink", type=float, default=MOST_SHRINK, help="of the distance to the target, below 1")
    arguments = parser.parse_args()
    try:
        check(arguments.certificate, most_shrink=arguments.most_shrink)
    except (Refused, Unreadable) as failure:
        print(f"REFUSED: {failure}" if isinstance(failure, Refused) else f"error: {failure}", file=sys.stderr)
        sys.exit(1 if isinstance(failure, Refused) else 2)
