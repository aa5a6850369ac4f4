#!/usr/bin/env python3
"""Checks dist/ before it is published: SHA256SUMS, the names and versions of all files, and the bill of materials.

    check_dist.py [FOLDER]             exit 1 and a line for each fault
    check_dist.py --write [FOLDER]     writes SHA256SUMS first
    check_dist.py --partial [FOLDER]   kinds of files may be missing, and are named

- SHA256SUMS names each other file once, with its hash, and no file that is not there.
- Each file is of a kind that docs/release.md describes, and each kind is there.
- The version in its name and inside of it is that of include/vantage/version.h.
- Each has a licence in it.
- vantage-VERSION.cdx.json follows the schema of CycloneDX, and lists the same files with the same hashes.

Needs the packages of python/packaging-requirements.lock (`make release` installs them).
"""

import argparse
import dataclasses
import hashlib
import json
import pathlib
import re
import sys
import tarfile
import zipfile
from collections.abc import Callable

from vantage_version import version
from write_sbom import NO_LIST, PROJECT, Failure

SUMS = "SHA256SUMS"


# ---- what files tell of themselves

def in_zip(file: pathlib.Path, pattern: str, told: str) -> str:
    with zipfile.ZipFile(file) as archive:
        name = next((name for name in archive.namelist() if re.fullmatch(pattern, name)), "")
        found = re.search(told, archive.read(name).decode(), re.MULTILINE) if name else None
    return found[1] if found else ""


def in_tar(file: pathlib.Path, pattern: str, told: str) -> str:
    with tarfile.open(file) as archive:
        member = next((member for member in archive if re.fullmatch(pattern, member.name)), None)
        content = archive.extractfile(member) if member else None
        found = re.search(told, content.read().decode(), re.MULTILINE) if content else None
    return found[1] if found else ""


def of_wheel(file: pathlib.Path) -> str:
    return in_zip(file, r"[^/]+\.dist-info/METADATA", r"^Version: (\S+)$")


def of_npm(file: pathlib.Path) -> str:
    return in_tar(file, r"package/package\.json", r'"version": "([^"]+)"')


def of_program(file: pathlib.Path) -> str:
    """That of the page which the program wrote of itself."""
    return in_tar(file, r"[^/]+/share/man/man1/vantage\.1", r'^\.TH .*"vantage ([\d.]+)"')


def of_source(file: pathlib.Path) -> str:
    return in_tar(file, r"vantage-[\d.]+/include/vantage/version\.h", r'VANTAGE_VERSION "([^"]+)"')


def of_qgis(file: pathlib.Path) -> str:
    return in_zip(file, r"vantage_processing/metadata\.txt", r"^version=(\S+)$")


def of_blender(file: pathlib.Path) -> str:
    return in_zip(file, r"vantage_blender/blender_manifest\.toml", r'^version = "([^"]+)"')


