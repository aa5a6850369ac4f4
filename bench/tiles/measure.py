#!/usr/bin/env python3
"""What bench/results has of 3D Tiles: tilesets as they are read, volumes in them and their proofs, heights of buildings.

    measure.py PROGRAM DATA     # DATA: the folder with plateau, wageningen and samples

Prints tables. Exit code 1 where a volume is not proved, the checker refuses a certificate, or rays tell otherwise.
"""

import json
import os
import pathlib
import resource
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from typing import Any, NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PLATEAU = "plateau/tileset.json"
WAGENINGEN = "wageningen/tileset.json"
SAMPLES = "samples/"


class Volume(NamedTuple):
    """A mission in a tileset. `scene`: its keys beside `tiles`."""

    name: str
    tileset: str
    scene: str
    target: str
    range_m: float


VOLUMES = [
    Volume("Tokyo, a roof", PLATEAU, "center: [35.6670, 139.7560], radius: 400",
           "{object: bldg_67c87b65-70c1-4a9f-acd7-c02273828106, part: roof}", 150),
    Volume("Tokyo, 6 m of ground", PLATEAU, "center: [35.6670, 139.7560], radius: 400, ground: 40",
           "{center: [35.6670, 139.7560], width: 6, length: 6}", 150),
    Volume("Wageningen, a roof's plane", WAGENINGEN, "", "{object: NL.IMBAG.Pand.0289100000001034, part: roof, nearest: [0, 0, 200]}",
           200),
    Volume("discrete levels", SAMPLES + "1.0/TilesetWithDiscreteLOD", "",
           "{vertices: [[-100, -250, 0], [100, -250, 0], [100, -200, 0], [-100, -200, 0]]}", 1500),
    Volume("request volume, a roof", SAMPLES + "1.0/TilesetWithRequestVolume", "",
           "{object: \"city/ll.b3dm#4\", part: roof}", 120),
    Volume("trees, 10 m of ground", SAMPLES + "1.0/TilesetWithTreeBillboards", "ground: -0.2",
           "{vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]}", 80),
    Volume("houses, 2 m between them", SAMPLES + "1.1/MetadataGranularities", "",
           "{vertices: [[-1, -1, 0.1], [1, -1, 0.1], [1, 1, 0.1], [-1, 1, 0.1]]}", 40),
    Volume("multiple contents", SAMPLES + "1.1/MultipleContents", "",
           "{vertices: [[0.3, -0.7, 0.2], [0.7, -0.7, 0.2], [0.7, -0.3, 0.2], [0.3, -0.3, 0.2]]}", 5),
    Volume("implicit octree", SAMPLES + "1.1/SparseImplicitOctree", "",
           "{vertices: [[0.7, 0.05, 0.5], [0.8, 0.05, 0.5], [0.8, 0.15, 0.5], [0.7, 0.15, 0.5]]}", 5),
    Volume("implicit quadtree, from below", SAMPLES + "1.1/SparseImplicitQuadtree", "",
           "{vertices: [[0.4, 0.4, 0.5], [0.6, 0.4, 0.5], [0.6, 0.6, 0.5], [0.4, 0.6, 0.5]], front: [0, 0, -1]}", 5),
    Volume("under a box", SAMPLES + "1.1/BoundingBoxTests/0_0_2-1_1_4", "",
           "{vertices: [[0.3, 0.3, 0], [0.7, 0.3, 0], [0.7, 0.7, 0], [0.3, 0.7, 0]]}", 10),
]


class Run(NamedTuple):
    code: int
    seconds: float
    processor_s: float
    megabytes: float
    out: str
    err: str


