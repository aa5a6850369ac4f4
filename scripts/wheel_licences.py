#!/usr/bin/env python3
"""Says what a wheel of vantage contains, under which licences, and fails where wheel_libraries.toml does not know it.

    wheel_licences.py collect --build FOLDER --prefix FOLDER --deps FOLDER --out FOLDER
    wheel_licences.py check WHEEL...

`collect` runs while the wheel is made. It reads from ninja which static libraries the linker was given and which headers
were compiled, and writes the list LIBRARIES.txt with the texts of the licences. `check` looks into a finished wheel: at
what each binary loads, at binaries that nobody listed, and at the list.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from importlib import metadata, util

import wheel_targets

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
LIST = "LIBRARIES.txt"


class Failure(Exception):
    pass


def read_list() -> dict:
    return tomllib.loads((HERE / "wheel_libraries.toml").read_text(encoding="utf-8"))


def entries(libraries: dict) -> list[dict]:
    return [entry for kind in ("built", "installed", "fetched") for entry in libraries.get(kind, [])]


def is_copyleft(licence: str) -> bool:
    """Whether it allows no use but under the GPL, the LGPL or the AGPL."""
    return "GPL" in re.sub(r"\(chosen; or [^)]*\)", "", licence)


# ---- collect

def given_archives(build: pathlib.Path) -> set[str]:
    """The static libraries that the linker was given for the module: all that code may have been taken from."""
    asked = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "vantage_python"], capture_output=True, text=True,
                           check=True)
    command = next((line for line in reversed(asked.stdout.splitlines()) if "_core." in line and ".a" in line), "")
    found = {pathlib.PurePosixPath(word).name for word in command.split() if word.endswith(".a")}
    if not found:
        raise Failure(f"ninja knows no command in {build} that links static libraries into the module")
    return found


def compiled_headers(build: pathlib.Path) -> set[pathlib.Path]:
    """All headers that sources in this build folder included."""
    answer = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True, check=True)
    names = {line.strip() for line in answer.stdout.splitlines() if line.startswith("    ")}
    if not names:
        raise Failure(f"ninja knows of no headers in {build}")
    return {(build / name).resolve() for name in names}


def debian_packages(files: list[pathlib.Path]) -> dict[pathlib.Path, str]:
    """The packages that installed these files."""
    answer = subprocess.run(["dpkg-query", "--search", *map(str, files)], capture_output=True, text=True, check=False)
    found = {}
    for line in answer.stdout.splitlines():
        package, _, name = line.partition(": ")
        found[pathlib.Path(name)] = package.split(",")[0].split(":")[0]
    return found


def unknown_archives(archives: set[str], libraries: dict) -> tuple[list[str], set[str]]:
    """Archives that the list lacks, and the names of the libraries whose archives are there."""
    known = {archive: entry["name"] for entry in entries(libraries) for archive in entry.get("archives", [])}
    own = re.compile(r"libvantage(_\w+)?\.a")
    strange = [name for name in sorted(archives)
               if name not in known and name not in libraries["system"]["archives"] and not own.fullmatch(name)]
    return strange, {known[name] for name in archives if name in known}


def unknown_headers(headers: set[pathlib.Path], folders: dict[pathlib.Path, str],
                    libraries: dict) -> tuple[list[str], set[str]]:
    """Headers that the list lacks, and the names of the libraries whose headers are there. `folders`: whose is what."""
    left, used = [], set()
    for header in headers:
        owner = next((name for folder, name in folders.items() if header.is_relative_to(folder)), None)
        if owner is None:
            left.append(header)
        elif owner:
            used.add(owner)
    owners = {entry["package"]: entry["name"] for entry in libraries.get("installed", [])}
    packages = debian_packages(left)
    strange = []
    for header in left:
        package = packages.get(header)
        if package in owners:
            used.add(owners[package])
        elif package not in libraries["system"]["packages"]:
            strange.append(f"{header} ({package or 'of no Debian package'})")
    return sorted(strange), used


def own_folders(build: pathlib.Path, libraries: dict, places: dict[str, str]) -> dict[pathlib.Path, str]:
    """Folders of headers, and the libraries that they are of; "" for what leaves no code of others."""
    folders = {}
    for entry in libraries.get("fetched", []):
        folders |= {pathlib.Path(header.format(**places)).resolve(): entry["name"] for header in entry["headers"]}
    # Headers of the libraries that were built: the linker's command tells which of these are used.
    prefix = pathlib.Path(places["prefix"])
    ours = [build, *(PROJECT / folder for folder in ("src", "include", "python", "cmake"))]
    return folders | {path: "" for path in (prefix, prefix.parent / "python", *ours)}  # the latter: headers of Pythons


def first_comment(text: str) -> str:
    match = re.search(r"/\*(.*?)\*/", text, re.DOTALL)
    if not match:
        raise Failure("a header that is to tell its licence has no comment")
    return re.sub(r"(?m)^ \* ?", "", match[1])


def has_files(entry: dict, prefix: pathlib.Path) -> bool:
    """Whether files of a package, but for headers, were taken for the wheel."""
    return any((prefix / folder / pathlib.PurePosixPath(name).name).exists()
               for folder, names in entry.get("files", {}).items() for name in names)


def collect(build: pathlib.Path, prefix: pathlib.Path, deps: pathlib.Path, out: pathlib.Path) -> None:
    libraries = read_list()
    spec = util.find_spec("nanobind")
    if spec is None or spec.origin is None:
        raise Failure("nanobind is not installed for this Python")
    info = metadata.distribution("nanobind")
    texts = next(pathlib.Path(info.locate_file(file)).parent for file in info.files or [] if file.name == "LICENSE")
    places = {"deps": str(deps.resolve()), "prefix": str(prefix.resolve()),
              "nanobind": str(pathlib.Path(spec.origin).parent), "nanobind_texts": str(texts),
              "zig": str(deps.resolve() / "zig" / "python" / "ziglang" / "lib")}
    strange, by_archive = unknown_archives(given_archives(build), libraries)
    folders = own_folders(build.resolve(), libraries, places)
    strange_headers, by_header = unknown_headers(compiled_headers(build.resolve()), folders, libraries)
    if strange or strange_headers:
        raise Failure("the wheel would contain what scripts/wheel_libraries.toml does not list: "
                      + ", ".join(strange + strange_headers[:10]))
    contained = [entry for entry in entries(libraries) if entry["name"] in by_archive | by_header or has_files(entry, prefix)
                 or entry.get("of_zig")]
    copyleft = [f"{entry['name']} ({entry['licence']})" for entry in contained if is_copyleft(entry["licence"])]
    if copyleft:
        raise Failure(f"the wheel would contain what is under no licence but GPL or LGPL: {', '.join(copyleft)}")
    out.mkdir(parents=True, exist_ok=True)
    rows = []
    for entry in contained:
        name = entry["name"].replace("/", "-")
        if "headers" in entry and "texts" in entry:
            texts = [pathlib.Path(text.format(**places)) for text in entry["texts"]]
            text = "\n".join(first_comment(file.read_text(encoding="utf-8")) if file.suffix == ".h"
                             else file.read_text(encoding="utf-8") for file in texts)
        else:
            text = (prefix / "licences" / f"{name}.txt").read_text(encoding="utf-8")
        (out / f"{name}.txt").write_text(text, encoding="utf-8")
        rows.append((entry["name"], entry["licence"], f"{name}.txt", origin(entry, prefix, info.version)))
    lines = ["# name | licence | its text | where the source is"] + [" | ".join(row) for row in rows]
    (out / LIST).write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"licences: {len(rows)} libraries, all listed")


def origin(entry: dict, prefix: pathlib.Path, nanobind: str) -> str:
    if "source" in entry:
        return "Debian source package: " + pathlib.PurePosixPath(entry["source"]).name
    if "package" in entry:
        return "Debian source package: " + (prefix / "versions" / entry["package"]).read_text(encoding="utf-8").strip()
    if entry.get("of_zig") or "libpython3.a" in entry.get("archives", []):
        return f"release of ziglang on PyPI: {(PROJECT / 'python/wheel/zig-requirements.lock').read_text().split()[-2]}"
    if entry["name"] in ("nanobind", "robin-map"):
        return f"release of nanobind {nanobind} on PyPI"
    pins = (HERE / "sources.txt").read_text(encoding="utf-8")
    pin = re.search(r"^\S*" + entry["name"].lower() + r"\S*==\S+", pins, re.MULTILINE)
    if not pin:
        raise Failure(f"scripts/sources.txt does not pin {entry['name']}")
    return f"source release {pin[0]} on PyPI"


# ---- check

def told_by(tool: list[str], binary: bytes) -> list[str]:
    """The lines that a tool writes about a binary."""
    with tempfile.NamedTemporaryFile() as file:
        file.write(binary)
        file.flush()
        return subprocess.run([*tool, file.name], capture_output=True, text=True, check=True).stdout.splitlines()


def loaded_by(binary: bytes) -> list[str]:
    """The libraries that a binary asks the system for."""
    return re.findall(r"\(NEEDED\).*\[(\S+)\]", "\n".join(told_by(["readelf", "--dynamic", "--wide"], binary)))


def left_open(binary: bytes) -> list[str]:
    """Functions that a binary needs and that neither a library of the system nor Python has."""
    names = [line.split()[-1] for line in told_by(["nm", "--dynamic", "--undefined-only"], binary) if " U " in line]
    return [name for name in names if "@" not in name and not re.match(r"_?Py", name)]


def shown(binary: bytes) -> list[str]:
    """What other binaries in the same process could take for theirs."""
    names = [line.split()[-1] for line in told_by(["nm", "--dynamic", "--defined-only", "--extern-only"], binary)]
    return [name for name in names if name != "PyInit__core"]


def faults(wheel: zipfile.ZipFile, libraries: dict) -> list[str]:
    """What is in a wheel that the list does not know, or what is missing from it."""
    names = wheel.namelist()
    lists = [name for name in names if name.endswith(f".dist-info/licenses/third-party/{LIST}")]
    if len(lists) != 1:
        return [f"it has no {LIST}"]
    found = []
    folder = lists[0].removesuffix(LIST)
    known = {entry["name"]: entry["licence"] for entry in entries(libraries)}
    for line in wheel.read(lists[0]).decode().splitlines():
        if line.startswith("#"):
            continue
        name, licence, text, _ = line.split(" | ")
        if known.get(name) != licence:
            found.append(f"{name} ({licence}) is not in scripts/wheel_libraries.toml")
        if is_copyleft(licence):
            found.append(f"{name} is under {licence} alone")
        if folder + text not in names or not wheel.read(folder + text).strip():
            found.append(f"the licence of {name} is missing")
    for required in ("LICENSE", "THIRD-PARTY-NOTICES.txt"):
        if not any(name.endswith(f".dist-info/licenses/{required}") for name in names):
            found.append(f"{required} is missing")
    for name in names:
        data = wheel.read(name)
        if not data.startswith(b"\x7fELF"):
            found += wheel_targets.binary_faults(name, data)
            continue
        if not re.fullmatch(r"vantage/_core\.[\w.-]+\.so", name):
            found.append(f"{name} is a binary that is not listed")
            continue
        found += [f"{name} loads {library}, which is not part of every system" for library in loaded_by(data)
                  if library not in libraries["system"]["libraries"]]
        found += [f"{name} lacks {symbol}" for symbol in left_open(data)]
        found += [f"{name} shows {symbol} to other modules" for symbol in shown(data)[:10]]
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    of_build = commands.add_parser("collect")
    for option in ("build", "prefix", "deps", "out"):
        of_build.add_argument(f"--{option}", type=pathlib.Path, required=True)
    of_wheel = commands.add_parser("check")
    of_wheel.add_argument("wheel", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        if arguments.command == "collect":
            collect(arguments.build, arguments.prefix, arguments.deps, arguments.out)
            return 0
        libraries = read_list()
        status = 0
        for file in arguments.wheel:
            with zipfile.ZipFile(file) as wheel:
                found = faults(wheel, libraries)
            print("\n".join(f"{file.name}: {fault}" for fault in found) or f"{file.name}: all that is in it is listed")
            status = status or (1 if found else 0)
        return status
    except (Failure, OSError, StopIteration, subprocess.CalledProcessError, zipfile.BadZipFile) as error:
        print(f"{error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
