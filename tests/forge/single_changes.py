"""Single changes of a sound certificate, and the exit code that each must get."""

import copy
import json
import math
import struct

from forged_files import (EAST, GROUND, SQUARE, TOWN, WALL, WEST, block, flat, inside_out, joined, mesh_hash, moved,
                          nothing, ply, scaled)

def put(**values):
    """Into the certificate."""
    return dict(certificate=lambda c: c.update(values))


def part(change=None, **values):
    def changed(claims):
        of = claims["parts"][0]
        of.update(values)
        if change:
            change(of)
    return dict(certificate=changed)


def say(change=None, **values):
    """Into what the volume says of itself."""
    def changed(statement):
        statement.update(values)
        return change(statement) if change else None
    return dict(statement=changed)


def words(old, new, count=1):
    """In the text of the certificate."""
    def changed(text):
        assert old in text, old
        return text.replace(old, new, count)
    return dict(text=changed)


def head(old, new, of="volume_ply", count=1):
    """In the header of the volume, or of the scene."""
    old, new = (x if isinstance(x, bytes) else x.encode() for x in (old, new))

    def changed(data):
        assert old in data, old
        return data.replace(old, new, count)
    return {of: changed}


def comment(text):
    return head("1.0\n", b"1.0\ncomment " + (text if isinstance(text, bytes) else text.encode()) + b"\n")


def polyglot():
    """Two meshes in one file: others read the second one, as the header ends at the second end_header for them."""
    by = (100, 100, 10)  # there no byte of a number is the end of a line
    begin = [(struct.unpack("<d", b"comment ")[0], 2.0, 2.0)], []
    first = joined(begin, moved(block((-28, -28, 0.5), (-4, 28, 24)), by))
    second = joined(([(0.0, 0.0, 9.0)], []), moved(block((-28, -28, 0.5), (28, 28, 24)), by))
    rows = ply(first).split(b"end_header\n", 1)[1]
    assert b"\n" not in rows

    def both(data):
        end = data.index(b"end_header\n")
        return data[:end] + b"comment end_header\n" + rows + b"\n" + data[end:]
    return dict(volume=second, scene=moved(TOWN, by), target=[[x + 100, y + 100, 10.0] for x, y, _ in SQUARE],
                volume_ply=both, certificate=lambda c: c["volume"].update(hash=mesh_hash(b"volume", first)))


def doubled_key(key, value):
    return words(f'"{key}": ', f'"{key}": {value}, "{key}": ')


def two_parts(change=nothing):
    other = [[x, y + 3, z] for x, y, z in SQUARE]

    def in_statement(statement):
        statement["target"]["parts"].append(other)
        statement["lift_m"].append(0.0)

    def in_certificate(claims):
        second = copy.deepcopy(claims["parts"][0])
        second.update(target=other, centre=[0.0, 3.0, 0.1])
        claims["parts"].append(second)
        change(claims["parts"])
    return dict(statement=in_statement, certificate=in_certificate)


def shell_of(*shells):
    return dict(volume=joined(WEST, *shells))


def cover(height, lift, size=3.0, roof=None, **more):
    """Something flat at a height over the target, which was raised."""
    pieces = [GROUND, WALL, flat((-size, -size, 0.1 + height), (size, size))]
    pieces += [flat((-2.5, -2.5, 0.1 + roof), (2.5, 2.5))] if roof is not None else []
    return dict(scene=joined(*pieces), volume=moved(WEST, (0, 0, 0.2)), shift=(0.0, lift), **more)


def small_world(margin):
    """All of it a millionth as large: what is left out must be smaller, too."""
    factor = 1e-6
    target = [[x * factor for x in p] for p in SQUARE]
    return dict(volume=scaled(WEST, factor), scene=scaled(TOWN, factor), target=target, reach=50 * factor,
                margin=margin)


POINT = dict(target=[[0.0, 0.0, 0.1]], certificate=lambda c: c["parts"][0].update(cut_height_m=None),
             step="(-1,0,0)", scene=WALL)
BOW = [SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]]
ELL = [[-2.0, -2.0, 0.1], [2.0, -2.0, 0.1], [2.0, 0.0, 0.1], [0.0, 0.0, 0.1], [0.0, 2.0, 0.1], [-2.0, 2.0, 0.1]]
FAR = -9e8
STAIRS = [(50.0, 50.0, 0.1 + 9e-7 * i) for i in range(3000)]  # the lift of each leads to the next one
HIGH = moved(WEST, (0, 0, 3))


def unused(*places):
    """Vertices that no triangle has."""
    return list(places), []


