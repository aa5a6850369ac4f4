#!/usr/bin/env python3
"""Builds the libraries that a wheel of vantage contains, static and small, into .deps/wheel-TARGET/prefix: those of
wheel_libraries.toml, from Debian's source packages, pinned by hash, with the compiler of zig. Does nothing when they are
there.

    build_wheel_libraries.py --target x86_64-linux-gnu.2.17 [--list FILE] [--folder FOLDER] [--jobs N]

The sources come from the archive that apt uses on this machine. Of this system no library is taken, only headers and
data. Each library that is built is kept, where the next one fails.
"""

import argparse
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
from collections.abc import Iterable

import wheel_targets
from debian_archive import Failure, fetch

HERE = pathlib.Path(__file__).resolve().parent


def run(command: list[str], folder: pathlib.Path, log: pathlib.Path, **variables: str) -> None:
    """Runs a command whose output goes into `log`; what it wrote last is shown if it fails."""
    with log.open("a", encoding="utf-8") as output:
        output.write(f"$ {shlex.join(command)}\n")
        output.flush()
        result = subprocess.run(command, cwd=folder, env={**os.environ, **variables}, stdin=subprocess.DEVNULL,
                                stdout=output, stderr=subprocess.STDOUT, check=False)
    if result.returncode:
        tail = "\n".join(log.read_text(encoding="utf-8", errors="replace").splitlines()[-25:])
        raise Failure(f"{shlex.join(command[:3])} ... failed in {folder}; the end of {log}:\n{tail}")


# ---- sources

def series(tar: tarfile.TarFile) -> list[str]:
    """The patches that Debian applies, in their order."""
    file = tar.extractfile("debian/patches/series")
    if file is None:
        raise Failure(f"{tar.name} has no debian/patches/series")
    lines = (line.split("#")[0].strip() for line in file.read().decode().splitlines())
    return [line.split()[0] for line in lines if line]


def unpack(library: dict, downloads: pathlib.Path, into: pathlib.Path, log: pathlib.Path) -> pathlib.Path:
    """The source of a library, with Debian's patches where the list asks for them."""
    with tarfile.open(fetch(library["source"], library["sha256"], downloads)) as tar:
        tar.extractall(into, filter="data") if hasattr(tarfile, "data_filter") else tar.extractall(into)
    tops = list(into.iterdir())
    source = tops[0] if len(tops) == 1 else into
    if "patches" in library:
        with tarfile.open(fetch(library["patches_from"], library["patches_sha256"], downloads)) as tar:
            for name in library["patches"] or series(tar):
                tar.extract(f"debian/patches/{name}", source)
                run(["patch", "-p1", "-i", f"debian/patches/{name}"], source, log)
    if "own_patch" in library:
        run(["patch", "-p1", "-i", str(HERE / library["own_patch"])], source, log)
    return source


# ---- building

def installed_version(package: str) -> str:
    """The source package of an installed Debian package, and its version."""
    asked = subprocess.run(["dpkg-query", "--show", "--showformat", "${source:Package} ${Version}", package],
                           capture_output=True, text=True, check=False)
    if asked.returncode:
        raise Failure(f"the Debian package {package} is not installed: scripts/install_packages.sh --wheels")
    return asked.stdout


@dataclasses.dataclass
class Tools:
    """The commands that compile for a processor, and what CMake and configure must be told of them."""

    c: str
    cxx: str
    ar: str
    ranlib: str
    for_cmake: list[str]
    for_configure: list[str]
    processor: str

    def options(self, library: dict) -> list[str]:
        return [*library["options"], *library.get(f"{self.processor}_options", [])]


def zig_tools(target: str, prefix: pathlib.Path) -> Tools:
    """Those of zig, for a system as zig names it."""
    made = subprocess.run([str(HERE / "zig_compiler.sh"), target], capture_output=True, text=True, check=False)
    if made.returncode:
        raise Failure(made.stderr.strip())
    folder = pathlib.Path(made.stdout.strip())
    processor = target.partition("-")[0]
    return Tools(*(str(folder / name) for name in ("clang", "clang++", "ar", "ranlib")),
                 [f"-DCMAKE_TOOLCHAIN_FILE={HERE.parent / 'cmake' / 'Zig.cmake'}", f"-DVANTAGE_ZIG={folder}",
                  f"-DVANTAGE_ZIG_PREFIX={prefix}", f"-DVANTAGE_ZIG_PROCESSOR={processor}",
                  f"-DVANTAGE_ZIG_SYSTEM={wheel_targets.system(target)}"],
                 [f"--host={target.partition('.')[0]}"], processor)


def unlink_older(tools: Tools, linked: Iterable[pathlib.Path]) -> None:
    """Removes what was linked before zig_compiler.sh made its archive anew, of which ninja does not know."""
    archive = pathlib.Path(tools.c).parent / "libvantage_zig.a"
    for file in linked:
        if file.exists() and file.stat().st_mtime < archive.stat().st_mtime:
            file.unlink()


