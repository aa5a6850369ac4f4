#!/usr/bin/env python3
"""Tries the wheel for Windows in wine, with a Python for Windows and numpy's wheel: python/wheel/try_engine.py, and the
missions of python/wheel/same_bytes.py against those of a program.

    check_wheel_wine.py WHEEL [--program build/bin/vantage] [--folder build-wheel/wine]

Needs wine64 of Debian, Maven, and zig (scripts/zig_compiler.sh). What it does not try: Windows itself.

The Python is that of the package org.bytedeco:cpython of Maven's central repository. It lacks python3.dll, which each
Python of python.org has: one that hands on all names is made here. numpy asks for functions of complex numbers that wine 8
lacks in the C library: these are given to the copy of numpy in that folder, under another name of the library.
"""

import argparse
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile

import python_for_windows
from debian_archive import Failure

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
TARGET = "x86_64-windows-gnu"
PYTHON = "org.bytedeco:cpython:3.13.5-1.5.12:jar:windows-x86_64"
PYTHON_SHA256 = "cfe5502ffa7ea369be707b6d88bf68344732a7800450665080fb4267c01bfeae"
NUMPY = "numpy==2.4.6 --hash=sha256:c4fc99836233ea196540b17ab0983aff60ed07941751930f5f4d05bc3b3b7359"
MATHS = b"api-ms-win-crt-math-l1-1-0.dll"
INSTEAD = b"vantage-crt-math.dll"  # no longer than that one
COMPLEX = """#include <math.h>
typedef struct { float re, im; } small;
typedef struct { double re, im; } large;
float our_crealf(small z) { return z.re; }
float our_cimagf(small z) { return z.im; }
float our_cabsf(small z) { return hypotf(z.re, z.im); }
float our_cargf(small z) { return atan2f(z.im, z.re); }
double our_creal(large z) { return z.re; }
double our_cimag(large z) { return z.im; }
double our_cabs(large z) { return hypot(z.re, z.im); }
double our_carg(large z) { return atan2(z.im, z.re); }
"""


def get_python(folder: pathlib.Path) -> pathlib.Path:
    """Where the Python for Windows lies, with its interpreter."""
    version = PYTHON.split(":")[2]
    jar = folder / f"cpython-{version}-windows-x86_64.jar"
    if not jar.exists():
        subprocess.run(["mvn", "-q", "org.apache.maven.plugins:maven-dependency-plugin:2.8:copy", f"-Dartifact={PYTHON}",
                        f"-DoutputDirectory={folder}"], check=True)
    if hashlib.sha256(jar.read_bytes()).hexdigest() != PYTHON_SHA256:
        raise Failure(f"{jar} has another hash than the one that was tried: remove it")
    place = folder / "python"
    shutil.rmtree(place, ignore_errors=True)
    with zipfile.ZipFile(jar) as archive:
        archive.extractall(place)
    return place / "org" / "bytedeco" / "cpython" / "windows-x86_64"


def make_library(zig: str, folder: pathlib.Path, name: str, source: str, exports: list[str]) -> None:
    (folder / "made.c").write_text(source + "int DllMain(void* a, unsigned b, void* c) { return 1; }\n", encoding="utf-8")
    (folder / "made.def").write_text("\n".join([f"LIBRARY {name}", "EXPORTS", *exports]) + "\n", encoding="utf-8")
    subprocess.run([zig, "-O1", "-fno-builtin", "-shared", str(folder / "made.c"), str(folder / "made.def"), "-o",
                    str(folder / name)], check=True)


def hand_on(line: str, library: str) -> str:
    name, *kind = line.split()
    return " ".join([f"{name} = {library}.{name}", *kind])


def maths_of(binaries: list[pathlib.Path]) -> list[str]:
    """The functions that these take from the C library's mathematics."""
    names, of_maths = set(), False
    for binary in binaries:
        told = subprocess.run(["objdump", "-p", str(binary)], capture_output=True, text=True, check=True).stdout
        for line in told.splitlines():
            words = line.split()
            if words[:2] == ["DLL", "Name:"]:
                of_maths = words[2].encode() == MATHS
            elif of_maths and len(words) == 3 and words[2].isidentifier():
                names.add(words[2])
    return sorted(names)


