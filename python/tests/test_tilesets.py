"""Scenes from tilesets of 3D Tiles, written here."""

import json
import struct

import pytest

import vantage as vt
from conftest import box, refused


def box_glb(low, high, node):
    """A GLB of one box, given with z up. glTF has y up."""
    corners, faces = box(low, high)
    points = [(x, z, -y) for x, y, z in corners]
    binary = b"".join(struct.pack("<3f", *point) for point in points)
    binary += b"".join(struct.pack("<3H", *face) for face in faces)
    ends = [[pick(point[i] for point in points) for i in range(3)] for pick in (min, max)]
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": node}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"byteLength": len(binary)}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 96},
                            {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": ends[0], "max": ends[1]},
                          {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]}
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def tile(error, uri=None, children=()):
    """A tile about the origin."""
    described = {"boundingVolume": {"box": [0, 0, 0, 200, 0, 0, 0, 200, 0, 0, 0, 200]}, "geometricError": error}
    if uri:
        described["content"] = {"uri": uri}
    if children:
        described.update(refine="REPLACE", children=list(children))
    return described


@pytest.fixture
def tileset(tmp_path):
    """Two towers, which a coarser tile joins."""
    folder = tmp_path / "town"
    folder.mkdir()
    (folder / "west.glb").write_bytes(box_glb((20, -5, 0), (30, 15, 40), "west"))
    (folder / "east.glb").write_bytes(box_glb((40, -5, 0), (50, 15, 30), "east"))
    (folder / "both.glb").write_bytes(box_glb((20, -5, 0), (50, 15, 40), "both"))
    root = tile(50, "both.glb", [tile(0, "west.glb"), tile(0, "east.glb")])
    file = folder / "tileset.json"
    file.write_text(json.dumps({"asset": {"version": "1.1"}, "geometricError": 100, "root": root}))
    return file


def test_from_tiles(tileset):
    scene = vt.Scene.from_tiles(tileset, ground=0)
    assert len(scene.faces) == 26
    assert [one.name for one in scene.objects] == ["west", "east", "ground"]
    assert scene.objects[2].kind == "ground"
    assert scene.bounds[1].tolist() == [50, 15, 40]
    assert scene.report["tileset"]["holes"] == 0
    assert scene.report["tileset"]["contents"] == 2
    coarse = vt.Scene.from_tiles(str(tileset), detail=50)
    assert [one.name for one in coarse.objects] == ["both"]
    assert coarse.report["tileset"]["largest_error_m"] == 50


def test_volumes_in_tiles(tileset):
    scene = vt.Scene.from_tiles(tileset, ground=0)
    square = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]
    result = vt.compute(scene, square, max_range=80)
    assert result.volume_m3 > 0
    assert any(cause.name.endswith("west") for cause in result.volume.causes)
    west = vt.compute(scene, vt.Target(object="west", part="roof"), max_range=80)
    assert west.volume_m3 > 0


def test_what_cannot_be_read(tileset):
    (tileset.parent / "east.glb").unlink()
    scene = vt.Scene.from_tiles(tileset)
    assert scene.report["tileset"]["holes"] == 1
    assert "east.glb" in scene.report["tileset"]["first_hole"]
    for file in tileset.parent.glob("*.glb"):
        file.unlink()
    assert refused(lambda: vt.Scene.from_tiles(tileset)).code == "mesh-empty"
    assert refused(lambda: vt.Scene.from_tiles(tileset, radius=100)).code == "missing-key"
    assert refused(lambda: vt.Scene.from_tiles(tileset.parent / "none.json")).code == "file-not-found"


def test_batches_in_tiles(tileset, tmp_path):
    pytest.importorskip("pyarrow")
    pytest.importorskip("geopandas")
    import vantage.batch

    targets = [{"id": i, "vertices": [[x, 0, 1], [x + 9, 0, 1], [x + 9, 9, 1]]} for i, x in enumerate((-20, 0))]
    scene = {"tiles": tileset, "ground": 0}
    report = vantage.batch.run(targets, scene, tmp_path / "out", max_range=60, workers=1)
    assert report.computed == 2 and report.errors == 0
    alone = vt.compute(vt.Scene.from_tiles(tileset, ground=0), targets[1]["vertices"], max_range=60)
    assert report.table().iloc[1]["volume_hash"] == alone.volume.hash
    error = refused(lambda: vantage.batch.run(targets, "s3://town/tileset.json", tmp_path / "far", max_range=60))
    assert error.code == "not-applicable"


def test_keys_are_not_written_into_results():
    _scenes = pytest.importorskip("vantage.batch._scenes")
    request = _scenes.request_of("https://example.org/a/tileset.json?key=SECRET")
    assert request == {"tiles": "https://example.org/a/tileset.json?key=SECRET"}
    assert _scenes.shown_request(request) == {"tiles": "https://example.org/a/tileset.json"}
    for address, shown in {  # as in Printable.AddressesAreCutToWhatIsNoSecret
            "https://me:secret@a.example:8/t@1.osm?key=1#x": "https://a.example:8/t@1.osm",
            "https://me%3Asecret%40a.example/t.osm%3fkey=1": "https://a.example/t.osm",
            "https://me:top;secret@a.example/t.osm;token=1": "https://a.example/t.osm",
            "https://me:secret%3F@a.example/x": "https://a.example/x",
            "https://me:top?secret@a.example/x": "https://",
            "https://me:top/secret@a.example/x": "https://",
            "https://a.example/t.osm%26key=secret": "https://a.example/t.osm",
            "https://a.example?user=me@b.example&key=secret": "https://",
            "sftp://me:secret@a.example/t.osm": "sftp://a.example/t.osm",
            "zip://t.osm::https://me:secret@a.example/t.zip?key=1": "zip://t.osm::https://a.example/t.zip",
            "/data/me@home/t;1.osm": "/data/me@home/t;1.osm"}.items():
        for key in ("osm", "mesh", "raster", "tiles", "terrain"):
            assert _scenes.shown_request({key: address, "radius": 9}) == {key: shown, "radius": 9}


def test_ground_from_a_raster(tileset, tmp_path):
    rows = "\n".join(" ".join(["12.5"] * 40) for _ in range(40))
    (tmp_path / "dem.asc").write_text(f"ncols 40\nnrows 40\nxllcorner 10.99\nyllcorner 47.99\ncellsize 0.0005\n{rows}\n")
    (tmp_path / "dem.prj").write_text('GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],'
                                      'PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]')
    given = dict(terrain=tmp_path / "dem.asc", crs="+proj=tmerc +lat_0=48 +lon_0=11 +datum=WGS84")
    assert refused(lambda: vt.Scene.from_tiles(tileset, **given)).code == "height-unknown"
    assert refused(lambda: vt.Scene.from_tiles(tileset, ground=3, **given)).code == "conflicting-keys"
    scene = vt.Scene.from_tiles(tileset, sea_level=5, **given)
    assert scene.objects[-1].kind == "ground"
    heights = scene.vertices[scene.faces[scene.object_of == 2]][..., 2]
    assert heights.size > 0 and abs(heights - 17.5).max() < 1e-4