class Builder:
    def __init__(self, folder: pathlib.Path, prefix: pathlib.Path, flags: str, jobs: int, tools: Tools):
        self.folder, self.prefix, self.jobs, self.tools = folder, prefix, str(jobs), tools
        # The folder must not show in what is built.
        self.flags = f"{flags} -ffile-prefix-map={folder}=."
        self.environment = {"CFLAGS": self.flags, "CXXFLAGS": self.flags,
                            "PKG_CONFIG_LIBDIR": str(prefix / "lib" / "pkgconfig")}

    def build(self, library: dict) -> None:
        slug = library["name"].lower().replace("/", "-")
        work, log = self.folder / slug, self.folder / f"{slug}.log"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir()
        (self.folder / "downloads").mkdir(exist_ok=True)
        (work / "source").mkdir()
        source = unpack(library, self.folder / "downloads", work / "source", log)
        getattr(self, "with_" + library["build"])(library, source, work, log)
        self.keep_texts(library, source)

    def with_cmake(self, library: dict, source: pathlib.Path, work: pathlib.Path, log: pathlib.Path) -> None:
        build = work / "build"
        options = [option.format(prefix=self.prefix) for option in [*self.tools.for_cmake, *self.tools.options(library)]]
        run(["cmake", "-S", str(source / library.get("folder", ".")), "-B", str(build), "-G", "Ninja",
             "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-DNDEBUG", "-DCMAKE_CXX_FLAGS_RELEASE=-DNDEBUG",
             "-DBUILD_SHARED_LIBS=OFF", "-DCMAKE_POSITION_INDEPENDENT_CODE=ON", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             "-DCMAKE_INSTALL_PREFIX=/usr", "-DCMAKE_INSTALL_LIBDIR=lib", *options], work, log, **self.environment)
        run(["cmake", "--build", str(build), "--parallel", self.jobs, "--target", library.get("target", "all")], work,
            log, **self.environment)
        for to, origin in library.get("before_install", {}).items():
            shutil.copyfile(origin, build / to)
        self.install(library["name"], build, work, log)

    def install(self, name: str, build: pathlib.Path, work: pathlib.Path, log: pathlib.Path) -> None:
        """By way of a folder of its own: a library whose places are absolute would write over this system."""
        stage = work / "stage"
        run(["cmake", "--install", str(build), "--prefix", str(self.prefix)], work, log, DESTDIR=str(stage))
        made = stage / self.prefix.relative_to("/")
        outside = [file for file in stage.rglob("*") if not file.is_dir() and made not in file.parents]
        if outside:
            raise Failure(f"{name} installs /{outside[0].relative_to(stage)}, outside of the prefix")
        shutil.copytree(made, self.prefix, symlinks=True, dirs_exist_ok=True)

    def with_configure(self, library: dict, source: pathlib.Path, work: pathlib.Path, log: pathlib.Path) -> None:
        build = work / "build"
        build.mkdir()
        run([str(source / "configure"), f"--prefix={self.prefix}", "--disable-shared", "--enable-static",
             *self.tools.for_configure, *self.tools.options(library), f"CC={self.tools.c}",
             f"AR={self.tools.ar}", f"RANLIB={self.tools.ranlib}", f"LDFLAGS=-L{self.prefix / 'lib'}", "LIBS=-lz -lm"],
            build, log, **self.environment)
        run(["make", f"-j{self.jobs}", "-C", library["folder"], "install"], build, log, **self.environment)
        if "then" in library:
            run(["make", library["then"]], build, log, **self.environment)

    def with_sources(self, library: dict, source: pathlib.Path, work: pathlib.Path, log: pathlib.Path) -> None:
        objects = []
        for command in library.get("before", []):
            run(shlex.split(command), source, log)
        for name in library["sources"]:
            compiler = self.tools.cxx if name.endswith(".cpp") else self.tools.c
            objects.append(str(work / (pathlib.PurePosixPath(name).stem + ".o")))
            run([compiler, *shlex.split(self.flags), *library.get("defines", []), "-DNDEBUG", "-c", name, "-o", objects[-1]],
                source, log, **self.environment)
        run([self.tools.ar, "rcs", str(self.prefix / "lib" / f"lib{library['library']}.a"), *objects], work, log)
        for folder, headers in library["includes"].items():
            to = self.prefix / "include" / folder
            to.mkdir(parents=True, exist_ok=True)
            for header in headers:
                shutil.copy(source / header, to)
        self.describe(library.get("pkg_config", library["library"]), library["library"], library["version"],
                      list(library["includes"]))

    def take_installed(self, package: dict) -> None:
        """What is taken from an installed Debian package, with its version."""
        asked = installed_version(package["package"])
        self.link_headers(package)
        for folder, names in package.get("files", {}).items():
            (self.prefix / folder).mkdir(parents=True, exist_ok=True)
            for name in names:
                shutil.copy(name, self.prefix / folder)
        self.keep_texts({**package, "texts": [f"/usr/share/doc/{package['package']}/copyright"]}, pathlib.Path("/"))
        (self.prefix / "versions").mkdir(exist_ok=True)
        (self.prefix / "versions" / package["package"]).write_text(asked + "\n", encoding="utf-8")

    def link_headers(self, package: dict) -> None:
        """The headers of a package and what CMake reads of them, apart from those of this system's C library."""
        for name in package.get("folders", []):
            link = self.prefix / "include" / name
            link.unlink(missing_ok=True)
            link.symlink_to(pathlib.Path("/usr/include") / name)
        for name in package.get("config", []):
            origin = pathlib.Path("/usr") / name.format(multiarch=sysconfig.get_config_var("MULTIARCH"))
            to = self.prefix / name.format(multiarch="any")
            # But not what names libraries.
            shutil.copytree(origin, to, dirs_exist_ok=True, ignore=shutil.ignore_patterns("*-targets-none.cmake"))

    def describe(self, name: str, library: str, version: str, folders: list[str]) -> None:
        """What pkg-config tells of a library; `folders` below include/ are those of its headers."""
        file = self.prefix / "lib" / "pkgconfig" / f"{name}.pc"
        flags = " ".join(f"-I{self.prefix / 'include' / folder}" for folder in folders)
        file.write_text(f"Name: {name}\nDescription: {name}\nVersion: {version}\nCflags: {flags}\n"
                        f"Libs: -L{self.prefix}/lib -l{library}\n", encoding="utf-8")

    def keep_texts(self, library: dict, source: pathlib.Path) -> None:
        folder = self.prefix / "licences"
        folder.mkdir(exist_ok=True)
        names = [*library["texts"], *library.get(f"{self.tools.processor}_texts", [])]
        text = "\n".join((source / name).read_text(encoding="utf-8", errors="replace") for name in names)
        (folder / f"{library['name'].replace('/', '-')}.txt").write_text(text, encoding="utf-8")


