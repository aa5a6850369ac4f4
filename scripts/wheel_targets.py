"""What differs in wheels for other systems than Linux: wheel_targets.toml."""

import fnmatch
import pathlib
import re
import shutil
import tomllib

import read_foreign
from debian_archive import Failure

HERE = pathlib.Path(__file__).resolve().parent


def settings(target: str) -> dict | None:
    """Those of a system as zig names it, x86_64-windows-gnu; None for Linux."""
    processor, kind = target.replace(".", "-").split("-")[:2]
    if kind == "linux":
        return None
    known = tomllib.loads((HERE / "wheel_targets.toml").read_text(encoding="utf-8"))
    if kind not in known or processor not in known[kind]["tag"]:
        raise Failure(f"scripts/wheel_targets.toml has no wheels for {target}")
    return {**known[kind], "tag": known[kind]["tag"][processor]}


def system(target: str) -> str:
    """CMake's name of it."""
    chosen = settings(target)
    return chosen["system"] if chosen else "Linux"


def part_for(target: str, libraries: dict) -> dict:
    """Of wheel_libraries.toml that which a wheel for this system needs."""
    chosen = settings(target)
    if chosen is None:
        return libraries
    unknown = [name for kind in ("built", "installed") for name in chosen["libraries" if kind == "built" else kind]
               if name not in {entry["name"] for entry in libraries[kind]}]
    if unknown:
        raise Failure(f"scripts/wheel_libraries.toml has no {', '.join(unknown)}, which scripts/wheel_targets.toml names")
    portable = {**libraries["portable"], "compiler": chosen["compiler"], target.partition("-")[0]: chosen["processor"]}
    return {**libraries, "portable": portable, "headers_alone": chosen["headers"],
            "built": [entry for entry in libraries["built"] if entry["name"] in chosen["libraries"]],
            "installed": [entry for entry in libraries["installed"] if entry["name"] in chosen["installed"]]}


def headers_of_macos(linux: list[pathlib.Path], into: pathlib.Path) -> pathlib.Path:
    """The headers of a Python for Linux on arm64, as macOS can take them for the stable ABI: sizes of types are the same.
    Debian's pyconfig.h only chooses one for a processor of Linux."""
    headers, above = linux
    folder = into / "macos" / headers.name
    if not folder.exists():
        half = folder.with_suffix(".new")
        shutil.rmtree(half, ignore_errors=True)
        shutil.copytree(headers, half)
        text = (above / "aarch64-linux-gnu" / headers.name / "pyconfig.h").read_text(encoding="utf-8")
        # Where these are asked for, macOS hides what its own headers need.
        text = re.sub(r"(?m)^#define _(POSIX_C|XOPEN|GNU)_SOURCE\b.*\n", "", text)
        (half / "pyconfig.h").write_text(text, encoding="utf-8")
        half.rename(folder)
    return folder


def binary_faults(name: str, data: bytes) -> list[str]:
    """What is wrong with a file of a wheel, where it is a binary of Windows or macOS."""
    kind = read_foreign.kind(data)
    if kind is None:
        return []
    if not re.fullmatch(r"vantage/_core\.(pyd|abi3\.so)", name):
        return [f"{name} is a binary that is not listed"]
    known = tomllib.loads((HERE / "wheel_targets.toml").read_text(encoding="utf-8"))[kind]
    found = [f"{name} loads {library}, which is not part of every system" for library in read_foreign.loaded_by(data)
             if not any(fnmatch.fnmatchcase(library.lower(), pattern.lower()) for pattern in known["libraries_of_system"])]
    if kind == "macos" and (read_foreign.oldest_macos(data) or (99, 0)) > tuple(known["oldest"]):
        found.append(f"{name} needs macOS {read_foreign.oldest_macos(data)}")
    return found
