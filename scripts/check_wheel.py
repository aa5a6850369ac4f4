"""Uses the installed package in a system that has nothing else: run by check_wheel.sh in a root of its own."""

from __future__ import annotations

import argparse
import fcntl
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.request

import numpy as np

import read_elf
import vantage as vt

HERE = pathlib.Path(__file__).resolve().parent
SQUARE = [[-12, -9, 0], [8, -11, 0], [11, 0, 0], [4, 10, 0], [-13, 8, 0]]
FAR_APART = [(0, 0), (400, 60), (800, -30), (700, 400), (150, 380)]
SET_FLAGS, IS_UP = 0x8914, 1  # netdevice(7): SIOCSIFFLAGS, IFF_UP
STARTED = time.perf_counter()
PYTHON = [sys.executable]  # the command that starts it again


def tell(what: str) -> None:
    print(f"{time.perf_counter() - STARTED:6.2f} s  {what}", flush=True)


def expect(condition: bool, what: str) -> None:
    if not condition:
        raise SystemExit(f"check failed: {what}")
    tell(what)


def program(*arguments: str) -> str:
    result = subprocess.run([*PYTHON, "-m", "vantage", *arguments], capture_output=True, text=True, cwd="/check",
                            check=False)
    expect(result.returncode == 0, f"python -m vantage {' '.join(arguments)}: exit {result.returncode} {result.stderr[-300:]}")
    return result.stdout


def same_as_program(result: vt.Result, name: str, expected: pathlib.Path | None) -> None:
    """The program in the wheel, and one that was built without it, write the same bytes as the package."""
    mission = HERE / f"examples/{name}/mission.yaml"
    result.save(f"/check/{name}.ply")
    program("compute", str(mission), "-o", f"/check/{name}_by_program.ply")
    written = pathlib.Path(f"/check/{name}.ply").read_bytes()
    expect(written == pathlib.Path(f"/check/{name}_by_program.ply").read_bytes(),
           f"{name}: the same {len(written)} bytes from python -m vantage")
    if expected is not None:
        expect(written == (expected / f"{name}.ply").read_bytes(), f"{name}: the same bytes as the program outside of the wheel")


def check_volumes(expected: pathlib.Path) -> None:
    """Twenty volumes, which the program outside of the wheel computed too."""
    result = subprocess.run([*PYTHON, "/check/same_bytes.py", "--expected", str(expected / "volumes.csv"), "--run-by", *PYTHON],
                            capture_output=True, text=True, cwd="/check", check=False)
    pathlib.Path("/check/volumes.csv").write_text(result.stdout)
    expect(result.returncode == 0, result.stderr.strip())


def check_tour() -> None:
    """A tour of few small targets, far apart: its bound is the one by pairs, which takes linear programs (HiGHS)."""
    ground = vt.Scene.from_arrays([[-99, -99, 0], [999, -99, 0], [999, 599, 0], [-99, 599, 0]], [[0, 1, 2], [0, 2, 3]],
                                  objects=[vt.SceneObject("lawn", kind="ground")])
    squares = [[[x, y, 0], [x + 4, y, 0], [x + 4, y + 4, 0], [x, y + 4, 0]] for x, y in FAR_APART]
    mission = vt.Mission.of(ground, squares, max_range=20, navigation=vt.Navigation(altitude=(5, 15)))
    tour = vt.tour(mission, {"view": {"dwell": 1}, "gap": 0.05, "time_limit": 300})
    assert tour.bound is not None
    expect(tour.bound.kind == "pairs" and 0 <= tour.bound.gap <= 0.05 and not tour.left_out,
           f"a tour of {tour.length_m:.1f} m, bound by {tour.bound.kind} {tour.bound.length_m:.1f} m (HiGHS)")