def settle_prefix(prefix: pathlib.Path) -> None:
    """The descriptions that CMake installed name /usr, which is compiled in as the place of their data, and the files in
    zig's cache of the C++ library, which zig links by itself."""
    for file in (prefix / "lib" / "pkgconfig").glob("*.pc"):
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
        lines = [f"prefix={prefix}\n" if line.startswith("prefix=") else re.sub(r"-l/\S+\.a\s*", "", line) for line in lines]
        file.write_text("".join(lines), encoding="utf-8")


def build_all(libraries: dict, folder: pathlib.Path, target: str, jobs: int) -> None:
    """Those that are not there yet as the list describes them."""
    prefix, build, done = folder / "prefix", folder / "build", folder / "done"
    for part in (prefix / "include", prefix / "lib" / "pkgconfig", build, done, folder / "downloads"):
        part.mkdir(parents=True, exist_ok=True)
    if not (build / "downloads").exists():
        (build / "downloads").symlink_to(folder / "downloads")
    tools = zig_tools(target, prefix)
    flags = f"{libraries['portable']['compiler']} {libraries['portable'][tools.processor]}"
    builder = Builder(build, prefix, flags, jobs, tools)
    for package in libraries.get("installed", []):
        builder.take_installed(package)
    for name in libraries.get("headers_alone", []):
        (prefix / "include" / name).unlink(missing_ok=True)
        shutil.copy2(pathlib.Path("/usr/include") / name, prefix / "include")
    built = libraries["built"]
    for number, library in enumerate(built, 1):
        patch = (HERE / library["own_patch"]).read_text(encoding="utf-8") if "own_patch" in library else ""
        text = f"{json.dumps(library, sort_keys=True)}\n{flags}\n{patch}"
        stamp = done / f"{library['name']}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"
        if stamp.exists():
            continue
        print(f"building {library['name']} {library['version']} for {target} ({number} of {len(built)})", flush=True)
        builder.build(library)
        settle_prefix(prefix)
        stamp.touch()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", type=pathlib.Path, default=HERE / "wheel_libraries.toml")
    parser.add_argument("--folder", type=pathlib.Path, help=".deps/wheel-TARGET")
    parser.add_argument("--target", required=True, help="the system, as zig names it: x86_64-linux-gnu.2.17")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    folder = (arguments.folder or HERE.parent / ".deps" / f"wheel-{arguments.target}").resolve()
    try:
        libraries = wheel_targets.part_for(arguments.target, tomllib.loads(arguments.list.read_text(encoding="utf-8")))
        build_all(libraries, folder, arguments.target, arguments.jobs)
    except (Failure, OSError, KeyError, tomllib.TOMLDecodeError) as error:
        print(f"{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
