#!/usr/bin/env python3
"""Checks a tileset that vantage wrote by the rules of its formats, and beside the same volume as PLY.

    check_tileset.py FOLDER.tiles VOLUME.ply     exit 1 and a line for each fault

The rules: 3D Tiles 1.1 (OGC 22-025r4), EXT_mesh_features and EXT_structural_metadata. Positions are compared with those
that PROJ finds, areas and causes with the facets of the PLY.
"""

import json
import math
import pathlib
import sys
from typing import Any

import numpy as np
from volume_files import Floats, Glb, PlyVolume, read_ply, to_earth

TOLERANCE_M = 1e-3  # of a position, besides the rounding that the file states

faults: list[str] = []


def check(is_right: bool, text: str) -> None:
    if not is_right:
        faults.append(text)


def is_numbers(value: Any, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(
        isinstance(number, int | float) and math.isfinite(number) for number in value)


def check_tileset(tileset: dict[str, Any], folder: pathlib.Path) -> None:
    """tileset.json alone."""
    check(tileset["asset"]["version"] == "1.1", "asset.version is not 1.1")
    root = tileset["root"]
    check(tileset["geometricError"] >= root["geometricError"] == 0, "geometric errors do not fall to 0")
    check(root["refine"] in ("ADD", "REPLACE"), "root.refine is neither ADD nor REPLACE")
    check(is_numbers(root["boundingVolume"]["box"], 12), "the box does not have twelve numbers")
    check(is_numbers(root["transform"], 16), "the transform does not have sixteen numbers")
    transform = np.array(root["transform"]).reshape(4, 4).T
    check(transform[3].tolist() == [0, 0, 0, 1], "the transform is not affine")
    turn = transform[:3, :3]
    check(np.abs(turn @ turn.T - np.eye(3)).max() < 1e-12 and np.linalg.det(turn) > 0, "the transform is no turn")
    uri = root["content"]["uri"]
    check("/" not in uri and (folder / uri).is_file(), "the content is not in the folder")
    check(sorted(file.name for file in folder.iterdir()) == sorted(["tileset.json", uri]), "other files are in the folder")


def z_up(positions: Any) -> Floats:
    """From the axes of glTF to those of 3D Tiles, as clients turn them."""
    p = positions.astype(np.float64)
    return np.stack([p[:, 0], -p[:, 2], p[:, 1]], axis=1)


def check_schema(glb: Glb) -> dict[str, Any]:
    """Returns the property table."""
    metadata = glb.json["extensions"]["EXT_structural_metadata"]
    check(set(glb.json["extensionsUsed"]) == {"EXT_mesh_features", "EXT_structural_metadata"}, "extensionsUsed is wrong")
    table: dict[str, Any] = metadata["propertyTables"][0]
    properties = metadata["schema"]["classes"][table["class"]]["properties"]
    check(set(properties) == set(table["properties"]) == {"kind", "name", "area_m2"}, "the properties are others")
    check(properties["kind"]["type"] == properties["name"]["type"] == "STRING", "kind or name is no STRING")
    area = properties["area_m2"]
    check((area["type"], area["componentType"]) == ("SCALAR", "FLOAT64"), "area_m2 is no FLOAT64")
    for view in glb.json["bufferViews"]:
        check(view["byteOffset"] % 8 == 0 and view["byteLength"] > 0, "a view is empty or not aligned")
    for name in ("kind", "name"):
        column = table["properties"][name]
        offsets = glb.view(column["stringOffsets"], "<u4")
        size = glb.json["bufferViews"][column["values"]]["byteLength"]
        check(len(offsets) == table["count"] + 1 and offsets[0] == 0, f"{name} has a wrong number of offsets")
        check(bool((np.diff(offsets.astype(np.int64)) >= 0).all()) and int(offsets[-1]) <= max(size, 1), f"offsets of {name}")
    return table


class Content:
    """All facets of a content in one: corners in the frame of the tile, and the feature of each."""

    def __init__(self, glb: Glb, feature_count: int) -> None:
        corners, features = [np.zeros((0, 3, 3))], [np.zeros(0)]
        self.points = [np.zeros((0, 3))]
        for primitive in (p for mesh in glb.json["meshes"] for p in mesh["primitives"]):
            ids = primitive["extensions"]["EXT_mesh_features"]["featureIds"]
            check(len(ids) == 1 and ids[0]["attribute"] == 0 and ids[0]["propertyTable"] == 0, "featureIds are others")
            places = z_up(glb.accessor(primitive["attributes"]["POSITION"]))
            feature = glb.accessor(primitive["attributes"]["_FEATURE_ID_0"])
            check(bool((feature == np.round(feature)).all() and feature.min() >= 0 and feature.max() < feature_count),
                  "a feature id is no row of the table")
            self.points.append(places)
            if primitive.get("mode", 4) == 4:
                facets = glb.accessor(primitive["indices"]).reshape(-1, 3)
                check(bool((feature[facets] == feature[facets[:, :1]]).all()), "a facet has two features")
                check(len(np.unique(feature[facets])) == ids[0]["featureCount"], "featureCount is another")
                corners.append(places[facets])
                features.append(feature[facets[:, 0]])
        self.corners = np.concatenate(corners)
        self.features = np.concatenate(features).astype(int)


def areas_of(corners: Floats) -> Floats:
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(np.linalg.norm(doubled, axis=1) / 2)


def check_features(glb: Glb, table: dict[str, Any], content: Content, volume: PlyVolume) -> None:
    kinds, names = glb.texts(table["properties"]["kind"]), glb.texts(table["properties"]["name"])
    stated = glb.view(table["properties"]["area_m2"]["values"], "<f8")
    wanted = [*volume.causes, *(("target", name) for name, _ in volume.targets)]
    check(list(zip(kinds, names)) == wanted, "kinds and names are not those of the PLY")
    facets_in_volume = content.features < len(volume.causes)
    check(int(facets_in_volume.sum()) == len(volume.facets), "the number of facets is another than that of the PLY")
    by_ply = np.bincount(volume.cause_of, areas_of(volume.vertices[volume.facets]), len(volume.causes))
    in_tile = np.bincount(content.features, areas_of(content.corners), len(kinds))
    for row, (kind, name) in enumerate(wanted):
        check(abs(in_tile[row] - stated[row]) <= 1e-3 * max(1, stated[row]), f"facets of {kind} '{name}' have another area")
        if kind != "target":
            check(abs(by_ply[row] - stated[row]) <= 1e-9 * max(1, stated[row]), f"area_m2 of {kind} '{name}'")


def check_box(tileset: dict[str, Any], content: Content) -> None:
    box = np.array(tileset["root"]["boundingVolume"]["box"]).reshape(4, 3)
    half_axes = box[1:].T
    for points in content.points:
        inside = np.linalg.solve(half_axes, (points - box[0]).T)
        check(bool((np.abs(inside) <= 1 + 1e-12).all()), "the box does not hold the content")


def check_places(tileset: dict[str, Any], content: Content, volume: PlyVolume) -> float:
    """Both ways, so that nothing is missing; returns the largest distance."""
    transform = np.array(tileset["root"]["transform"]).reshape(4, 4).T
    in_tile = np.concatenate(content.points) @ transform[:3, :3].T + transform[:3, 3]
    wanted = to_earth(volume, np.concatenate([volume.vertices, *(part for _, parts in volume.targets for part in parts)]))
    middle = wanted.mean(axis=0)
    distances = np.linalg.norm((in_tile - middle)[:, None, :] - (wanted - middle)[None, :, :], axis=2)
    farthest = float(max(distances.min(axis=1).max(), distances.min(axis=0).max()))
    rounding_m = tileset["asset"]["extras"]["vantage"]["rounding_m"]
    check(farthest <= TOLERANCE_M + rounding_m, f"a vertex is {farthest} m from where PROJ has it")
    print(f"positions: at most {1e3 * farthest:.6f} mm from PROJ's; stated rounding {1e3 * rounding_m:.6f} mm")
    return farthest


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1])
    volume = read_ply(pathlib.Path(sys.argv[2]))
    tileset = json.loads((folder / "tileset.json").read_text())
    check_tileset(tileset, folder)
    glb = Glb(folder / tileset["root"]["content"]["uri"])
    table = check_schema(glb)
    content = Content(glb, table["count"])
    check_features(glb, table, content, volume)
    check_box(tileset, content)
    check_places(tileset, content, volume)
    print(f"{folder.name}: {table['count']} features, {len(content.corners)} facets, {len(faults)} faults")
    for fault in faults:
        print(f"check_tileset.py: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
