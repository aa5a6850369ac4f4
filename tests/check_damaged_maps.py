#!/usr/bin/env python3
"""Real maps with damaged buildings: nothing may vanish without a word, and no stand-in may hide too little.

    check_damaged_maps.py PROGRAM [--damages 1000] [--seed 1] [--jobs 2] [--keep FOLDER]

Takes buildings of the extracts in data/osm of VANTAGE_SHARED (../shared beside the project), with what stands round
them, and damages one of them: rings are opened, ways removed, courtyards moved across their outlines, heights garbled,
corners swapped; and posts of a surface raster lose their heights. Each damage must leave the building as it is, or be
in the ledger. Positions round the building are then asked of the sound map and of the damaged one, whether they see a
target beside it: none may be claimed that the sound map refutes, but where a height is lost that nothing else tells, or
a way of a ring, of which what is known is held, "in part": the ledger says that it may be larger. So it says of each
ring of a relation that is open, since a way may be gone.
Prints a table, and exits with 1 for a fault.
"""

import argparse
import collections
import concurrent.futures
import copy
import csv
import json
import math
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

EXTRACTS = ["empire-state-600m.osm.pbf", "helsinki.osm.pbf", "new-york-les.osm.pbf", "singapore-bayfront.osm.pbf",
            "berlin-siegessaeule.osm.gz", "erlangen.osm.gz", "monaco.osm.pbf", "manhattan-midtown.osm.pbf"]
RASTER = "dsm.tif"
REACH_M = 90
METRES_PER_DEGREE = 111320.0
CLOSE_M = 0.05  # of a border: the two frames round differently


class Map:
    """The nodes, ways and relations of an extract."""

    def __init__(self, file: pathlib.Path) -> None:
        with tempfile.TemporaryDirectory() as scratch:
            xml = pathlib.Path(scratch) / "map.osm"
            subprocess.run(["osmium", "cat", "-o", xml, file], check=True, capture_output=True)
            root = ElementTree.parse(xml).getroot()
        self.nodes = {e.get("id"): (float(e.get("lat")), float(e.get("lon")))
                      for e in root.iter("node") if e.get("lat")}
        self.ways = {e.get("id"): e for e in root.iter("way")}
        self.relations = {e.get("id"): e for e in root.iter("relation")}
        self.reach = {e: self.places(e) for e in (*self.ways.values(), *self.relations.values())}
        self.boxes = {e: tuple(limit(p[axis] for p in places) for axis in (0, 1) for limit in (min, max))
                      for e, places in self.reach.items() if places}

    def places(self, element: ElementTree.Element) -> list[tuple[float, float]]:
        if element.tag == "way":
            return [self.nodes[n.get("ref")] for n in element.iter("nd") if n.get("ref") in self.nodes]
        ways = [self.ways[m.get("ref")] for m in element.iter("member") if m.get("ref") in self.ways]
        return [place for way in ways for place in self.places(way)]


def tags(element: ElementTree.Element) -> dict[str, str]:
    return {t.get("k"): t.get("v") for t in element.iter("tag")}


def is_building(element: ElementTree.Element) -> bool:
    return tags(element).get("building", "no") != "no" and "building:part" not in tags(element)


def is_whole(city: Map, way: ElementTree.Element) -> bool:
    refs = [n.get("ref") for n in way.iter("nd")]
    return len(refs) > 4 and refs[0] == refs[-1] and all(ref in city.nodes for ref in refs)


