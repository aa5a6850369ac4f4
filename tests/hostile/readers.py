"""What the program reads: for each kind of file some that are right, and the command that reads them."""

import bz2
import gzip
import io
import json
import pathlib
import struct
import sys
import xml.etree.ElementTree as ElementTree
import zipfile
import zlib
from collections.abc import Callable
from typing import NamedTuple

from hostile import tilesets

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SEEDS = ROOT / "tests" / "fuzz" / "seeds"


class Reader(NamedTuple):
    """A kind of file. FILE in the arguments is the file's name."""

    name: str
    file: str
    arguments: list[str]
    originals: list[bytes]
    pack: Callable[[bytes], bytes] = bytes  # after a change: what is compressed is changed inside
    program: str = ""  # where it is another one: that of the checker of certificates


# ---- files by hand ----

CITY = """o ground
v -60 -60 0\nv 60 -60 0\nv 60 60 0\nv -60 60 0\nf 1 2 3 4
o house
v 8 -5 0\nv 14 -5 0\nv 14 5 0\nv 8 5 0\nv 8 -5 9\nv 14 -5 9\nv 14 5 9\nv 8 5 9
f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12
"""
MISSION = """scene: {mesh: city.obj}
target: {name: square, vertices: [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]}
sensor: {max_range: 25}
exact: {tolerance: 0.2}
"""
MISSIONS = [MISSION, """scene:
  mesh: city.obj
  up: z
  scale: 1.0
  origin: [48.0, 11.0]
target:
  name: wall
  vertices: [[8, -4, 1], [8, 4, 1], [8, 4, 6], [8, -4, 6]]
  front: [-1, 0, 0]
  offset: 0.01
sensor: {max_range: 30, min_range: 2, incidence: 70, camera: {width: 800, height: 600, focal_length: 24,
  sensor_width: 36}, mount: {yaw: any, pitch: -20, roll: 0}, pixel: {size: 0.05, kind: worst}}
navigation:
  altitude: {agl: [1, 40], z: [0, 50]}
  ground: 0
  clearance: 1
  keep_in: [{min: [-40, -40, 0], max: [40, 40, 60]}]
  keep_out: [{polygon: [[-20, -20], [-15, -20], [-15, -12]], z: [0, 10]}]
method: exact
exact: {tolerance: 0.2}
""", """scene: {mesh: city.obj}
targets:
  - {name: a, point: [0, 0, 2]}
  - {name: b, object: house, part: facade, facing: west}
  - {name: c, outline: [[-9, -9], [-3, -9], [-3, -3], [-7, -5]], holes: []}
combine: any
sensor: {max_range: 20}
exact: {tolerance: 0.5}
"""]
FLIGHT_MISSION = """scene: {mesh: city.obj, origin: [48.0, 11.0], sea_level: -100}
targets:
  - {name: square, vertices: [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]}
  - {name: wall, vertices: [[14, 4, 1], [14, -4, 1], [14, -4, 6], [14, 4, 6]], front: [1, 0, 0]}
combine: each
sensor: {max_range: 30}
navigation: {altitude: {agl: [2, 60]}, ground: 0}
tour: {home: [48.0001, 10.9999], view: {dwell: 1, margin: 0.2}, clearance: 1, gap: 0.5, time_limit: 5}
exact: {tolerance: 0.5}
"""
PLANS = ("plan", "waypoints", "kml", "kmz", "gpx", "csv", "geojson")
TOWN_MISSION = """scene: {osm: town.osm, center: [48.0, 11.0], radius: 100}
target: {osm: way/1}
sensor: {max_range: 40}
navigation: {altitude: [2, 60], KEY: [{file: ZONES, heights: any}]}
exact: {tolerance: 0.5}
"""
TARGET_MISSION = """scene: {osm: town.osm, center: [48.0, 11.0], radius: 100}
target: {file: TARGET, feature: square}
sensor: {max_range: 40}
exact: {tolerance: 0.5}
"""
TARGET_GEOJSON = b"""{"type": "FeatureCollection", "features": [
 {"type": "Feature", "properties": {"name": "square"}, "geometry": {"type": "Polygon", "coordinates":
  [[[11.0001, 48.0001], [11.0003, 48.0001], [11.0003, 48.0003], [11.0001, 48.0001]]]}},
 {"type": "Feature", "id": 7, "properties": {}, "geometry": {"type": "Point", "coordinates": [11, 48, 3.5]}}]}
"""
TARGET_KML = b"""<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>square</name><Polygon>
<altitudeMode>relativeToGround</altitudeMode><outerBoundaryIs><LinearRing><coordinates>
11.0001,48.0001,1 11.0003,48.0001,1 11.0003,48.0003,1 11.0001,48.0001,1
</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>
"""
CONFIG = """mesh:
  filename: city.obj
visibility_vol:
  id: 1
  width: 8
  height: 8
  origin: [0.0, 2.0, 5.0]
  up_max: 30.0
  up_min: -1.0
  radius_max: 20.0
  output_file: volume_1.obj
"""


