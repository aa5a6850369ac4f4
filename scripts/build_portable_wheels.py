#!/usr/bin/env python3
"""Builds wheels that run on old Linux systems and on other processors, into dist/, with the compiler of zig: for each
system one for CPython 3.11 and one for all from CPython 3.12 on (the stable ABI).

    build_portable_wheels.py [--targets x86_64-linux-gnu.2.17] [--pythons cp311 abi3] [--jobs N]

What is in them: wheel_libraries.toml, and the page, where `make web` has built it. The name of a wheel says which glibc it
needs: the newest version that one of the functions has which it takes from glibc. It may not be newer than that of the
target. auditwheel must say the same. --targets aarch64-linux-gnu.2.17 makes those for aarch64.
"""

import argparse
import base64
import csv
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile

import python_for_windows
import read_elf
import wheel_targets
from build_wheel_libraries import Failure, run, unlink_older, zig_tools
from debian_archive import fetch, unpack

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
DEPS = PROJECT / ".deps"
TARGETS = ["x86_64-linux-gnu.2.17"]
TAGS = {"cp311": "cp311-cp311", "abi3": "cp312-abi3"}
FIXED_TIME = (2020, 1, 1, 0, 0, 0)  # of all files: the same wheel from the same sources


def python_headers(python: str, processor: str, folder: pathlib.Path, libraries: dict) -> list[pathlib.Path]:
    """The folders of the headers of a Python, from Debian's package for that processor."""
    package = libraries["python"][python]
    file = fetch(package[processor], package[f"{processor}_sha256"], folder / "downloads")
    include = unpack(file, folder / "python" / file.stem, "./usr/include") / "usr" / "include"
    return [next(include.glob("python3.*")), include]


def make_tools(deps: pathlib.Path) -> pathlib.Path:
    """An environment with what makes wheels."""
    lock = PROJECT / "python" / "wheel-requirements.lock"
    folder = deps / "wheel-tools"
    stamp = folder / f"{hashlib.sha256(lock.read_bytes()).hexdigest()[:16]}.stamp"
    if not stamp.exists():
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        subprocess.run([str(folder / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
                        "--require-hashes", "--no-deps", "--only-binary=:all:", "--requirement", str(lock)], check=True)
        stamp.touch()
    return folder / "bin" / "python"


def build_module(target: str, python: str, folder: pathlib.Path, build: pathlib.Path, tools: pathlib.Path, jobs: int,
                 libraries: dict) -> pathlib.Path:
    """Compiles vantage, and puts what belongs into the wheel into a folder."""
    zig = zig_tools(target, folder / "prefix")
    portable = libraries["portable"]
    flags = f"{portable['vantage']} {portable[zig.processor]} -ffile-prefix-map={PROJECT}=."
    chosen = wheel_targets.settings(target)
    options = portable["vantage_options"]
    if chosen:
        options = [*options, f"-DVANTAGE_COMPONENTS={chosen['components']}",
                   f"-DVANTAGE_PROJ_INCLUDE_DIRS={folder / 'prefix' / 'include'}", *chosen["vantage_options"]]
    if chosen and chosen["system"] == "Windows":
        include, library = python_for_windows.prepare(libraries["python"][python], folder / "downloads", folder / "python",
                                                      DEPS / "zig" / "python" / "ziglang" / "zig")
        headers = [include]
        options = [*options, f"-DVANTAGE_PYTHON_LIBRARY={library}"]
    else:
        headers = python_headers(python, zig.processor, folder, libraries)
    if chosen and chosen["system"] == "Darwin":
        headers = [wheel_targets.headers_of_macos(headers, folder / "python")]
    soabi = "abi3" if python == "abi3" else f"cpython-311-{zig.processor}-linux-gnu"
    log = build / "log"
    out = build / python
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    run([str(tools), "-c", "import sys; from scikit_build_core.build import prepare_metadata_for_build_wheel as prepare; "
         "prepare(sys.argv[1])", str(out)], PROJECT, log)
    info = next(out.glob("*.dist-info"))
    cache = build / "cmake" / "CMakeCache.txt"
    if cache.exists() and any(done.stat().st_mtime > cache.stat().st_mtime for done in (folder / "done").iterdir()):
        cache.unlink()  # what CMake remembers of libraries holds until they are built anew
    environment = {"PKG_CONFIG_LIBDIR": str(folder / "prefix" / "lib" / "pkgconfig")}
    run(["cmake", "-S", str(PROJECT), "-B", str(build / "cmake"), "-G", "Ninja", *zig.for_cmake,
         "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DCMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG",
         f"-DCMAKE_C_FLAGS={flags}", f"-DCMAKE_CXX_FLAGS={flags}", "-DBUILD_SHARED_LIBS=OFF", "-DVANTAGE_CCACHE=OFF",
         "-DVANTAGE_BUILD_PYTHON=ON", "-DVANTAGE_BUILD_TESTS=OFF", "-DVANTAGE_BUILD_BENCHMARKS=OFF", "-DVANTAGE_INSTALL=OFF",
         "-DVANTAGE_JOIN_SOURCES=ON", "-DVANTAGE_WHEEL=ON", f"-DVANTAGE_WHEEL_PREFIX={folder / 'prefix'}",
         "-DVANTAGE_LINK_PROJ=ON",
         "-DPKG_CONFIG_ARGN=--static", f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}",
         f"-Dfmt_DIR={folder / 'prefix' / 'lib' / 'any' / 'cmake' / 'fmt'}", f"-DPython_EXECUTABLE={tools}",
         f"-DVANTAGE_PYTHON_HEADERS={';'.join(map(str, headers))}", f"-DVANTAGE_PYTHON_SOABI={soabi}",
         f"-DSKBUILD_METADATA_DIR={info}", *options], build, log, **environment)
    unlink_older(zig, (build / "cmake" / "python" / "vantage").glob("_core.*.so"))
    run(["cmake", "--build", str(build / "cmake"), "--parallel", str(jobs), "--target", "vantage_python"], build, log)
    run(["cmake", "--install", str(build / "cmake"), "--prefix", str(out), "--component", "python"], build, log)
    shutil.copytree(PROJECT / "python" / "vantage", out / "vantage", dirs_exist_ok=True,
                    ignore=shutil.ignore_patterns("__pycache__", "*.pyc"))
    return out