def of_dsc(file: pathlib.Path) -> str:
    found = re.search(r"^Version: ([\d.]+)-\S+$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return found[1] if found else ""


def of_bill(file: pathlib.Path) -> str:
    return json.loads(file.read_text(encoding="utf-8"))["metadata"]["component"]["version"]


@dataclasses.dataclass
class Kind:
    """Files of a release. `name`: what theirs match, with V for the version; `told`: the version inside, None where there
    is none; `licence`: what the name of a file in it that has its licence matches; `may_lack`: a release may be without."""

    what: str
    name: str
    told: Callable[[pathlib.Path], str] | None = None
    licence: str = ""
    may_lack: bool = False


KINDS = [
    Kind("wheel for CPython 3.11, x86-64", r"vantage-V-cp311-cp311-[\w.]*manylinux\w+_x86_64\.whl", of_wheel, r".*licenses/LICENSE"),
    Kind("wheel for CPython 3.12 and later, x86-64", r"vantage-V-cp312-abi3-[\w.]*manylinux\w+_x86_64\.whl", of_wheel, r".*licenses/LICENSE"),
    Kind("wheel for CPython 3.11, aarch64", r"vantage-V-cp311-cp311-[\w.]*manylinux\w+_aarch64\.whl", of_wheel, r".*licenses/LICENSE"),
    Kind("wheel for CPython 3.12 and later, aarch64", r"vantage-V-cp312-abi3-[\w.]*manylinux\w+_aarch64\.whl", of_wheel, r".*licenses/LICENSE"),
    Kind("wheel for Windows, x86-64", r"vantage-V-cp312-abi3-win_amd64\.whl", of_wheel, r".*licenses/LICENSE", may_lack=True),
    Kind("wheel for macOS, arm64", r"vantage-V-cp312-abi3-macosx_11_0_arm64\.whl", of_wheel, r".*licenses/LICENSE", may_lack=True),
    Kind("wheel over WebAssembly", r"vantage-V-py3-none-any\.whl", of_wheel, r".*/LICENSE"),
    Kind("npm package", r"vantage-engine-V\.tgz", of_npm, r"package/LICENSE"),
    Kind("program for glibc, x86-64", r"vantage-V-linux-x86_64\.tar\.xz", of_program, r".*/share/doc/vantage/LICENSE"),
    Kind("program for glibc, aarch64", r"vantage-V-linux-aarch64\.tar\.xz", of_program, r".*/share/doc/vantage/LICENSE"),
    Kind("static program", r"vantage-V-linux-x86_64-static\.tar\.xz", of_program, r".*/share/doc/vantage/LICENSE"),
    Kind("plugin of QGIS", r"vantage_processing-V\.zip", of_qgis, r"vantage_processing/LICENSE"),
    Kind("add-on of Blender", r"vantage_blender\.zip", of_blender, r"vantage_blender/LICENSE"),
    Kind("source", r"vantage-V\.tar\.xz", of_source, r"vantage-[\d.]+/LICENSE"),
    Kind("Debian's source package", r"vantage_V-\d+\.dsc", of_dsc),
    Kind("source in it", r"vantage_V\.orig\.tar\.xz", of_source, r"vantage-[\d.]+/LICENSE"),
    Kind("Manifold in it", r"vantage_V\.orig-manifold\.tar\.gz", None, r"[^/]+/LICENSE"),
    Kind("CDT in it", r"vantage_V\.orig-cdt\.tar\.gz", None, r"[^/]+/CDT/LICENSE"),
    Kind("HiGHS in it", r"vantage_V\.orig-highs\.tar\.gz", None, r"[^/]+/LICENSE.txt"),
    Kind("packaging in it", r"vantage_V-\d+\.debian\.tar\.xz", None, r"debian/copyright"),
    Kind("bill of materials", r"vantage-V\.cdx\.json", of_bill),
]


def members(file: pathlib.Path) -> list[str]:
    if zipfile.is_zipfile(file):
        with zipfile.ZipFile(file) as archive:
            return archive.namelist()
    with tarfile.open(file) as archive:
        return archive.getnames()


def file_faults(file: pathlib.Path, number: str) -> tuple[Kind | None, list[str]]:
    kind = next((kind for kind in KINDS if re.fullmatch(kind.name.replace("V", re.escape(number)), file.name)), None)
    if kind is None:
        return None, [f"{file.name} is no file of release {number}: remove it, or describe it in KINDS and docs/release.md"]
    found = []
    try:
        told = kind.told(file) if kind.told else number
        if told != number:
            found.append(f"{file.name} says inside that it is version {told or '(none)'}, not {number}")
        if kind.licence and not any(re.fullmatch(kind.licence, name) for name in members(file)):
            found.append(f"{file.name} has no licence in it ({kind.licence})")
    except (tarfile.TarError, zipfile.BadZipFile, EOFError, OSError, KeyError, ValueError) as error:
        found.append(f"{file.name} cannot be read: {error}")
    return kind, found


# ---- hashes and the bill

def sha256(file: pathlib.Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def write_sums(folder: pathlib.Path) -> None:
    lines = [f"{sha256(file)}  {file.name}\n" for file in sorted(folder.iterdir()) if file.name != SUMS]
    half = folder / f"{SUMS}.new"
    half.write_text("".join(lines), encoding="utf-8")
    half.replace(folder / SUMS)


def sum_faults(folder: pathlib.Path, hashes: dict[str, str]) -> list[str]:
    if not (folder / SUMS).is_file():
        return [f"{folder} has no {SUMS}"]
    found, listed = [], {}
    for line in (folder / SUMS).read_text(encoding="utf-8").splitlines():
        match = re.fullmatch(r"([0-9a-f]{64})  ([\w.+~-]+)", line)
        if match is None:
            found.append(f"{SUMS} has a line that is not understood: {line[:80]}")
        elif match[2] in listed:
            found.append(f"{SUMS} names {match[2]} twice")
        else:
            listed[match[2]] = match[1]
    found += [f"{SUMS} lacks {name}" for name in sorted(hashes.keys() - listed.keys())]
    found += [f"{SUMS} names {name}, which is not there" for name in sorted(listed.keys() - hashes.keys())]
    return found + [f"{name} has another hash than {SUMS} says" for name in sorted(hashes.keys() & listed.keys())
                    if hashes[name] != listed[name]]


def schema_faults(bill: dict) -> list[str]:
    """What in the bill the schema of CycloneDX does not allow."""
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator

    schema = {told.to_version(): told for told in SchemaVersion}.get(bill["specVersion"])
    if schema is None:
        return [f"the bill of materials is of CycloneDX {bill['specVersion']}, whose schema is not known here"]
    error = JsonStrictValidator(schema).validate_str(json.dumps(bill))
    return [f"the bill of materials is not CycloneDX {bill['specVersion']}: {error}"[:600]] if error else []


def bill_faults(folder: pathlib.Path, number: str, hashes: dict[str, str]) -> list[str]:
    file = folder / f"vantage-{number}.cdx.json"
    if not file.is_file():
        return [f"{folder} has no bill of materials, {file.name}"]
    bill = json.loads(file.read_text(encoding="utf-8"))
    found = schema_faults(bill)
    listed = {component["name"]: component["hashes"][0]["content"] for component in bill["components"] if component["type"] == "file"}
    wanted = {name: digest for name, digest in hashes.items() if not name.endswith(NO_LIST)}
    found += [f"{file.name} lacks {name}" for name in sorted(wanted.keys() - listed.keys())]
    found += [f"{file.name} lists {name}, which is not there" for name in sorted(listed.keys() - wanted.keys())]
    found += [f"{file.name} has another hash of {name}" for name in sorted(wanted.keys() & listed.keys()) if wanted[name] != listed[name]]
    refs = {component["bom-ref"] for component in bill["components"]} | {bill["metadata"]["component"]["bom-ref"]}
    named = {ref for entry in bill["dependencies"] for ref in (entry["ref"], *entry["dependsOn"])}
    return found + [f"{file.name} names {ref} and does not describe it" for ref in sorted(named - refs)]


def faults(folder: pathlib.Path, number: str) -> tuple[list[str], list[str]]:
    """What is wrong, and which kinds of files are missing."""
    files = sorted(file for file in folder.iterdir() if file.name != SUMS)
    hashes = {file.name: sha256(file) for file in files}
    found, there = sum_faults(folder, hashes), []
    for file in files:
        kind, more = file_faults(file, number)
        found += more
        there.append(kind)
    missing = [f"missing: {kind.what} ({kind.name.replace('V', number)})" for kind in KINDS
               if kind not in there and not kind.may_lack]
    return found + bill_faults(folder, number, hashes), missing


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=PROJECT / "dist")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--partial", action="store_true")
    arguments = parser.parse_args()
    try:
        number = version()
        if arguments.write:
            write_sums(arguments.folder)
        found, missing = faults(arguments.folder, number)
    except (Failure, ImportError, OSError, KeyError, ValueError) as error:
        print(f"{arguments.folder} could not be checked: {error}", file=sys.stderr)
        return 1
    print("\n".join(found + missing) or f"{arguments.folder}: a whole release {number}", file=sys.stderr if found else sys.stdout)
    return 1 if found or missing and not arguments.partial else 0


if __name__ == "__main__":
    sys.exit(main())