def varint(number: int) -> bytes:
    result = bytearray()
    while number > 127:
        result.append(number & 127 | 128)
        number >>= 7
    result.append(number)
    return bytes(result)


def field(number: int, value: bytes | int) -> bytes:
    """Of a protocol buffer."""
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def signed(numbers: list[int]) -> bytes:
    return b"".join(varint(n << 1 if n >= 0 else (-n << 1) - 1) for n in numbers)


def steps(numbers: list[int]) -> list[int]:
    """Each less the one before."""
    return [n - before for n, before in zip(numbers, [0, *numbers])]


def blob(kind: bytes, content: bytes) -> bytes:
    body = field(2, len(content)) + field(3, zlib.compress(content))
    header = field(1, kind) + field(3, len(body))
    return struct.pack(">I", len(header)) + header + body


PBF_HEADER = blob(b"OSMHeader", field(4, b"OsmSchema-V0.6") + field(4, b"DenseNodes"))


def pbf_block(xml: bytes) -> bytes:
    """A block of what is in an OSM XML file."""
    root = ElementTree.fromstring(xml)
    texts = {"": 0}

    def index(text: str) -> int:
        return texts.setdefault(text, len(texts))

    def tags(element: ElementTree.Element) -> bytes:
        keys = [(index(tag.get("k", "")), index(tag.get("v", ""))) for tag in element.findall("tag")]
        return field(2, b"".join(varint(k) for k, _ in keys)) + field(3, b"".join(varint(v) for _, v in keys))

    groups = []
    nodes = root.findall("node")
    if nodes:
        words = []
        for node in nodes:
            for tag in node.findall("tag"):
                words += [index(tag.get("k", "")), index(tag.get("v", ""))]
            words.append(0)
        units = [[round(float(node.get(key, "0")) * 1e7) for node in nodes] for key in ("lat", "lon")]
        groups.append(field(2, field(1, signed(steps([int(node.get("id", "0")) for node in nodes])))
                            + field(8, signed(steps(units[0]))) + field(9, signed(steps(units[1])))
                            + field(10, b"".join(map(varint, words)))))
    for way in root.findall("way"):
        references = [int(nd.get("ref", "0")) for nd in way.findall("nd")]
        groups.append(field(3, field(1, int(way.get("id", "0"))) + tags(way) + field(8, signed(steps(references)))))
    kinds = {"node": 0, "way": 1, "relation": 2}
    for relation in root.findall("relation"):
        members = relation.findall("member")
        groups.append(field(4, field(1, int(relation.get("id", "0"))) + tags(relation)
                            + field(8, b"".join(varint(index(m.get("role", ""))) for m in members))
                            + field(9, signed(steps([int(m.get("ref", "0")) for m in members])))
                            + field(10, b"".join(varint(kinds[m.get("type", "way")]) for m in members))))
    return field(1, b"".join(field(1, text.encode()) for text in texts)) + b"".join(field(2, g) for g in groups)


