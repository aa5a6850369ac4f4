#!/usr/bin/env python3
"""Checks that no tour of some regions is shorter than a certificate says. Needs Python 3.8 and nothing else.

    python3 check_tour.py tour.cert

All is decided with whole numbers; nothing of the program that found the bound is believed. docs/theory.md, "Tours", has
the proofs. In short, a leg with a vector u, not longer than 1, is no shorter than its progress along u, so that a tour
is no shorter than the sum over its stops of the least (u before - u behind) . v over the corners v of its region. The
tree covers all tours: "insert" puts a region behind each stop, "cut" takes both sides of a plane, "edge" fixes an edge
in and out. Only files say that regions hold all there is to visit. Exits with 0 accepted, 1 refused, 2 unreadable."""

import argparse, hashlib, json, math, re, struct, sys  # noqa: E401
from fractions import Fraction
from pathlib import Path

UNIT, BITS, LARGEST = 1 << 30, 90, 1e9  # of vectors; lengths are in 2^-90 m, or finer; metres
HEADER = re.compile(rb"ply\nformat binary_little_endian 1\.0\ncomment vantage region: (outer|given)\nelement vertex "
                    rb"([1-9][0-9]{0,9})\nproperty double x\nproperty double y\nproperty double z\nelement face "
                    rb"([1-9][0-9]{0,9})\nproperty list uchar int vertex_indices\nend_header\n")

class Refused(Exception):
    """The certificate does not prove what it says."""

class Unreadable(Exception):
    """A file is not what it should be."""

def demand(holds, problem, error=Refused):
    if not holds:
        raise error(problem)

def parsed(text, kind, most):
    demand(len(text) <= most and math.isfinite(kind(text)), "a number that no double holds")
    return kind(text)

def list_of(values, kinds, count=None):
    """Bools and strings are neither numbers nor lists."""
    demand(type(values) is list and all(type(v) in kinds for v in values), "a list of other things than it should hold")
    demand(count is None or len(values) == count, "a list is too long or too short")
    return values

def indices(values, end):
    demand(all(0 <= v < end for v in list_of(values, [int])), "an index out of range")
    return values

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

def vectors_of(numbers):
    demand(len(list_of(numbers, [int])) % 3 == 0, "a vector is not three numbers")
    vectors = [tuple(numbers[i:i + 3]) for i in range(0, len(numbers), 3)]
    demand(all(dot(v, v) <= UNIT * UNIT for v in vectors), "a vector is longer than 1")
    return vectors

def read_mesh(path, kind, said):
    """The triangles, as nine numbers each, of the PLY files that vantage writes beside certificates."""
    header = HEADER.match(data := path.read_bytes() if path.is_file() else b"")
    demand(header or b"vantage volume: " not in data, f"{path}: a computed volume lies inside, there is no bound of it")
    demand(header, f"{path}: is no mesh of a region", Unreadable)
    demand(header[1].decode() == kind, f"{path}: is a region of another kind")
    vertices, faces = int(header[2]), int(header[3])
    middle = header.end() + 24 * vertices
    demand(len(data) == middle + 13 * faces, f"{path}: its size is not the one that its header says", Unreadable)
    places = list(struct.iter_unpack("<3d", data[header.end():middle]))
    demand(all(abs(x) <= LARGEST for p in places for x in p), f"{path}: a coordinate is not finite, or too large")
    digest, triangles = hashlib.sha256(b"vantage volume 1\n" + struct.pack("<Q", faces)), []
    for count, *corners in struct.iter_unpack("<B3i", data[middle:]):
        demand(count == 3 and all(0 <= c < vertices for c in corners), f"{path}: a face is no triangle of its vertices")
        triangles.append([x + 0.0 for c in corners for x in places[c]])
        digest.update(struct.pack("<9d", *triangles[-1]))
    demand(digest.hexdigest() == said, f"{path}: is not the region that the certificate is about")
    return triangles