class Piece:
    """A building and what stands round it, about a place."""

    def __init__(self, city: Map, building: ElementTree.Element) -> None:
        self.id = f"{building.tag}/{building.get('id')}"
        own = city.places(building)
        self.south, self.north = min(p[0] for p in own), max(p[0] for p in own)
        self.west, self.east = min(p[1] for p in own), max(p[1] for p in own)
        self.center = ((self.south + self.north) / 2, (self.west + self.east) / 2)
        self.per_degree = (METRES_PER_DEGREE, METRES_PER_DEGREE * math.cos(math.radians(self.center[0])))
        self.relations = {i: copy.deepcopy(r) for i, r in city.relations.items() if self.touches(city, r)
                          and tags(r).get("type") in ("multipolygon", "building")}
        members = {m.get("ref") for r in self.relations.values() for m in r.iter("member") if m.get("type") == "way"}
        self.ways = {i: copy.deepcopy(w) for i, w in city.ways.items() if i in members or self.touches(city, w)}
        self.nodes = {n.get("ref"): city.nodes[n.get("ref")] for w in self.ways.values() for n in w.iter("nd")
                      if n.get("ref") in city.nodes}

    def half(self) -> tuple[float, float]:
        return ((self.north - self.south) / 2 * self.per_degree[0], (self.east - self.west) / 2 * self.per_degree[1])

    def touches(self, city: Map, element: ElementTree.Element) -> bool:
        margin = [REACH_M / m for m in self.per_degree]
        south, north = self.south - margin[0], self.north + margin[0]
        west, east = self.west - margin[1], self.east + margin[1]
        if element not in city.boxes:
            return False
        low_lat, high_lat, low_lon, high_lon = city.boxes[element]
        return (low_lat < north and high_lat > south and low_lon < east and high_lon > west and
                any(south < lat < north and west < lon < east for lat, lon in city.reach[element]))

    def is_whole(self, way: ElementTree.Element) -> bool:
        return all(n.get("ref") in self.nodes for n in way.iter("nd"))

    def element(self) -> ElementTree.Element:
        kind, number = self.id.split("/")
        return (self.ways if kind == "way" else self.relations)[number]

    def rings(self) -> list[ElementTree.Element]:
        """The ways of its outer rings that are in the file."""
        if self.id.startswith("way"):
            return [self.element()]
        return [self.ways[m.get("ref")] for m in self.element().iter("member")
                if m.get("role") == "outer" and m.get("ref") in self.ways]

    def text(self) -> bytes:
        root = ElementTree.Element("osm", version="0.6")
        for number, (lat, lon) in self.nodes.items():
            ElementTree.SubElement(root, "node", id=number, version="1", lat=f"{lat:.7f}", lon=f"{lon:.7f}")
        root.extend(self.ways.values())
        root.extend(self.relations.values())
        return ElementTree.tostring(root)


# ---- the damages: each returns whether it could be done


def open_ring(piece: Piece, numbers: random.Random) -> bool:
    way = numbers.choice(piece.rings())
    refs = way.findall("nd")
    if len(refs) < 4:
        return False
    way.remove(refs[-1])
    return True


def remove_way(piece: Piece, numbers: random.Random) -> bool:
    """A way of a ring that is made of several: out of the relation, or out of the file."""
    rings = piece.rings()
    if piece.id.startswith("way") or len(rings) < 2:
        return False
    lost = numbers.choice([w for w in rings])
    refs = [n.get("ref") for n in lost.iter("nd")]
    if refs[0] == refs[-1]:
        return False
    if numbers.random() < 0.5:
        del piece.ways[lost.get("id")]
        return True
    for member in piece.element().findall("member"):
        if member.get("ref") == lost.get("id"):
            piece.element().remove(member)
    return True


def move_inner(piece: Piece, numbers: random.Random) -> bool:
    """A courtyard goes across the outline, as far as half of it or a hair's breadth."""
    inner = [m.get("ref") for m in piece.element().iter("member") if m.get("role") == "inner"]
    inner = [i for i in inner if i in piece.ways]
    if not inner:
        return False
    refs = {n.get("ref") for n in piece.ways[numbers.choice(inner)].iter("nd")}
    others = {n.get("ref") for w in piece.rings() for n in w.iter("nd")}
    if refs & others or not refs <= piece.nodes.keys():
        return False
    axis, side = numbers.randrange(2), numbers.choice((-1, 1))
    places = [piece.nodes[r] for r in refs]
    border = (piece.north, piece.east)[axis] if side > 0 else (piece.south, piece.west)[axis]
    edge = max(p[axis] for p in places) if side > 0 else min(p[axis] for p in places)
    beyond = numbers.choice((0.02, 0.5, 3.0)) / piece.per_degree[axis]
    for ref in refs:
        place = list(piece.nodes[ref])
        place[axis] += border - edge + side * beyond
        piece.nodes[ref] = (place[0], place[1])
    return True