def lowest_glibc(module: pathlib.Path) -> str:
    """The oldest glibc that has all that the module takes from it."""
    elf = read_elf.read(module)
    if elf is None:
        raise Failure(f"{module} is no library of Linux")
    for library in elf.needed:
        if not re.match(r"(libc|libm|libdl|libpthread|librt|ld-linux-[\w-]+)\.so\.", library):
            raise Failure(f"{module} needs {library}, which is not of glibc")
    versions = [tuple(map(int, name.removeprefix("GLIBC_").split("."))) for name in elf.needed_versions
                if re.fullmatch(r"GLIBC_[0-9.]+", name)]
    if not versions:
        raise Failure(f"{module} takes nothing from glibc")
    return "_".join(map(str, max(versions)[:2]))


def platform_tags(glibc: str, processor: str) -> list[str]:
    """What installers call systems with that glibc: the older name too, where there is one."""
    major, minor = (int(part) for part in glibc.split("_"))
    minor = max(minor, 17)  # no older system has this Python
    older = {17: "manylinux2014"}.get(minor) if major == 2 else None
    return [f"manylinux_{major}_{minor}_{processor}"] + ([f"{older}_{processor}"] if older else [])


def check_glibc(glibc: str, target: str) -> None:
    """Fails where a module that needs that glibc was not built for the glibc of the target."""
    wanted = re.search(r"-gnu\.(\d+)\.(\d+)$", target)
    if wanted is None:
        raise Failure(f"{target} names no glibc: x86_64-linux-gnu.2.17 does")
    if tuple(map(int, glibc.split("_"))) > tuple(map(int, wanted.groups())):
        raise Failure(f"the module takes functions of glibc {glibc.replace('_', '.')}, and is for {target}")


