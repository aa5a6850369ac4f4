"""Whether what a certificate claims is true.

Positions are drawn in the volume, and their view, range and front computed from the files as other programs read them.
"""

import json
import math
import struct

SIZES = {"uchar": "B", "int": "i", "uint": "I", "float": "f", "double": "d"}


def read_as_others_do(data):
    """Line by line."""
    at, elements, line = 0, [], b""
    while line != b"end_header":
        end = data.index(b"\n", at)
        line, at = data[at:end].strip(), end + 1
        words = line.decode("latin-1").split()
        if words[:1] == ["element"]:
            elements.append([int(words[2]), []])
        elif words[:1] == ["property"]:
            elements[-1][1].append(words[1:])
    rows = []
    for count, properties in elements:
        row = struct.Struct("<" + "".join("B3i" if p[0] == "list" else SIZES[p[0]] for p in properties))
        rows.append([row.unpack_from(data, at + i * row.size) for i in range(count)])
        at += count * row.size
    names = [p[-1] for p in elements[0][1]]
    return [tuple(r[names.index(k)] for k in "xyz") for r in rows[0]], [r[1:4] for r in rows[1]]


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def winds_round(mesh, point):
    """Sum of the solid angles of the facets (van Oosterom and Strackee 1983)."""
    total = 0.0
    for face in mesh[1]:
        a, b, c = (minus(mesh[0][v], point) for v in face)
        u, v, w = (math.sqrt(dot(p, p)) for p in (a, b, c))
        total += 2 * math.atan2(dot(a, cross(b, c)), u * v * w + dot(a, b) * w + dot(a, c) * v + dot(b, c) * u)
    return round(total / (4 * math.pi))


def is_hidden(scene, viewpoint, seen):
    """Whether the segment passes through the inside of a triangle; what touches it by rounding does not count."""
    way = minus(seen, viewpoint)
    for face in scene[1]:
        a, b, c = (scene[0][v] for v in face)
        u, v, from_a = minus(b, a), minus(c, a), minus(viewpoint, a)
        across = cross(way, v)
        size = dot(u, across)
        if abs(size) <= 1e-9 * math.sqrt(dot(u, u) * dot(across, across)):
            continue
        first, other = dot(from_a, across) / size, cross(from_a, u)
        second, along = dot(way, other) / size, dot(v, other) / size
        if min(first, second, 1 - first - second) > 1e-6 and 1e-6 < along < 1 - 1e-4:
            return True
    return False


def what_is_false(folder, numbers):
    """Of a certificate that was accepted: something that it claims and that does not hold, or nothing."""
    try:
        return what_does_not_hold(folder, numbers)
    except Exception as problem:  # whatever it is: others cannot read what the checker accepted
        return f"{type(problem).__name__}: {problem}"


def what_does_not_hold(folder, numbers, points=60):
    claims = json.loads((folder / "volume.cert").read_text(encoding="utf-8"))
    volume = read_as_others_do((folder / claims["volume"]["file"]).read_bytes())
    scene = read_as_others_do((folder / claims["scene"]["file"]).read_bytes())
    if len(claims["parts"]) < 1 or not 0 <= claims["shrink"] <= 1e-5:
        return "it claims nothing"
    used = [volume[0][v] for face in volume[1] for v in face]
    low, high = ([f(p[k] for p in used) for k in range(3)] for f in (min, max))
    tiny = 1e-5 * max(map(abs, low + high))
    for _ in range(points):
        place = tuple(numbers.uniform(a, b) for a, b in zip(low, high))
        if winds_round(volume, place) == 0:
            continue
        for box in claims["boxes"]:
            for x, least, most in zip(place, box["min"], box["max"]):
                if (least is not None and x < least - tiny) or (most is not None and x > most + tiny):
                    return f"{place} is outside of a box"
        for part in claims["parts"]:
            raised = [tuple(x + part["shift_m"] * n for x, n in zip(p, part["normal"])) for p in part["target"]]
            middle = tuple(sum(p[k] for p in raised) / len(raised) for k in range(3))
            if part["cut_height_m"] is not None and dot(part["normal"], minus(place, middle)) < -tiny:
                return f"{place} is behind the target"
            for corner in raised:
                inner = tuple(x + 1e-3 * (m - x) for x, m in zip(corner, middle))
                if math.dist(place, corner) > claims["max_range_m"] + tiny:
                    return f"{place} is out of range"
                if is_hidden(scene, place, inner):
                    return f"{inner} is hidden from {place}"
    return ""