def check_page() -> None:
    """A report, and what `view` serves, where the wheel was built with the page."""
    mission = str(HERE / "examples/plaza/mission.yaml")
    if not (pathlib.Path(vt.__file__).parent / "share/web/index.html").exists():
        tell("no page in this wheel (make web)")
        return
    program("report", mission, "-o", "/check/report.html")
    report = pathlib.Path("/check/report.html").read_text()
    expect("vantageReport" in report and "vantageLive=" not in report, f"a report of {len(report)} bytes")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:  # a root without network has no 127.0.0.1 either
        fcntl.ioctl(any_socket, SET_FLAGS, struct.pack("16sh22x", b"lo", IS_UP))
    server = subprocess.Popen([*PYTHON, "-m", "vantage", "view", mission, "--no-browser"], stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        address = server.stdout.readline().strip()
        with urllib.request.urlopen(address, timeout=300) as answer:
            page = answer.read().decode()
        expect("vantageLive=" in page, f"view serves the page, {len(page)} bytes")
    finally:
        server.send_signal(signal.SIGINT)
    expect(server.wait(timeout=300) == 0, "view ends at Ctrl-C")


def check_binaries() -> None:
    """No library is looked for in a folder of somebody else, and what is compiled in is hardened, all of it."""
    found = []
    count = 0
    for file in sorted(pathlib.Path(vt.__file__).parent.rglob("*")):
        elf = read_elf.read(file) if file.is_file() else None
        if elf is None:
            continue
        count += 1
        faults = read_elf.search_path_faults(elf) + read_elf.hardening_faults(elf, is_fortified=True)
        found += [f"{file.name} {fault}" for fault in faults]
    expect(count > 0 and not found, "; ".join(found) or f"{count} binary: where it looks for libraries, and how it is hardened")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--no-opengl", action="store_true", help="a picture must fail, and say what it lacks")
    parser.add_argument("--picture", help="where to draw one")
    parser.add_argument("--expected", type=pathlib.Path, help="volumes of the examples, from a program built otherwise")
    parser.add_argument("--run-by", help="an emulator that starts this Python")
    arguments = parser.parse_args()
    if arguments.run_by:
        PYTHON.insert(0, arguments.run_by)
    tell(f"import vantage {vt.__version__} from {pathlib.Path(vt.__file__).parent}, numpy {np.__version__}, "
         f"Python {sys.version.split()[0]}")
    check_binaries()
    expect(vt.__version__ in program("--version"), "the program tells the version of the package")
    expect("compute" in program("--help"), "the program tells its commands")

    yard = vt.Scene.from_arrays([[-60, -60, 0], [60, -60, 0], [60, 60, 0], [-60, 60, 0]], [[0, 1, 2], [0, 2, 3]])
    above = vt.compute(yard, SQUARE, max_range=50)
    expect(above.volume_m3 > 1000, f"a scene from arrays: {above.volume_m3:.3f} m3")

    scene = vt.Scene.from_mesh(HERE / "examples/plaza/plaza.obj")
    result = vt.compute(scene, SQUARE, max_range=70, navigation=vt.Navigation(altitude=(3, 50)))
    expect(result.volume_m3 > 1000, f"plaza: {result.volume_m3:.3f} m3, {len(result.faces)} facets, hash {result.volume.hash}")
    expect(result.prove()["verdict"] == "proved", "plaza: proved (exact arithmetic)")
    expect(result.verify(points=2000)["over_claimed"] == 0, "plaza: no over-claim among 2000 points (Embree)")
    same_as_program(vt.Mission.read(HERE / "examples/plaza/mission.yaml").run(), "plaza", arguments.expected)

    town = vt.Mission.read(HERE / "examples/town/mission.yaml").run()
    expect(town.volume_m3 > 1000, f"town: an OpenStreetMap scene of {len(town.scene.faces)} triangles, {town.volume_m3:.3f} m3, "
           f"hash {town.volume.hash}")
    expect(town.scene.georeference is not None, f"town: {town.scene.crs}")
    same_as_program(town, "town", arguments.expected)

    if arguments.expected:
        check_volumes(arguments.expected)
    check_tour()
    check_page()
    for name in ("draco", "meshopt"):
        packed = vt.Scene.from_mesh(HERE / f"{name}.glb")
        expect(len(packed.faces) == 4, f"glTF compressed by {name}")
    cube = vt.Scene.from_bytes((HERE / "dutch_cube.city.json").read_bytes(), "json")
    place = cube.georeference
    assert place is not None
    expect(abs(place.latitude_deg - 52.155172897) < 1e-4 and abs(place.longitude_deg - 5.387203657) < 1e-4,
           f"CityJSON in {place.source_crs}: {place.latitude_deg:.6f}, {place.longitude_deg:.6f} (PROJ and proj.db)")

    sphere = vt.visibility_sphere(scene, (0, 0, 20), 60, cubemap=64, device="cpu")
    expect(sphere.volume_m3 > 1000, f"visibility sphere on the CPU: {sphere.volume_m3:.1f} m3 (Embree, Manifold)")
    heights = pathlib.Path("/check/heights.asc")
    heights.write_text("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 4\n")
    try:
        vt.Scene.from_raster(heights)
    except vt.Error as error:
        expect(error.code == "library-missing", f"a raster without GDAL: {error.code}: {error.fix}")
    else:
        raise SystemExit("check failed: a raster was read without GDAL")

    if arguments.no_opengl:
        try:
            result.picture()
        except vt.Error as error:
            expect(error.code == "device-missing", f"a picture without OpenGL: {error.code}: {error.fix}")
        else:
            raise SystemExit("check failed: a picture was drawn without OpenGL")
    if arguments.picture:
        picture = result.picture(arguments.picture, title="Plaza \u00e9\u00df\u0142", size=(1200, 900))
        expect(picture.shape == (900, 1200, 4) and len(np.unique(picture.reshape(-1, 4), axis=0)) > 500,
               f"a picture of {pathlib.Path(arguments.picture).stat().st_size} bytes, with text")
    print("all of it works")
    return 0


if __name__ == "__main__":
    sys.exit(main())
