"""Computes twenty volumes of the examples, and writes a table of their SHA-256, to compare programs and wheels with:

    python3 python/wheel/same_bytes.py --program build/bin/vantage > native.csv
    python3 python/wheel/same_bytes.py --expected native.csv          # of the package that this Python imports
    python3 python/wheel/same_bytes.py --expected native.csv --engine # of one without the program: missions that it lacks
                                                                      # parts for are left out, and told

The missions are those of examples/plaza and examples/town with one limit after the other. With --expected the exit code
is 1 where a hash differs, and the rows that do are told on standard error.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = next(folder / "examples" for folder in (HERE, *HERE.parents) if (folder / "examples").is_dir())
SQUARE = "{name: square, vertices: [[-12, -9, 0], [8, -11, 0], [11, 0, 0], [4, 10, 0], [-13, 8, 0]]}"
WALL = "{name: wall, vertices: [[-5, 3, 2], [5, 3, 2], [5, 3, 9], [-5, 3, 9]], sides: both}"
CAMERA = "camera: {width: 4000, height: 3000, sensor_width: 17.3, focal_length: 12}"

PLAZA = {
    "open": (SQUARE, "{max_range: 70}", "{}"),
    "coarse": (SQUARE, "{max_range: 70}", "{altitude: [3, 50]}"),
    "altitude": (SQUARE, "{max_range: 70}", "{altitude: {agl: [5, 40]}, ground: 0}"),
    "min_range": (SQUARE, "{max_range: 80, min_range: 20}", "{altitude: [3, 60]}"),
    "incidence": (SQUARE, "{max_range: 70, incidence: 50}", "{altitude: [3, 60]}"),
    "frame": (SQUARE, f"{{max_range: 70, {CAMERA}}}", "{altitude: [3, 60]}"),
    "mount": (SQUARE, "{max_range: 70, fov: [80, 60], mount: {yaw: any, pitch: -60}}", "{altitude: [3, 60]}"),
    "gimbal": (SQUARE, "{max_range: 70, fov: [80, 60], gimbal: {pitch: [-90, -30]}}", "{altitude: [3, 60]}"),
    "pixel": (SQUARE, f"{{pixel: {{size: 0.02}}, {CAMERA}}}", "{altitude: [3, 60]}"),
    "dori": (SQUARE, f"{{dori: observation, {CAMERA}}}", "{altitude: [3, 60]}"),
    "sun": (SQUARE, "{max_range: 70, sun: {exclude: 30, azimuth: 200, elevation: 40}}", "{altitude: [3, 60]}"),
    "clearance": (SQUARE, "{max_range: 60}", "{altitude: [3, 40], clearance: 2}"),
    "zones": (SQUARE, "{max_range: 70}", "{keep_in: [{polygon: [[-60, -60], [60, -50], [50, 60], [-55, 40]], z: [3, 60]}], "
              "keep_out: [{min: [18, -10, 0], max: [35, 7, 43]}]}"),
    "share": (SQUARE, "{max_range: 70, visible: 0.7, cells: 8}", "{altitude: [3, 60]}"),
    "link": ("{name: mast, point: [-12, 8, 12]}", "{max_range: 80, link: {frequency: 2.4}}", "{altitude: [3, 60]}"),
    "pilot": ("{name: pilot, point: [-12, -9, 1.7]}", "{vlos: {aircraft_size: 0.35, kind: multirotor, visibility: 5000}}",
              "{altitude: [3, 60], keep_in: [{min: [-70, -70, 0], max: [70, 70, 60]}]}"),
    "both_sides": (WALL, "{max_range: 50}", "{altitude: [1, 40]}"),
}
TOWN = {
    "map": ("{name: square, osm: way/1}", "{max_range: 90}", "{altitude: [3, 60]}"),
    "facade": ("{name: back, osm: Town Hall, part: facade, nearest: [-2, 36, 8]}", "{max_range: 50}", "{altitude: {agl: [5, 60]}}"),
    "map_clearance": ("{name: square, osm: way/1}", "{max_range: 70, incidence: 70}", "{altitude: {agl: [5, 60]}, clearance: 3}"),
}


def missions() -> dict[str, str]:
    folder = EXAMPLES.as_posix()
    plaza = f"scene: {{mesh: {folder}/plaza/plaza.obj}}\n"
    town = (f"scene: {{osm: {folder}/town/town.osm, center: [48.0, 11.0], radius: 120, defaults: {{level: 3.2}}, "
            "without: [walls]}\n")
    found = {}
    for scene, named in ((plaza, PLAZA), (town, TOWN)):
        for name, (target, sensor, navigation) in named.items():
            exact = "exact: {tolerance: 0.1}\n" if name == "coarse" else ""
            found[name] = f"{scene}target: {target}\nsensor: {sensor}\nnavigation: {navigation}\n{exact}"
    return found


def run_program(program: list[str], text: str, volume: pathlib.Path) -> str:
    """Empty, or what went wrong."""
    done = subprocess.run([*program, "compute", "-", "-o", str(volume), "--quiet"], input=text, capture_output=True, text=True,
                          check=False)
    return "" if done.returncode == 0 and volume.exists() else f"exit code {done.returncode}: {done.stderr.strip()}"


def run_package(text: str, volume: pathlib.Path) -> bool:
    """Whether the package that is imported has what the mission needs."""
    import vantage as vt

    mission = volume.with_name("mission.yaml")
    mission.write_text(text, encoding="utf-8")
    try:
        vt.Mission.read(mission).run().save(volume)
    except vt.InputError as error:
        if error.code != "component-missing":
            raise
        return False
    return True


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", help="the program; else `python -m vantage` of this Python")
    parser.add_argument("--run-by", nargs="+", default=[sys.executable], help="the command that starts Python")
    parser.add_argument("--engine", action="store_true", help="the package without its program, in this process")
    parser.add_argument("--expected", type=pathlib.Path, help="a table that this one must be the same as")
    arguments = parser.parse_args()
    program = [arguments.program] if arguments.program else [*arguments.run_by, "-m", "vantage"]
    rows, lacking = [], []
    with tempfile.TemporaryDirectory() as folder:
        for name, text in missions().items():
            volume = pathlib.Path(folder) / "volume.ply"
            volume.unlink(missing_ok=True)
            started = time.perf_counter()
            if arguments.engine and not run_package(text, volume):
                lacking.append(name)
                continue
            problem = "" if arguments.engine else run_program(program, text, volume)
            seconds = time.perf_counter() - started
            if problem:
                print(f"{name}: {problem}", file=sys.stderr)
                return 2
            data = volume.read_bytes()
            rows.append((name, hashlib.sha256(data).hexdigest(), len(data), round(seconds, 2)))
    writer = csv.writer(sys.stdout)
    writer.writerow(("mission", "sha256", "bytes", "seconds"))
    writer.writerows(rows)
    if lacking:
        print(f"left out, since the package lacks what they need: {', '.join(lacking)}", file=sys.stderr)
    if not arguments.expected:
        return 0
    with arguments.expected.open(newline="") as file:
        expected = {row["mission"]: row["sha256"] for row in csv.DictReader(file)}
    differing = [name for name, digest, _, _ in rows if expected.get(name) != digest]
    for name in differing:
        print(f"{name}: not the bytes of {arguments.expected}", file=sys.stderr)
    print(f"{len(rows) - len(differing)} of {len(rows)} volumes have the same bytes", file=sys.stderr)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
