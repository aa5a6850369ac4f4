"""A flight over three squares of the plaza: when each of them is seen.

    PYTHONPATH=build/python python docs/flight/draw.py     writes profile.png beside this file; needs matplotlib
"""

import pathlib

import vantage as vt

HERE = pathlib.Path(__file__).resolve().parent
PLACES = {"west": (-60, -50), "market": (0, 0), "east": (60, 50)}
FLIGHT = [[-80, -40, 20], [0, -30, 35], [50, -10, 45], [80, 45, 25]]

scene = vt.Scene.from_mesh(HERE.parents[1] / "examples" / "plaza" / "plaza.obj")
targets = [vt.Target(name=name, vertices=[[x - 2, y - 2, 0.2], [x + 2, y - 2, 0.2], [x + 2, y + 2, 0.2], [x - 2, y + 2, 0.2]])
           for name, (x, y) in PLACES.items()]
mission = vt.Mission.of(scene, targets, max_range=60, navigation=vt.Navigation(altitude=(3, 50)))
vt.check(mission, FLIGHT, speed_m_s=5, tube_m=1).plot(HERE / "profile.png", size=(1200, 700))
