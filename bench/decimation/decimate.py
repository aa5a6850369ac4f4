#!/usr/bin/env python3
"""Decimates a PLY of vantage with another program, for compare_decimation.py.

    decimate.py meshoptimizer|blender VOLUME.ply FACETS RESULT.ply     prints the CPU seconds that the decimation took

Needs numpy, and `meshoptimizer` or `bpy` from PyPI: each in an environment of its own, if need be.
"""

import sys
import time

import numpy


def read_ply(file):
    """Vertices and triangles of a binary PLY that vantage wrote, or this script."""
    data = open(file, "rb").read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode()
    vertices = int(header.split("element vertex ")[1].split()[0])
    faces = int(header.split("element face ")[1].split()[0])
    positions = numpy.frombuffer(data, "<f8", 3 * vertices, end).reshape(-1, 3)
    fields = [("count", "u1"), ("corners", "<i4", 3)]
    row = numpy.dtype(fields + ([("cause", "<u4")] if "property uint cause" in header else []))
    return positions, numpy.frombuffer(data, row, faces, end + 24 * vertices)["corners"]


def write_ply(file, positions, triangles):
    with open(file, "wb") as out:
        out.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\nproperty double x\n"
                  f"property double y\nproperty double z\nelement face {len(triangles)}\n"
                  "property list uchar int vertex_indices\nend_header\n".encode())
        out.write(numpy.asarray(positions, "<f8").tobytes())
        rows = numpy.zeros(len(triangles), numpy.dtype([("count", "u1"), ("corners", "<i4", 3)]))
        rows["count"] = 3
        rows["corners"] = triangles
        out.write(rows.tobytes())


def with_meshoptimizer(positions, triangles, facets):
    import meshoptimizer
    indices = triangles.astype(numpy.uint32).ravel()
    # Single precision is all that it takes. Its result is a choice of the vertices: they keep their own numbers.
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
    local = numpy.ascontiguousarray(positions - middle, numpy.float32)
    result = numpy.zeros_like(indices)
    begin = time.process_time()
    count = meshoptimizer.simplify(result, indices, local, target_index_count=3 * facets, target_error=1e9)
    seconds = time.process_time() - begin
    return positions, result[:count].reshape(-1, 3), seconds


def with_blender(positions, triangles, facets):
    import bpy
    # Blender's meshes are in single precision: about the middle, so that little is lost by that.
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("volume")
    mesh.from_pydata((positions - middle).tolist(), [], triangles.tolist())
    volume = bpy.data.objects.new("volume", mesh)
    bpy.context.collection.objects.link(volume)
    modifier = volume.modifiers.new("decimate", "DECIMATE")  # "collapse", as the button does
    modifier.ratio = facets / len(triangles)
    modifier.use_collapse_triangulate = True
    begin = time.process_time()
    made = volume.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    seconds = time.process_time() - begin
    made.calc_loop_triangles()
    corners = numpy.array([t.vertices[:] for t in made.loop_triangles])
    return numpy.array([v.co[:] for v in made.vertices], float) + middle, corners, seconds


def main():
    program, volume, facets, result = sys.argv[1:5]
    decimate = {"meshoptimizer": with_meshoptimizer, "blender": with_blender}[program]
    positions, triangles = read_ply(volume)
    positions, triangles, seconds = decimate(positions, triangles, int(facets))
    used, corners = numpy.unique(triangles, return_inverse=True)
    write_ply(result, positions[used], corners.reshape(-1, 3))
    print(seconds)


if __name__ == "__main__":
    main()
