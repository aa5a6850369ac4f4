"""Small tilesets of 3D Tiles, one for each kind of file that they are made of."""

import json
import pathlib
import struct

KINDS = ("json", "glb", "b3dm", "i3dm", "cmpt", "subtree", "draco", "meshopt")

# A tetrahedron of edges 4, 4 and 8 along x, y and z, with a number of a feature for each face, as the encoder of Draco
# 1.5.5 wrote it (sequential and edgebreaker), and the vertices and indices of meshoptimizer 0.18.
DRACO = [bytes.fromhex(text) for text in (
    "445241434f020201000000040801000102000203040506070605010200090300000404010001020100010101028002052055055505ffffffef"
    "55150743f52f986336a800000000ff000000000101000203014001001000000000010000000000000000000000000000000000004108",
    "445241434f02020101000000040401030000012f0101105503ecca8202ff0000000100010009030000020104040100010101010101028002052"
    "055055505ffffffef5515058bd4e6608200000000ff000000000000000000000000000000000000410801010100020301400100110000000001"
    "000000")]
VERTICES = bytes.fromhex("a00000013c000000ffff013c000000807f0000010f000000ffff010f000000807f000000010300000082") + b"\0" * 36
INDICES = bytes.fromhex("e1fe0e1203f004007687566778a9866589689801690000")
FACES = (0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6, 0, 2, 4, 2, 6, 4, 1, 5, 3, 3, 5, 7)

Json = dict[str, object]


def padded(data: bytes, size: int, fill: bytes) -> bytes:
    return data + fill * (-len(data) % size)


def text_of(value: object) -> bytes:
    return json.dumps(value).encode()


def glb(document: Json, buffer: bytes) -> bytes:
    text, buffer = padded(text_of(document), 4, b" "), padded(buffer, 4, b"\0")
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(buffer), len(text), 0x4E4F534A) + text
            + struct.pack("<II", len(buffer), 0x4E4942) + buffer)


def gltf(**more: object) -> Json:
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "house"}],
            **more}


def box(feature: str = "_BATCHID", sets: list[Json] | None = None) -> bytes:
    """A box of 1 m: half of its corners are of feature 0, half of 1. `sets`: those of EXT_mesh_features."""
    own: Json = {"attributes": {"POSITION": 0, feature: 2}, "indices": 1}
    if sets:
        own["extensions"] = {"EXT_mesh_features": {"featureIds": sets}}
    corners = b"".join(struct.pack("<3f", i & 1, i >> 2, i >> 1 & 1) for i in range(8))
    parts = [corners, struct.pack("<36I", *FACES), struct.pack("<8f", *(i // 4 for i in range(8)))]
    starts = [0, 96, 240]
    return glb(gltf(meshes=[{"primitives": [own]}],
                    accessors=[{"bufferView": i, "componentType": kind, "count": count, "type": form} for i, (kind, count, form)
                               in enumerate([(5126, 8, "VEC3"), (5125, 36, "SCALAR"), (5126, 8, "SCALAR")])],
                    bufferViews=[{"buffer": 0, "byteOffset": start, "byteLength": len(part)}
                                 for start, part in zip(starts, parts)],
                    buffers=[{"byteLength": 272}]), b"".join(parts))


def draco(data: bytes) -> bytes:
    packed = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0, "_BATCHID": 1}}}
    return glb(gltf(extensionsUsed=list(packed), extensionsRequired=list(packed),
                    meshes=[{"primitives": [{"attributes": {"POSITION": 0, "_BATCHID": 2}, "indices": 1,
                                             "extensions": packed}]}],
                    accessors=[{"componentType": 5126, "count": 8, "type": "VEC3"},
                               {"componentType": 5125, "count": 12, "type": "SCALAR"},
                               {"componentType": 5123, "count": 8, "type": "SCALAR"}],
                    bufferViews=[{"buffer": 0, "byteLength": len(data)}], buffers=[{"byteLength": len(data)}]), data)