def folded(*places):
    """A triangle of both sides without area: the places lie on a line."""
    return [places[0], places[len(places) // 2], places[-1]], [(0, 1, 2), (0, 2, 1)]


def raised_past(height, lift, *more, **others):
    """By so much that what is flat at a height over the target is below it; and something more in the scene."""
    made = dict(cover(height, lift), volume=HIGH, **others)
    return dict(made, scene=joined(made["scene"], *more))


def ranges(of_volume, of_certificate=None):
    """What is said of the range."""
    reach = of_certificate or of_volume
    return dict(reach=of_volume, certificate=lambda c: c.update(max_range_m=reach))


def small_and_far(margin):
    """A world of micrometres whose target is said to lie a metre lower, and to be moved by that metre."""
    made = small_world(margin)
    z = made["target"][0][2]

    def at_its_place(claims):
        claims["parts"][0]["centre"] = [0.0, 0.0, z]
    return dict(made, target=[[x, y, z - 1] for x, y, _ in made["target"]], shift=(1.0, 0.0), certificate=at_its_place)
MINUS_INFINITY, NAN = float("-inf"), float("nan")

# What is changed, the exit code that it must get, and the change.
CHANGES = [
    ("nothing", 0, {}),

    # Planes.
    ("a plane of four numbers", 1, dict(volume=EAST, **part(steps="(0,0,0,-1)"))),
    ("a plane of five numbers", 1, dict(volume=EAST, **part(steps="(0,0,0,0,-1)"))),
    ("a plane of six numbers", 1, dict(volume=EAST, **part(steps="(0,0,0,0,0,-1)"))),
    ("a plane of two numbers", 1, part(steps="(-1,0)")),
    ("a plane of none", 1, part(steps="()")),
    ("a plane that is zero", 1, part(steps="(0,0,0)")),
    ("a plane that does not separate", 1, part(steps="(1,0,0)")),
    ("blanks in a plane", 1, part(steps="( -1 ,0,0)")),
    ("a plus in a plane", 1, part(steps="(-1,+0,0)")),
    ("an underscore in a plane", 1, part(steps="(-1,0_0,0)")),
    ("Arabic digits in a plane", 1, part(steps="(-\u0661,0,0)")),
    ("full-width digits in a plane", 1, part(steps="(-\uff11,0,0)")),
    ("a minus zero in a plane", 1, part(steps="(-1,-0,0)")),
    ("leading zeros in a plane", 1, part(steps="(-01,0,0)")),
    ("capitals in a plane", 1, part(steps="(-Z,0,0)")),
    ("a fraction in a plane", 1, part(steps="(-1.5,0,0)")),
    ("a plane as large as any is written", 0, part(steps="(-" + "z" * 12 + ",0,0)")),
    ("a plane of 2000 digits", 1, part(steps="(-" + "z" * 2000 + ",0,0)")),
    ("a plane of a million digits", 1, part(steps="(-" + "z" * 1000000 + ",0,0)")),
    ("a newline among the steps", 1, part(steps="(-1,0,0)\n")),
    ("a step too many", 1, part(steps="(-1,0,0).")),
    ("the scene left out", 1, part(steps=".")),
    ("no steps", 1, part(steps="")),
    ("100,000 halvings", 1, part(steps="<" * 100000)),

    # Lengths.
    ("a negative range", 1, put(max_range_m=-50.0)),
    ("a volume of 2 km in a negative range", 1, dict(volume=block((-2000, -25, 0.2), (-5, 25, 25)),
                                                     **put(max_range_m=-1e9))),
    ("no range", 1, put(max_range_m=0)),
    ("a range of 1e9 m", 0, ranges(1e9)),
    ("a range of 1.1e9 m", 1, ranges(1.1e9)),
    ("a range of 1.1e9 m in the volume alone", 1, ranges(1.1e9, 50.0)),
    ("a range of 1.1e9 m that the volume does not tell", 1, dict(ranges(1.1e9), said=False)),
    ("a range of 1e15 m, and a volume behind the target", 1, dict(
        ranges(1e15), volume=block((-25, -25, -0.9), (-5, 25, 25)), scene=WALL)),
    ("a range of 1e9 m, and a volume a micrometre behind the target", 1, dict(
        ranges(1e9), volume=block((-25, -25, 0.1 - 1e-6), (-5, 25, 25)))),
    ("a rounding of a micrometre, and a volume half of one behind the target", 1, dict(
        ranges(1e9), rounding=1e-6, volume=joined(block((-25, -25, 0.1 - 5e-7), (-5, 25, 25)),
                                                  block((FAR, -1, 1), (FAR + 9, 1, 2))))),
    ("a rounding of a micrometre, and a volume as far away", 0, dict(
        ranges(1e9), rounding=1e-6, volume=joined(WEST, block((FAR, -1, 1), (FAR + 9, 1, 2))))),
    ("a range that is no number", 2, put(max_range_m=NAN)),
    ("an infinite range", 2, put(max_range_m=math.inf)),
    ("a range of 1e400", 2, words('"max_range_m": 50.0', '"max_range_m": 1e400')),
    ("a range of 10^400", 2, words('"max_range_m": 50.0', '"max_range_m": 1' + "0" * 400)),
    ("a range that is true", 2, put(max_range_m=True)),
    ("a range that is a text", 2, put(max_range_m="50")),
    ("a range that is null", 2, put(max_range_m=None)),
    ("a range in Arabic digits", 2, words('"max_range_m": 50.0', '"max_range_m": \u0665\u0660')),
    ("a longer range than the volume's", 1, put(max_range_m=50.1)),
    ("a shorter range that holds", 0, put(max_range_m=49.9)),
    ("a shorter range that does not", 1, put(max_range_m=30)),
    ("a negative range in both", 1, dict(reach=-50.0)),
    ("a shrink of minus zero", 0, put(shrink=-0.0)),
    ("a shrink that is false", 2, put(shrink=False)),
    ("a shrink that is no number", 2, put(shrink=NAN)),
    ("a shrink of a thousandth", 1, put(shrink=1e-3)),
    ("a shrink of 1.1e-5", 1, put(shrink=1.1e-5)),
    ("a shrink of 1e-5", 0, put(shrink=1e-5)),
    ("a negative shrink", 1, put(shrink=-1e-5)),
    ("a shrink of more than all", 1, put(shrink=2)),
    ("a rounding that is a text", 2, put(rounding_m="0")),
    ("a negative rounding", 1, put(rounding_m=-1)),
    ("a rounding that is no number", 2, put(rounding_m=NAN)),
    ("a rounding that the volume does not have", 1, put(rounding_m=1e-15)),
    ("a rounding that the volume has", 0, dict(rounding=1e-15)),
    ("a rounding that its numbers cannot have", 1, dict(rounding=1e-13)),
    ("two roundings", 1, comment("vantage rounding_m 1e-15")),
    ("a rounding with a blank before it", 2, head("comment vantage rounding_m", "comment  vantage rounding_m")),
    ("a rounding with another word", 2, dict(rounding="0 0", **put(rounding_m=0))),
    ("a rounding to the base of 16", 2, dict(rounding="0x0", **put(rounding_m=0))),
    ("no rounding", 0, head("comment vantage rounding_m 0\n", "")),
    ("a height that does not count, no number", 2, part(cut_height_m=NAN)),
    ("a negative height that does not count", 1, part(cut_height_m=-1e-9)),
    ("a millimetre that does not count", 1, part(cut_height_m=1e-3)),
    ("a nanometre in a world of micrometres", 1, small_world(1e-9)),
    ("as little as that in proportion", 0, small_world(1e-15)),
    ("a nanometre in a world of micrometres that is moved by a metre", 1, small_and_far(5e-10)),
    ("what a metre of that is rounded by", 0, small_and_far(1e-15)),
    ("a target at 1.1e9 m that is moved as far", 1, dict(
        target=[[x, y, -1.1e9] for x, y, _ in SQUARE], shift=(1.1e9 + 0.1, 0.0))),

    # Keys, and JSON.
    ("a range twice, the first one shorter", 2, doubled_key("max_range_m", 10.0)),
    ("a scene twice", 2, doubled_key("scene", '{"file": "a", "hash": ""}')),
    ("a target twice", 2, doubled_key("target", "[]")),
    ("a key more", 2, put(checked=True)),
    ("a key more in a part", 2, part(sides="both")),
    ("a key less", 2, dict(certificate=lambda c: c.pop("boxes") and None)),
    ("a key less in a part", 2, part(lambda p: p.pop("normal"))),
    ("another format", 2, put(format="vantage certificate 2")),
    ("a format that is a list", 2, put(format=["vantage certificate 1"])),
    ("a list for all", 2, dict(text=lambda t: "[" + t + "]")),
    ("100,000 lists in each other", 2, dict(text=lambda t: "[" * 100000)),
    ("a second certificate behind it", 2, dict(text=lambda t: t + t)),
    ("an order mark", 2, dict(text=lambda t: "\ufeff" + t)),
    ("half a surrogate", 2, dict(text=lambda t: t.replace("vantage", "\ud800", 1))),
    ("nothing in it", 2, dict(text=lambda t: "")),
    ("parts that are none", 1, put(parts=[])),
    ("a part that is null", 2, put(parts=[None])),
    ("parts that are an object", 2, put(parts={})),
    ("a mission that is none", 1, put(mission_hash="")),
    ("another mission", 1, put(mission_hash="00" * 32)),
    ("control characters in the mission", 1, dict(statement=lambda s: s.update(mission_hash="\x1b[2J"),
                                                  **put(mission_hash="\x1b[2J"))),

    # Boxes.
    ("a box that is kept", 0, put(boxes=[{"name": "altitude", "min": [None, None, 0], "max": [None, None, 25]}])),
    ("a box that is not", 1, put(boxes=[{"name": "altitude", "min": [None, None, 0], "max": [None, None, 24]}])),
    ("a box the wrong way round", 1, put(boxes=[{"name": "keep_in", "min": [9, 9, 9], "max": [-9, -9, -9]}])),
    ("a limit that is no box", 1, put(boxes=[{"name": "sun", "min": [None] * 3, "max": [None] * 3}])),
    ("a limit of two lines", 1, put(boxes=[{"name": "altitude\naccepted: sun", "min": [None] * 3, "max": [None] * 3}])),
    ("a box of texts", 2, put(boxes=[{"name": "altitude", "min": [None, None, "0"], "max": [None] * 3}])),
    ("a box of truths", 2, put(boxes=[{"name": "altitude", "min": [False] * 3, "max": [None] * 3}])),
    ("a box of infinities", 2, put(boxes=[{"name": "altitude", "min": [MINUS_INFINITY] * 3, "max": [None] * 3}])),
    ("a box of four numbers", 2, put(boxes=[{"name": "altitude", "min": [None] * 4, "max": [None] * 3}])),
    ("a box of two numbers", 2, put(boxes=[{"name": "altitude", "min": [None] * 2, "max": [None] * 3}])),

    # Files.
    ("a file that is a folder", 2, dict(certificate=lambda c: c["volume"].update(file=".."))),
    ("a file without a name", 2, dict(certificate=lambda c: c["volume"].update(file=""))),
    ("a file in another folder", 1, dict(certificate=lambda c: c["volume"].update(file="../volume.ply"))),
    ("a file from the root", 1, dict(certificate=lambda c: c["scene"].update(file="/dev/zero"))),
    ("a NUL in a file's name", 1, dict(certificate=lambda c: c["volume"].update(file="a\0b"))),
    ("an escape in a file's name", 1, dict(certificate=lambda c: c["volume"].update(file="\x1b[2Jv.ply"))),
    ("a file that is not there", 2, dict(certificate=lambda c: c["volume"].update(file="gone.ply"))),
    ("the certificate as its volume", 2, dict(certificate=lambda c: c["volume"].update(file="volume.cert"))),
    ("the scene as its volume", 1, dict(certificate=lambda c: c["volume"].update(file="volume.scene.ply"))),
    ("the hash of another scene", 1, dict(certificate=lambda c: c["scene"].update(hash="0" * 64))),
    ("the hash of another volume", 1, dict(certificate=lambda c: c["volume"].update(hash="0" * 64))),

    # Facets.
    ("a negative facet", 1, part(lambda p: p.update(facets="-1 " + p["facets"]))),
    ("a facet that is not there", 1, part(lambda p: p.update(facets=p["facets"] + " c"))),
    ("a facet left out", 1, part(facets="1 2 3 4 5 6 7 8 9 a b")),
    ("all facets twice", 1, part(lambda p: p.update(facets=p["facets"] + " " + p["facets"], steps=2 * p["steps"]))),
    ("two blanks between facets", 1, part(lambda p: p.update(facets=p["facets"].replace(" ", "  ", 1)))),
    ("a blank before the facets", 1, part(lambda p: p.update(facets=" " + p["facets"]))),
    ("a blank behind the facets", 1, part(lambda p: p.update(facets=p["facets"] + " "))),
    ("a tab between facets", 1, part(lambda p: p.update(facets=p["facets"].replace(" ", "\t", 1)))),
    ("a capital facet", 1, part(lambda p: p.update(facets=p["facets"].replace("a", "A")))),
    ("a facet with a leading zero", 1, part(lambda p: p.update(facets=p["facets"].replace("a", "0a")))),
    ("a facet in Arabic digits", 1, part(lambda p: p.update(facets=p["facets"].replace("1", "\u0661")))),
    ("a facet of a million digits", 1, part(facets="z" * 1000000)),
    ("facets that are a list", 2, part(facets=[0, 1, 2])),
    ("no facets", 1, part(facets="", steps="")),

    # The target, and what is proved of it.
    ("first corners alike", 0, part(lambda p: p["corners"].insert(0, p["corners"][0]))),
    ("first corners alike, and one missing", 1, part(lambda p: p.update(corners=[p["corners"][0]] + p["corners"][:3]))),
    ("corners in the order of a star", 0, part(lambda p: p.update(corners=[p["corners"][i] for i in (0, 2, 1, 3)]))),
    ("corners on a line", 1, part(corners=[[-2, -2, 0], [2, 2, 0], [0, 0, 0], [1, 1, 0]])),
    ("corners of half the size", 1, part(lambda p: p.update(corners=[[x / 2 for x in c] for c in p["corners"]]))),
    ("no corners", 1, part(corners=[])),
    ("a corner of two numbers", 2, part(lambda p: p["corners"][0].pop())),
    ("a centre a millimetre beside the target", 1, part(
        lambda p: p.update(corners=[[x - 2.001, y, 0] for x, y, _ in p["corners"]]), centre=[2.001, 0, 0.1])),
    ("a centre that is no number", 2, part(centre=[NAN, 0, 0.1])),
    ("a centre that is true", 2, part(centre=[True, 0, 0.1])),
    ("a centre of 1e308", 1, part(centre=[1e308, 0, 0.1])),
    ("a normal to the other side", 1, part(normal=[0, 0, -1])),
    ("a normal that is tilted by 1e-9", 1, part(normal=[1e-9, 0, 1])),
    ("a normal that is too long", 1, part(normal=[0, 0, 1.000001])),
    ("a normal that is zero", 1, part(normal=[0, 0, 0])),
    ("another target in the certificate", 1, part(target=[[x / 2, y / 2, z] for x, y, z in SQUARE])),
    ("the target in another order", 1, part(target=SQUARE[1:] + SQUARE[:1])),
    ("a target of truths", 2, part(target=[[True, False, True]] * 3)),
    ("a target without corners", 1, dict(certificate=lambda c: c["parts"][0].update(target=[]),
                                         statement=lambda s: s["target"].update(parts=[[]]))),
    ("a target of two corners", 1, dict(target=SQUARE[:2])),
    ("a target whose corner is doubled", 0, dict(target=SQUARE + [SQUARE[-1]], centre=[0.0, 0.0, 0.1])),
    ("a target that crosses itself", 1, dict(target=BOW)),
    ("a target that is not convex", 0, dict(target=ELL, centre=[-0.2, -0.2, 0.1])),
    ("a target with a corner 0.9 mm off its plane", 1, dict(target=[[-2.0, -2.0, 0.1009]] + SQUARE[1:])),
    ("a point from all sides", 0, POINT),
    ("a point that was moved sideways", 1, dict(POINT, shift=(8.0, 0.0), normal=(-1.0, 0.0, 0.0))),
    ("a point that was moved upwards", 0, dict(POINT, shift=(8.0, 0.0))),
    ("a polygon that is seen from all sides", 1, part(cut_height_m=None)),
    ("a point with a front that is seen from all sides", 1, dict(POINT, more_target={"front": [0, 0, 1]})),
    ("a front in the target's plane", 1, dict(more_target={"front": [1, 0, 0]})),
    ("a front on the other side", 1, dict(more_target={"front": [0, 0, -1]})),
    ("a front that is zero", 1, dict(more_target={"front": [0, 0, 0]})),
    ("a front by an order that is a text", 2, dict(more_target={"front_by_order": "no"})),
    ("a front by another order", 1, dict(target=SQUARE[::-1], more_target={"front_by_order": True})),
    ("two parts", 0, two_parts()),
    ("the second part left out", 1, two_parts(lambda p: p.pop())),
    ("the first part twice", 1, two_parts(lambda p: p.__setitem__(1, p[0]))),
    ("a part too many", 1, two_parts(lambda p: p.append(p[0]))),

    # What the volume says of itself.
    ("nothing is said of the volume", 0, dict(said=False)),
    ("the target of another volume", 1, say(lambda s: s["target"].update(parts=[[[9.0, 9.0, 9.0]]]))),
    ("another offset", 1, say(lambda s: s["target"].update(offset_m=1.0))),
    ("an offset that is no number", 2, say(lambda s: s["target"].update(offset_m=NAN))),
    ("the hash of another mesh", 1, say(volume_hash="0" * 64)),
    ("no hash of the volume", 2, say(lambda s: s.pop("volume_hash") and None)),
    ("no hash of the scene", 2, say(lambda s: s.pop("scene_hash") and None)),
    ("no mission", 2, say(lambda s: s.pop("mission_hash") and None)),
    ("another scene", 1, say(scene_hash="0" * 64)),
    ("no range", 1, say(lambda s: s.pop("max_range_m") and None)),
    ("an endless range", 2, say(max_range_m=math.inf)),
    ("a range by negative pixels", 1, say(lambda s: s.pop("max_range_m") and None, sensor={
        "pixel": {"size_m": -1, "kind": "worst"}, "camera": {"half_width": 1, "half_height": 1, "focal_px": -50}})),
    ("a range by pixels", 0, say(lambda s: s.pop("max_range_m") and None, sensor={
        "pixel": {"size_m": 1, "kind": "worst"}, "camera": {"half_width": 1, "half_height": 1, "focal_px": 50}})),
    ("a shorter range by pixels", 1, say(sensor={
        "pixel": {"size_m": 1, "kind": "worst"}, "camera": {"half_width": 1, "half_height": 1, "focal_px": 40}})),
    ("pixels without a camera", 2, say(sensor={"pixel": {"size_m": 1, "kind": "worst"}})),
    ("a sensor that is a list", 2, say(sensor=[])),
    ("lifts that are missing", 2, say(lambda s: s.pop("lift_m") and None)),
    ("a lift too many", 1, say(lift_m=[0, 0])),
    ("a lift that is true", 2, say(lift_m=[False])),
    ("a target and views", 1, say(lambda s: s.update(views=[[s["target"]]]))),
    ("views instead of a target", 0, say(lambda s: s.update(views=[[s.pop("target")]]))),
    ("a view of two targets, one of which is seen", 2, say(lambda s: s.update(views=[[s["target"], s.pop("target")]]))),
    ("no views", 1, say(lambda s: s.pop("target") and s.update(views=[]))),
    ("a view without targets", 2, say(lambda s: s.pop("target") and s.update(views=[[]]))),
    ("a key more", 2, say(sides="both")),
    ("a key more in a target", 2, dict(more_target={"sides": "both"})),
    ("said twice", 2, comment("vantage volume: {}")),
    ("a target said twice", 2, dict(statement=lambda s: json.dumps(s).replace(
        '"target"', '"target": {}, "target"', 1))),
    ("said in two lines", 0, dict(statement=lambda s: json.dumps(s).replace(
        '"lift_m"', '\ncomment vantage volume: "lift_m"'))),
    ("said behind other words", 2, comment("note: vantage volume: {}")),
    ("said with a blank before it", 2, head("comment vantage volume", "comment  vantage volume")),
    ("another place on the earth", 1, comment('vantage georeference: {"latitude_deg":48,"longitude_deg":11}')),
    ("the same place on the earth", 0, dict(comment('vantage georeference: {"latitude_deg":48}'), **head(
        "1.0\n", '1.0\ncomment vantage georeference: {"latitude_deg":48}\n', "scene_ply"))),
    ("the place of the scene alone", 0, head("1.0\n", '1.0\ncomment vantage georeference: {"latitude_deg":48}\n',
                                             "scene_ply")),
    ("two places on the earth", 1, head("1.0\n", '1.0\ncomment vantage georeference: {"latitude_deg":48}\n'
                                        'comment vantage georeference: {"latitude_deg":49}\n', "scene_ply")),

    # What a raised target may leave below.
    ("a lift of 1 cm over a cover at 9 mm", 1, cover(0.009, 0.01)),
    ("a lift of 2 mm for nothing", 1, dict(shift=(0.0, 0.002))),
    ("a lift of a micrometre for nothing", 0, dict(shift=(0.0, 1e-6))),
    ("a lift over its surface", 0, cover(0.0015, 0.001501)),
    ("a higher lift than its surface needs", 1, cover(0.001, 0.0015)),
    ("a lift over more than its surface", 1, cover(0.005, 0.005001, roof=0.0005)),
    ("a lift into what leans over the target", 1, dict(cover(0.0015, 0.001501), scene=joined(
        GROUND, WALL, flat((-3.0, -3.0, 0.1015), (3.0, 3.0)),
        ([(-3.0, -3.0, 0.1001), (3.0, -3.0, 0.1001), (0.0, 3.0, 0.11)], [(0, 1, 2)])))),
    ("a lift in proportion in a world of micrometres", 1, dict(small_world(1e-15), shift=(0.0, 1e-6))),
    ("a lift of 2 m past a plate, and a vertex at 1e14 m that nothing uses", 2, raised_past(
        1.9, 2.0, unused((1e14, 0.0, 0.0)))),
    ("a lift of 2 m past a plate, and a triangle without area at 1e14 m", 2, raised_past(
        1.9, 2.0, folded((1e14, 0.0, 0.0), (1e14, 9.0, 0.0), (1e14, 18.0, 0.0)))),
    ("a lift of 2 m past a plate", 1, raised_past(1.9, 2.0)),
    ("a lift of 2 cm past a plate, and a range of 1e12 m", 1, dict(raised_past(0.01, 0.02), **ranges(1e12))),
    ("a lift of 2 mm past a plate, and a range of 1e12 m", 1, dict(raised_past(0.0019, 0.0025), **ranges(1e12))),
    ("a lift of 6 um for nothing", 1, dict(shift=(0.0, 6e-6))),
    ("a lift of 6 um for nothing, and a vertex at 9e8 m that nothing uses", 1, dict(
        shift=(0.0, 6e-6), scene=joined(TOWN, unused((9e8, 0.0, 0.0))))),
    ("a lift of 6 um for nothing, and a triangle without area at 9e8 m", 1, dict(
        shift=(0.0, 6e-6), scene=joined(TOWN, folded((9e8, 0.0, -9.0), (9e8, 9.0, -9.0), (9e8, 18.0, -9.0))))),
    ("a lift of 6 um for nothing, and a vertex of the volume at 9e8 m that nothing uses", 1, dict(
        shift=(0.0, 6e-6), volume=joined(WEST, unused((9e8, 0.0, 0.0))))),
    ("a lift of 6 um for nothing, and a range of 1e9 m", 0, dict(ranges(1e9), shift=(0.0, 6e-6))),
    ("a lift of 1.99 mm for nothing", 1, dict(shift=(0.0, 1.99e-3))),
    ("a lift of 1.99 mm over vertices that nothing uses", 1, dict(
        shift=(0.0, 1.99e-3), scene=joined(TOWN, unused(*STAIRS)))),
    ("a lift of 1.99 mm over triangles without area", 1, dict(shift=(0.0, 1.99e-3), scene=joined(TOWN, *(
        folded(*[(x, y, z) for x in (50.0, 51.0, 52.0)]) for _, y, z in STAIRS)))),
    ("a lift of 1.99 mm over vertices of the volume that nothing uses", 1, dict(
        shift=(0.0, 1.99e-3), volume=joined(WEST, unused(*STAIRS)))),
    ("vertices that nothing uses in both meshes", 0, dict(
        scene=joined(unused(*STAIRS), TOWN), volume=joined(unused(*STAIRS), WEST))),
    ("a lift of a micrometre in a range of 50 um, of a volume that has a range of 20 m", 1, dict(
        small_world(1e-15), volume=scaled(HIGH, 1e-6), shift=(0.0, 1e-6), **ranges(20.0, 5e-5))),
    ("a negative lift", 1, dict(shift=(0.0, -0.001))),
    ("a lift that is no number", 2, say(lift_m=[NAN])),

    # The header of the PLY.
    ("two meshes in one file", 2, polyglot()),
    ("bytes behind the faces", 2, dict(volume_ply=lambda d: d + b"more")),
    ("bytes that are missing", 2, dict(volume_ply=lambda d: d[:-1])),
    ("a second format", 2, head("1.0\n", "1.0\nformat ascii 1.0\n")),
    ("another format", 2, head("binary_little_endian", "ascii")),
    ("an unknown word", 2, head("1.0\n", "1.0\nfoo bar\n")),
    ("obj_info", 2, head("1.0\n", "1.0\nobj_info vantage\n")),
    ("an empty line", 2, head("1.0\n", "1.0\n\n")),
    ("lines that end as Windows has them", 2, dict(volume_ply=lambda d: d.replace(b"\n", b"\r\n", 14))),
    ("lines that end in a carriage return", 2, comment("a\relement vertex 9")),
    ("a comment with a form feed", 2, comment("a\x0cb")),
    ("a comment with a NUL", 2, comment("a\0b")),
    ("a comment with a next line of Unicode", 2, comment("vantage cause 0 scene a\u0085b")),
    ("a comment with a line separator of Unicode", 2, comment("vantage cause 0 scene a\u2028b")),
    ("a comment with a letter that is not ASCII", 2, comment("Stra\u00dfe")),
    ("a cause with a letter that is not ASCII", 0, comment("vantage cause 0 scene Stra\u00dfe")),
    ("a comment that ends the header", 2, comment("end_header")),
    ("a comment in which the header ends", 2, comment("a end_header b")),
    ("a comment behind an element", 2, head("element face", "comment a\nelement face")),
    ("a count in full-width digits", 2, head("element vertex 8", "element vertex \uff18")),
    ("no-break blanks", 2, head("element vertex 8", "element\u00a0vertex\u00a08")),
    ("two blanks", 2, head("element vertex", "element  vertex")),
    ("a tab", 2, head("element vertex", "element\tvertex")),
    ("a blank at the end of a line", 2, head("property double x\n", "property double x \n")),
    ("a negative count", 2, head("element vertex 8", "element vertex -8")),
    ("a count of 10^18", 2, head("element vertex 8", "element vertex 1000000000000000000")),
    ("a count of 10^9", 2, head("element face 12", "element face 1000000000")),
    ("a count with a plus", 2, head("element vertex 8", "element vertex +8")),
    ("a count with a leading zero", 2, head("element vertex 8", "element vertex 08")),
    ("a count with a fraction", 2, head("element vertex 8", "element vertex 8.0")),
    ("a third element", 2, head("end_header", "element edge 0\nproperty int a\nend_header")),
    ("a second element of vertices", 2, head("element face", "element vertex 0\nproperty double x\nelement face")),
    ("no element of faces", 2, head("element face", "element fac")),
    ("a property twice", 2, head("property double y", "property double x")),
    ("a property that is missing", 2, head("property double y", "property double t")),
    ("a coordinate that is a whole number", 2, head("property double x\n", "property int x\nproperty int a\n")),
    ("an unknown type", 2, head("property double x", "property half x")),
    ("indices that are fractions", 2, head("list uchar int", "list uchar float")),
    ("corners by another name", 2, head("vertex_indices", "vertex_index")),
    ("a second list", 2, head("end_header", "property list uchar int more\nend_header")),
    ("a longer line at the end of the header", 2, head("end_header\n", "end_header \n")),
    ("a negative index", 2, dict(volume_ply=lambda d: d[:-4] + struct.pack("<i", -1))),
    ("an index out of range", 2, dict(volume_ply=lambda d: d[:-4] + struct.pack("<i", 8))),
    ("a face that is no triangle", 2, dict(volume_ply=lambda d: d[:-13] + b"\4" + d[-12:])),
    ("a coordinate that is no number", 2, dict(volume_ply=lambda d: d.replace(
        struct.pack("<3d", -25, -25, 0.2), struct.pack("<3d", NAN, -25, 0.2), 1))),
    ("an object that is a fraction", 2, head("property uint object", "property float object", "scene_ply")),
    ("an object that is negative", 2, dict(scene_ply=lambda d: d.replace(b"uint object", b"int object", 1)[:-4] +
                                           struct.pack("<i", -1))),
    ("an object twice", 2, head("end_header", "property uint object\nend_header", "scene_ply")),
    ("bytes behind the scene", 2, dict(scene_ply=lambda d: d + b"\0")),
    ("a header alone", 2, dict(volume_ply=lambda d: d[:d.index(b"end_header")])),
    ("an empty file", 2, dict(volume_ply=lambda d: b"")),

    # The volume's mesh.
    ("a vertex at 1e18 m that nothing uses", 2, shell_of(unused((1e18, 0.0, 0.0)))),
    ("a vertex at 1e18 m that nothing uses, of the scene", 2, dict(scene=joined(TOWN, unused((1e18, 0.0, 0.0))))),
    ("a vertex at 9e8 m that nothing uses", 0, shell_of(unused((FAR, 0.0, 0.0)))),
    ("a vertex at 9e8 m that nothing uses, of the scene", 0, dict(scene=joined(TOWN, unused((FAR, 0.0, 0.0))))),
    ("a vertex at 9e8 m that nothing uses, and a rounding of a micrometre", 1, dict(
        shell_of(unused((FAR, 0.0, 0.0))), rounding=1e-6)),
    ("a triangle without area at 9e8 m, and a rounding of a micrometre", 1, dict(
        shell_of(([(FAR, 0.0, 0.0)], [(0, 0, 0)])), rounding=1e-6)),
    ("a triangle of two corners at 9e8 m, and a rounding of a micrometre", 1, dict(
        shell_of(([(FAR, 0.0, 0.0), (FAR, 9.0, 0.0)], [(0, 0, 1)])), rounding=1e-6)),
    ("triangles without area at 9e8 m, a range of 1e9 m, and a rounding of a micrometre", 1, dict(
        shell_of(folded((FAR, 0.0, 9.0), (FAR, 9.0, 9.0), (FAR, 18.0, 9.0))), rounding=1e-6, **ranges(1e9))),
    ("a flap out of range", 1, shell_of(([(-500.0, 0.0, 1.0), (-500.0, 1.0, 1.0), (-500.0, 0.0, 2.0)],
                                         [(0, 1, 2), (0, 2, 1)]))),
    ("all of it twice", 0, shell_of(WEST)),
    ("a hollow in it", 0, shell_of(inside_out(block((-20, -20, 1), (-10, 20, 20))))),
    ("a shell behind the wall", 1, shell_of(EAST)),
    ("a shell behind the wall, inside out", 1, shell_of(inside_out(EAST))),
    ("a shell behind the wall and the same inside out", 1, shell_of(EAST, inside_out(EAST))),
    ("a facet turned round", 1, dict(volume=(WEST[0], WEST[1][:-1] + [WEST[1][-1][::-1]]))),
    ("a facet left out of the mesh", 1, dict(volume=(WEST[0], WEST[1][:-1]))),
    ("no facets at all", 1, dict(volume=(WEST[0], []))),
    ("below the target", 1, dict(volume=block((-25, -25, -9), (-5, 25, 25)), scene=WALL)),
    ("another scene", 1, dict(scene_ply=lambda d: ply(joined(TOWN, block((-4, -1, 0), (-3, 1, 9))), (), [0] * 26))),
]