def height_tag(piece: Piece) -> ElementTree.Element | None:
    return next((t for t in piece.element().iter("tag") if t.get("k") == "height"), None)


def garble_height(piece: Piece, numbers: random.Random) -> bool:
    """A height that is no plain number, but holds it."""
    tag = height_tag(piece)
    try:
        height = float(tag.get("v").removesuffix("m").strip()) if tag is not None else 0
    except ValueError:
        return False
    if height <= 0:
        return False
    form = numbers.choice(("~{h:g}", "{l:g}-{h:g}", "{h:g} m (approx)", "{l:g}m - {h:g}m", "ca. {h:g}", "{h:g} m high",
                           "{h:g}+", "c{h:g}", "{h:g}/{l:g}", "{h:g} to {l:g} m"))
    tag.set("v", form.format(h=height, l=max(1, round(height / 2))))
    return True


def lose_height(piece: Piece, numbers: random.Random) -> bool:
    """A height that nothing tells any more."""
    tag = height_tag(piece)
    if tag is None or any(t.get("k") in ("building:levels", "est_height", "building:height")
                          for t in piece.element().iter("tag")):
        return False
    tag.set("v", numbers.choice(("high", "unknown", "?", "tall", "n/a", "-", "m")))
    return True


def swap_nodes(piece: Piece, numbers: random.Random) -> bool:
    """Two corners that follow each other change places, so that the ring crosses itself."""
    way = numbers.choice(piece.rings())
    refs = way.findall("nd")
    if len(refs) < 5 or refs[0].get("ref") != refs[-1].get("ref") or not piece.is_whole(way):
        return False
    at = numbers.randrange(1, len(refs) - 2)
    corners = [piece.nodes[r.get("ref")] for r in refs[at - 1:at + 3]]
    a, b = refs[at].get("ref"), refs[at + 1].get("ref")
    refs[at].set("ref", b)
    refs[at + 1].set("ref", a)
    return crosses(corners[0], corners[2], corners[1], corners[3])


def crosses(a, b, c, d) -> bool:
    def turn(o, p, q):
        return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0])
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def nothing_tells(damage: str, fate: str) -> bool:
    """Of a height that is lost, how high; of a way that is gone, how far it went: the ledger says "may be larger"."""
    return fate == "ledger only" or (fate == "in part" and damage == "remove_way")


DAMAGES = [open_ring, remove_way, move_inner, garble_height, lose_height, swap_nodes]


# ---- judging


def run(program: str, arguments: list, folder: pathlib.Path) -> subprocess.CompletedProcess:
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=120, check=False)


def mission_text(file: str, piece: Piece, target: tuple[float, float]) -> str:
    return (f"scene: {{osm: {file}, center: [{piece.center[0]:.9f}, {piece.center[1]:.9f}], radius: 400}}\n"
            f"target: {{center: [{target[0]:.9f}, {target[1]:.9f}], width: 4, length: 4}}\n"
            "sensor: {max_range: 150}\n")


def positions(piece: Piece, numbers: random.Random) -> str:
    half = piece.half()
    rows = ["x,y,z"]
    for _ in range(300):
        x, y = numbers.uniform(-1, 1) * (half[1] + 40), numbers.uniform(-1, 1) * (half[0] + 40)
        rows.append(f"{x:.3f},{y:.3f},{numbers.uniform(1, 60):.3f}")
    return "\n".join(rows) + "\n"