def meshopt() -> bytes:
    def packed(start: int, data: bytes, stride: int, count: int, mode: str) -> Json:
        return {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": start, "byteLength": len(data), "byteStride": stride,
                                            "count": count, "mode": mode}}

    return glb(gltf(extensionsUsed=["EXT_meshopt_compression"], extensionsRequired=["EXT_meshopt_compression"],
                    meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                    accessors=[{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                               {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"}],
                    bufferViews=[{"buffer": 1, "byteLength": 64, "byteStride": 16,
                                  "extensions": packed(0, VERTICES, 16, 4, "ATTRIBUTES")},
                                 {"buffer": 1, "byteLength": 48,
                                  "extensions": packed(len(VERTICES), INDICES, 4, 12, "TRIANGLES")}],
                    buffers=[{"byteLength": len(VERTICES) + len(INDICES)}, {"byteLength": 112}]), VERTICES + INDICES)


# Who the features of a tile are: in a table of their own, and in a hierarchy, whose numbers are binary in the second one.
TABLE: Json = {"gml_id": ["a", "b"], "name": ["A", "B"],
               "height": {"byteOffset": 0, "componentType": "DOUBLE", "type": "SCALAR"}}
HIERARCHY: Json = {"classes": [{"name": "Wall", "length": 2, "instances": {"id": [1, 2]}},
                               {"name": "House", "length": 2, "instances": {"gml_id": ["h", "i"], "name": ["H", "I"]}}],
                   "instancesLength": 4, "classIds": [0, 0, 1, 1], "parentCounts": [1, 2, 1, 0], "parentIds": [2, 3, 2, 3]}
BINARY: Json = {"classes": [{"name": "Wall", "length": 2, "instances": {
                    "id": {"byteOffset": 8, "componentType": "UNSIGNED_SHORT", "type": "SCALAR"}}},
                            {"name": "House", "length": 2, "instances": {"name": ["H", "I"]}}],
                "instancesLength": 4, "classIds": {"byteOffset": 0, "componentType": "UNSIGNED_BYTE"},
                "parentCounts": {"byteOffset": 4, "componentType": "UNSIGNED_BYTE"}, "parentIds": {"byteOffset": 8}}


def hierarchy(of: Json) -> Json:
    return {"extensions": {"3DTILES_batch_table_hierarchy": of}}


def b3dm(content: bytes, table: Json = TABLE, numbers: bytes = struct.pack("<2d", 3, 4)) -> bytes:
    features = padded(text_of({"BATCH_LENGTH": 2}), 8, b" ")
    batch = padded(text_of(table), 8, b" ")
    length = 28 + len(features) + len(batch) + len(numbers) + len(content)
    return (struct.pack("<4s6I", b"b3dm", 1, length, len(features), 0, len(batch), len(numbers)) + features + batch + numbers
            + content)


def i3dm(content: bytes) -> bytes:
    features = padded(text_of({"INSTANCES_LENGTH": 2, "POSITION": {"byteOffset": 0}, "NORMAL_UP": {"byteOffset": 24},
                               "NORMAL_RIGHT": {"byteOffset": 48}, "SCALE": {"byteOffset": 72}}), 8, b" ")
    numbers = struct.pack("<20f", 10, 20, 30, -10, -20, -30, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 0, 0, 1, 2)
    batch = padded(text_of({"id": [4, 5]}), 8, b" ")
    length = 32 + len(features) + len(numbers) + len(batch) + len(content)
    return (struct.pack("<4s7I", b"i3dm", 1, length, len(features), len(numbers), len(batch), 0, 1) + features + numbers + batch
            + content)


def cmpt(*parts: bytes) -> bytes:
    inside = b"".join(padded(part, 8, b"\0") for part in parts)
    return struct.pack("<4s3I", b"cmpt", 1, 16 + len(inside), len(parts)) + inside


def subtree() -> bytes:
    text = padded(text_of({"buffers": [{"byteLength": 8}], "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 1}],
                           "tileAvailability": {"bitstream": 0}, "contentAvailability": [{"constant": 1}],
                           "childSubtreeAvailability": {"constant": 0}}), 8, b" ")
    return struct.pack("<4sIQQ", b"subt", 1, len(text), 8) + text + b"\x1f" + b"\0" * 7


def tile(error: float, uri: str = "", **more: object) -> Json:
    content = {"content": {"uri": uri}} if uri else {}
    return {"boundingVolume": {"box": [0, 0, 0, 100, 0, 0, 0, 100, 0, 0, 0, 100]}, "geometricError": error, **content, **more}


def tileset(root: Json) -> bytes:
    return text_of({"asset": {"version": "1.1"}, "geometricError": 100, "root": root})


def originals(kind: str) -> list[bytes]:
    house = b3dm(box())
    trees = i3dm(box())
    of_kind = {"json": [tileset(tile(10, refine="ADD", children=[tile(0, "a.glb"), tile(0, "b.glb", transform=[
                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1])]))],
               "glb": [box("_FEATURE_ID_0"), box("_FEATURE_ID_0", [{"featureCount": 2, "texture": {"index": 0, "channels": [0]}},
                                                                   {"featureCount": 2, "attribute": 0}])],
               "b3dm": [house, b3dm(draco(DRACO[1])), b3dm(box(), hierarchy(HIERARCHY), b""),
                        b3dm(box(), hierarchy(BINARY), bytes((0, 0, 1, 1, 1, 1, 1, 0)) + struct.pack("<4H", 2, 3, 3, 3))],
               "i3dm": [trees],
               "cmpt": [cmpt(house, trees)], "subtree": [subtree()], "draco": [draco(data) for data in DRACO],
               "meshopt": [meshopt()]}
    return of_kind[kind]


def file_of(kind: str) -> str:
    """The file that is changed."""
    names = {"json": "tileset.json", "subtree": "0_0_0.subtree"}
    return f"tiles_{kind}/{names.get(kind, 'c.' + ('glb' if kind in ('draco', 'meshopt') else kind))}"


def prepare(folder: pathlib.Path) -> None:
    """Writes a tileset for each kind, in a folder of its own."""
    for kind in KINDS:
        place = folder / f"tiles_{kind}"
        place.mkdir()
        root = tile(0, pathlib.PurePosixPath(file_of(kind)).name)
        if kind == "subtree":
            root = tile(64, "{level}_{x}_{y}.glb", implicitTiling={
                "subdivisionScheme": "QUADTREE", "subtreeLevels": 2, "availableLevels": 2,
                "subtrees": {"uri": "{level}_{x}_{y}.subtree"}})
            for name in ("1_0_0.glb", "1_1_0.glb", "1_0_1.glb", "1_1_1.glb"):
                (place / name).write_bytes(box())
        for name in ("a.glb", "b.glb"):
            (place / name).write_bytes(box())
        (place / "tileset.json").write_bytes(tileset(root))
