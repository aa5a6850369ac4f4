"""Random changes of certificates, volumes and scenes."""

import copy
import json
import math
import pathlib
import struct
import tempfile

import check_certificate as checker

NAN, MINUS_INFINITY = float("nan"), float("-inf")

def statement_in(data):
    lines = [line[24:] for line in data.split(b"\n") if line.startswith(b"comment vantage volume: ")]
    return json.loads(b"".join(lines)) if lines else None


HOSTILE = [0, -0.0, 1, -1, 1e-300, 5e-324, 1e300, -1e300, NAN, math.inf, MINUS_INFINITY, 2**63, 10**30, True, False,
           None, "", "0", "\u0661", "-1", " 1", "1_0", [], {}, [[]], [0, 0, 0], [0.0, 0.0, 1.0], "(-1,0,0)",
           "(0,0,0,-1)", "<", ">", ".", "z" * 50]


def places_in(value, found=None, way=()):
    """Of everything in a JSON value: the keys that lead there."""
    found = [] if found is None else found
    keys = value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    for key in keys:
        found.append(way + (key,))
        places_in(value[key], found, way + (key,))
    return found


def mutant_of_json(value, numbers):
    value = copy.deepcopy(value)
    for _ in range(numbers.choice([1, 1, 1, 2, 4])):
        places = places_in(value)
        if not places:
            break
        way = numbers.choice(places)
        holder = value
        for key in way[:-1]:
            holder = holder[key]
        old, kind = holder[way[-1]], numbers.randrange(6)
        if kind == 0:
            del holder[way[-1]]
        elif kind == 1 and isinstance(holder, list):
            holder.insert(numbers.randrange(len(holder) + 1), copy.deepcopy(numbers.choice(holder)))
        elif kind == 1:
            holder["more"] = old
        elif kind == 2 and isinstance(old, (int, float)):
            factor, more = numbers.choice([1 + 1e-15, 1 + 1e-9, 1.001, 2, -1, 1e9]), numbers.choice([0, 0, 1e-9, 1e-3])
            holder[way[-1]] = old * factor + more
        elif kind == 3:
            holder[way[-1]] = copy.deepcopy(numbers.choice(HOSTILE))
        elif kind == 4:
            other = value
            for key in numbers.choice(places)[:-1]:
                other = other[key]
            holder[way[-1]] = copy.deepcopy(numbers.choice(list(other.values()) if isinstance(other, dict) else other))
        elif isinstance(old, str) and old:
            at = numbers.randrange(len(old))
            holder[way[-1]] = old[:at] + numbers.choice(["", *"0-(),<.a "]) + old[at + 1:]
    return value


def mutant_of_bytes(data, numbers, end=None):
    """Changes before `end`."""
    data, end = bytearray(data), end or len(data)
    for _ in range(numbers.choice([1, 1, 2, 10])):
        at, kind = numbers.randrange(min(end, len(data) - 1)), numbers.randrange(5)
        if kind == 0:
            data[at] = numbers.randrange(256)
        elif kind == 1:
            del data[at:at + numbers.randrange(1, 20)]
        elif kind == 2:
            data[at:at] = data[numbers.randrange(len(data)):][:numbers.randrange(1, 20)]
        elif kind == 3:
            data[at] ^= 1 << numbers.randrange(8)
        else:
            data[at] = ord(numbers.choice("0123456789-[]{},.\"enul \n\r\t"))
        if len(data) < 2:
            break
    return bytes(data)


def mutant_of_lines(data, numbers):
    """Of a header: lines left out, doubled, exchanged, or with another word."""
    end = data.index(b"end_header\n") + 11
    lines = data[:end].split(b"\n")[:-1]
    for _ in range(numbers.choice([1, 1, 2])):
        at, kind = numbers.randrange(len(lines)), numbers.randrange(5)
        if kind == 0 and len(lines) > 1:
            del lines[at]
        elif kind == 1:
            lines.insert(numbers.randrange(len(lines)), lines[at])
        elif kind == 2:
            other = numbers.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        elif kind == 3:
            lines.insert(at, numbers.choice([b"comment a", b"comment end_header", b"end_header", b"element vertex 3",
                                             b"property uchar red", b"property list uchar int more",
                                             b"format ascii 1.0", b"comment vantage volume: {}",
                                             b"comment vantage rounding_m 1"]))
        else:
            some = lines[at].split(b" ")
            some[numbers.randrange(len(some))] = numbers.choice([
                b"", b"8", b"0", b"12", b"float", b"uchar", b"double", b"int", b"x", b"face", b"-1", b"9" * 12, b"1e3"])
            lines[at] = b" ".join(some)
    return b"\n".join(lines) + b"\n" + data[end:]