def answers(program: str, mission: str, folder: pathlib.Path) -> list[tuple[bool, float]] | None:
    done = run(program, ["query", mission, "points.csv", "--quiet"], folder)
    if done.returncode != 0:
        return None
    return [(row["inside"] == "true", float(row["margin_m"] or 0)) for row in csv.DictReader(done.stdout.splitlines())]


def built(program: str, file: str, folder: pathlib.Path) -> tuple[dict, dict]:
    """What is built by id, as numbers that tell it, and the ledger by id."""
    listed = run(program, ["inspect", file, "--objects", "*", "--json"], folder)
    objects = {o["source_id"]: (round(o["height_m"], 3), round(o.get("footprint_m2") or 0, 1))
               for o in json.loads(listed.stdout)["objects"]} if listed.returncode == 0 else {}
    told = run(program, ["inspect", file, "--json"], folder)
    if told.returncode != 0:
        return objects, {}
    told = json.loads(told.stdout)
    ledger = {e["object"]: e for e in told["ledger"]}
    for passed in told["passed_over"]:  # for a way that bounds a relation the relation stands in
        other = re.search(r"(?:way|relation)/\d+", passed["reason"])
        if other and other[0] in ledger:
            ledger.setdefault(passed["object"], ledger[other[0]])
    return objects, ledger


def fate(sound: tuple[dict, dict], damaged: tuple[dict, dict], name: str) -> str:
    entry = damaged[1].get(name)
    if entry is None:
        return "built right" if damaged[0].get(name) == sound[0].get(name) is not None else "silent"
    if entry["stand_in"] is None or (entry["may_be_larger"] and entry["reason"].startswith("height=")):
        return "ledger only"
    return "in part" if entry["may_be_larger"] else "held"


def over_claimed(program: str, piece: Piece, numbers: random.Random, folder: pathlib.Path) -> tuple[int, int]:
    """How many positions were judged, and how many the damaged map claims that the sound one refutes."""
    (folder / "points.csv").write_text(positions(piece, numbers))
    half = piece.half()
    for _ in range(6):
        angle = numbers.uniform(0, 2 * math.pi)
        north = (half[0] + 10) * math.sin(angle) / piece.per_degree[0]
        east = (half[1] + 10) * math.cos(angle) / piece.per_degree[1]
        target = (piece.center[0] + north, piece.center[1] + east)
        for which in ("sound", "damaged"):
            (folder / f"{which}.yaml").write_text(mission_text(f"{which}.osm", piece, target))
        sound = answers(program, "sound.yaml", folder)
        if sound is None:
            continue  # something stands on it
        damaged = answers(program, "damaged.yaml", folder)
        if damaged is None:
            return len(sound), 0  # a stand-in holds the target: nothing is claimed
        wrong = sum(there and not here and abs(margin) > CLOSE_M and abs(other) > CLOSE_M
                    for (there, other), (here, margin) in zip(damaged, sound, strict=True))
        return len(sound), wrong
    return 0, 0


Result = collections.namedtuple("Result", "damage fate judged wrong what")


def try_damage(program: str, city: Map, choices: list, seed: str, kept: pathlib.Path | None) -> Result | None:
    numbers = random.Random(seed)
    damage = numbers.choice(DAMAGES)
    for _ in range(30):  # few buildings have a courtyard, and fewer a ring of several ways
        piece = Piece(city, numbers.choice(choices))
        sound = piece.text()
        if damage(piece, numbers):
            break
    else:
        return None
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "sound.osm").write_bytes(sound)
        (folder / "damaged.osm").write_bytes(piece.text())
        before, after = built(program, "sound.osm", folder), built(program, "damaged.osm", folder)
        if piece.id in before[1] or piece.id not in before[0]:
            return None  # it is damaged as it is, or its parts are built in its place
        became = fate(before, after, piece.id)
        judged, wrong = over_claimed(program, piece, numbers, folder)
        what = f"{piece.id}, {damage.__name__}, {became}: {wrong} of {judged} positions; seed {seed!r}"
        if kept is not None and (became == "silent" or (wrong and not nothing_tells(damage.__name__, became))):
            shutil.copytree(folder, kept / seed.replace(" ", "-"), dirs_exist_ok=True)
        return Result(damage.__name__, became, judged, wrong, what)


