"""Reads instances of the generalised travelling salesman problem with neighbourhoods in 3D (GTSPN; Gentilini, Margot
and Shimada 2013), and makes closed meshes of them: each set is a union of convex bodies (polyhedra, ellipsoids, and
intersections of the two).

A body is stood for by a polyhedron that holds it ("outer", for bounds) or lies in it ("inner", for tours). Polyhedra
are the same in both. An ellipsoid is the image of a ball; round the ball lies a polyhedron with facets that touch it
from outside, in the ball one with corners on it. Nothing but the standard library is needed.

The files have four decimals, although what was published was computed of more: a plane at coordinates of 500 m may lie
5 cm from where it was. Outer bodies hold all that the decimals can stand for, inner ones are of the numbers as written.
"""

import math
import pathlib
import re

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
ROUNDED = 0.5e-4  # of each number in the files
GROWN = 1e-9  # of the size: by so much more than rounding needs are outer bodies larger, inner ones smaller


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def ball(times):
    """Triangles of an icosahedron, divided so many times, with corners at distance 1; and the smallest distance of a
    facet's plane from the middle."""
    g = (1 + 5**0.5) / 2
    corners = [p for a in (-1, 1) for b in (-g, g) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    unit = lambda p: tuple(x / math.sqrt(dot(p, p)) for x in p)  # noqa: E731
    near = lambda p, q: abs(dot(minus(p, q), minus(p, q)) - 4) < 1e-6  # noqa: E731
    faces = []
    for i, a in enumerate(corners):
        for j, b in enumerate(corners[:i]):
            for c in corners[:j]:
                if near(a, b) and near(b, c) and near(c, a):
                    faces.append((a, b, c) if dot(cross(minus(b, a), minus(c, a)), a) > 0 else (a, c, b))
    faces = [tuple(map(unit, f)) for f in faces]
    for _ in range(times):
        middle = lambda p, q: unit(tuple(x + y for x, y in zip(p, q)))  # noqa: E731
        faces = [t for a, b, c in faces
                 for t in ((a, middle(a, b), middle(c, a)), (middle(a, b), b, middle(b, c)),
                           (middle(c, a), middle(b, c), c), (middle(a, b), middle(b, c), middle(c, a)))]
    least = 1.0
    for a, b, c in faces:
        normal = cross(minus(b, a), minus(c, a))
        least = min(least, dot(normal, a) / math.sqrt(dot(normal, normal)))
    return faces, least


def inverse(m):
    columns = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])]
    determinant = dot(m[0], columns[0])
    return [[columns[j][i] / determinant for j in range(3)] for i in range(3)]


def cholesky(m):
    low = [[0.0] * 3 for _ in range(3)]
    for i in range(3):
        for j in range(i + 1):
            s = m[i][j] - sum(low[i][k] * low[j][k] for k in range(j))
            low[i][j] = math.sqrt(s) if i == j else s / low[j][j]
    return low


def clip(faces, normal, offset):
    """What of a convex body, given by its faces as polygons, has normal . x <= offset."""
    out, rim = [], []
    for face in faces:
        heights = [dot(normal, p) - offset for p in face]
        kept = []
        for i, p in enumerate(face):
            q, at_p, at_q = face[i - 1], heights[i], heights[i - 1]
            if (at_p < 0 < at_q) or (at_q < 0 < at_p):
                (low, at_low), (high, at_high) = sorted(((p, at_p), (q, at_q)))  # the same point from both faces
                t = at_low / (at_low - at_high)
                kept.append(tuple(a + t * (b - a) for a, b in zip(low, high)))
                rim.append(kept[-1])
            if at_p <= 0:
                kept.append(p)
            if at_p == 0:
                rim.append(p)
        if len(kept) >= 3:
            out.append(kept)
    rim = list(set(rim))
    if len(rim) > 2:
        middle = tuple(sum(p[k] for p in rim) / len(rim) for k in range(3))
        right = next(s for s in (minus(p, middle) for p in rim) if dot(s, s) > 0)
        up = cross(normal, right)
        rim.sort(key=lambda p: math.atan2(dot(minus(p, middle), up), dot(minus(p, middle), right)))
        out.append(rim)
    return out


def body(shape, faces_of_ball, scale):
    """The faces of a body; `scale` of the ball: 1 for inner ones, one over the least distance for outer ones."""
    low, high = shape["lb"], shape["ub"]
    far = [max(abs(a), abs(b)) for a, b in zip(low, high)]
    sign = 1 if scale > 1 else -1
    size = max(b - a for a, b in zip(low, high))
    if shape["P^-1"]:
        # The norm of a matrix of such numbers is 3 times as large at most.
        form = [[x - (3 * ROUNDED if sign > 0 and i == j else 0) for j, x in enumerate(row)]
                for i, row in enumerate(shape["P^-1"])]
        root = cholesky(inverse(form))
        place = lambda p: tuple(c + scale * (1 + sign * GROWN) * dot(r, p)  # noqa: E731
                                for c, r in zip(shape["q_c"], root))
        faces = [[place(p) for p in f] for f in faces_of_ball]
    else:
        low, high = [a - size for a in low], [b + size for b in high]
        corner = lambda i: tuple((low, high)[i >> k & 1][k] for k in range(3))  # noqa: E731
        faces = [[corner(i) for i in f] for f in
                 ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))]
    for normal, offset in zip(shape["A"], shape["b"]):
        by = GROWN * size + (ROUNDED * (1 + sum(map(abs, far))) if sign > 0 else 0)
        faces = clip(faces, normal, offset + sign * by)
    return faces


def read(path):
    """The sets of an instance: lists of bodies as dictionaries of what the file says."""
    sets, lines = [], [line.strip() for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines()]
    numbers = lambda text: [float(x) for x in NUMBER.findall(text)]  # noqa: E731
    at, key = None, None
    for line in lines:
        if re.fullmatch(r"S\d+:", line):
            sets.append([])
            at = None
        elif re.fullmatch(r"Q\d+:", line):
            at = {"A": [], "b": [], "P^-1": []}
            sets[-1].append(at)
        elif at is not None and (match := re.match(r"(q_c|ub|lb) *:(.*)", line)):
            at[match[1]] = numbers(match[2])
        elif at is not None and (match := re.match(r"(A|b|P\^-1) *:", line)):
            key = match[1]
        elif line.startswith("="):
            key = None
        elif at is not None and key and line and not line[0].isalpha():
            at[key].append(numbers(line)[0] if key == "b" else numbers(line))
    return sets


def meshes(path, outer, times=2):
    """For each set a list of triangles, of all its bodies."""
    faces, least = ball(times)
    regions = []
    for shapes in read(path):
        triangles = []
        for shape in shapes:
            for face in body(shape, faces, 1 / least if outer else 1.0):
                triangles += [(face[0], face[i], face[i + 1]) for i in range(1, len(face) - 1)]
        regions.append(triangles)
    return regions