class Cell:
    """A region on some sides of planes. Corners (x, y, z, w) are the point (x, y, z) / w, which boxes have rounded."""

    def __init__(self, region, polygons, is_cut):
        self.region, self.polygons, self.is_cut, self.parts, self.known = region, polygons, is_cut, {}, {}
        points = sorted({tuple(x // c[3] for x in c[:3]) for p in polygons for c in p})
        self.root = self.boxes(points) if points else None

    def boxes(self, points):
        box = [least(p[k] for p in points) for least in (min, max) for k in range(3)]
        if len(points) <= 6:
            return box, points, None
        axis, half = max(range(3), key=lambda k: box[k + 3] - box[k]), len(points) // 2
        points = sorted(points, key=lambda p: p[axis])
        return box, self.boxes(points[:half]), self.boxes(points[half:])

    def least(self, direction):
        """Of direction . point, in units of lengths times those of vectors."""
        demand(self.root, "a part of a region is empty")
        if direction not in self.known:
            (x, y, z), (a, b, c) = direction, (0 if d >= 0 else 3 for d in direction)
            best, stack = math.inf, [self.root]
            while stack:
                box, first, second = stack.pop()
                if x * box[a] + y * box[1 + b] + z * box[2 + c] >= best:
                    continue
                if second is None:
                    best = min(best, min(dot(direction, p) for p in first))
                else:
                    stack += [first, second]
            self.known[direction] = best - self.is_cut * sum(map(abs, direction))  # what rounding may hide
        return self.known[direction]

    def cut(self, normal, offset):
        """What is above the plane, and below it."""
        if (normal, offset) not in self.parts:
            halves = [[clip(p, normal, offset, side) for p in self.polygons] for side in (1, -1)]
            self.parts[normal, offset] = [Cell(self.region, [p for p in half if p], True) for half in halves]
        return self.parts[normal, offset]

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
    """What the certificate is about, in whole numbers."""

    def __init__(self, certificate, folder):
        keys = {"format", "bound_m", "turn_radius_m", "closed", "first", "last", "regions", "proof"}
        demand(certificate["format"] == "vantage tour certificate 2", "a certificate of another version")
        self.missing = certificate.pop("scene_incomplete", None)
        demand(set(certificate) == keys, "keys too many or too few")
        demand(self.missing is None or type(self.missing) is str, "what the scene lacks is no text", Unreadable)
        demand(self.missing != "", "it says that the scene lacks nothing")
        self.closed, self.regions = certificate["closed"], list_of(certificate["regions"], [dict])
        soups = [self.read(region, folder) for region in self.regions]
        self.bits = max([BITS] + [x.as_integer_ratio()[1].bit_length() - 1 for s in soups for t in s for x in t])
        demand(self.bits <= 400, "a coordinate is too fine")
        corners = lambda t: [tuple(map(self.whole, t[k:k + 3])) + (1,) for k in range(0, len(t), 3)]  # noqa: E731
        self.cells = [Cell(i, list(map(corners, soup)), False) for i, soup in enumerate(soups)]
        self.radius = self.whole(certificate["turn_radius_m"])
        self.dwell = [self.whole(region["dwell_m"]) for region in self.regions]
        self.places = {i for i, region in enumerate(self.regions) if region["kind"] == "point"}
        self.ends = [e for e in (certificate["first"], certificate["last"]) if e is not None]
        demand(len(set(indices(self.ends, len(soups)))) == len(self.ends), "one region is both ends")
        demand(all(d >= 0 for d in self.dwell + [self.radius]), "a stay or a radius of negative length")
        demand(type(self.closed) is bool and (not self.ends if self.closed else certificate["first"] is not None),
               "neither closed nor open, or ends that it cannot have")
        demand(all(e in self.places and not self.dwell[e] for e in self.ends), "an end is no place")

    def whole(self, number):
        demand(type(number) in (int, float) and abs(number) <= 1e15, "no number, or too large")
        top, bottom = float(number).as_integer_ratio()
        demand(bottom.bit_length() - 1 <= self.bits, "a number is too fine")
        return top << (self.bits - bottom.bit_length() + 1)

    @staticmethod
    def read(region, folder):
        demand(type(region["name"]) is str, "a region has a name that is no text", Unreadable)
        if region["kind"] == "point":
            demand(set(region) == {"name", "kind", "dwell_m", "at"}, "a place has keys too many or too few")
            demand(all(abs(x) <= LARGEST for x in list_of(region["at"], [int, float], 3)), "a place is too far")
            return [list(map(float, region["at"]))]
        demand(region["kind"] in ("outer", "given"), "a region of a kind that no bound can be over")
        demand(set(region) == {"name", "kind", "dwell_m", "file", "hash"}, "a region has keys too many or too few")
        demand(re.fullmatch(r"[\w.-]+", region["file"], re.ASCII), "a mesh lies in another folder")
        return read_mesh(folder / region["file"], region["kind"], region["hash"])

def turning(tour, cell, before, behind, rooms):
    """What turning adds at a stop between legs of these vectors; `rooms`: the least ways over ground beside it."""
    squares, one = [v[0] * v[0] + v[1] * v[1] for v in (before, behind)], UNIT * UNIT
    along, norms = before[0] * behind[0] + before[1] * behind[1], math.isqrt(squares[0] * squares[1])
    if not tour.radius * norms or cell.region in tour.places:  # where flights begin and end, in any direction
        return 0
    cosine = min(one, -(-one * along // (norms + (along < 0))))  # from here to `half` all is rounded to less turning
    quarter = math.isqrt(UNIT * max(0, UNIT - 1 - math.isqrt((one + cosine) // 2)) // 2)  # its sine, then a series
    half = 2 * quarter + quarter ** 3 // (3 * one) + 3 * quarter ** 5 // (20 * one * one)
    costs = [a ** 3 * (20 * one - a * a) // (120 * one * one)  # a - sin a, or less
             for a in [half] + [min(2 * half, max(0, room) // (2 * tour.radius)) for room in rooms]]
    return math.isqrt(min(squares)) * min(2 * costs[0], *costs[1:]) * tour.radius // UNIT

def room(start, u, end):
    return start.least((-u[0], -u[1], 0)) + end.least((u[0], u[1], 0))

def leaf_of_insertion(tour, stops, vectors):
    points, stays = [], []  # a stop with a dwell is two points, with a leg between that counts as so long at least
    for cell, stay in ((cell, tour.dwell[cell.region]) for cell in stops):
        points, stays = (points + [cell, cell], stays + [stay, 0]) if stay else (points + [cell], stays + [0])
    demand(len(vectors) == len(points) - (not tour.closed or len(points) == 1), "vectors for another number of legs")
    demand(all(s.root for s in stops), "a part of a region is empty")
    ends = vectors[-1:] + vectors if tour.closed else [(0, 0, 0)] + vectors + [(0, 0, 0)]
    around = list(zip(points if vectors else [], ends, ends[1:]))  # a stop, the vectors of its legs
    total = sum(cell.least(tuple(a - b for a, b in zip(before, behind))) for cell, before, behind in around)
    turned = tour.radius and tour.places <= {c.region for c in points}  # elsewhere a flight could begin on the way
    turns = [(c, u, v) for c, u, v in around if u != v or c.region in tour.places] if turned else []
    rooms = [room(turns[k - 1][0], u, c) for k, (c, u, v) in enumerate(turns)]
    total += sum(turning(tour, *turn, both) for turn, both in zip(turns, zip(rooms, rooms[1:] + rooms[:1])))
    return total + sum(s * (UNIT - 1 - math.isqrt(dot(v, v) - 1) if any(v) else UNIT) for v, s in zip(vectors, stays))

def check_insertion(tour, proof):
    demand(set(proof) == {"kind", "root", "tree"}, "keys too many or too few")
    root, least = indices(proof["root"], len(tour.cells)), math.inf
    three = len(set(root)) == min(3, len(tour.cells)) == len(root)
    demand(three if tour.closed else root == tour.ends, "the tree does not begin with three regions, or the ends")
    waiting = [[tour.cells[r] for r in root]]
    for kind, *of in list_of(proof["tree"], [list]):
        demand(waiting, "the tree has too many nodes")
        stops = waiting.pop()
        if kind == "leaf":
            least = min(least, leaf_of_insertion(tour, stops, vectors_of(*of)))
        elif kind == "insert":
            region, = indices(of, len(tour.cells))
            demand(all(s.region != region for s in stops), "a region is inserted that is there")
            places = range(len(stops) - (len(tour.ends) == 2), 0, -1)
            waiting += [stops[:i] + [tour.cells[region]] + stops[i:] for i in places]
        elif kind == "cut":
            cell, (stop, normal, offset) = stops[indices(of[:1], len(stops))[0]], of
            demand(not tour.dwell[cell.region], "a region where the flight stays is cut")
            demand(any(list_of(normal, [int], 3)) and all(abs(n) <= 1 for n in normal), "no plane")
            halves = reversed(cell.cut(tuple(normal), tour.whole(offset)))
            waiting += [stops[:stop] + [half] + stops[stop + 1:] for half in halves]
        else:
            demand(kind == "empty" and not of and not all(s.root for s in stops), "said to be empty, and is not")
    demand(not waiting, "the tree ends too early")
    return least

def leaf_of_pairs(tour, rows, origin, inside, outside, p, d, sets):
    """`inside` and `outside`: edges that are fixed. The region behind the last one is everywhere."""
    def u(i, j):
        return rows[i][j] if j < i else tuple(-x for x in rows[j][i])

    def cost(i, j, k):
        if i == len(tour.cells):
            return 0
        both, cell, stay = tuple(a + b for a, b in zip(u(i, j), u(i, k))), tour.cells[i], tour.dwell[i]
        least = cell.least(u(i, j)) + cell.least(u(i, k)) + stay * UNIT if stay else cell.least(both)
        if tour.radius and not stay and max(j, k) < len(tour.cells):
            rooms = [room(tour.cells[other], u(i, other), cell) for other in (j, k)]
            least += turning(tour, cell, u(i, j), u(k, i), rooms)
        return least - dot(both, origin)  # p and d are of points about it

    total = sum(2 * x for x in d) + sum(2 * s for s, _ in sets)
    for i in range(len(d)):
        beside = [j for j in range(len(d)) if j != i and (min(i, j), max(i, j)) not in outside]
        must = {j for j in beside if (min(i, j), max(i, j)) in inside}
        pairs = ((j, k) for j in beside for k in beside if j < k and must <= {j, k})
        total += min((cost(i, j, k) - p[i][j] - p[i][k] for j, k in pairs), default=math.inf)
        for j in (j for j in beside if j < i):
            left = p[i][j] + p[j][i] - d[i] - d[j] - sum(s for s, of in sets if (i in of) != (j in of))
            total += left if j in must else min(0, left)
    return total

def check_pairs(tour, proof):
    demand(set(proof) == {"kind", "origin", "vectors", "tree"}, "keys too many or too few")
    count, least = len(tour.cells) + (not tour.closed), math.inf
    sets = [[vectors_of(row) for row in list_of(rows, [list], count)] for rows in list_of(proof["vectors"], [list])]
    demand(count > 2 and all(len(row) == i for r in sets for i, row in enumerate(r)), "vectors for other pairs")
    demand(tour.closed or not any(any(map(any, rows[-1])) for rows in sets), "vectors to everywhere are not 0")
    origin = list(map(tour.whole, list_of(proof["origin"], [int, float], 3)))
    dual = lambda numbers, n: [tour.whole(x) * UNIT for x in list_of(numbers, [int, float], n)]  # noqa: E731
    waiting = [({(e, count - 1) for e in tour.ends}, set())]
    for kind, *of in list_of(proof["tree"], [list]):
        demand(waiting, "the tree has too many nodes")
        inside, outside = waiting.pop()
        if kind == "edge":
            i, j = indices(of, count)
            demand(i < j, "no edge")
            waiting += [(inside, outside | {(i, j)}), (inside | {(i, j)}, outside)]
        else:
            demand(kind == "leaf", "a node of no known kind")
            which, p, d, cuts = of
            cuts = [(dual([s], 1)[0], set(indices(members, count))) for s, members in list_of(cuts, [list])]
            demand(all(s >= 0 and 0 < len(members) < count for s, members in cuts), "no set, or less than 0")
            p, rows = [dual(row, count) for row in list_of(p, [list], count)], sets[indices([which], len(sets))[0]]
            least = min(least, leaf_of_pairs(tour, rows, origin, inside, outside, p, dual(d, count), cuts))
    demand(not waiting, "the tree ends too early")
    return least

def check(path, say=print):
    try:
        certificate = json.loads(path.read_text(encoding="ascii") if path.is_file() else "", parse_constant=float,
                                 object_pairs_hook=lambda p: demand(len(dict(p)) == len(p), "a key twice") or dict(p),
                                 parse_float=lambda t: parsed(t, float, 40), parse_int=lambda t: parsed(t, int, 16))
        tour, proof = Tour(certificate, path.parent), certificate["proof"]
        bound = tour.whole(certificate["bound_m"]) * UNIT
        proved = {"insertion": check_insertion, "pairs": check_pairs}[proof["kind"]](tour, proof)
    except (OSError, ValueError, TypeError, LookupError, ArithmeticError, RecursionError, MemoryError) as error:
        raise Unreadable(f"{path}, or a file that it names, is garbled: {type(error).__name__}: {error}") from error
    demand(bound <= max(0, proved), "less is proved than the certificate says")
    for region, stay in zip(tour.regions, tour.dwell):
        say(f"{region['kind']:5} {region['name']!a}" + f": {region['dwell_m']} m in it, for it alone" * (stay > 0))
    wing = f", turning in {certificate['turn_radius_m']} m over ground or more," * (tour.radius > 0)
    say(f"accepted: no {'closed' if tour.closed else 'open'} tour of these {len(tour.regions)}{wing} is shorter than "
        f"{certificate['bound_m']} m ({proof['kind']}, {len(proof['tree'])} nodes)")
    if tour.missing is not None:
        say(f"Of the scene as built: {tour.missing!a}")
    return Fraction(bound, UNIT << tour.bits)

if __name__ == "__main__":
    PARSER = argparse.ArgumentParser(description="Checks a bound of tours.")
    PARSER.add_argument("certificate", type=lambda p: Path(p) if Path(p).is_file() else PARSER.error(f"{p} is no file"))
    try:
        check(PARSER.parse_args().certificate)
    except (Refused, Unreadable) as problem:
        print(f"refused: {problem}" if isinstance(problem, Refused) else problem, file=sys.stderr)
        sys.exit(1 if isinstance(problem, Refused) else 2)
