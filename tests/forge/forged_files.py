"""Certificates that are made by hand, with their meshes. No program of vantage is needed."""

import hashlib
import json
import struct

MISSION = "5e" * 32
SQUARE = [[-2.0, -2.0, 0.1], [2.0, -2.0, 0.1], [2.0, 2.0, 0.1], [-2.0, 2.0, 0.1]]


# ---- meshes: (vertices, triangles) ----

def block(low, high):
    corners = [tuple(float((low, high)[i >> k & 1][k]) for k in range(3)) for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


def flat(low, high):
    """A rectangle at low[2]."""
    (x, y, z), (u, v) = low, high
    return [(x, y, z), (u, y, z), (u, v, z), (x, v, z)], [(0, 1, 2), (0, 2, 3)]


def joined(*meshes):
    vertices, triangles = [], []
    for points, faces in meshes:
        triangles += [tuple(v + len(vertices) for v in face) for face in faces]
        vertices += points
    return vertices, triangles


def inside_out(mesh):
    return mesh[0], [face[::-1] for face in mesh[1]]


def moved(mesh, by):
    return [tuple(x + d for x, d in zip(p, by)) for p in mesh[0]], mesh[1]


def scaled(mesh, factor):
    return [tuple(x * factor for x in p) for p in mesh[0]], mesh[1]


GROUND, WALL = flat((-60.0, -60.0, 0.0), (60.0, 60.0)), block((8, -10, 0), (10, 10, 20))
TOWN = joined(GROUND, WALL)
WEST = block((-25, -25, 0.2), (-5, 25, 25))  # from there the target is seen past the wall
EAST = block((12, -5, 0.2), (20, 5, 8))      # from there it is not


# ---- files ----

def mesh_hash(kind, mesh, objects=None):
    text = b"vantage " + kind + b" 1\n" + struct.pack("<Q", len(mesh[1]))
    for i, face in enumerate(mesh[1]):
        text += b"".join(struct.pack("<3d", *(x + 0.0 for x in mesh[0][v])) for v in face)
        text += b"" if objects is None else struct.pack("<I", objects[i])
    return hashlib.sha256(text).hexdigest()


def ply(mesh, comments=(), objects=None):
    header = "ply\nformat binary_little_endian 1.0\n" + "".join(f"comment {line}\n" for line in comments)
    header += f"element vertex {len(mesh[0])}\nproperty double x\nproperty double y\nproperty double z\n"
    header += f"element face {len(mesh[1])}\nproperty list uchar int vertex_indices\n"
    header += "" if objects is None else "property uint object\n"
    rows = b"".join(struct.pack("<3d", *p) for p in mesh[0])
    for i, face in enumerate(mesh[1]):
        rows += struct.pack("<B3i", 3, *face) + (b"" if objects is None else struct.pack("<I", objects[i]))
    return header.encode() + b"end_header\n" + rows


def base36(number):
    text, rest = "", abs(number)
    while rest or not text:
        text, rest = "0123456789abcdefghijklmnopqrstuvwxyz"[rest % 36] + text, rest // 36
    return "-" * (number < 0) + text


def groups(count):
    """How many groups of at most 256 facets there are."""
    return 0 if count == 0 else 1 if count <= 256 else groups(count // 2) + groups(count - count // 2)


def nothing(value):
    return value


def files(volume=WEST, scene=TOWN, target=SQUARE, shift=(0.0, 0.0), step="(-1,0,0)", reach=50.0, rounding=0,
          margin=1e-9, normal=(0.0, 0.0, 1.0), centre=None, more_target=None, comments=(), statement=nothing,
          certificate=nothing, text=nothing, volume_ply=nothing, scene_ply=nothing, said=True):
    """Of a sound certificate, if nothing is given: the volume lies to the west of a wall. `shift` is (offset, lift).
    What is called `certificate`, `statement`, ... changes it and returns it, or changes it in place."""
    objects = [int(i >= 2) for i in range(len(scene[1]))]
    hashes = mesh_hash(b"scene", scene, objects), mesh_hash(b"volume", volume)
    say = {"version": "0.1.0", "method": "exact",
           "target": dict({"name": "target", "parts": [target], "offset_m": shift[0]}, **(more_target or {})),
           "max_range_m": reach, "tolerance_m": 0.01, "lift_m": [shift[1]], "scene_hash": hashes[0],
           "mission_hash": MISSION, "volume_hash": hashes[1]}
    say = statement(say) or say
    lines = [f"vantage rounding_m {rounding}"] + list(comments)
    if said:
        lines.append("vantage volume: " + (say if isinstance(say, str) else json.dumps(say)))
    whole = sum(shift)
    if centre is None:
        centre = [sum(p[k] for p in target) / len(target) + whole * normal[k] for k in range(3)]
    corners = [[(x + whole * n - c) * (1 - margin / 4) for x, n, c in zip(p, normal, centre)] for p in target]
    good = [i for i, t in enumerate(volume[1]) if len({volume[0][v] for v in t}) == 3]
    claims = {"format": "vantage certificate 1", "scene": {"file": "volume.scene.ply", "hash": hashes[0]},
              "volume": {"file": "volume.ply", "hash": hashes[1]}, "mission_hash": MISSION, "shrink": 1e-6,
              "rounding_m": rounding, "max_range_m": reach, "boxes": [],
              "parts": [{"target": target, "shift_m": whole, "normal": list(normal), "centre": centre,
                         "corners": corners if len(target) > 1 else [[0.0, 0.0, 0.0]], "cut_height_m": 1.5 * margin,
                         "facets": " ".join(map(base36, good)), "steps": step * groups(len(good))}]}
    claims = certificate(claims) or claims
    return {"volume.ply": volume_ply(ply(volume, lines)), "volume.scene.ply": scene_ply(ply(scene, (), objects)),
            "volume.cert": text(json.dumps(claims)).encode("utf-8", "surrogatepass")}