# ---- posts of a raster


class Raster:
    """The posts of an uncompressed GeoTIFF of 32-bit floats, 1 m apart, and where they lie in the file."""

    def __init__(self, file: pathlib.Path) -> None:
        self.bytes = file.read_bytes()
        (directory,) = struct.unpack_from("<I", self.bytes, 4)
        entries = [struct.unpack_from("<HHII", self.bytes, directory + 2 + 12 * i)
                   for i in range(struct.unpack_from("<H", self.bytes, directory)[0])]
        value = {tag: at for tag, _, _, at in entries}
        strips = next(count for tag, _, count, _ in entries if tag == 273)
        self.columns, self.rows = value[256], value[257]
        offsets = struct.unpack_from(f"<{strips}I", self.bytes, value[273])
        per_strip = value[278]
        self.place = [offsets[r // per_strip] + 4 * ((r % per_strip) * self.columns + c)
                      for r in range(self.rows) for c in range(self.columns)]
        self.heights = [struct.unpack_from("<f", self.bytes, at)[0] for at in self.place]
        self.void = min(self.heights)

    def block(self, row: int, column: int, rows: int, columns: int) -> list[int]:
        return [r * self.columns + c for r in range(row, row + rows) for c in range(column, column + columns)]

    def without(self, posts: list[int]) -> bytes:
        text = bytearray(self.bytes)
        for post in posts:
            struct.pack_into("<f", text, self.place[post], self.void)
        return bytes(text)


def void_posts(program: str, raster: Raster, seed: str, kept: pathlib.Path | None) -> Result | None:
    """Up to 18 m of posts near the middle. Where one of them is higher than all of the rim nothing tells that."""
    numbers = random.Random(seed)
    rows, columns = numbers.randint(1, 18), numbers.randint(1, 18)
    row = raster.rows // 2 + numbers.randint(-30, 12)
    column = raster.columns // 2 + numbers.randint(-30, 12)
    lost = raster.block(row, column, rows, columns)
    rim = set(raster.block(row - 1, column - 1, rows + 2, columns + 2)) - set(lost)
    if any(raster.heights[post] == raster.void for post in [*lost, *rim]):
        return None
    is_told = max(raster.heights[p] for p in lost) <= max(raster.heights[p] for p in rim)
    near = [h for h in (raster.heights[p] for p in raster.block(row - 30, column - 30, rows + 60, columns + 60))
            if h != raster.void]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "sound.tif").write_bytes(raster.bytes)
        (folder / "damaged.tif").write_bytes(raster.without(lost))
        told = [json.loads(run(program, ["inspect", f"{name}.tif", "--json"], folder).stdout)
                for name in ("sound", "damaged")]
        # The void's middle in the scene, whose axes are turned by some degrees against those of the raster.
        x, y = column + columns / 2 - raster.columns / 2, raster.rows / 2 - row - rows / 2
        points = ["x,y,z"] + [f"{x + numbers.uniform(-40, 40):.3f},{y + numbers.uniform(-40, 40):.3f},"
                              f"{numbers.uniform(min(near), max(near) + 15):.3f}" for _ in range(300)]
        (folder / "points.csv").write_text("\n".join(points) + "\n")
        judged = wrong = 0
        for _ in range(6):
            a, b = x + numbers.uniform(-25, 25), y + numbers.uniform(-25, 25)
            z = numbers.uniform(min(near), max(near))
            corners = ", ".join(f"[{a + i:.3f}, {b + j:.3f}, {z:.3f}]" for i, j in ((0, 0), (3, 0), (3, 3), (0, 3)))
            for name in ("sound", "damaged"):
                (folder / f"{name}.yaml").write_text(f"scene: {{raster: {name}.tif, error: 0.001}}\n"
                                                     f"target: {{vertices: [{corners}]}}\nsensor: {{max_range: 70}}\n")
            sound = answers(program, "sound.yaml", folder)
            damaged = None if sound is None else answers(program, "damaged.yaml", folder)
            if damaged is None:
                continue
            judged = len(sound)
            wrong = sum(there and not here and abs(margin) > CLOSE_M and abs(other) > CLOSE_M
                        for (there, other), (here, margin) in zip(damaged, sound, strict=True))
            break
        became = "silent" if len(told[1]["ledger"]) == len(told[0]["ledger"]) else "held" if is_told else "ledger only"
        what = f"{rows} x {columns} posts, {became}: {wrong} of {judged} positions; seed {seed!r}"
        if kept is not None and (became == "silent" or (wrong and not nothing_tells("void_posts", became))):
            shutil.copytree(folder, kept / seed.replace(" ", "-"), dirs_exist_ok=True)
        return Result(void_posts.__name__, became, judged, wrong, what)


