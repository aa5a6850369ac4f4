"""Small files that ask for much: memory, time, depth. What a reader may not do, and what it must refuse."""

import bz2
import gzip
import io
import math
import pathlib
import random
import struct
import zipfile
from collections.abc import Callable, Iterator
from typing import NamedTuple

from hostile.readers import PBF_HEADER, TOWN_MISSION, blob, field, geotiff, to_json

MIB = 1 << 20


class Bomb(NamedTuple):
    """A file, and what reads it."""

    name: str
    file: str
    content: Callable[[], bytes]
    arguments: list[str]
    is_refused: bool = True  # else it may be read as well


def repeated(pack: Callable[[bytes], bytes], first: bytes, part: bytes, count: int) -> bytes:
    """Compressed streams, one after the other."""
    return pack(first) + pack(part) * count


def inspected(name: str, file: str, content: Callable[[], bytes], is_refused: bool = True) -> Bomb:
    return Bomb(name, file, content, ["inspect", file, "--threads", "1"], is_refused)


def zipped(files: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def glb(document: object, buffer: bytes = b"") -> bytes:
    text = document if isinstance(document, bytes) else to_json(document)
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if buffer:
        chunks += struct.pack("<II", len(buffer), 0x4E4942) + buffer
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def gltf(count: int, **more: object) -> dict[str, object]:
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"componentType": 5126, "type": "VEC3", "count": count, "bufferView": 0}],
            "buffers": [{"byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}], **more}


TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
CITY = {"type": "CityJSON", "version": "2.0", "transform": {"scale": [1, 1, 1], "translate": [0, 0, 0]},
        "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}
PLY = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
       "element face {}\nproperty list {} int vertex_indices\nend_header\n")


def ply(vertices: int, faces: int, count: str, content: bytes = bytes(136)) -> bytes:
    return PLY.format(vertices, faces, count).encode() + content


def compressed() -> Iterator[Bomb]:
    """Gigabytes in some megabytes."""
    def gz(file: str, first: bytes, part: bytes, count: int = 280) -> Bomb:
        return inspected(f"{file} of {len(part) * count >> 20} MiB", file,
                         lambda: repeated(gzip.compress, first, part, count))

    yield gz("comment.obj.gz", b"#", b"#" * 16 * MIB)
    yield gz("nul.obj.gz", b"v 0 0 0\n", bytes(16 * MIB))
    yield gz("vertices.obj.gz", b"", b"v 0 0 0\n" * 2 * MIB)
    yield gz("faces.obj.gz", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", b"f 1 2 3\n" * 2 * MIB)
    yield gz("blanks.stl.gz", b"solid a\n", b" " * 16 * MIB)
    yield gz("text.city.json.gz", b'{"type":"CityJSON","version":"2.0","x":"', b"A" * 16 * MIB)
    yield gz("vertices.ply.gz", PLY.format(200000000, 1, "uchar").encode(), bytes(16 * MIB))
    yield gz("blanks.osm.gz", b'<osm version="0.6">', b" " * 16 * MIB)
    yield gz("nodes.osm.gz", b'<osm version="0.6">', b'<node id="1" lat="1" lon="1"/>' * 500000, 60)
    yield gz("way.osm.gz", b'<osm version="0.6"><way id="1">', b'<nd ref="1"/>' * MIB)
    yield inspected("blanks.osm.bz2 of gigabytes", "blanks.osm.bz2",
                    lambda: repeated(bz2.compress, b'<osm version="0.6">', b" " * 16 * MIB, 300))
    # Within what is decompressed: it may be read.
    yield inspected("faces.obj.gz of 60 MiB", "f.obj.gz", lambda: gzip.compress(
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"f 1 2 3\n" * (7 * MIB), 1), False)
    yield inspected("vertices.obj.gz of 60 MiB", "v.obj.gz", lambda: gzip.compress(
        b"v 0 0 0\n" * (7 * MIB) + b"f 1 2 3\n", 1), False)


def maps() -> Iterator[Bomb]:
    def pbf(name: str, texts: list[bytes], groups: list[bytes], copies: int = 1, is_refused: bool = True) -> Bomb:
        block = field(1, b"".join(field(1, text) for text in texts)) + b"".join(field(2, group) for group in groups)
        return inspected(name, "bomb.osm.pbf", lambda: PBF_HEADER + blob(b"OSMData", block) * copies, is_refused)

    many = 8 * MIB
    column = b"\2" * many
    yield pbf("pbf, blocks of 8 million nodes", [b""], [field(2, field(1, column) + field(8, column) + field(9, column))],
              20)
    some = b"\2" * 262144
    yield pbf("pbf, 400 blocks of 262144 nodes", [b""], [field(2, field(1, some) + field(8, some) + field(9, some))], 400)
    yield pbf("pbf, a way of many tags", [b"", b"k" * 1000],
              [field(3, field(1, 1) + field(2, b"\1" * many) + field(3, b"\1" * many))])
    yield pbf("pbf, a relation of many roles", [b"", b"k" * 1000],
              [field(4, field(1, 1) + field(8, b"\1" * many) + field(9, column) + field(10, b"\1" * many))])
    yield pbf("pbf, a text with NUL", [b"", b"a\0b", b"yes"],
              [field(3, field(1, 1) + field(2, b"\1") + field(3, b"\2"))])
    yield inspected("osm, an attribute of 50 MB", "attribute.osm", lambda: (
        b'<osm version="0.6"><node id="1" lat="48" lon="11"><tag k="name" v="' + b"A" * 50000000 + b'"/></node></osm>'))
    yield inspected("osm, a comment of 50 MB", "comment.osm",
                    lambda: b'<osm version="0.6"><!--' + b"> " * 25000000 + b"--></osm>")
    yield inspected("osm, nested", "nested.osm", lambda: b'<osm version="0.6">' + b"<node>" * 500000)
    nodes = 20000
    yield inspected("osm, an outline that crosses itself", "crossing.osm", lambda: (
        '<osm version="0.6">'
        + "".join(f'<node id="{i}" lat="{48 + i * 7919 % nodes * 1e-7:.7f}" lon="{11 + i * 104729 % nodes * 1e-7:.7f}"/>'
                  for i in range(1, nodes))
        + '<way id="99">' + "".join(f'<nd ref="{i}"/>' for i in range(1, nodes))
        + '<nd ref="1"/><tag k="building" v="yes"/></way></osm>').encode(), is_refused=False)  # its hull stands in


def headers() -> Iterator[Bomb]:
    """A few bytes that announce billions of things."""
    for vertices, faces, count in ((10**9, 1, "uchar"), (3, 10**9, "uchar"), (2**64 - 1, 1, "uchar"), (3, 1, "uint"),
                                   (2**32 - 1, 2**32 - 1, "int")):
        content = TRIANGLE + b"\xff\xff\xff\xff" + bytes(100)
        yield inspected(f"ply, {vertices} vertices, {faces} faces", "count.ply",
                        lambda v=vertices, f=faces, c=count, d=content: ply(v, f, c, d))
    yield inspected("ply, 500000 elements", "elements.ply",
                    lambda: b"ply\nformat ascii 1.0\n" + b"element e 0\n" * 500000 + b"end_header\n")
    yield inspected("stl, 1e9 facets", "count.stl", lambda: bytes(80) + struct.pack("<I", 10**9) + bytes(50))
    for count in (10**9, 2**53):
        yield inspected(f"glb, {count} vertices", "count.glb", lambda n=count: glb(gltf(n), TRIANGLE))
    yield inspected("glb, nodes that repeat", "repeat.glb", lambda: glb(
        gltf(3, nodes=[{"children": [i + 1, i + 1]} for i in range(30)] + [{"mesh": 0}]), TRIANGLE))
    yield inspected("glb, 200000 nested nodes", "chain.glb", lambda: glb(
        gltf(3, nodes=[{"children": [i + 1]} for i in range(200000)] + [{"mesh": 0}]), TRIANGLE), False)
    yield inspected("cityjson, templates that repeat", "templates.city.json", lambda: to_json(
        {**CITY, "geometry-templates": {
            "templates": [{"type": "MultiSurface", "lod": "2", "boundaries": [[[0, 1, 2]]] * 20000}],
            "vertices-templates": CITY["vertices"]},
         "CityObjects": {f"a{i}": {"type": "CityFurniture", "geometry": [
             {"type": "GeometryInstance", "template": 0, "boundaries": [0],
              "transformationMatrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]} for i in range(20000)}}))
    for name, part in (("arrays", b"[],"), ("objects", b'{"":{"":0}},'), ("texts", b'"",')):
        count = 40 * MIB // len(part)
        yield inspected(f"cityjson, 40 MiB of {name}", "values.city.json", lambda p=part, n=count: (
            b'{"type":"CityJSON","version":"2.0","x":[' + p * n + b'0]}'))
    yield inspected("obj, a face of a million corners", "corners.obj",
                    lambda: b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + b"1 2 3 " * 333333 + b"\n")
    yield inspected("obj, a line of 100 MB", "line.obj", lambda: b"v " + b"1" * 100000000)
    for name, bytes_ in (("glb", glb(b"[" * 1000000)), ("city.json", b'{"type":"CityJSON","version":"2.0","x":'
                                                        + b"[" * 500000)):
        yield inspected(f"{name}, nested", f"nested.{name}", lambda b=bytes_: b)
    for side in (16000, 50000, 2 * 10**9):
        yield inspected(f"geotiff, {side} columns and rows", "count.tif", lambda n=side: geotiff(n, n, bytes(100)))
    yield inspected("ascii grid, 2e9 columns and rows", "count.asc", lambda: (
        b"ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n"))
    yield inspected("hgt.zip of 3 GB", "N43E007.hgt.zip", lambda: zipped({"N43E007.hgt": bytes(1 << 30)}))
    yield inspected("hgt.zip of 20000 files", "N43E008.hgt.zip",
                    lambda: zipped({f"{i}.hgt": b"" for i in range(20000)}))


def texts() -> Iterator[Bomb]:
    """YAML, JSON, KML and tables."""
    def mission(name: str, text: str | bytes, is_refused: bool = True) -> Bomb:
        content = text if isinstance(text, bytes) else text.encode()
        return Bomb(f"mission, {name}", "bomb.yaml", lambda: content,
                    ["compute", "bomb.yaml", "-o", "out.ply", "--threads", "1"], is_refused)

    yield mission("anchors that repeat", "a: &a [1,1,1,1]\n" + "".join(
        f"{chr(98 + i)}: &{chr(98 + i)} [*{chr(97 + i)},*{chr(97 + i)},*{chr(97 + i)}]\n" for i in range(20)))
    for name, text in (("lists", "a: " + "[" * 1000000), ("maps", "{a: " * 200000), ("dashes", "- " * 500000),
                       ("questions", "? " * 500000), ("both", "a: " + "[{b: " * 100000)):
        yield mission(f"nested {name}", text)
    base = "scene: {mesh: city.obj}\nsensor: {max_range: 20}\nexact: {tolerance: 0.5}\n"
    corners = ",".join(f"[{9 * math.cos(i * 1e-4):.4f},{9 * math.sin(i * 1e-4):.4f}]" for i in range(60000))
    yield mission("an outline of 60000 corners", base + "target: {outline: [" + corners + "]}\n")
    boxes = ",".join(f"{{min: [{i * .01:g},{i % 7},1], max: [{i * .01 + 5:g},{i % 7 + 1},2]}}" for i in range(5000))
    yield mission("5000 boxes", base + "target: {point: [0, 0, 2]}\nnavigation: {keep_out: [" + boxes + "]}\n", False)

    def zones(name: str, content: Callable[[], bytes], is_refused: bool = True) -> Bomb:
        return Bomb(f"zones, {name}", "zones.json", content,
                    ["compute", "zones.json.yaml", "-o", "out.ply", "--threads", "1"], is_refused)

    def polygon(ring: list[list[float]]) -> dict[str, object]:
        return {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}

    def many(count: int) -> bytes:
        places = [(11 + i % 100 * 1e-6, 48 + i // 100 * 1e-6) for i in range(count)]
        return to_json({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {}, "geometry": polygon([[x, y], [x + 8e-7, y], [x, y + 8e-7]])}
            for x, y in places]})

    yield zones("nested lists", lambda: b'{"type":"FeatureCollection","features":' + b"[" * 500000)
    yield zones("nested collections", lambda: (b'{"type":"GeometryCollection","geometries":[' * 20000
                                               + b'{"type":"Point","coordinates":[0,0]}' + b"]}" * 20000))
    for count in (4000, 100000):  # the more of them take minutes
        yield zones(f"{count} of them", lambda n=count: many(n), count > 10000)
    numbers = random.Random(1)
    for count in (4000, 16000):
        ring = [[11 + numbers.random() * 1e-3, 48 + numbers.random() * 1e-3] for _ in range(count)]
        yield zones(f"one of {count} corners that crosses itself", lambda r=ring: to_json(polygon(r)))
        star = [[11 + 1e-3 * math.cos(i * math.tau / count) * (1 + 0.1 * (i % 2)),
                 48 + 1e-3 * math.sin(i * math.tau / count) * (1 + 0.1 * (i % 2))] for i in range(count)]
        yield zones(f"a star of {count} corners", lambda r=star: to_json(polygon(r)), False)

    def kml(name: str, content: bytes) -> Bomb:
        return Bomb(f"kml, {name}", "zones.kml", lambda: content,
                    ["compute", "zones.kml.yaml", "-o", "out.ply", "--threads", "1"])

    yield kml("nested", b"<kml>" + b"<Folder>" * 300000)
    yield kml("an attribute of 20 MB", b'<kml a="' + b"A" * 20000000 + b'"/>')
    place = " ".join(f"10.9{i * 104729 % 999999:06d},47.9{i * 7919 % 999999:06d},5" for i in range(19000))
    yield kml("one of 19000 corners", (
        '<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><name>a</name><Polygon><outerBoundaryIs><LinearRing>'
        f"<coordinates>{place}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>").encode())
    for name, content in (("a row of 4 MB", b"x,y,z\n" + b"1," * 2000000), ("a quote of 6 MB", b'x,y,z\n"' + b"a\n" * 3000000),
                          ("a million columns", ",".join(f"c{i}" for i in range(1000000)).encode() + b"\n")):
        yield Bomb(f"points, {name}", "points.csv", lambda c=content: c,
                   ["query", "mission.yaml", "points.csv", "--threads", "1"])
    yield Bomb("cameras, nested", "cameras.json", lambda: b'{"a":' + b"[" * 1000000, ["cameras", "cameras.json"])


def all_bombs() -> Iterator[Bomb]:
    yield from compressed()
    yield from maps()
    yield from headers()
    yield from texts()


def prepare(folder: pathlib.Path) -> None:
    """Files that the bombs are read with, beside those of the readers."""
    for zones in ("zones.json", "zones.kml"):
        mission = TOWN_MISSION.replace("KEY", "keep_out").replace("ZONES", zones)
        (folder / f"{zones}.yaml").write_text(mission, encoding="utf-8")
