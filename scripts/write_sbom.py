#!/usr/bin/env python3
"""Writes the software bill of materials of a release, dist/vantage-VERSION.cdx.json, in CycloneDX 1.6: each file of dist/
with its hash, and what of others is in it.

    write_sbom.py [FOLDER]      FOLDER: dist

Of a wheel or a program that is its own list, LIBRARIES.txt, which was made from what the linker was given; of the page and
the engine in WebAssembly what web/package-lock.json, scripts/fetch_web_sources.py and scripts/sources.txt pin. Versions and
hashes are those of scripts/wheel_libraries.toml, scripts/sources.txt and the locks. The same files give the same bytes.
"""

import argparse
import base64
import dataclasses
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tarfile
import tomllib
import uuid
import zipfile

import fetch_web_sources
from vantage_version import version

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
LIST = "third-party/LIBRARIES.txt"
ENGINE = ["Manifold", "CDT", "Eigen", "nlohmann/json", "libfmt"]
"""What the engine in WebAssembly is compiled with, of wheel_libraries.toml; and fetch_web_sources.py, and Emscripten's."""
EMSCRIPTEN_LIBRARIES = {"musl": "MIT", "libc++": "Apache-2.0 with LLVM exception"}
NO_LIST = ("SHA256SUMS", ".cdx.json", ".dsc", ".changes", ".buildinfo")


class Failure(Exception):
    pass


@dataclasses.dataclass
class Library:
    """One that is in a file of the release."""

    name: str
    version: str
    licence: str
    purl: str
    origin: str = ""
    sha256: str = ""
    sha512: str = ""

    @property
    def ref(self) -> str:
        return self.purl

    def component(self) -> dict:
        licence = re.sub(r" \(chosen; or [^)]*\)", "", self.licence)
        kind = "name" if re.search(r"[ ;]", licence) else "id"
        told = {"type": "library", "bom-ref": self.ref, "name": self.name, "version": self.version,
                "licenses": [{"license": {kind: licence}}], "purl": self.purl}
        hashes = [{"alg": alg, "content": content} for alg, content in (("SHA-256", self.sha256), ("SHA-512", self.sha512)) if content]
        if hashes:
            told["externalReferences"] = [{"type": "source-distribution", "url": self.origin, "hashes": hashes}]
        elif self.origin:
            told["description"] = self.origin
        return told


# ---- what is pinned

def pin(name: str, file: str = "scripts/sources.txt") -> tuple[str, str]:
    """The version and the SHA-256 of a pinned release."""
    found = re.search(rf"^{name}==(\S+)\s+(?:\\\s+)?--hash=sha256:(\w+)", (PROJECT / file).read_text(encoding="utf-8"), re.MULTILINE)
    if found is None:
        raise Failure(f"{file} does not pin {name}")
    return found[1], found[2]


FETCHED = {"Manifold": "manifold3d", "HiGHS": "highspy", "CDT": "pythoncdt"}


def of_index(name: str, licence: str, release: str, file: str = "scripts/sources.txt") -> Library:
    version, sha256 = pin(release, file)
    return Library(name, version, licence, f"pkg:pypi/{release}@{version}#{name.replace(' ', '%20').replace('+', '%2B').replace(',', '')}",
                   f"pkg:pypi/{release}@{version}", sha256)


def from_list(line: str, libraries: dict[str, list[dict]]) -> Library:
    """A row of LIBRARIES.txt."""
    name, licence, _, origin = line.split(" | ")
    if name in FETCHED:
        return of_index(name, licence, FETCHED[name])
    if "ziglang" in origin or name == "musl":
        return of_index(name, licence, "ziglang", "python/wheel/zig-requirements.lock")
    if "nanobind" in origin:
        return of_index(name, licence, "nanobind", "python/wheel-requirements.lock")
    for entry in libraries.get(name, []):
        if "source" in entry and origin.endswith(pathlib.PurePosixPath(entry["source"]).name):
            package = pathlib.PurePosixPath(entry["source"]).name.split("_")[0]
            return Library(name, entry["version"], licence, f"pkg:generic/{package}@{entry['version']}",
                           entry["source"], entry["sha256"])
    found = re.fullmatch(r"Debian source package: (\S+) (\S+)", origin)
    if found is None:
        raise Failure(f"where {name} is from is not understood: {origin}")
    return Library(name, found[2], licence, f"pkg:deb/debian/{found[1]}@{found[2].replace('+', '%2B')}?arch=source"
                   + (f"#{name.replace(' ', '%20').replace('/', '%2F')}" if name.lower() not in found[1] else ""), origin)


def installed_version(package: str) -> tuple[str, str]:
    asked = subprocess.run(["dpkg-query", "--show", "--showformat", "${source:Package} ${source:Version}", package],
                           capture_output=True, text=True, check=False)
    if asked.returncode:
        raise Failure(f"the Debian package {package} is not installed, so its version is not known")
    source, version = asked.stdout.split()
    return source, version


def engine_libraries(libraries: dict[str, list[dict]]) -> list[Library]:
    """What the engine in WebAssembly holds."""
    found = []
    for name in ENGINE:
        entry = libraries[name][0]
        if name in FETCHED:
            found.append(of_index(name, entry["licence"], FETCHED[name]))
        else:
            source, version = installed_version(entry["package"])
            found.append(Library(name, version, entry["licence"], f"pkg:deb/debian/{source}@{version.replace('+', '%2B')}?arch=source",
                                 f"Debian source package: {source} {version}"))
    for name, path, sha256 in fetch_web_sources.SOURCES:
        version = re.sub(r"\.orig\..*", "", path.rpartition("_")[2])
        found.append(Library(name, version, libraries[name][0]["licence"], f"pkg:generic/{name}@{version.replace('+', '%2B')}",
                             path, sha256))
    _, version = installed_version("emscripten")
    found += [Library(f"{name} of Emscripten", version, licence, f"pkg:deb/debian/emscripten@{version}?arch=source#{name.replace('+', '%2B')}",
                      f"Debian source package: emscripten {version}") for name, licence in EMSCRIPTEN_LIBRARIES.items()]
    return found


