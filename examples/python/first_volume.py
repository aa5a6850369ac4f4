"""A first volume: from where can a drone see a whole market square between houses? Nothing is fetched.

    pip install 'vantage[plot]'
    python first_volume.py          writes first_volume.png
"""

import sys

import numpy as np

import vantage as vt

# Four houses about a square of 30 m, on flat ground: a box each, of 8 corners and 12 triangles.
SIDES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                  [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
houses = {"town hall": (-35, -10, -18, 12, 22), "bakery": (20, -15, 32, 0, 9), "inn": (-10, 20, 12, 34, 12),
          "church": (4, -45, 20, -22, 30)}
vertices = [[-90, -90, 0], [90, -90, 0], [90, 90, 0], [-90, 90, 0]]
faces, owner = [[0, 1, 2], [0, 2, 3]], [0, 0]
for number, (west, south, east, north, height) in enumerate(houses.values(), 1):
    faces += (SIDES + len(vertices)).tolist()
    vertices += [[x, y, z] for x in (west, east) for y in (south, north) for z in (0, height)]
    owner += [number] * len(SIDES)
objects = [vt.SceneObject("ground", kind="ground"), *(vt.SceneObject(name, kind="building") for name in houses)]
scene = vt.Scene.from_arrays(vertices, faces, object_of=owner, objects=objects)

square = [[-15, -15, 0], [15, -15, 0], [15, 15, 0], [-15, 15, 0]]
result = vt.compute(scene, square, max_range=80, navigation=vt.Navigation(altitude=(5, 60), clearance=3))

print(result)
print("at 20 m above the ground:", result.slice(z=20))
for cause in sorted(result.causes, key=lambda cause: -cause.area_m2)[:4]:
    print(f"  {cause.area_m2:6.0f} m2 of the boundary: {cause.name}")
print("proof:", result.prove()["verdict"])
result.plot(sys.argv[1] if len(sys.argv) > 1 else "first_volume.png")