def pack(folder: pathlib.Path, tag: str, target: str, dist: pathlib.Path) -> pathlib.Path:
    """The wheel of what lies in a folder."""
    chosen, processor = wheel_targets.settings(target), target.partition("-")[0]
    if chosen:
        platforms = [chosen["tag"]]
    else:
        glibc = lowest_glibc(next((folder / "vantage").glob("_core.*.so")))
        check_glibc(glibc, target)
        platforms = platform_tags(glibc, processor)
    info = next(folder.glob("*.dist-info"))
    lines = ["Wheel-Version: 1.0", "Generator: vantage", "Root-Is-Purelib: false", *(f"Tag: {tag}-{name}" for name in platforms)]
    (info / "WHEEL").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (info / "RECORD").unlink(missing_ok=True)
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    with (info / "RECORD").open("w", encoding="utf-8", newline="") as opened:
        record = csv.writer(opened, lineterminator="\n")
        for file in files:
            digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest()).rstrip(b"=").decode()
            record.writerow([file.relative_to(folder).as_posix(), f"sha256={digest}", file.stat().st_size])
        record.writerow([f"{info.name}/RECORD", "", ""])
    name = info.name.removesuffix(".dist-info")
    for old in dist.glob(f"{name}-{tag}-{platforms[0] if chosen else f'*linux*_{processor}'}.whl"):
        old.unlink()
    wheel = dist / f"{name}-{tag}-{'.'.join(platforms)}.whl"
    half = wheel.with_suffix(".new")
    with zipfile.ZipFile(half, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in [*files, info / "RECORD"]:
            entry = zipfile.ZipInfo(file.relative_to(folder).as_posix(), FIXED_TIME)
            entry.external_attr = (0o100755 if file.suffix == ".so" else 0o100644) << 16
            archive.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)
    half.replace(wheel)
    return wheel


def check_tag(wheel: pathlib.Path, tools: pathlib.Path) -> None:
    """Fails where auditwheel names another system than the wheel's name does."""
    told = subprocess.run([str(tools), "-m", "auditwheel", "show", str(wheel)], capture_output=True, text=True, check=False)
    match = re.search(r'following platform\s+tag:\s+"(\w+)"', told.stdout)
    if told.returncode or not match or match[1] not in re.split("[-.]", wheel.stem):
        raise Failure(f"auditwheel does not say what the name of {wheel} says:\n{told.stdout}{told.stderr}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--targets", nargs="+", default=TARGETS)
    parser.add_argument("--pythons", nargs="+", choices=sorted(TAGS), default=list(TAGS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    libraries = tomllib.loads((HERE / "wheel_libraries.toml").read_text(encoding="utf-8"))
    dist = PROJECT / "dist"
    dist.mkdir(exist_ok=True)
    try:
        tools = make_tools(DEPS)
        for target in arguments.targets:
            subprocess.run([str(HERE / "build_wheel_libraries.py"), "--target", target, "--jobs", str(arguments.jobs)], check=True)
            build = PROJECT / "build-wheel" / target
            build.mkdir(parents=True, exist_ok=True)
            chosen, part = wheel_targets.settings(target), wheel_targets.part_for(target, libraries)
            for python in [name for name in arguments.pythons if not chosen or name in chosen["pythons"]]:
                print(f"building vantage for {target}, {TAGS[python]}", flush=True)
                folder = build_module(target, python, DEPS / f"wheel-{target}", build, tools, arguments.jobs, part)
                if not chosen:  # those for Linux
                    module = next((folder / "vantage").glob("_core.*.so"))
                    for fault in read_elf.mathematics_faults(read_elf.Elf(module.read_bytes())):
                        raise Failure(f"{module} {fault}")
                wheel = pack(folder, TAGS[python], target, dist)
                if not chosen:
                    check_tag(wheel, tools)
                subprocess.run([sys.executable, str(HERE / "wheel_licences.py"), "check", str(wheel)], check=True)
                if not chosen and not (folder / "vantage" / "share" / "web" / "index.html").exists():
                    print("the page of `vantage view` is not in it: run `make web` first")
                print(f"{wheel.stat().st_size / 1e6:.1f} MB  {wheel}", flush=True)
    except (Failure, OSError, KeyError, subprocess.CalledProcessError) as error:
        print(f"{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