def run(*command: object) -> Run:
    began = time.monotonic()
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process = subprocess.Popen([str(word) for word in command], stdout=out, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - began
        out.seek(0)
        err.seek(0)
        return Run(process.returncode, seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, out.read(), err.read())


def row(*cells: object) -> None:
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def table(*heads: str) -> None:
    row(*heads)
    row(*["---"] * len(heads))


def extent(bounds: dict[str, list[float]]) -> str:
    return " x ".join(f"{high - low:,.4g}" for low, high in zip(bounds["min"], bounds["max"]))


def inspect(program: str, data: pathlib.Path) -> None:
    table("tileset", "triangles", "objects", "files of surfaces", "missing", "extent, m", "largest error used, m", "s",
          "s of the processor", "MB")
    refused = []
    for file in sorted(data.rglob("tileset.json")):
        name = str(file.parent.relative_to(data))
        found = run(program, "inspect", file, "--json")
        if found.code != 0:
            refused.append((name, found.err.splitlines()[0].removeprefix("vantage: ")))
            continue
        told = json.loads(found.out)
        tiles = told["tileset"]
        row(name, f"{told['triangles']:,}", f"{told['objects']:,}", tiles["contents"], tiles["holes"], extent(told["bounds"]),
            f"{tiles['largest_error_m']:g}", f"{found.seconds:.2f}", f"{found.processor_s:.2f}", f"{found.megabytes:.0f}")
    for name, why in refused:
        print(f"\nNot read: {name}: {why}.")


def volumes(program: str, data: pathlib.Path, folder: pathlib.Path) -> int:
    table("volume", "range, m", "facets", "m³", "compute, s", "prove, s", "verdict", "certificate", "rays: over-claimed of")
    bad = 0
    for number, one in enumerate(VOLUMES):
        tileset = data / one.tileset
        file = tileset if tileset.name == "tileset.json" else tileset / "tileset.json"
        mission, ply, cert = (folder / f"{number}.{end}" for end in ("yaml", "ply", "cert"))
        keys = ", ".join(filter(None, [f"tiles: {json.dumps(str(file))}", one.scene]))
        mission.write_text(f"scene: {{{keys}}}\ntarget: {one.target}\nsensor: {{max_range: {one.range_m}}}\n", encoding="utf-8")
        computed = run(program, "compute", mission, "-q", "-o", ply)
        if computed.code != 0:
            sys.exit(f"{one.name}: {computed.err}")
        report = json.loads((folder / f"{number}.report.json").read_text(encoding="utf-8"))
        proved = run(program, "prove", mission, ply, "-q", "--json", "--certificate", cert)
        proof = json.loads(proved.out)
        checked = run(sys.executable, ROOT / "tools" / "check_certificate.py", cert) if cert.exists() else None
        verified = run(program, "verify", mission, ply, "--json", "-q")
        rays = json.loads(verified.out)
        verdict = "proved" if proved.code == 0 else "not proved" if proved.code == 4 else "wrong"
        accepted = "none" if checked is None else "accepted" if checked.code == 0 else "refused"
        over = find(rays, "over_claimed")
        row(one.name, f"{one.range_m:g}", f"{find(report, 'facets'):,}", f"{find(report, 'volume_m3'):,.5g}",
            f"{computed.seconds:.2f}", f"{proved.seconds:.2f}", verdict, accepted, f"{over} of {find(rays, 'points'):,}")
        bad += proved.code != 0 or accepted != "accepted" or verified.code != 0
        if proved.code != 0:
            print(json.dumps(proof)[:400], file=sys.stderr)
    return bad


def find(value: Any, key: str) -> Any:
    """The first value of that key, at any depth."""
    if isinstance(value, dict):
        if key in value:
            return value[key]
        value = list(value.values())
    for one in value if isinstance(value, list) else []:
        found = find(one, key)
        if found is not None:
            return found
    return None


def measured_heights(folder: pathlib.Path) -> dict[str, float]:
    """By gml_id, of the batch tables of all b3dm files there; where several have it, the last."""
    heights = {}
    for file in sorted(folder.glob("*.b3dm")):
        data = file.read_bytes()
        features, feature_bytes, size, _ = struct.unpack_from("<4I", data, 12)
        begin = 28 + features + feature_bytes
        batch = json.loads(data[begin:begin + size])
        column = batch["bldg:measuredHeight"]
        if isinstance(column, dict):
            column = struct.unpack_from(f"<{len(batch['gml_id'])}d", data, begin + size + column["byteOffset"])
        heights.update({name: height for name, height in zip(batch["gml_id"], column) if height and height > 0})
    return heights


def heights(program: str, data: pathlib.Path) -> None:
    told = json.loads(run(program, "inspect", data / PLATEAU, "--objects", "", "--json").out)
    objects = sorted((one["source_id"], one["height_m"]) for one in told["objects"])
    measured = measured_heights(data / "plateau" / "data")
    known = [(name, height, measured[name]) for name, height in objects if name in measured]
    chosen = known[::len(known) // 50][:50]
    off = sorted(abs(height - own) for _, height, own in chosen)
    print(f"{len(objects)} buildings, {len(known)} with a measured height; of {len(chosen)} of them, each "
          f"{len(known) // 50}th by id: median difference {statistics.median(off):.2f} m, worst {off[-1]:.2f} m, "
          f"{sum(value < 1 for value in off)} within 1 m.")
    for name, height, own in sorted(chosen, key=lambda one: -abs(one[1] - one[2]))[:3]:
        print(f"- {name}: {height:.2f} m in the tiles, {own:.2f} m measured")
    everywhere = [abs(height - own) for _, height, own in known]
    print(f"All {len(known)}: median {statistics.median(everywhere):.2f} m, worst {max(everywhere):.2f} m.")


def buildings(program: str, data: pathlib.Path) -> None:
    told = json.loads(run(program, "inspect", data / WAGENINGEN, "--objects", "", "--json").out)
    ids = [one["source_id"] for one in told["objects"]]
    pand = sum(one.startswith("NL.IMBAG.Pand.") for one in ids)
    print(f"{len(ids)} objects, {len(set(ids))} ids, {pand} of the form NL.IMBAG.Pand.*.")


def main() -> int:
    program, data = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    print("## As they are read\n")
    inspect(program, data)
    print("\n## Volumes\n")
    with tempfile.TemporaryDirectory() as scratch:
        bad = volumes(program, data, pathlib.Path(scratch))
    print("\n## Heights of Tokyo's buildings\n")
    heights(program, data)
    print("\n## Buildings of Wageningen\n")
    buildings(program, data)
    print(f"\nlargest of all runs: {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f} MB", file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
