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
include/vantage/prove.h has the format. What is not written as it says is refused: nothing can be read in two ways.
Exit code: 0 accepted, 1 refused, 2 a file that cannot be read."""

import argparse, collections, hashlib, json, math, re, struct, sys  # noqa: E401
from fractions import Fraction
from pathlib import Path

MOST_FACETS = 256  # of the largest group that is tried at once
MOST_KNOWN = 16  # planes that are kept of a group
DIGITS = r"(?:0|-?[1-9a-z][0-9a-z]{0,13})"  # to the base of 36
FACETS = re.compile(r"(?:(?:0|[1-9a-z][0-9a-z]{0,6})(?: (?=[0-9a-z])|$))*")
DESCEND, LEAVE, NOTHING, STEP = ">", "<", ".", rf"[0-9a-f<>.]|\({DIGITS},{DIGITS},{DIGITS}\)"
VERTICAL = 1e-6  # a normal that points down no more than this is taken as it is
MOST_SHRINK = 1e-5  # more of the distance is left out only if that is asked for
ROUNDED = 16 * 2.0**-53  # of the largest coordinate: twice what writing a PLY moves a vertex (src/io/stored_mesh.cpp)
TILT = Fraction(3, 2 * 10**12)  # an axis within 1e-12 of the normal's other two numbers is taken for the normal
LEAST_BITS = 80  # of fractions: boxes round pieces outwards by one unit
LARGEST = 1e9  # metres: vantage reads no larger coordinates and ranges. What rounding is allowed to do grows with both
MARGIN, STEPS = 1e-9, 2.0**-49  # metres, and of the largest coordinate: what of the target is left out
FULL_RANGE = 20  # metres: with a shorter range the next three are smaller in proportion (src/target/lengths.cpp)
OWN_SURFACE, CLEAR, POINT = 2e-3, 1e-6, 5e-4  # what lies so low over the target is its surface; how far above that the
# target is raised; the radius of what is looked at in the place of a point
SIZES = {"uchar": "B", "int": "i", "uint": "I", "float": "f", "double": "d"}
COUNT, PROPERTY = rb"(0|[1-9][0-9]{0,9})", rb"property (?:uchar|int|uint|float|double) [!-~]+\n"
HEADER = re.compile(rb"ply\nformat binary_little_endian 1\.0\n((?:comment [^\0-\x1f\x7f]*\n)*)element vertex " + COUNT +
                    rb"\n((?:" + PROPERTY + rb")+)element face " + COUNT +
                    rb"\n(property list uchar u?int vertex_indices\n(?:" + PROPERTY + rb")*)end_header\n")
MARKS = ("vantage volume: ", "vantage rounding_m ", "vantage georeference:")  # what a volume says of itself

# Of JSON: a list of three forms is three values, a tuple of one form any number of them, a set has alternatives; keys
# that end with ? may be left out, and there are no others.
VECTOR, LIMITS = [float] * 3, [{float, type(None)}] * 3
FILE = {"file": str, "hash": str}
CERTIFICATE = {
    "format": str, "scene": FILE, "volume": FILE, "mission_hash": str, "shrink": float, "rounding_m": float,
    "max_range_m": float, "scene_incomplete?": str, "boxes": ({"name": str, "min": LIMITS, "max": LIMITS},),
    "parts": ({"target": (VECTOR,), "shift_m": float, "centre": VECTOR, "corners": (VECTOR,), "normal": VECTOR,
               "cut_height_m": {float, type(None)}, "facets": str, "steps": str},)}
TARGET = {"name": str, "parts": ((VECTOR,),), "offset_m": float, "front?": VECTOR, "front_by_order?": bool}
STATEMENT = {
    "version": str, "method": str, "target?": TARGET, "views?": ([TARGET],), "max_range_m?": float, "sensor?": dict,
    "tolerance_m": float, "lift_m": (float,), "scene_hash": str, "mission_hash": str, "volume_hash": str}
PIXEL, CAMERA = {"size_m": float, "kind": str}, {"half_width": float, "half_height": float, "focal_px": float}

class Refused(Exception):
    """The certificate does not prove what it says."""

class Unreadable(Exception):
    """A file is not what it should be."""

def demand(holds, problem):
    if not holds:
        raise Refused(problem)

def has_form(value, form):
    if isinstance(form, tuple):
        return type(value) is list and all(has_form(v, form[0]) for v in value)
    if isinstance(form, list):
        return type(value) is list and len(value) == len(form) and all(map(has_form, value, form))
    if isinstance(form, dict):
        forms = {key.rstrip("?"): of for key, of in form.items()}
        return (type(value) is dict and all(key in value for key in form if key[-1] != "?") and
                all(key in forms and has_form(v, forms[key]) for key, v in value.items()))
    return type(value) in form if isinstance(form, set) else type(value) is form

def number(text):
    """Of JSON: no other digits than those of ASCII, and nothing that no double holds."""
    value = float(text) if text.isascii() and len(text) < 400 else math.inf
    if not math.isfinite(value):
        raise ValueError(f"{text[:20]!a} is no number")
    return value

def with_each_key_once(pairs):
    if len(dict(pairs)) != len(pairs):
        raise ValueError("a key twice")
    return dict(pairs)

def check_form(value, form):
    if not has_form(value, form):
        raise ValueError("a key or a number too many, too few, or of another kind")
    return value

def read_json(text, form):
    return check_form(json.loads(text, object_pairs_hook=with_each_key_once, parse_int=number, parse_float=number,
                                 parse_constant=number), form)

def read_bytes(path):
    if not path.is_file():
        raise ValueError("not a file")  # others may have no end
    return path.read_bytes()

class Mesh:
    """A PLY file: binary, little-endian, triangles."""

    def __init__(self, path):
        try:
            self.read(read_bytes(path))
        except (OSError, struct.error, LookupError, ValueError, MemoryError) as error:
            why = f"{type(error).__name__}: {error}"
            raise Unreadable(f"{path}: is cut short, or no PLY of triangles as vantage writes it ({why})") from error

    def read(self, data):
        header = HEADER.match(data)
        if not header:
            raise ValueError("its header is another one")
        self.read_comments(header[1])
        fields = [[line.split() for line in lines.decode().splitlines()] for lines in (header[3], header[5])]
        names = [[field[-1] for field in of] for of in fields]
        if any(len(set(of)) != len(of) for of in names):
            raise ValueError("a property twice")
        rows = [struct.Struct("<" + "".join(SIZES[f[1]] for f in fields[0])),
                struct.Struct("<B3" + SIZES[fields[1][0][3]] + "".join(SIZES[f[1]] for f in fields[1][1:]))]
        counts, begin = (int(header[2]), int(header[4])), header.end()
        middle = begin + counts[0] * rows[0].size
        if len(data) != middle + counts[1] * rows[1].size:
            raise ValueError("its size is not the one that its header says")
        axes = [names[0].index(axis) for axis in "xyz"]
        if any(fields[0][at][1] not in ("float", "double") for at in axes):
            raise ValueError("a coordinate that is no fraction")
        self.vertices = [tuple(row[at] for at in axes) for row in rows[0].iter_unpack(data[begin:middle])]
        faces = list(rows[1].iter_unpack(data[middle:]))
        self.triangles, self.objects = [face[1:4] for face in faces], [0] * len(faces)
        if "object" in names[1]:
            self.objects = [face[names[1].index("object") + 3] for face in faces]  # a list of three is four numbers
        if any(face[0] != 3 for face in faces) or any(type(o) is not int or o < 0 for o in self.objects):
            raise ValueError("a face that is no triangle, or an object that is no number of one")
        if any(not 0 <= v < len(self.vertices) for t in self.triangles for v in t):
            raise ValueError("an index out of range")
        if not all(math.isfinite(x) for v in self.vertices for x in v):
            raise ValueError("a number that is not finite")
        if any(abs(x) > LARGEST for v in self.vertices for x in v):
            raise ValueError("a coordinate is larger than 1e9 m")
        self.find_area()

    def find_area(self):
        """No hash holds a vertex that no triangle has, so nothing may depend on it. What has no area is no surface."""
        places = list(map(Scale(self.vertices).point, self.vertices))
        self.with_area = [t for t in self.triangles if not is_flat([places[v] for v in t])]
        self.with_area_at = sorted({v for t in self.with_area for v in t})

    def read_comments(self, lines):
        """Other programs may read a line where this one reads none, or the other way round: nothing like that."""
        text = lines.decode("utf-8", "replace")
        self.comments = [line[8:] for line in text.split("\n")[:-1]]
        if "end_header" in text or text.splitlines() != text.split("\n")[:-1]:
            raise ValueError("a comment that may be read as more than one")
        if not all(c.isascii() or re.match("vantage cause [0-9]+ [a-z_]+ ", c) for c in self.comments):
            raise ValueError("other letters than those of ASCII, but in the name of a cause")
        if any(text.count(mark) != sum(c.startswith(mark) for c in self.comments) for mark in MARKS):
            raise ValueError("what vantage says of the volume begins within a line")

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

def is_flat(triangle):
    return not any(cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0])))

def clip(polygon, normal, cut):
    """What of a polygon lies higher than the cut. Its corners are (x, y, z, ..., w), for the points (x, y, z) / w."""
    corners, over = [], [dot(normal, c) - cut * c[-1] for c in polygon]
    for i, a in enumerate(polygon):
        b, at_a, at_b = polygon[i - 1], over[i], over[i - 1]
        if (at_a >= 0) != (at_b >= 0):
            corners.append(tuple(x * abs(at_b) + y * abs(at_a) for x, y in zip(a, b)))
        if at_a >= 0:
            corners.append(a)
    return corners

def corners_in_front(triangle, normal, cut):
    """Lines hide nothing."""
    corners = [] if is_flat(triangle) else [c + (1,) for c in triangle]
    return corners if cut is None else clip(corners, normal, cut)

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
        demand(FACETS.fullmatch(part["facets"]), "what is between the facets is none")
        self.facets, self.steps = [int(n, 36) for n in part["facets"].split()], re.findall(STEP, part["steps"])
        demand(len(set(self.facets)) == len(self.facets), "a facet is named twice")
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
    up = next((u for u in (cross(normal, minus(p, points[0])) for p in points) if any(u)), (0, 0, 0))
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

def sides_of(polygon, normal):
    """Of a convex polygon, seen against the normal: a corner of each, and the way out."""
    hull = hull_of(polygon, normal) if polygon else []
    demand(len(hull) >= 3, "a polygon has no area")
    return [(a, cross(minus(b, a), normal)) for a, b in zip(hull, hull[1:] + hull[:1])]

def lies_in(polygon, normal, allowed, points):
    """Whether points lie in a convex polygon, seen against the normal, or as near to it as is allowed."""
    sides = sides_of(polygon, normal)
    return all(dot(out, minus(p, a)) <= allowed * math.isqrt(dot(out, out)) for a, out in sides for p in points)

def check_front(part, view, is_all_round):
    """That the normal is that of the target, but for rounding, on the side that is looked at (docs/proof.md)."""
    front = view.get("front") and [Fraction(x) for x in view["front"]]
    way, given = [Fraction(x) for x in part["normal"]], [[Fraction(x) for x in v] for v in part["target"]]
    demand(is_all_round == (len(given) == 1 and not front), "only a point without a front is seen from all sides")
    demand(not is_all_round or way == [0, 0, 1], "a point that is seen from all sides is moved upwards alone")
    own = newell(given) if len(given) > 1 else front or way
    demand(not front or dot(own, front)**2 * 10**12 >= dot(own, own) * dot(front, front) > 0, "its front is no side of it")
    down = own[2] < -VERTICAL * math.hypot(*map(float, own)) and not view.get("front_by_order")
    own = [-x for x in own] if (dot(own, front) < 0 if front else down) else own
    sizes = [sum(map(abs, minus(v, given[0]))) for v in given]
    spread = (len(given) + 5) * sum(a * b for a, b in zip(sizes[1:], sizes[2:])) / 2**52  # twice what rounding can do
    largest, off = max(map(abs, own)), cross(own, way)
    allowed = min(TILT * largest + spread, largest / 10**6)
    demand(dot(own, way) > 0 and dot(off, off) <= allowed**2, "the target does not look to the stated side")

def moved_target(part, scale, centre, normal):
    """Its corners, moved by the stated shift, about the centre. Numbers times 2^(2 bits)."""
    shift, unit, given = scale.whole(part["shift_m"]), 1 << scale.bits, map(scale.point, part["target"])
    return [tuple((x - c) * unit + shift * n for x, c, n in zip(v, centre, normal)) for v in given]

def check_target(moved, unit, normal, corners, allowed):
    """That the polygon is the moved target, and the centre in it."""
    demand(abs(dot(normal, normal) - unit * unit) * 10**14 <= unit * unit, "the normal is not of unit length")
    if len(moved) == 1:
        demand(corners == [(0, 0, 0)] and dot(moved[0], moved[0]) <= (allowed * unit)**2, "the point is another one")
        return
    extent = math.isqrt(sum((max(axis) - min(axis))**2 for axis in zip(*moved)))
    flat = max(extent // 10**6, unit * unit // 1000)  # a target need not be flatter; the plane is that of the mean
    demand(all(abs(dot(normal, p)) <= flat * unit for p in moved), "the target does not lie in the stated plane")
    demand(abs(sum(dot(normal, p) for p in moved)) <= len(moved) * allowed * unit * unit, "the plane is moved")
    demand(all(abs(dot(normal, c)) <= allowed * unit for c in corners), "the polygon does not lie in the stated plane")
    demand(lies_in(moved, normal, allowed * unit, [(0, 0, 0)]), "the centre is not in the target")
    wide = [tuple(x * unit for x in c) for c in corners]
    demand(lies_in(wide, normal, allowed * unit, moved), "the polygon is smaller than the target")

def column_over(moved, normal, unit):
    """The sides of the prism that stands on the target, as ways in and how far; of a point, of what is about it."""
    if len(moved) > 1:
        return [(minus((0, 0, 0), out), -dot(out, a) // unit) for a, out in sides_of(moved, normal)]
    across = cross(normal, [int(abs(n) == min(map(abs, normal))) for n in normal])
    return [(way, 0) for u in (across, cross(normal, across)) for way in (u, minus((0, 0, 0), u))]

def heights_over(column, grown, places, heights, triangles, most):
    """Of each triangle over the target, down to so far below its plane as `most` is above it: from where to where."""
    sides = [(way, at - grown * math.isqrt(dot(way, way))) for way, at in column]
    for t in triangles:
        if max(heights[v] for v in t) < -most or min(heights[v] for v in t) > most:
            continue
        piece = [places[v] + (heights[v], 1) for v in t]
        for way, at in sides:
            piece = clip(piece, way, at)
        if piece:
            yield min(c[3] // c[-1] for c in piece), max(-(-c[3] // c[-1]) for c in piece)

def check_lift(lift_m, lengths, part, scale, normal, moved, places, scene):
    """That a raised target leaves nothing below it but its own surface (docs/proof.md), and is raised for it alone."""
    if lift_m == 0:
        return
    (reach_m, farthest_m, radius_m), centre = lengths, part["centre"]
    unit, small = 1 << scale.bits, min(1, reach_m / FULL_RANGE)
    radius_m = radius_m if len(moved) > 1 else POINT * small
    largest = max([abs(x) for v in scene.with_area_at for x in scene.vertices[v]] + list(map(abs, centre)))
    size_m, least_m = largest + max(map(abs, centre)) + radius_m, MARGIN * min(1, radius_m)
    slack_m = max(least_m, STEPS * (size_m + farthest_m))
    # vantage raises a target so far for the sake of the range, however near the volume was cut to it.
    clear_m = max(CLEAR * small, 4 * max(least_m, STEPS * (size_m + reach_m)))
    own_m = min(OWN_SURFACE, max(OWN_SURFACE * small, 4 * clear_m))  # wherever a scene lies, and however large it is
    clear_m = min(OWN_SURFACE / 4, clear_m)
    whole = lambda length_m: math.ceil(Fraction(length_m) * unit * unit)  # noqa: E731: heights are times 2^(2 bits)
    lift, slack, clear, own = map(whole, (lift_m, slack_m, clear_m, own_m))
    point = whole(POINT * small) if len(moved) == 1 else 0
    heights, column = [dot(normal, p) + lift for p in places], column_over(moved, normal, unit)
    over = list(heights_over(column, point // unit, places, heights, scene.with_area, 3 * own))
    raised, tops = 0, [top for _, top in over]
    if part["cut_height_m"] is None:  # twice the diameter of what is looked at in its place
        raised = max([0] + [top + clear + 4 * point for top in tops if -clear - 4 * point < top <= own])
        own = clear  # what is higher is no surface that it lies on
    most = raised + own + 2 * clear
    raised = max([raised] + [top + clear for top in tops if raised - clear < top <= raised + own])
    for height in sorted(heights[v] for v in scene.with_area_at):  # what all but continues the plane, anywhere
        if raised < height <= min(raised + clear, most):
            raised = height + clear
    demand(lift <= raised + clear, "the target is raised by more than the surface that it lies on needs")
    inner = heights_over(column, -2 * slack // unit, places, heights, scene.with_area if not point else [], 3 * own)
    demand(not any(low < lift - 2 * slack and top > lift + 4 * slack for low, top in inner),
           "something lies between the target and where it was raised to, and is not its surface")

def check_vertices(points, shrunk, used, moved, unit, reach, rounding, allowed, normal):
    """Range and front. What numbers cannot tell of a vertex grows with its own distance, not with what is stated."""
    for v in used:
        slack = allowed + math.ceil(Fraction(STEPS * math.hypot(*shrunk[v])) * unit)
        away = [minus(tuple(x * unit for x in points[v]), t) for t in moved]
        most = (reach + rounding + slack) * unit
        demand(all(dot(a, a) <= most**2 for a in away), "a vertex lies beyond the range")
        demand(not normal or dot(normal, points[v]) >= -slack * unit, "a vertex lies behind the target")

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
    demand(part["target"], "a part of the target has no corners")
    moved = moved_target(part, scale, whole_centre, normal)
    radius_m = math.isqrt(max(dot(p, p) for p in moved)) / unit**2
    largest = max(abs(x) for p in part["target"] + [centre] for x in p)
    allowed_m = 2 * max(MARGIN * min(1, radius_m), STEPS * (largest + radius_m))
    allowed = math.ceil(Fraction(allowed_m) * unit)
    check_target(moved, unit, normal, corners, allowed)

    check_closed(triangles)
    used = {v for t in triangles.values() for v in t}
    reach, rounding = (math.floor(Fraction(certificate[key]) * unit) for key in ("max_range_m", "rounding_m"))
    cut = part["cut_height_m"]
    check_front(part, view, cut is None)
    check_vertices(points, shrunk, used, moved, unit, reach, rounding, allowed, None if cut is None else normal)
    if cut is not None:
        demand(0 <= cut <= allowed_m, "more of the scene is left out than rounding needs")
        cut = scale.whole(cut) * unit

    tested = {i for i, (a, b, c) in triangles.items() if dot(points[a], cross(points[b], points[c])) != 0}
    replay = Replay(part, points, triangles, corners)
    demand(set(replay.facets) >= tested, "a facet is left out")
    places = [minus(scale.point(v), whole_centre) for v in scene.vertices]
    farthest_m = max(math.hypot(*shrunk[v]) for v in used)
    lengths = certificate["max_range_m"], farthest_m, radius_m
    check_lift(view.get("lift_m", 0), lengths, part, scale, normal, moved, places, scene)
    if scene.triangles:
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

def check_rounding(certificate, volume):
    said = [c[19:] for c in volume.comments if c.startswith("vantage rounding_m ")]
    demand(len(said) <= 1, "the volume says twice how far it was rounded")
    demand(certificate["rounding_m"] in [0, *map(number, said)], "the volume was not rounded so much")
    largest = max((abs(x) for v in volume.with_area_at for x in volume.vertices[v]), default=0)
    demand(0 <= certificate["rounding_m"] <= ROUNDED * largest, "the volume's numbers cannot be rounded so much")

def reach_of(said):
    """How far the volume says that its positions are from the target at most."""
    lengths, sensor = [said[key] for key in ("max_range_m",) if key in said], said.get("sensor", {})
    if "pixel" in sensor:
        pixel, camera = check_form(sensor["pixel"], PIXEL), check_form(sensor["camera"], CAMERA)
        demand(min(pixel["size_m"], camera["focal_px"]) > 0, "a pixel or a focal length is not positive")
        lengths.append(pixel["size_m"] * camera["focal_px"])
    demand(lengths and min(lengths) > 0, "the volume has no range")
    demand(min(lengths) <= LARGEST, "the volume has a range of more than 1e9 m")
    return min(lengths)

def check_sizes(certificate):
    """Of all lengths that a tolerance grows with."""
    demand(0 < certificate["max_range_m"] <= LARGEST, "the range is not positive, or more than 1e9 m")
    for part in certificate["parts"]:
        demand(all(abs(x) <= LARGEST for p in part["target"] + [part["centre"], [part["shift_m"]]] for x in p),
               "the target is farther away than 1e9 m, or was moved so far")

def check_files(certificate, scene, volume):
    """Compares with what the volume says of itself; returns the target that each part is of."""
    demand(scene.hash(b"scene") == certificate["scene"]["hash"], "the scene is not the one of the certificate")
    demand(volume.hash(b"volume") == certificate["volume"]["hash"], "the volume is not the one of the certificate")
    demand(re.fullmatch("[0-9a-f]{64}", certificate["mission_hash"]), "the hash of the mission is none")
    check_rounding(certificate, volume)
    on_earth = [{c for c in of.comments if c.startswith("vantage georeference:")} for of in (scene, volume)]
    demand(on_earth[1] <= on_earth[0] and len(on_earth[0]) <= 1, "the volume lies at another place on the earth")
    pieces = [c[16:] for c in volume.comments if c.startswith("vantage volume: ")]
    if not pieces:
        return None
    said = read_json("".join(pieces), STATEMENT)  # what the volume says of itself
    demand(said["mission_hash"] == certificate["mission_hash"], "the volume is of another mission")
    demand(said["scene_hash"] == certificate["scene"]["hash"], "the volume is of another scene")
    demand(said["volume_hash"] == certificate["volume"]["hash"], "the volume was changed since it was written")
    demand(certificate["max_range_m"] <= reach_of(said), "the volume has a shorter range")
    demand(("views" in said) != ("target" in said), "the volume has no target, or two")
    views = [view[0] for view in said["views"]] if "views" in said else [said["target"]]
    parts = [(part, view) for view in views for part in view["parts"]]
    lifts = said["lift_m"]
    demand(len(parts) == len(lifts) == len(certificate["parts"]), "the parts are not those of the volume's target")
    demand(all(lift >= 0 for lift in lifts), "the target was lowered")
    stated = [(part, view["offset_m"] + lift) for (part, view), lift in zip(parts, lifts)]
    demand(stated == [(p["target"], p["shift_m"]) for p in certificate["parts"]], "the target is not the volume's")
    return [dict(view, lift_m=lift) for (_, view), lift in zip(parts, lifts)]

def read_certificate(path):
    certificate = read_json(read_bytes(path).decode("utf-8"), dict)
    if certificate["format"] != "vantage certificate 1":
        raise Unreadable(f"{path}: is a certificate of another version, {certificate['format']!a:.80}")
    check_form(certificate, CERTIFICATE)
    files = [certificate[kind]["file"] for kind in ("scene", "volume")]
    demand(all(Path(name).name == name and name.isprintable() for name in files), "a file lies in another folder")
    return certificate, [Mesh(path.parent / name) for name in files]

def check(path, out=print, most_shrink=MOST_SHRINK):
    try:
        certificate, (scene, volume) = read_certificate(path)
        shrink, views = certificate["shrink"], check_files(certificate, scene, volume)
        demand(0 <= shrink <= most_shrink < 1, f"a shrink of {shrink} is out of range: see --most-shrink")
        demand(certificate["parts"], "the certificate has no part")
        demand(certificate.get("scene_incomplete") != "", "it says that the scene lacks nothing")
        check_sizes(certificate)
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
        out(f"of the volume less {shrink} of the distance to the target, rounded by {certificate['rounding_m']} m,")
        mission = certificate["mission_hash"] if views else "the volume names none; compare target and range yourself"
        out(f"within {certificate['max_range_m']} m. Mission: {mission}")
        if "scene_incomplete" in certificate:
            out(f"Of the scene as built: {certificate['scene_incomplete']!a}")
    except (OSError, LookupError, TypeError, ValueError, AttributeError, ArithmeticError, RecursionError, struct.error,
            MemoryError) as error:
        why = f"{type(error).__name__}: {error}"
        raise Unreadable(f"{path}: is no certificate, cut short or garbled ({why})") from error

def main(arguments=None):
    parser = argparse.ArgumentParser(description="Check the certificate of a visibility volume.")
    parser.add_argument("certificate", type=Path, help="with the two files that it names beside it")
    parser.add_argument("--most-shrink", type=float, default=MOST_SHRINK, help="of the distance to the target, below 1")
    given = parser.parse_args(arguments)
    try:
        check(given.certificate, most_shrink=given.most_shrink)
    except (Refused, Unreadable) as failure:
        print(f"REFUSED: {failure}" if isinstance(failure, Refused) else f"error: {failure}", file=sys.stderr)
        return 1 if isinstance(failure, Refused) else 2
    return 0

if __name__ == "__main__":
    sys.exit(main())
