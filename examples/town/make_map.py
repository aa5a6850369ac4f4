#!/usr/bin/env python3
"""Prints town.osm, an invented town of ten buildings as an OpenStreetMap file: no such place exists.

    make_map.py > town.osm
"""

import math

ORIGIN = (48.0, 11.0)  # latitude, longitude of (0, 0)
# Metres in a degree there, on the WGS 84 ellipsoid.
NORTH, EAST = 111199.97, 74624.83


class Map:
    def __init__(self):
        self.nodes, self.ways, self.relations = [], [], []

    def node(self, x, y, **tags):
        self.nodes.append((ORIGIN[0] + y / NORTH, ORIGIN[1] + x / EAST, tags))
        return len(self.nodes)

    def way(self, points, closed=True, **tags):
        numbers = [self.node(x, y) for x, y in points]
        self.ways.append((numbers + numbers[:1] if closed else numbers, tags))
        return len(self.ways)

    def box(self, west, south, east, north, **tags):
        return self.way([(west, south), (east, south), (east, north), (west, north)], **tags)

    def relation(self, members, **tags):
        self.relations.append((members, tags))


def key(name):
    """The tag of an argument's name: building_levels is building:levels."""
    return name.replace("_", ":")


def town():
    m = Map()
    # The square, and what stands round it.
    m.way([(-14, -10), (12, -12), (16, 4), (4, 13), (-15, 9)], place="square", name="Market Square")
    hall = m.box(-10, 22, 14, 36, building="civic", name="Town Hall", height="16")
    wing = m.box(-10, 22, 6, 36, building_part="yes", height="12", roof_shape="hipped", roof_height="4")
    tower = m.box(6, 22, 14, 36, building_part="yes", height="30", roof_shape="pyramidal", roof_height="8")
    m.relation([("outline", hall), ("part", wing), ("part", tower)], type="building")
    m.box(26, -8, 44, 6, building="church", height="14", roof_shape="gabled", roof_height="6", name="St Anne")
    m.way([(47 + 4 * math.cos(a * math.pi / 4), -1 + 4 * math.sin(a * math.pi / 4)) for a in range(8)],
          building="yes", height="34", roof_shape="onion", roof_height="10", name="St Anne's tower")
    m.box(-34, 12, -22, 30, building="house", building_levels="2", roof_shape="gabled", roof_levels="1")
    m.box(-34, -8, -22, 10, building="house", building_levels="3", roof_shape="mansard", roof_levels="1")
    m.box(-36, -34, -20, -16, building="retail", building_levels="2")
    outer = m.box(-12, -44, 20, -22)
    inner = m.box(-4, -38, 12, -28)
    m.relation([("outer", outer), ("inner", inner)], type="multipolygon", building="apartments", building_levels="4",
               name="The Court")
    m.box(24, -30, 34, -18, building="yes", height="concrete")  # nonsense, reported; three storeys by default
    m.box(24, 16, 36, 28, building="roof", height="6", name="Market roof")
    m.box(-6, -18, 2, -14, building="kiosk")
    # What hides besides buildings.
    m.way([(18, -14), (19, 8)], closed=False, natural="tree_row", height="9")
    m.node(-10, 14, natural="tree", height="12")
    m.way([(-18, -46), (26, -46)], closed=False, barrier="wall", height="2.5")
    m.way([(-60, 42), (60, 44)], closed=False, highway="primary", bridge="yes", layer="1", lanes="2")
    return m


def write(m):
    print('<?xml version="1.0" encoding="UTF-8"?>')
    print("<!-- An invented town, made by make_map.py: no such place exists. -->")
    print('<osm version="0.6" generator="make_map.py">')

    def tags(items):
        for name, value in items.items():
            print(f'    <tag k="{key(name)}" v="{value}"/>')

    for number, (latitude, longitude, items) in enumerate(m.nodes, 1):
        print(f'  <node id="{number}" version="1" lat="{latitude:.7f}" lon="{longitude:.7f}"' + (">" if items else "/>"))
        if items:
            tags(items)
            print("  </node>")
    for number, (nodes, items) in enumerate(m.ways, 1):
        print(f'  <way id="{number}" version="1">')
        for node in nodes:
            print(f'    <nd ref="{node}"/>')
        tags(items)
        print("  </way>")
    for number, (members, items) in enumerate(m.relations, 1):
        print(f'  <relation id="{number}" version="1">')
        for role, way in members:
            print(f'    <member type="way" ref="{way}" role="{role}"/>')
        tags(items)
        print("  </relation>")
    print("</osm>")


if __name__ == "__main__":
    write(town())
