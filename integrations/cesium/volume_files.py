"""Reads a volume that vantage wrote, as PLY and as a tileset, by code that is not vantage's: numpy and PROJ alone."""

import json
import pathlib
import struct
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pyproj

Floats = npt.NDArray[np.float64]


class PlyVolume(NamedTuple):
    vertices: Floats                    # (n, 3), scene frame, metres
    facets: npt.NDArray[np.int32]       # (m, 3)
    cause_of: npt.NDArray[np.uint32]    # (m)
    causes: list[tuple[str, str]]       # kind and name
    georeference: dict[str, Any]
    targets: list[tuple[str, list[Floats]]]  # name, and polygons of (k, 3)


def comments_of(lines: list[str], mark: str) -> list[str]:
    start = f"comment vantage {mark}"
    return [line[len(start):].strip("\r") for line in lines if line.startswith(start)]


def count_of(lines: list[str], element: str) -> int:
    return next(int(line.split()[2]) for line in lines if line.startswith(f"element {element} "))


def read_ply(file: pathlib.Path) -> PlyVolume:
    """Throws ValueError for a file that is no volume of vantage's."""
    content = file.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    lines = content[:end].decode().split("\n")
    count = count_of(lines, "vertex")
    vertices = np.frombuffer(content, "<f8", 3 * count, end).reshape(-1, 3)
    row = np.dtype([("corners", "u1"), ("facet", "<i4", 3), ("cause", "<u4")])
    rows = np.frombuffer(content, row, count_of(lines, "face"), end + vertices.nbytes)
    causes = [(kind, name) for _, kind, name in (text.split(" ", 2) for text in comments_of(lines, "cause "))]
    statement = json.loads("".join(text.removeprefix(" ") for text in comments_of(lines, "volume:")))
    stated = statement["target"]
    targets = [(stated["name"], [np.array(part) for part in stated["parts"]])]
    return PlyVolume(vertices, rows["facet"], rows["cause"], causes, json.loads(comments_of(lines, "georeference:")[0]), targets)


def to_earth(volume: PlyVolume, points: Floats) -> Floats:
    """ECEF by PROJ, of points of the scene frame; z is taken as the height above the ellipsoid."""
    to_degrees = pyproj.Transformer.from_crs(volume.georeference["projection"], "EPSG:4326", always_xy=True)
    to_ecef = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    longitude, latitude = to_degrees.transform(points[:, 0], points[:, 1])
    return np.stack(to_ecef.transform(longitude, latitude, points[:, 2]), axis=1)


class Glb:
    """A binary glTF and the arrays of its accessors and views."""

    def __init__(self, file: pathlib.Path) -> None:
        content = file.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", content)
        if (magic, version, length) != (b"glTF", 2, len(content)):
            raise ValueError(f"{file}: no binary glTF 2.0")
        size, _ = struct.unpack_from("<I4s", content, 12)
        self.json: dict[str, Any] = json.loads(content[20:20 + size])
        self.buffer = content[20 + size + 8:]

    def view(self, index: int, kind: str) -> npt.NDArray[Any]:
        view = self.json["bufferViews"][index]
        return np.frombuffer(self.buffer, kind, view["byteLength"] // np.dtype(kind).itemsize, view["byteOffset"])

    def accessor(self, index: int) -> npt.NDArray[Any]:
        accessor = self.json["accessors"][index]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        values = self.view(accessor["bufferView"], kind)
        return values.reshape(-1, 3) if accessor["type"] == "VEC3" else values

    def texts(self, column: dict[str, Any]) -> list[str]:
        offsets = self.view(column["stringOffsets"], "<u4")
        values = self.view(column["values"], "u1").tobytes()
        return [values[a:b].decode() for a, b in zip(offsets[:-1], offsets[1:])]