def report(results: list[Result]) -> int:
    fates = ["built right", "held", "in part", "ledger only", "silent"]
    print(f"{'damage':16}" + "".join(f"{f:>14}" for f in fates) + f"{'positions':>12}{'over-claimed':>14}")
    for damage in [*DAMAGES, void_posts]:
        own = [r for r in results if r.damage == damage.__name__]
        counts = collections.Counter(r.fate for r in own)
        wrong = sum(r.wrong for r in own if not nothing_tells(r.damage, r.fate))
        print(f"{damage.__name__:16}" + "".join(f"{counts[f]:14}" for f in fates) +
              f"{sum(r.judged for r in own):12}{wrong:14}")
    faults = [r for r in results if r.fate == "silent" or (r.wrong and not nothing_tells(r.damage, r.fate)) or
              (r.fate == "ledger only" and r.damage not in ("lose_height", "void_posts"))]
    for fault in faults[:40]:
        print("FAULT", fault.what)
    unknown = [r for r in results if r.fate == "in part" and r.wrong and nothing_tells(r.damage, r.fate)]
    print(f"{len(unknown)} removed ways leave claims that the sound map refutes; the ledger says that more may stand there")
    print(f"{len(results)} damages, {sum(r.judged for r in results)} positions, {len(faults)} faults")
    return 1 if faults or not results else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--damages", type=int, default=1000)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    shared = pathlib.Path(os.environ.get("VANTAGE_SHARED", pathlib.Path(__file__).resolve().parents[2] / "shared"))
    files = [shared / "data" / "osm" / name for name in EXTRACTS]
    files = [file for file in files if file.exists()]
    if not files:
        print("skipped: set VANTAGE_SHARED to the folder that holds data/osm")
        return 0
    program = str(pathlib.Path(arguments.program).resolve())
    cities = []
    for file in files:
        city = Map(file)
        choices = [w for w in city.ways.values() if is_building(w) and is_whole(city, w)]
        relations = [r for r in city.relations.values() if is_building(r) and tags(r).get("type") == "multipolygon"]
        # Relations are few, and most damages are of theirs.
        cities.append((city, choices + relations * max(1, len(choices) // max(1, 2 * len(relations)))))
    surface = Raster(shared / "data" / "dsm" / RASTER)
    results: list[Result] = []

    def damage_one(number: int) -> Result | None:
        seed, turn = f"{arguments.seed} {number}", number % (len(cities) + 1)
        if turn == len(cities):
            return void_posts(program, surface, seed, arguments.keep)
        return try_damage(program, *cities[turn], seed, arguments.keep)

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        number = 0
        while len(results) < arguments.damages and number < 20 * arguments.damages:
            batch = range(number, number + 4 * arguments.jobs)
            number = batch.stop
            results.extend(r for r in pool.map(damage_one, batch) if r is not None)
    print(f"seed {arguments.seed}; {', '.join(file.name for file in files)}")
    return report(results[:arguments.damages])


if __name__ == "__main__":
    sys.exit(main())