def page_libraries(libraries: dict[str, list[dict]]) -> list[Library]:
    """What the page holds: the engine, and what npm's lock names but for tools."""
    lock = json.loads((PROJECT / "web" / "package-lock.json").read_text(encoding="utf-8"))
    found = []
    for path, package in lock["packages"].items():
        if not path or package.get("dev") or package.get("optional") or package.get("link"):
            continue
        name = path.rpartition("node_modules/")[2]
        digest = base64.b64decode(package["integrity"].removeprefix("sha512-")).hex()
        found.append(Library(name, package["version"], package["license"], f"pkg:npm/{name}@{package['version']}",
                             f"pkg:npm/{name}@{package['version']}", sha512=digest))
    return found + engine_libraries(libraries)


# ---- what is in the files

def list_in(file: pathlib.Path) -> tuple[str, bool]:
    """The text of LIBRARIES.txt in an archive, and whether the page is in it too."""
    if file.suffix == ".whl":
        with zipfile.ZipFile(file) as archive:
            names = archive.namelist()
            name = next((name for name in names if name.endswith(LIST)), "")
            return archive.read(name).decode() if name else "", any(name.endswith("share/web/index.html") for name in names)
    with tarfile.open(file) as archive:
        names = archive.getnames()
        name = next((name for name in names if name.endswith(LIST)), "")
        member = archive.extractfile(name) if name else None
        return member.read().decode() if member else "", any(name.endswith("vantage/web/index.html") for name in names)


def libraries_in(file: pathlib.Path, libraries: dict[str, list[dict]]) -> list[Library]:
    name = file.name
    if name.endswith((".zip", ".debian.tar.xz", ".deb")) or "third-party" in name:
        return []
    if re.fullmatch(r"vantage_.*\.orig(-\w+)?\.tar\.\w+", name):
        part = re.search(r"\.orig-(\w+)\.", name)
        origin = {release.lower(): (release, package) for release, package in FETCHED.items()}
        if part is None:
            return []
        title, release = origin[part[1]]
        return [of_index(title, libraries[title][0]["licence"], release)]
    if re.fullmatch(r"vantage-[\d.]+\.tar\.xz", name):
        return []
    if name.endswith("-none-any.whl") or name.endswith(".tgz"):
        return engine_libraries(libraries)
    text, has_page = list_in(file)
    if not text:
        raise Failure(f"{name} has no {LIST}")
    found = [from_list(line, libraries) for line in text.splitlines() if not line.startswith("#")]
    return found + (page_libraries(libraries) if has_page else [])


def commit_time() -> str:
    told = subprocess.run(["git", "log", "-1", "--format=%cd", "--date=format-local:%Y-%m-%dT%H:%M:%SZ"], cwd=PROJECT, env={"TZ": "UTC", "PATH": "/usr/bin:/bin"},
                          capture_output=True, text=True, check=True)
    return told.stdout.strip()


def bill(folder: pathlib.Path) -> dict:
    listed: dict[str, list[dict]] = {}
    toml = tomllib.loads((HERE / "wheel_libraries.toml").read_text(encoding="utf-8"))
    for section in ("built", "installed", "fetched"):
        for entry in toml[section]:
            listed.setdefault(entry["name"], []).append(entry)
    used: dict[str, Library] = {}
    files: list[dict] = []
    depends: list[dict] = []
    for file in sorted(folder.iterdir()):
        if file.name.endswith(NO_LIST):
            continue
        found = {library.ref: library for library in libraries_in(file, listed)}
        used |= found
        files.append({"type": "file", "bom-ref": f"file:{file.name}", "name": file.name,
                      "hashes": [{"alg": "SHA-256", "content": hashlib.sha256(file.read_bytes()).hexdigest()}]})
        depends.append({"ref": f"file:{file.name}", "dependsOn": sorted(found)})
    if not files:
        raise Failure(f"{folder} holds nothing of a release")
    own = version()
    told = {
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json", "bomFormat": "CycloneDX", "specVersion": "1.6", "version": 1,
        "metadata": {"timestamp": commit_time(),
                     "component": {"type": "application", "bom-ref": "vantage", "name": "vantage", "version": own,
                                   "licenses": [{"license": {"id": "Apache-2.0"}}]}},
        "components": files + [used[ref].component() for ref in sorted(used)],
        "dependencies": [{"ref": "vantage", "dependsOn": [entry["bom-ref"] for entry in files]}, *depends]}
    told["serialNumber"] = f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(told, sort_keys=True))}"
    return told


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=PROJECT / "dist")
    folder = parser.parse_args().folder
    try:
        file = folder / f"vantage-{version()}.cdx.json"
        told = bill(folder)
        half = file.with_suffix(".new")
        half.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
        half.replace(file)
    except (Failure, OSError, KeyError, ValueError, tarfile.TarError, zipfile.BadZipFile, subprocess.CalledProcessError) as error:
        print(f"no bill of materials: {error}", file=sys.stderr)
        return 1
    libraries = sum(component["type"] == "library" for component in told["components"])
    print(f"{file}: {len(told['components']) - libraries} files, {libraries} libraries")
    return 0


if __name__ == "__main__":
    sys.exit(main())