def zipped(name: str) -> Callable[[bytes], bytes]:
    """What packs a file as the only one of an archive."""
    def pack(content: bytes) -> bytes:
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED, 1)
        return buffer.getvalue()
    return pack


def geotiff(columns: int, rows: int, heights: bytes) -> bytes:
    """Of floats, in degrees; `heights` may be shorter than it says."""
    tags = [(256, 4, 1, columns), (257, 4, 1, rows), (258, 3, 1, 32), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, -1),
            (277, 3, 1, 1), (278, 4, 1, rows), (279, 4, 1, len(heights)), (339, 3, 1, 3), (33550, 12, 3, 0),
            (33922, 12, 6, 24), (34735, 3, 16, 72)]
    extra = 8 + 2 + 12 * len(tags) + 4
    directory = struct.pack("<H", len(tags))
    for tag, kind, count, value in tags:
        place = extra + value if tag > 30000 else extra + 104 if value < 0 else value
        directory += struct.pack("<HHII", tag, kind, count, place)
    place = struct.pack("<9d", 1e-4, 1e-4, 0, 0, 0, 0, 11, 48, 0)
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326)
    return b"II*\0" + struct.pack("<I", 8) + directory + struct.pack("<I", 0) + place + keys + heights


def grid_text() -> bytes:
    rows = "\n".join(" ".join(str(100 + c - r if (r, c) != (2, 3) else -9999) for c in range(12)) for r in range(10))
    return f"ncols 12\nnrows 10\nxllcorner 11\nyllcorner 48\ncellsize 0.0001\nNODATA_value -9999\n{rows}\n".encode()


SYSTEM = ('GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],'
          'UNIT["Degree",0.0174532925199433]]')


# ---- what is read ----

def seeds(name: str, pattern: str = "*") -> list[bytes]:
    return [file.read_bytes() for file in sorted((SEEDS / name).glob(pattern))]


def prepare(folder: pathlib.Path, run: Callable[[list[str]], None]) -> None:
    """Writes the files that the others are read with."""
    (folder / "city.obj").write_text(CITY, encoding="utf-8")
    (folder / "mission.yaml").write_text(MISSION, encoding="utf-8")
    (folder / "grid.prj").write_text(SYSTEM, encoding="utf-8")
    (folder / "town.osm").write_bytes((ROOT / "examples/town/town.osm").read_bytes())
    for target in ("target.geojson", "target.kml", "target.kmz"):
        (folder / f"{target}.yaml").write_text(TARGET_MISSION.replace("TARGET", target), encoding="utf-8")
    for key, zones in (("keep_out", "zones.json"), ("keep_out", "zones.kml"), ("keep_out", "zones.kmz"),
                       ("keep_in", "fence.plan")):
        mission = TOWN_MISSION.replace("KEY", key).replace("ZONES", zones)
        (folder / f"{zones}.yaml").write_text(mission, encoding="utf-8")
    tilesets.prepare(folder)
    run(["compute", "mission.yaml", "-q", *(word for end in ("ply", "obj", "glb", "stl")
                                            for word in ("-o", f"good.{end}"))])
    (folder / "fly.yaml").write_text(FLIGHT_MISSION, encoding="utf-8")
    for end in PLANS:
        run(["tour", "fly.yaml", "-q", "--no-bound", "--undulation", "45", "--aircraft", "77,0,66", "-o", f"good.{end}"])
    run(["tour", "fly.yaml", "-q", "-o", "fly.plan", "--certificate", "fly.cert"])
    run(["prove", "mission.yaml", "good.ply", "-q", "--certificate", "good.cert"])


def mesh_readers() -> list[Reader]:
    kinds = [("obj", "mesh.obj", seeds("obj") + [CITY.encode()]), ("ply", "mesh.ply", seeds("ply")),
             ("stl", "mesh.stl", seeds("stl")), ("gltf", "mesh.gltf", seeds("gltf", "*.gltf")),
             ("glb", "mesh.glb", seeds("gltf", "*.glb")),
             ("cityjson", "mesh.city.json", seeds("cityjson", "*.json")),
             ("cityjson sequence", "mesh.city.jsonl", seeds("cityjson", "*.jsonl"))]
    read = ["inspect", "FILE", "--threads", "1"]
    return ([Reader(name, file, read, originals) for name, file, originals in kinds]
            + [Reader(f"{name}, gzip", f"{file}.gz", read, originals, lambda data: gzip.compress(data, 1))
               for name, file, originals in kinds])