def complete_numpy(zig: str, python: pathlib.Path) -> None:
    """Gives numpy the functions that wine lacks. A long double is a double on Windows."""
    binaries = [file for file in (python / "lib" / "site-packages" / "numpy").rglob("*.pyd") if MATHS in file.read_bytes()]
    exports = []
    for name in maths_of(binaries):
        ours = name.removesuffix("l") if name in ("cabsl", "cargl", "cimagl", "creall") else name
        is_ours = f"our_{ours}(" in COMPLEX
        exports.append(f"{name} = our_{ours}" if is_ours else hand_on(name, "ucrtbase"))
    make_library(zig, python, INSTEAD.decode(), COMPLEX, exports)
    for file in binaries:
        file.write_bytes(file.read_bytes().replace(MATHS, INSTEAD.ljust(len(MATHS), b"\0")))


def make_root(wheel: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """A Python with numpy and the wheel."""
    zig = subprocess.run([str(HERE / "zig_compiler.sh"), TARGET], capture_output=True, text=True, check=True).stdout.strip() + "/clang"
    python = get_python(folder)
    packages = python / "lib" / "site-packages"
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as asked:
        asked.write(NUMPY + "\n")
        asked.flush()
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps",
                        "--require-hashes", "--only-binary=:all:", "--platform", "win_amd64", "--python-version", "3.13",
                        "--implementation", "cp", "--root-user-action=ignore", "--target", str(packages), "-r", asked.name], check=True)
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(packages)
    source = tomllib.loads((HERE / "wheel_libraries.toml").read_text(encoding="utf-8"))["python"]["abi3"]
    deps = PROJECT / ".deps" / f"wheel-{TARGET}"
    include, _ = python_for_windows.prepare(source, deps / "downloads", deps / "python", pathlib.Path(zig).parents[1] / "python/ziglang/zig")
    names = (include.parent / "python3.def").read_text(encoding="utf-8").splitlines()[2:]
    make_library(zig, python, python_for_windows.LIBRARY, "", [hand_on(line, "python313") for line in names])
    complete_numpy(zig, python)
    return python


def in_wine(folder: pathlib.Path, python: pathlib.Path, *arguments: str) -> None:
    """Runs a Python program. Its output goes through a file: wine gives no other kind to a program without a console."""
    variables = {**os.environ, "WINEPREFIX": str(folder / "prefix"), "WINEDEBUG": "-all", "PYTHONUTF8": "1"}
    told = folder / "told.txt"
    with told.open("w", encoding="utf-8") as output:
        pipe = subprocess.Popen(["wine", str(python / "python.exe"), *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, env=variables, text=True, encoding="utf-8", errors="replace")
        for line in pipe.stdout or ():
            print(line, end="", flush=True)
            output.write(line)
    if pipe.wait():
        raise Failure(f"python.exe {' '.join(arguments)} ended with {pipe.returncode}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheel", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=PROJECT / "build" / "bin" / "vantage")
    parser.add_argument("--folder", type=pathlib.Path, default=PROJECT / "build-wheel" / "wine")
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        for command in ("wine", "mvn"):
            if shutil.which(command) is None:
                raise Failure(f"there is no {command}: install Debian's {'wine64 and wine' if command == 'wine' else 'maven'}")
        python = make_root(arguments.wheel, folder)
        in_wine(folder, python, str(PROJECT / "python/wheel/try_engine.py"))
        same = PROJECT / "python/wheel/same_bytes.py"
        with (folder / "expected.csv").open("w", encoding="utf-8") as expected:
            subprocess.run([sys.executable, str(same), "--program", str(arguments.program)], stdout=expected, check=True)
        in_wine(folder, python, str(same), "--engine", "--expected", str(folder / "expected.csv"))
    except (Failure, OSError, KeyError, subprocess.CalledProcessError) as error:
        print(f"{error}", file=sys.stderr)
        return 1
    print(f"{arguments.wheel.name}: works in wine")
    return 0


if __name__ == "__main__":
    sys.exit(main())
