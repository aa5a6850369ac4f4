#!/usr/bin/env python3
"""Draws a volume in its scene, seen obliquely, into a PNG: scene grey, target red, volume translucent with its creases.

    pip install numpy pillow pyyaml trimesh
    render.py MISSION.yaml VOLUME.ply PICTURE.png [--azimuth 235] [--elevation 38] [--margin 0.25]

Reads what `vantage compute MISSION.yaml -o VOLUME.ply` wrote. Colours of the volume: blue where the scene bounds it,
orange where the range does, green where a navigation limit does. Parallel projection; needs no display and no GPU.
"""

import argparse
import pathlib

import numpy
import trimesh
import yaml
from PIL import Image

SIZE = (1200, 800)  # pixels, width and height
SAMPLES = 2  # per pixel, each way
BACKGROUND = numpy.array([246, 247, 249], float)
TARGET = numpy.array([214, 30, 40], float)
KINDS = {
    "scene": (52, 110, 190),
    "range": (238, 150, 50),
    "target_plane": (150, 150, 150),
    "navigation": (60, 160, 100),
}
FRONT_OPACITY, BACK_OPACITY = 0.34, 0.22
CREASE_DEGREES = 4.0  # edges flatter than this are not drawn: the range sphere's triangles
SLIVER = 0.02  # square metres: on the sphere the normal of a smaller facet says little


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mission", type=pathlib.Path)
    parser.add_argument("volume", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--azimuth", type=float, default=235, help="degrees from x to where the camera is")
    parser.add_argument("--elevation", type=float, default=38, help="degrees above the horizon")
    parser.add_argument("--margin", type=float, default=0.25, help="scene shown around the volume, as a share of it")
    return parser.parse_args()


def read_mesh(file: pathlib.Path, up: str = "z", scale: float = 1.0) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Vertices in the scene frame, metres, and triangles."""
    mesh = trimesh.load(file, force="mesh", process=False)
    vertices = numpy.asarray(mesh.vertices, float) * scale
    if up == "y":
        vertices = numpy.column_stack([vertices[:, 0], -vertices[:, 2], vertices[:, 1]])
    return vertices, numpy.asarray(mesh.faces)


def read_causes(file: pathlib.Path) -> numpy.ndarray:
    """The kind of cause of each facet of a volume."""
    header = file.read_bytes().split(b"end_header")[0].decode()
    kinds = {}
    for line in header.splitlines():
        words = line.split()
        if words[:3] == ["comment", "vantage", "cause"]:
            kinds[int(words[3])] = words[4]
    raw = trimesh.load(file, process=False).metadata["_ply_raw"]["face"]["data"]
    return numpy.array([kinds[int(cause)] for cause in raw["cause"]])


class Camera:
    """Parallel projection to (pixels right, pixels down, metres of depth)."""

    def __init__(self, azimuth: float, elevation: float):
        a, e = numpy.radians([azimuth, elevation])
        self.towards = numpy.array([numpy.cos(a) * numpy.cos(e), numpy.sin(a) * numpy.cos(e), numpy.sin(e)])
        self.right = numpy.array([-numpy.sin(a), numpy.cos(a), 0])
        self.up = numpy.cross(self.towards, self.right)
        self.scale, self.shift = 1.0, numpy.zeros(2)

    def project(self, points: numpy.ndarray) -> numpy.ndarray:
        flat = numpy.column_stack([points @ self.right, -points @ self.up]) * self.scale + self.shift
        return numpy.column_stack([flat, -points @ self.towards])

    def frame(self, points: numpy.ndarray, margin: float) -> None:
        flat = self.project(points)[:, :2]
        low, high = flat.min(0), flat.max(0)
        size = numpy.array(SIZE) * SAMPLES
        self.scale = (size / ((high - low) * (1 + margin))).min()
        self.shift = size / 2 - self.scale * (low + high) / 2


class Layer:
    """A depth buffer with colours. `nearest` keeps the least depth, otherwise the greatest."""

    def __init__(self, nearest: bool = True):
        self.nearest = nearest
        shape = (SIZE[1] * SAMPLES, SIZE[0] * SAMPLES)
        self.depth = numpy.full(shape, numpy.inf if nearest else -numpy.inf)
        self.colour = numpy.tile(BACKGROUND, shape + (1,))

    def triangle(self, corners: numpy.ndarray, colour: numpy.ndarray) -> None:
        height, width = self.depth.shape
        left, top = numpy.maximum(numpy.floor(corners[:, :2].min(0)).astype(int), 0)
        right, bottom = numpy.minimum(numpy.ceil(corners[:, :2].max(0)).astype(int) + 1, (width, height))
        if left >= right or top >= bottom:
            return
        a, b, c = corners
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-9:
            return
        x, y = numpy.arange(left, right)[None, :] + 0.5 - a[0], numpy.arange(top, bottom)[:, None] + 0.5 - a[1]
        u = (x * (c[1] - a[1]) - y * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * y - (b[1] - a[1]) * x) / area
        depth = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
        here = (slice(top, bottom), slice(left, right))
        better = depth < self.depth[here] if self.nearest else depth > self.depth[here]
        inside = (u >= 0) & (v >= 0) & (u + v <= 1) & better
        self.depth[here][inside] = depth[inside]
        self.colour[here][inside] = colour

    def mesh(self, camera: Camera, vertices: numpy.ndarray, triangles: numpy.ndarray, colours: numpy.ndarray) -> None:
        corners = camera.project(vertices)[triangles]
        for triangle, colour in zip(corners, colours):
            self.triangle(triangle, colour)


def normals_of(vertices: numpy.ndarray, triangles: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Unit normals, and areas."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    normals = numpy.cross(b - a, c - a)
    sizes = numpy.linalg.norm(normals, axis=1)
    return normals / numpy.maximum(sizes, 1e-30)[:, None], sizes / 2


def grey(normals: numpy.ndarray) -> numpy.ndarray:
    """Light from above and from two sides; triangles are opaque from both sides, so the sign plays no part."""
    light = 0.62 + 0.28 * numpy.abs(normals[:, 2]) + 0.10 * numpy.abs(normals[:, 0])
    return light[:, None] * numpy.array([222, 222, 226])


def creases(
    triangles: numpy.ndarray, normals: numpy.ndarray, areas: numpy.ndarray, kinds: numpy.ndarray
) -> numpy.ndarray:
    """Edges, as pairs of vertices, between facets that differ in kind or meet at an angle."""
    edges = numpy.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = numpy.lexsort((edges[:, 1], edges[:, 0]))
    facet = order // 3
    same = (edges[order][:-1] == edges[order][1:]).all(1)
    one, other = facet[:-1][same], facet[1:][same]
    sharp = (normals[one] * normals[other]).sum(1) < numpy.cos(numpy.radians(CREASE_DEGREES))
    sharp &= (kinds[one] != "range") | (numpy.minimum(areas[one], areas[other]) > SLIVER)
    return edges[order][:-1][same][sharp | (kinds[one] != kinds[other])]


def draw_lines(image: numpy.ndarray, ends: numpy.ndarray, scene: Layer, front: Layer, near: float) -> None:
    """Dark where nothing is before them, faint where the volume's front is, none where the scene is; `near`: metres
    that count as on the surface."""
    height, width = scene.depth.shape
    for a, b in ends:
        count = int(numpy.abs(b - a)[:2].max()) + 1
        points = a + (b - a) * (numpy.arange(count + 1) / count)[:, None]
        x, y = points[:, 0].astype(int), points[:, 1].astype(int)
        keep = (x >= 0) & (y >= 0) & (x < width - 1) & (y < height - 1)
        x, y, depth = x[keep], y[keep], points[keep, 2]
        shown = depth < scene.depth[y, x] + near
        x, y, depth = x[shown], y[shown], depth[shown]
        strength = numpy.where(depth < front.depth[y, x] + near, 0.75, 0.22)[:, None]
        for dx, dy in ((0, 0), (1, 0), (0, 1)):
            image[y + dy, x + dx] = (1 - strength) * image[y + dy, x + dx] + strength * numpy.array([18, 38, 72])


def draw_outline(image: numpy.ndarray, corners: numpy.ndarray) -> None:
    """The target's outline, through everything: buildings may hide the target itself."""
    for a, b in zip(corners, numpy.roll(corners, -1, axis=0)):
        count = int(numpy.abs(b - a)[:2].max()) + 1
        points = (a + (b - a) * (numpy.arange(count + 1) / count)[:, None])[:, :2].astype(int)
        for x, y in points:
            if 1 < x < image.shape[1] - 2 and 1 < y < image.shape[0] - 2:
                image[y - 1:y + 2, x - 1:x + 2] = TARGET


def target_triangles(target: dict) -> tuple[numpy.ndarray, numpy.ndarray]:
    vertices = numpy.array(target["vertices"], float)
    return vertices, numpy.array([[0, i, i + 1] for i in range(1, len(vertices) - 1)])


def draw(mission_file: pathlib.Path, volume_file: pathlib.Path, camera: Camera, margin: float) -> numpy.ndarray:
    mission = yaml.safe_load(mission_file.read_text())
    options = mission["scene"]
    vertices, triangles = read_mesh(mission_file.parent / options["mesh"], options.get("up", "z"),
                                    options.get("scale", 1.0))
    volume, facets = read_mesh(volume_file)
    kinds = read_causes(volume_file)
    normals, areas = normals_of(volume, facets)
    camera.frame(volume, margin)

    scene = Layer()
    scene.mesh(camera, vertices, triangles, grey(normals_of(vertices, triangles)[0]))
    corners, fan = target_triangles(mission["target"])
    nearer = 0.003 * SIZE[0] * SAMPLES / camera.scale  # so that it shows on the surface that it lies on
    scene.mesh(camera, corners + nearer * camera.towards, fan, [TARGET] * len(fan))

    shade = 0.72 + 0.28 * numpy.abs(normals @ numpy.array([0.35, -0.45, 0.82]))
    colours = shade[:, None] * numpy.array([KINDS[kind] for kind in kinds], float)
    facing = normals @ camera.towards > 0
    front, back = Layer(), Layer(nearest=False)
    front.mesh(camera, volume, facets[facing], colours[facing])
    back.mesh(camera, volume, facets[~facing], colours[~facing])

    image = scene.colour.copy()
    for layer, opacity in ((back, BACK_OPACITY), (front, FRONT_OPACITY)):
        shown = numpy.isfinite(layer.depth) & (layer.depth < scene.depth)
        image[shown] = (1 - opacity) * image[shown] + opacity * layer.colour[shown]
    near = 3 / camera.scale  # three samples
    draw_lines(image, camera.project(volume)[creases(facets, normals, areas, kinds)], scene, front, near)
    draw_outline(image, camera.project(corners))
    return image


def main() -> None:
    options = arguments()
    camera = Camera(options.azimuth, options.elevation)
    image = draw(options.mission, options.volume, camera, options.margin)
    picture = Image.fromarray(image.clip(0, 255).astype(numpy.uint8)).resize(SIZE, Image.Resampling.BOX)
    picture.save(options.picture, optimize=True)


if __name__ == "__main__":
    main()
