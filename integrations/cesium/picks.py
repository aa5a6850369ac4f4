#!/usr/bin/env python3
"""Chooses lines of sight to a volume, and finds what each meets first: from the PLY alone, by all facets, one by one.

    picks.py VOLUME.ply PICKS.json [SEED]

For each cause, and the target, a line to the middle of one of its facets; more of the largest causes up to ten. The
places are written in ECEF, by PROJ, for check.mjs.
"""

import json
import pathlib
import sys
from typing import Any

import numpy as np
from volume_files import Floats, PlyVolume, read_ply, to_earth

FEWEST = 10
ATTEMPTS = 400
LEAST_AREA_M2 = 4.0
BESIDE_M = 0.15  # lines so far beside must meet the same cause: a pixel is not a line


class Shown:
    """All triangles that are shown, and what each belongs to."""

    def __init__(self, volume: PlyVolume) -> None:
        corners = [volume.vertices[volume.facets]]
        features = [volume.cause_of.astype(int)]
        self.names = [*volume.causes]
        for name, parts in volume.targets:
            for part in parts:
                fan = np.array([[part[0], part[i - 1], part[i]] for i in range(2, len(part))])
                corners.append(fan)
                features.append(np.full(len(fan), len(self.names)))
            self.names.append(("target", name))
        self.corners, self.features = np.concatenate(corners), np.concatenate(features)
        self.doubled = np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        self.areas = np.linalg.norm(self.doubled, axis=1) / 2

    def first_hit(self, start: Floats, direction: Floats) -> tuple[float, int]:
        """Distance, and the triangle (Moeller and Trumbore, 1997); infinity where there is none."""
        a, b, c = self.corners[:, 0], self.corners[:, 1], self.corners[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            p = np.cross(direction, c - a)
            scale = 1 / np.einsum("ij,ij->i", b - a, p)
            u = np.einsum("ij,ij->i", start - a, p) * scale
            q = np.cross(start - a, b - a)
            v = q @ direction * scale
            distance = np.einsum("ij,ij->i", c - a, q) * scale
            hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 0)
        distance = np.where(hit, distance, np.inf)
        nearest = int(distance.argmin())
        return float(distance[nearest]), nearest


def clear_line(shown: Shown, triangle: int, random: np.random.Generator) -> tuple[Floats, Floats] | None:
    """From where to where a line meets the triangle before all else, and so do lines beside it."""
    at = shown.corners[triangle].mean(axis=0)
    normal = shown.doubled[triangle] / np.linalg.norm(shown.doubled[triangle])
    aside = random.normal(size=3)
    away = normal * random.choice([-1, 1]) + 0.6 * aside / np.linalg.norm(aside)
    start = at + away / np.linalg.norm(away) * random.uniform(2, 40)
    if start[2] < 0.5:
        return None
    length = np.linalg.norm(at - start)
    for shift in [np.zeros(3), *(BESIDE_M * np.eye(3)), *(-BESIDE_M * np.eye(3))]:
        towards = at + shift - start
        _, met = shown.first_hit(start, towards / np.linalg.norm(towards))
        if shown.features[met] != shown.features[triangle]:
            return None
    distance, met = shown.first_hit(start, (at - start) / length)
    return (start, at) if met == triangle and abs(distance - length) < 1e-6 else None


def pick_of(shown: Shown, feature: int, random: np.random.Generator) -> tuple[Floats, Floats] | None:
    own = np.flatnonzero((shown.features == feature) & (shown.areas > 0))
    large = own[shown.areas[own] >= min(LEAST_AREA_M2, shown.areas[own].max())]
    for _ in range(ATTEMPTS):
        line = clear_line(shown, int(random.choice(large)), random)
        if line is not None:
            return line
    return None


def main() -> int:
    if len(sys.argv) not in (3, 4):
        print(__doc__, file=sys.stderr)
        return 2
    volume = read_ply(pathlib.Path(sys.argv[1]))
    random = np.random.default_rng(int(sys.argv[3]) if len(sys.argv) == 4 else 1)
    shown = Shown(volume)
    areas = np.bincount(shown.features, shown.areas, len(shown.names))
    order = [int(feature) for feature in np.argsort(-areas) if areas[feature] > 0]
    picks: list[dict[str, Any]] = []
    for feature in [*order, *order[:max(0, FEWEST - len(order))]]:
        line = pick_of(shown, feature, random)
        kind, name = shown.names[feature]
        if line is None:
            print(f"no line of sight meets {kind} '{name}' before all else")
            continue
        start, at = to_earth(volume, np.array(line))
        picks.append({"kind": kind, "name": name, "area_m2": float(areas[feature]), "from": start.tolist(), "at": at.tolist()})
    pathlib.Path(sys.argv[2]).write_text(json.dumps(picks, indent=1) + "\n")
    print(f"{len(picks)} lines of sight, to {len({(pick['kind'], pick['name']) for pick in picks})} causes and targets")
    return 0


if __name__ == "__main__":
    sys.exit(main())
