"""Runs inside Blender: intersects meshes with its exact boolean, one after another.

    blender --background --factory-startup --python intersect_in_blender.py -- RESULT.json MESH.ply MESH.ply ...

RESULT.json is written anew after each boolean, so that it tells how far a run came that was stopped.
"""

import json
import os
import struct
import sys
import time

import bmesh
import bpy

SIZES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
         "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f",
         "float64": "d"}


def read_ply(path):
    """Vertices and triangles of a binary little-endian PLY file, as `vantage` writes it."""
    with open(path, "rb") as stream:
        header = []
        while not header or header[-1] != "end_header":
            header.append(stream.readline().decode("utf-8").strip())
        body = stream.read()
    if "format binary_little_endian 1.0" not in header:
        raise SystemExit(f"{path}: not a binary little-endian PLY file")
    elements = []
    for words in (line.split() for line in header):
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    found = {"vertex": [], "face": []}
    at = 0
    for name, count, properties in elements:
        for _ in range(count):
            row = {}
            for kind, *rest in properties:
                if kind == "list":
                    (length,) = struct.unpack_from("<" + SIZES[rest[0]], body, at)
                    at += struct.calcsize(SIZES[rest[0]])
                    form = f"<{length}{SIZES[rest[1]]}"
                    row[rest[2]] = struct.unpack_from(form, body, at)
                else:
                    form = "<" + SIZES[kind]
                    (row[rest[0]],) = struct.unpack_from(form, body, at)
                at += struct.calcsize(form)
            found.setdefault(name, []).append(row)
    vertices = [(row["x"], row["y"], row["z"]) for row in found["vertex"]]
    faces = [row.get("vertex_indices", row.get("vertex_index")) for row in found["face"]]
    return vertices, faces


def add(path, origin):
    """The mesh as an object; Blender has single precision only, so it is moved to `origin`."""
    vertices, faces = read_ply(path)
    mesh = bpy.data.meshes.new(path)
    mesh.from_pydata([tuple(v[k] - origin[k] for k in range(3)) for v in vertices], [], faces)
    thing = bpy.data.objects.new(path, mesh)
    bpy.context.collection.objects.link(thing)
    return thing


def measure(mesh):
    work = bmesh.new()
    work.from_mesh(mesh)
    open_edges = sum(1 for edge in work.edges if not edge.is_manifold)
    result = {"faces": len(work.faces), "open_edges": open_edges, "closed": bool(work.faces) and open_edges == 0,
              "volume_m3": work.calc_volume()}
    work.free()
    return result


def main():
    result_file, *meshes = sys.argv[sys.argv.index("--") + 1:]
    first, _ = read_ply(meshes[0])
    origin = [sum(v[k] for v in first) / len(first) for k in range(3)]
    things = [add(path, origin) for path in meshes]
    result = {"blender": bpy.app.version_string, "seconds": [], "cpu_seconds": [], "measures": []}
    whole = things[0]
    bpy.context.view_layer.objects.active = whole
    for other in things[1:]:
        start, cpu_start = time.perf_counter(), time.process_time()
        modifier = whole.modifiers.new(name="intersection", type="BOOLEAN")
        modifier.operation = "INTERSECT"
        modifier.solver = "EXACT"
        modifier.object = other
        bpy.ops.object.modifier_apply(modifier=modifier.name)
        result["seconds"].append(time.perf_counter() - start)
        result["cpu_seconds"].append(time.process_time() - cpu_start)
        result["measures"].append(measure(whole.data))
        with open(result_file + ".part", "w", encoding="utf-8") as stream:
            json.dump(result, stream)
        os.replace(result_file + ".part", result_file)


main()
