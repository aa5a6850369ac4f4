#!/usr/bin/env python3
"""Tries the program's tarballs where there is nothing else: in roots of Debian 11, 12 and 13 that hold the C library alone;
no network, no /proc, no /dev. Then that for glibc in Debian 12 and 13 with GDAL and software OpenGL, which it loads; and the
static one in a root that holds it alone, and in one with musl's loader and busybox, as Alpine has them. Those for another
processor are run by the emulator of Debian's qemu-user-static, and not with GDAL and OpenGL.

    check_program.py TARBALL... [--program build/bin/vantage] [--folder build-wheel/program-roots] [--suites bullseye ...]
                     [--bare]

    --program   a vantage that was built otherwise, on this machine: 21 volumes must be its, byte for byte; of the static
                one 18, of meshes
    --bare      without the roots that have GDAL and OpenGL

Exit 0 only when all of it worked. Needs no rights where users may make namespaces.
"""

import argparse
import json
import os
import pathlib
import platform
import shlex
import shutil
import subprocess
import sys
import tarfile
import time

import debian_archive

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent / folder) for folder in ("python/wheel", "tests/hostile")]
import same_bytes  # noqa: E402
import tilesets  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
SUITES = ["bullseye", "bookworm", "trixie"]
MUSL = ["musl", "busybox-static"]
ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}
"""Names of processors in Debian, by those in names of tarballs."""
LOADED = {"bookworm": ["libgdal32"], "trixie": ["libgdal36"]}  # GDAL, by the name that a suite has for it
RASTER = bytes(2 * 1201 * 1201)
"""A tile of SRTM, flat, at sea level."""
OF_MAPS = ("map,", "facade,", "map_clearance,")
"""Volumes of same_bytes.py whose scenes are maps: musl has another sine than glibc, so that coordinates of a map differ in
the last digit."""
COMPARED_IN = "bookworm"
"""The suite whose glibc computes as that of this machine does: hypot is another one in that of Debian 11."""


class Fault(Exception):
    pass


TILES = """scene: {tiles: "http://127.0.0.1:9/tileset.json"}
target: {name: square, vertices: [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]}
sensor: {max_range: 20}
"""


def tour_by_pairs() -> str:
    """A mission of few small targets, far apart: the bound of its tour is the one by pairs, which takes HiGHS."""
    places = ((0, 0), (400, 60), (800, -30), (700, 400), (150, 380))
    targets = [{"name": f"square {x}", "vertices": [[x, y, 0], [x + 4, y, 0], [x + 4, y + 4, 0], [x, y + 4, 0]]} for x, y in places]
    return json.dumps({"scene": {"mesh": "lawn.obj"}, "targets": targets, "sensor": {"max_range": 20},
                       "navigation": {"altitude": [5, 15]},
                       "tour": {"vehicle": {"kind": "multirotor", "speed": 6}, "view": {"dwell": 1}, "gap": 0.05, "time_limit": 100}})


# ---- roots

def packed_meshes() -> dict[str, bytes]:
    """A tetrahedron in glTF, compressed by Draco and by meshoptimizer."""
    return {"draco.glb": tilesets.draco(tilesets.DRACO[1]), "meshopt.glb": tilesets.meshopt()}