def mutant_of_rows(data, numbers):
    """Of a mesh: a number of a vertex, or a corner of a face."""
    begin, data = data.index(b"end_header\n") + 11, bytearray(data)
    vertices = int(data.split(b"element vertex ", 1)[1].split(b"\n", 1)[0])
    for _ in range(numbers.choice([1, 1, 3])):
        if numbers.random() < 0.7:
            at = begin + 8 * numbers.randrange(3 * vertices)
            old = struct.unpack_from("<d", data, at)[0]
            new = numbers.choice([old + 1e-9, old * 1.1, -old, old + numbers.uniform(-5, 5),
                                  numbers.choice(HOSTILE[:11])])
            struct.pack_into("<d", data, at, float(new))
        else:
            row = numbers.randrange((len(data) - begin - 24 * vertices) // 13)
            at = begin + 24 * vertices + 13 * row + 1 + 4 * numbers.randrange(3)
            if at + 4 <= len(data):
                struct.pack_into("<i", data, at, numbers.choice([-1, 0, 1, vertices - 1, vertices, 2**31 - 1]))
    return bytes(data)


def mutant_of_vertices(data, numbers):
    """Of a mesh: vertices that no triangle has behind the others."""
    end = data.index(b"end_header\n") + 11
    count = int(data.split(b"element vertex ", 1)[1].split(b"\n", 1)[0])
    far = numbers.choice([0.0, 1.0, 1e3, 9e8, 1e14, 1e300])
    more = numbers.choice([[(far, 0.0, 0.0)], [(far, far, 0.1 + 9e-7 * i) for i in range(3000)]])
    rows = data[end:end + 24 * count] + b"".join(struct.pack("<3d", *p) for p in more) + data[end + 24 * count:]
    return data[:end].replace(b"element vertex %d\n" % count, b"element vertex %d\n" % (count + len(more))) + rows


def with_its_hash(content, of):
    """As somebody does who mends what names the mesh."""
    with tempfile.TemporaryDirectory() as scratch:
        place = pathlib.Path(scratch) / "m.ply"
        place.write_bytes(content[of])
        try:
            new = checker.Mesh(place).hash(b"volume" if of == "volume.ply" else b"scene").encode()
        except checker.Unreadable:
            return content
    old = json.loads(content["volume.cert"])["volume" if of == "volume.ply" else "scene"]["hash"].encode()
    return {name: data.replace(old, new) for name, data in content.items()}


def mutant(content, of, numbers):
    content = dict(content)
    if of == "volume.cert":
        kind = numbers.randrange(3)
        if kind == 0:
            content[of] = mutant_of_bytes(content[of], numbers)
        elif kind == 1:
            content[of] = json.dumps(mutant_of_json(json.loads(content[of]), numbers)).encode()
        else:  # what the volume says is changed alike
            claims = mutant_of_json(json.loads(content[of]), numbers)
            said = mutant_of_json(statement_in(content["volume.ply"]), numbers)
            start = b"comment vantage volume: "
            lines = [start + json.dumps(said).encode() if line.startswith(start) else line
                     for line in content["volume.ply"].split(b"\n")]
            content.update({of: json.dumps(claims).encode(), "volume.ply": b"\n".join(lines)})
        return content
    change = numbers.choice([mutant_of_lines, mutant_of_rows, mutant_of_bytes, mutant_of_vertices,
                             lambda d, n: mutant_of_bytes(d, n, d.index(b"end_header"))])
    content[of] = change(content[of], numbers)
    return with_its_hash(content, of) if numbers.random() < 0.6 else content