def map_readers() -> list[Reader]:
    town = (ROOT / "examples/town/town.osm").read_bytes()
    read = ["inspect", "FILE", "--threads", "1"]
    block = pbf_block(town)
    return [Reader("osm", "map.osm", read, [town]),
            Reader("osm, gzip", "map.osm.gz", read, [town], lambda data: gzip.compress(data, 1)),
            Reader("osm, bzip2", "map.osm.bz2", read, [town], bz2.compress),
            Reader("osm, gzip outside", "map.osm.gz", read, [gzip.compress(town)]),
            Reader("osm, bzip2 outside", "map.osm.bz2", read, [bz2.compress(town)]),
            Reader("pbf", "map.osm.pbf", read, [block], lambda data: PBF_HEADER + blob(b"OSMData", data)),
            Reader("pbf outside", "map.osm.pbf", read, [PBF_HEADER + blob(b"OSMData", block)])]


def raster_readers() -> list[Reader]:
    heights = struct.pack("<120f", *(100 + n % 12 - n // 12 for n in range(120)))
    tile = struct.pack(">2402h", *(n % 300 for n in range(2402))) * 600 + b"\0\1" * 1201
    read = ["inspect", "FILE", "--threads", "1"]
    return [Reader("geotiff", "dem.tif", read, [geotiff(12, 10, heights)]),
            Reader("ascii grid", "grid.asc", read, [grid_text()]),
            Reader("srtm", "N43E007.hgt", [*read, "--window", "3,4,40,30"], [tile]),
            Reader("srtm, zip", "N43E007.hgt.zip", [*read, "--window", "3,4,40,30"], [tile], zipped("N43E007.hgt")),
            Reader("srtm, zip outside", "N43E007.hgt.zip", [*read, "--window", "3,4,40,30"],
                   [zipped("N43E007.hgt")(tile)])]


def mission_readers() -> list[Reader]:
    compute = ["compute", "FILE", "-o", "out.ply", "--threads", "1"]
    zones = seeds("zones")
    plans = [data for data in zones if b"geoFence" in data]
    kml = [data for data in zones if b"<kml" in data]
    others = [data for data in zones if data not in plans + kml]

    def with_mission(file: str) -> list[str]:
        return ["compute", f"{file}.yaml", "-o", "out.ply", "--threads", "1"]

    kmz, target_kmz = zipped("doc.kml")(kml[0]), zipped("doc.kml")(TARGET_KML)

    return [Reader("mission", "changed.yaml", compute, [text.encode() for text in MISSIONS]),
            Reader("zones, json", "zones.json", with_mission("zones.json"), others),
            Reader("zones, kml", "zones.kml", with_mission("zones.kml"), kml),
            Reader("zones, kmz", "zones.kmz", with_mission("zones.kmz"), kml, zipped("doc.kml")),
            Reader("zones, kmz outside", "zones.kmz", with_mission("zones.kmz"), [kmz]),
            Reader("target, geojson", "target.geojson", with_mission("target.geojson"), [TARGET_GEOJSON]),
            Reader("target, kml", "target.kml", with_mission("target.kml"), [TARGET_KML]),
            Reader("target, kmz", "target.kmz", with_mission("target.kmz"), [TARGET_KML], zipped("doc.kml")),
            Reader("target, kmz outside", "target.kmz", with_mission("target.kmz"), [target_kmz]),
            Reader("zones, plan", "fence.plan", with_mission("fence.plan"), plans),
            Reader("cameras", "cameras.json", ["cameras", "FILE"], seeds("camera_list")),
            Reader("points", "points.csv", ["query", "mission.yaml", "FILE", "--threads", "1"],
                   [(ROOT / "examples/plaza/points.csv").read_bytes(), b"x;y;z;id\n1.5;2e0;3.5;a\n",
                    b'x,y,z,note\n1,2,3,"a ""b"", c"\n']),
            Reader("willis config", "config.yaml", ["spheres", "-c", "FILE", "--device", "cpu"],
                   [CONFIG.encode()])]


def volume_readers(folder: pathlib.Path) -> list[Reader]:
    """Statements of volumes: in comments, in extras, and in files beside."""
    def judged(file: str) -> list[str]:
        return ["verify", "mission.yaml", file, "--points", "50", "--threads", "1"]

    good = {end: (folder / f"good.{end}").read_bytes() for end in ("ply", "obj", "glb", "stl")}
    readers = [Reader(f"volume, {end}", f"volume.{end}", judged("FILE"), [data]) for end, data in good.items()]
    statement = (folder / "good.stl.place.json").read_bytes()
    report = (folder / "good.report.json").read_bytes()
    (folder / "beside.stl").write_bytes(good["stl"])
    (folder / "reported.stl").write_bytes(good["stl"])
    return readers + [Reader("volume, beside an stl", "beside.stl.place.json", judged("beside.stl"), [statement]),
                      Reader("volume, report", "reported.report.json", judged("reported.stl"), [report])]


def certificate_readers(folder: pathlib.Path) -> list[Reader]:
    """The checker, on certificates, on the volume and on the scene beside them."""
    checker = str(ROOT / "tools" / "check_certificate.py")

    def checked(name: str, file: str) -> Reader:
        return Reader(f"certificate, {name}", file, [checker, "good.cert"], [(folder / file).read_bytes()],
                      program=sys.executable)

    scene = json.loads((folder / "good.cert").read_bytes())["scene"]["file"]
    return [checked("itself", "good.cert"), checked("its volume", "good.ply"), checked("its scene", scene)]


def plan_readers(folder: pathlib.Path) -> list[Reader]:
    """Plans of flights, as vantage writes them, and those of others that are seeds of the fuzzer: these lie elsewhere."""
    def judged(file: str) -> list[str]:
        return ["check", "fly.yaml", file, "--undulation", "45", "--heights", "scene" if file.endswith("csv") else "ground",
                "--threads", "1"]

    readers = [Reader(f"plan, {end}", f"flown.{end}", judged(f"flown.{end}"), [(folder / f"good.{end}").read_bytes()])
               for end in PLANS]
    inside = (folder / "good.kmz").read_bytes()
    with zipfile.ZipFile(io.BytesIO(inside)) as archive:
        name = next(name for name in archive.namelist() if name.endswith("waylines.wpml"))
        waylines = archive.read(name)
    return readers + [Reader("plan, kmz inside", "flown.kmz", judged("flown.kmz"), [waylines], zipped(name))]


def tour_readers(folder: pathlib.Path) -> list[Reader]:
    """Bounds of tours: the program's judge and the checker, on certificates and on the regions beside them."""
    checker = str(ROOT / "tools" / "check_tour.py")
    readers = []
    for name, file in (("itself", "fly.cert"), ("its region", "fly.region0.ply")):
        data = [(folder / file).read_bytes()]
        readers.append(Reader(f"tour certificate, {name}", file, ["verify-tour", "fly.cert"], data))
        readers.append(Reader(f"tour checker, {name}", file, [checker, "fly.cert"], data, program=sys.executable))
    return readers


def tile_readers() -> list[Reader]:
    return [Reader(f"tileset, {kind}", tilesets.file_of(kind), ["inspect", f"tiles_{kind}/tileset.json", "--threads", "1"],
                   tilesets.originals(kind)) for kind in tilesets.KINDS]


def all_readers(folder: pathlib.Path) -> list[Reader]:
    return (mesh_readers() + tile_readers() + map_readers() + raster_readers() + mission_readers() + volume_readers(folder)
            + certificate_readers(folder) + plan_readers(folder) + tour_readers(folder))


def to_json(value: object) -> bytes:
    return json.dumps(value).encode()