class Debian:
    """Packages of a release of Debian, apart from what apt knows for this machine."""

    def __init__(self, suite: str, architecture: str, folder: pathlib.Path):
        self.folder = folder / f"packages-{suite}-{architecture}"
        for name in ("partial", "lists/partial", "archives/partial"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        status = self.folder / "nothing-installed"
        status.touch()
        sources = self.folder / "sources.list"
        sources.write_text("deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] "
                           f"{debian_archive.archives()[0]} {suite} main\n", encoding="utf-8")
        self.options = ["-o", f"APT::Architecture={architecture}", "-o", f"APT::Architectures::={architecture}",
                        "-o", f"Dir::Etc::sourcelist={sources}", "-o", "Dir::Etc::sourceparts=-", "-o", f"Dir::State::lists={self.folder}/lists",
                        "-o", f"Dir::Cache={self.folder}", "-o", f"Dir::State::status={status}",
                        "-o", "APT::Install-Recommends=0", "-o", "Debug::NoLocking=1", "-o", "APT::Sandbox::User=root"]
        self.apt("-q", "-q", "update")

    def apt(self, *arguments: str) -> str:
        command = ["apt-get", *self.options, *arguments]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        if result.returncode:
            raise Fault(f"apt-get {' '.join(arguments)} failed: {result.stderr.strip()[-300:]}")
        return result.stdout

    def unpack(self, packages: list[str], root: pathlib.Path) -> list[str]:
        """Puts these packages and what they need into a root; what that was."""
        told = self.apt("--simulate", "install", *packages)
        names = [line.split()[1] for line in told.splitlines() if line.startswith("Inst ")]
        missing = [name for name in names if not list(self.folder.glob(f"{name}_*.deb"))]
        if missing:
            self.apt("-q", "-q", "download", *missing)
        for name in names:
            file = next(self.folder.glob(f"{name}_*.deb"))
            with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", str(file)], stdout=subprocess.PIPE) as unpacked:
                subprocess.run(["tar", "-x", "-C", str(root), "--keep-directory-symlink", "--no-same-owner", "--exclude=./usr/share/doc/*",
                                "--exclude=./usr/share/locale/*"], stdin=unpacked.stdout, check=True)
        for name in ("blas", "lapack"):  # what the packages' own scripts would link
            for library in root.glob(f"usr/lib/*/{name}/lib*.so.3"):
                (library.parent.parent / library.name).symlink_to(f"{name}/{library.name}")
        return names


def make_root(root: pathlib.Path, tarball: pathlib.Path, debian: Debian | None, packages: list[str]) -> str:
    """A root with these packages and the program at /opt; in words, what is in it."""
    shutil.rmtree(root, ignore_errors=True)
    (root / "trial").mkdir(parents=True)
    names: list[str] = []
    if debian:
        for name in ("bin", "sbin", "lib", "lib64"):
            (root / "usr" / name).mkdir(parents=True)
            (root / name).symlink_to(f"usr/{name}")
        names = debian.unpack(packages, root)
    with tarfile.open(tarball) as archive:
        archive.extractall(root / "opt", filter="data") if hasattr(tarfile, "data_filter") else archive.extractall(root / "opt")
    (next((root / "opt").iterdir())).rename(root / "opt" / "moved")  # its place is not compiled in
    shutil.copytree(root / "opt/moved/share/doc/vantage/examples", root / "trial/examples")
    shutil.copy(PROJECT / "examples/town/tour.yaml", root / "trial/examples/town")
    (root / "trial/N48E011.hgt").write_bytes(RASTER)
    (root / "trial/lawn.obj").write_text("v -99 -99 0\nv 999 -99 0\nv 999 599 0\nv -99 599 0\ng lawn\nf 1 2 3 4\n", encoding="utf-8")
    (root / "trial/far_apart.yaml").write_text(tour_by_pairs(), encoding="utf-8")
    (root / "trial/tiles.yaml").write_text(TILES, encoding="utf-8")
    shutil.copy(PROJECT / "python/wheel/dutch_cube.city.json", root / "trial/cube.city.json")
    for name, file in packed_meshes().items():
        (root / "trial" / name).write_bytes(file)
    return f"{len(names)} packages of Debian" + (f": {' '.join(names)}" if 0 < len(names) < 8 else "")


class Program:
    """The program in a root. `emulator`: what runs it, where it is for another processor."""

    def __init__(self, root: pathlib.Path, emulator: pathlib.Path | None):
        self.root = root
        self.start = ["/opt/moved/bin/vantage"]
        if emulator:
            shutil.copy(emulator, root / "emulator")
            self.start.insert(0, "/emulator")

    def call(self, *arguments: str) -> subprocess.CompletedProcess:
        command = ["unshare", "--user", "--map-root-user", "--net", shutil.which("chroot") or "/usr/sbin/chroot", str(self.root),
                   *self.start, *arguments]
        environment = {"PATH": os.environ["PATH"], "HOME": "/trial"}
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    def run(self, *arguments: str) -> str:
        started = time.perf_counter()
        result = self.call(*arguments)
        if result.returncode:
            raise Fault(f"vantage {' '.join(arguments)}: exit code {result.returncode}: {result.stderr.strip()[-400:]}")
        print(f"  {time.perf_counter() - started:6.2f} s  vantage {' '.join(arguments)}", flush=True)
        return result.stdout

    def refuses(self, named: list[str], *arguments: str) -> None:
        """It must end with exit code 2, and name what it lacks."""
        result = self.call(*arguments)
        if result.returncode != 2 or not all(name in result.stderr for name in named):
            raise Fault(f"vantage {' '.join(arguments)} should say that it lacks {named[0]}: exit code {result.returncode}: "
                        f"{result.stderr.strip()[-400:]}")
        print(f"           vantage {' '.join(arguments)}: refused, it names {', '.join(named)}", flush=True)


def check_everywhere(program: Program, version: str) -> None:
    """What needs nothing of the system."""
    if version not in program.run("--version"):
        raise Fault(f"the program is not version {version}")
    program.run("compute", "/trial/examples/town/mission.yaml", "-o", "/trial/town.ply")
    program.run("prove", "/trial/examples/town/mission.yaml", "/trial/town.ply")
    program.run("verify", "/trial/examples/town/mission.yaml", "/trial/town.ply")
    program.run("compute", "/trial/examples/plaza/mission.yaml", "-o", "/trial/plaza.ply")
    program.run("query", "/trial/examples/plaza/mission.yaml", "/trial/examples/plaza/points.csv")
    program.run("tour", "/trial/examples/town/tour.yaml", "-o", "/trial/tour.plan", "--certificate", "/trial/tour.cert")
    program.run("verify-tour", "/trial/tour.cert")
    told = json.loads(program.run("tour", "/trial/far_apart.yaml", "-o", "/trial/far_apart.csv", "--json"))
    if told["bound"]["kind"] != "pairs":
        raise Fault(f"the bound of a tour is by {told['bound']['kind']} where it should be by pairs (HiGHS)")
    place = json.loads(program.run("inspect", "/trial/cube.city.json", "--json"))["georeference"]
    if abs(place["latitude_deg"] - 52.155217) > 1e-4 or abs(place["longitude_deg"] - 5.387277) > 1e-4:
        raise Fault(f"a scene in the Dutch system lies at {place['latitude_deg']}, {place['longitude_deg']}")
    for name in packed_meshes():
        if json.loads(program.run("inspect", f"/trial/{name}", "--json"))["triangles"] != 4:
            raise Fault(f"{name} has not the four triangles of a tetrahedron")
    program.run("report", "/trial/examples/plaza/mission.yaml", "-o", "/trial/report.html")
    subprocess.run([sys.executable, str(PROJECT / "tools" / "check_tour.py"), str(program.root / "trial/tour.cert")],
                   stdout=subprocess.DEVNULL, check=True)
    man = program.root / "opt/moved/share/man/man1"
    if "vantage-compute.1" not in {file.name for file in man.iterdir()}:
        raise Fault("there is no manual page of compute")


def check_bare(program: Program, static: bool) -> None:
    """What needs libraries of the system: the errors name them, and say of the static program that it can load none."""
    why = ["statically"] if static else []
    program.refuses(["GDAL", *why], "inspect", "/trial/N48E011.hgt")
    program.refuses(["OpenGL", *why], "render", "/trial/examples/plaza/mission.yaml", "-o", "/trial/picture.png")
    program.refuses(["libcurl", *why], "compute", "/trial/tiles.yaml", "-o", "/trial/tiles.ply")


def check_loaded(program: Program) -> None:
    """What loads libraries of the system."""
    program.run("inspect", "/trial/N48E011.hgt")
    program.run("render", "/trial/examples/plaza/mission.yaml", "--volume", "/trial/plaza.ply", "-o", "/trial/picture.png")
    print(f"           the picture: {program.root}/trial/picture.png", flush=True)


def volumes_of(program: pathlib.Path, maps: bool) -> list[list[str]]:
    """Names and hashes of volumes, `maps`: also of those whose scenes are maps."""
    command = [sys.executable, str(PROJECT / "python/wheel/same_bytes.py"), "--program", str(program)]
    table = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[1:]
    rows = [line.split(",")[:2] for line in table if maps or not line.startswith(OF_MAPS)]
    fewest = 20 if maps else 17
    if len(rows) < fewest:
        raise Fault(f"{program} gave {len(rows)} volumes, fewer than {fewest}")
    return rows


def check_bytes(root: pathlib.Path, emulator: pathlib.Path | None, expected: pathlib.Path, folder: pathlib.Path, maps: bool) -> None:
    """The example of a mesh in that root, and others on this machine, have the bytes of another program's."""
    file = folder / "expected-plaza.ply"
    subprocess.run([str(expected), "compute", str(PROJECT / "examples/plaza/mission.yaml"), "-o", str(file), "--quiet"], check=True)
    if file.read_bytes() != (root / "trial/plaza.ply").read_bytes():
        raise Fault(f"plaza: other bytes than {expected}")
    program = root / "opt/moved/bin/vantage"
    if emulator:
        emulated = folder / "emulated-vantage"
        emulated.write_text(f'#!/bin/sh\nexec {shlex.join([str(emulator), "-L", str(root), str(program)])} "$@"\n', encoding="utf-8")
        emulated.chmod(0o755)
        program = emulated
    own, others = volumes_of(program, maps), volumes_of(expected, maps)
    differing = [name for (name, digest), other in zip(own, others, strict=True) if [name, digest] != other]
    if differing:
        raise Fault(f"other bytes than {expected}: {', '.join(differing)}")
    print(f"           {len(own) + 1} volumes: the same bytes as another build", flush=True)


def emulator_for(processor: str) -> pathlib.Path | None:
    """What runs programs for that processor here; None where nothing is needed."""
    if processor == platform.machine():
        return None
    found = shutil.which(f"qemu-{processor}-static")
    if found is None:
        raise Fault(f"there is no qemu-{processor}-static, which runs programs for {processor}: install Debian's qemu-user-static")
    return pathlib.Path(found)


def roots_for(static: bool, bare_alone: bool, arguments: argparse.Namespace) -> list[tuple[str, str | None, list[str]]]:
    """Roots by name, the suite of Debian that their packages are of, and the packages."""
    bare: list[tuple[str, str | None, list[str]]] = [(suite, suite, ["libc6"]) for suite in arguments.suites]
    if static:
        return [("empty", None, []), ("musl", "bookworm", MUSL), *bare]
    loaded = [] if bare_alone else [suite for suite in arguments.suites if suite in LOADED]
    return bare + [(f"{suite}-loaded", suite, [*LOADED[suite], "libegl1", "libgl1-mesa-dri"]) for suite in loaded]


def check(tarball: pathlib.Path, arguments: argparse.Namespace) -> None:
    _, version, _, processor, *_ = tarball.name.removesuffix(".tar.xz").split("-")
    if processor not in ARCHITECTURES:
        raise Fault(f"{tarball} is for no processor that is known: {', '.join(ARCHITECTURES)}")
    emulator = emulator_for(processor)
    folder = arguments.folder
    static = "-static" in tarball.name
    for name, suite, packages in roots_for(static, arguments.bare or emulator is not None, arguments):
        root = folder / name
        debian = Debian(suite, ARCHITECTURES[processor], folder) if suite else None
        print(f"{tarball.name} in {name}, {make_root(root, tarball, debian, packages)}", flush=True)
        program = Program(root, emulator)
        check_everywhere(program, version)
        if name.endswith("-loaded"):
            check_loaded(program)
        else:
            check_bare(program, static)
        if arguments.program and name == ("empty" if static else COMPARED_IN):
            check_bytes(root, emulator, arguments.program, folder, maps=not static)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tarballs", nargs="+", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--folder", type=pathlib.Path, default=PROJECT / "build-wheel" / "program-roots")
    parser.add_argument("--suites", nargs="+", default=SUITES)
    parser.add_argument("--bare", action="store_true")
    arguments = parser.parse_args()
    if arguments.program and COMPARED_IN not in arguments.suites:
        parser.error(f"--program compares in {COMPARED_IN}, which is not among the suites")
    arguments.folder = arguments.folder.resolve()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    try:
        for tarball in arguments.tarballs:
            check(tarball, arguments)
    except (Fault, debian_archive.Failure, OSError, subprocess.CalledProcessError, tarfile.TarError) as error:
        print(f"check failed: {error}", file=sys.stderr)
        return 1
    print(f"{len(arguments.tarballs)} tarballs work")
    return 0


if __name__ == "__main__":
    sys.exit(main())
