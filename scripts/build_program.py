#!/usr/bin/env python3
"""Builds the program for all Linux systems of a processor, as tarballs in dist/ that run where they are unpacked, with
the compiler of zig.

    build_program.py [--targets x86_64-linux-gnu.2.17] [--jobs N]

    vantage-VERSION-linux-x86_64.tar.xz          for glibc 2.17 or newer; loads GDAL and OpenGL where they are installed
    vantage-VERSION-linux-x86_64-static.tar.xz   --targets x86_64-linux-musl: for any Linux, with no library at all; so
                                                 neither GDAL nor OpenGL, and no tilesets over the network
    vantage-VERSION-linux-aarch64.tar.xz         --targets aarch64-linux-gnu.2.17

What is in them: wheel_libraries.toml, as in the wheels, and the build fails on anything else. The same sources give the
same bytes. The program writes its man pages and completions itself; that for another processor is run by the emulator of
Debian's qemu-user-static.
"""

import argparse
import io
import lzma
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile

import read_elf
import wheel_licences
from build_wheel_libraries import Failure, run, unlink_older, zig_tools
from debian_archive import fetch, unpack
from vantage_version import version

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent
DEPS = PROJECT / ".deps"
TARGETS = ["x86_64-linux-gnu.2.17", "x86_64-linux-musl"]
FIXED_TIME = 1577836800  # 2020-01-01, of all files
GLIBC = re.compile(r"(libc|libm|libdl|libpthread|librt|ld-linux-[\w-]+)\.so\.\d+")
ZIG_ARCHIVES = {"libc++.a", "libc++abi.a", "libunwind.a", "libcompiler_rt.a"}
"""Those that zig made of its own sources: the list has these under its name."""
PAGES = ("index.html", "report.html")  # of `vantage view` and `vantage report`
DOCUMENTS = ("LICENSE", "THIRD-PARTY-NOTICES.txt", "CHANGELOG.md", "README.md", "docs/*.md", "examples/plaza", "examples/town",
             "tools/check_certificate.py", "tools/check_tour.py")
STACK_BYTES = 8 << 20
"""Of each thread, as glibc gives it; musl gives 128 KiB where a program does not ask for more, and never more than this."""


def is_static(target: str) -> bool:
    return target.endswith("-musl")


def tarball_name(target: str) -> str:
    """The name of a tarball, and of the folder in it, without the ending."""
    processor, system = target.split("-")[:2]
    return f"vantage-{version()}-{system}-{processor}{'-static' if is_static(target) else ''}"


# ---- building

def build(target: str, work: pathlib.Path, jobs: int, libraries: dict) -> pathlib.Path:
    """Compiles the program, in the folder in which build_portable_wheels.py compiles the same libraries with the same
    flags, where it does; the folder of the build."""
    folder, build_folder, log = DEPS / f"wheel-{target}", work / "cmake", work / "program.log"
    prefix = folder / "prefix"
    work.mkdir(parents=True, exist_ok=True)
    zig = zig_tools(target, prefix)
    portable = libraries["portable"]
    flags = f"{portable['vantage']} {portable[zig.processor]} -ffile-prefix-map={PROJECT}=."
    link, options = "-Wl,--gc-sections -s", list(portable["vantage_options"])
    if is_static(target):  # zig links for musl without libraries, as a PIE
        link += f" -Wl,-z,stack-size={STACK_BYTES}"
        options.append("-DVANTAGE_LOAD_LIBRARIES=OFF")
    cache = build_folder / "CMakeCache.txt"
    if cache.exists() and any(done.stat().st_mtime > cache.stat().st_mtime for done in (folder / "done").iterdir()):
        cache.unlink()  # what CMake remembers of libraries holds until they are built anew
    run(["cmake", "-S", str(PROJECT), "-B", str(build_folder), "-G", "Ninja", *zig.for_cmake,
         "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DCMAKE_C_FLAGS_RELEASE=-O2 -DNDEBUG",
         f"-DCMAKE_C_FLAGS={flags}", f"-DCMAKE_CXX_FLAGS={flags}", f"-DCMAKE_EXE_LINKER_FLAGS={link}",
         "-DBUILD_SHARED_LIBS=OFF", "-DVANTAGE_CCACHE=OFF", "-DVANTAGE_BUILD_TESTS=OFF", "-DVANTAGE_BUILD_BENCHMARKS=OFF",
         "-DVANTAGE_BUILD_PYTHON=OFF",
         "-DVANTAGE_INSTALL=OFF", "-DVANTAGE_JOIN_SOURCES=ON", "-DVANTAGE_LINK_PROJ=ON",
         "-DPKG_CONFIG_ARGN=--static", f"-DCMAKE_PREFIX_PATH={prefix}",
         f"-Dfmt_DIR={prefix / 'lib' / 'any' / 'cmake' / 'fmt'}", *options],
        PROJECT, log, PKG_CONFIG_LIBDIR=str(prefix / "lib" / "pkgconfig"))
    unlink_older(zig, [build_folder / "bin" / "vantage"])
    run(["cmake", "--build", str(build_folder), "--parallel", str(jobs), "--target", "vantage_cli"], PROJECT, log)
    return build_folder


def starter(target: str, libraries: dict) -> list[str]:
    """What starts the program on this machine: nothing, or an emulator, with the C library of Debian 12 where it needs one."""
    processor = target.partition("-")[0]
    if processor == platform.machine():
        return []
    emulator = shutil.which(f"qemu-{processor}-static")
    if emulator is None:
        raise Failure(f"there is no qemu-{processor}-static, which runs the program for {target}: install Debian's qemu-user-static")
    if is_static(target):
        return [emulator]
    folder, pinned = DEPS / f"wheel-{target}", libraries["libc"]
    if processor not in pinned:
        raise Failure(f"scripts/wheel_libraries.toml has no C library for {processor}, which the program for {target} is run with")
    package = fetch(pinned[processor], pinned[f"{processor}_sha256"], folder / "downloads")
    return [emulator, "-L", str(unpack(package, folder / "libc" / package.stem, "./lib"))]


def check_binary(program: pathlib.Path, target: str) -> str:
    """What it needs of the system, in words; fails where that is more than the target has."""
    elf = read_elf.read(program)
    if elf is None:
        raise Failure(f"{program} is no program of Linux")
    faults = read_elf.search_path_faults(elf) + read_elf.hardening_faults(elf, not is_static(target))  # musl has no FORTIFY
    if not is_static(target):
        faults += read_elf.mathematics_faults(elf)
    if faults:
        raise Failure(f"{program} {'; '.join(faults)}")
    if is_static(target):
        if elf.needed or elf.has_loader:
            raise Failure(f"{program} is not static: it needs {', '.join(elf.needed) or 'a loader'}")
        if elf.stack_bytes < STACK_BYTES:
            raise Failure(f"{program} asks for stacks of {elf.stack_bytes} bytes, fewer than {STACK_BYTES}")
        return "no library"
    strange = [name for name in elf.needed if not GLIBC.fullmatch(name)]
    if strange:
        raise Failure(f"{program} needs {', '.join(strange)}, which are not of glibc")
    asked = [tuple(map(int, name.removeprefix("GLIBC_").split("."))) for name in elf.needed_versions
             if re.fullmatch(r"GLIBC_[0-9.]+", name)]
    allowed = re.search(r"-gnu\.(\d+)\.(\d+)$", target)
    if not asked or allowed is None:
        raise Failure(f"{program} asks for no version of glibc, or {target} names none")
    newest = max(asked)
    if newest[:2] > tuple(map(int, allowed.groups())):
        raise Failure(f"{program} takes functions of glibc {'.'.join(map(str, newest))}, and is for {target}")
    return f"glibc {'.'.join(map(str, newest))}"


# ---- licences

def linked_archives(build_folder: pathlib.Path) -> set[str]:
    """The static libraries that the linker was given for the program."""
    asked = subprocess.run(["ninja", "-C", str(build_folder), "-t", "commands", "vantage_cli"], capture_output=True,
                           text=True, check=True)
    command = next((line for line in reversed(asked.stdout.splitlines()) if "-o bin/vantage" in line), "")
    found = {pathlib.PurePosixPath(word).name for word in command.split() if word.endswith(".a")} - ZIG_ARCHIVES
    if not found:
        raise Failure(f"ninja knows no command in {build_folder} that links static libraries into the program")
    return found


def compiled_headers(build_folder: pathlib.Path) -> set[pathlib.Path]:
    """The headers that sources of the program included; in the same folder there may be wheels."""
    def asked(tool: str, *names: str) -> list[str]:
        command = ["ninja", "-C", str(build_folder), "-t", tool, *names]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    objects = [name for name in asked("inputs", "bin/vantage") if name.endswith(".o")]
    names = {line.strip() for line in asked("deps", *objects) if line.startswith("    ")} if objects else set()
    if not names:
        raise Failure(f"ninja knows of no headers in {build_folder}")
    return {(build_folder / name).resolve() for name in names}


def without_wheels(libraries: dict) -> dict:
    """The list without what is in wheels alone: the bindings, and libraries of wheels that are built without zig."""
    sections = ("built", "installed", "fetched")
    return libraries | {section: [entry for entry in libraries[section] if entry["name"] not in ("nanobind", "robin-map")
                                  and entry.get("only") != "native"] for section in sections}


def is_of_zig(entry: dict) -> bool:
    """Whether zig links it in without being asked."""
    return "archives" not in entry and (entry.get("of_zig", False) or entry.get("only") == "portable")


def write_licences(target: str, build_folder: pathlib.Path, out: pathlib.Path) -> int:
    """The list of all that is in the program, and the texts; how many there are. Fails on what is not listed."""
    prefix = DEPS / f"wheel-{target}" / "prefix"
    libraries = without_wheels(wheel_licences.read_list())
    places = {"deps": str(DEPS.resolve()), "prefix": str(prefix.resolve()),
              "zig": str(DEPS.resolve() / "zig" / "python" / "ziglang" / "lib")}
    strange, by_archive = wheel_licences.unknown_archives(linked_archives(build_folder), libraries)
    folders = wheel_licences.own_folders(build_folder.resolve(), libraries, places)
    strange_headers, by_header = wheel_licences.unknown_headers(compiled_headers(build_folder), folders, libraries)
    if strange or strange_headers:
        raise Failure("the program would contain what scripts/wheel_libraries.toml does not list: "
                      + ", ".join(strange + strange_headers[:10]))
    contained = [entry for entry in wheel_licences.entries(libraries)
                 if entry["name"] in by_archive | by_header or "files" in entry
                 or is_of_zig(entry)]
    if is_static(target):
        contained.append({"name": "musl", "licence": "MIT", "texts": ["{zig}/libc/musl/COPYRIGHT"], "headers": [],
                          "only": "portable", "of_zig": True})
    copyleft = [entry["name"] for entry in contained if wheel_licences.is_copyleft(entry["licence"])]
    if copyleft:
        raise Failure(f"the program would contain what is under no licence but GPL or LGPL: {', '.join(copyleft)}")
    out.mkdir(parents=True)
    rows = ["# name | licence | its text | where the source is"]
    for entry in contained:
        name = entry["name"].replace("/", "-")
        texts = [pathlib.Path(text.format(**places)) for text in entry["texts"]] if "headers" in entry and "texts" in entry \
            else [prefix / "licences" / f"{name}.txt"]
        (out / f"{name}.txt").write_text("\n".join(text.read_text(encoding="utf-8") for text in texts), encoding="utf-8")
        origin = wheel_licences.origin(entry, prefix, "")
        if origin.endswith(": "):
            raise Failure(f"{prefix / 'versions' / entry['package']} is empty: remove {prefix.parent}, and build again")
        rows.append(" | ".join((entry["name"], entry["licence"], f"{name}.txt", origin)))
    (out / wheel_licences.LIST).write_text("\n".join(rows) + "\n", encoding="utf-8")
    return len(contained)


# ---- packing

def put_together(target: str, build_folder: pathlib.Path, start: list[str]) -> pathlib.Path:
    """The folder that the tarball holds. `start`: what starts the program."""
    program = build_folder / "bin" / "vantage"
    prefix = DEPS / f"wheel-{target}" / "prefix"
    root = build_folder.parent / "program" / tarball_name(target)
    shutil.rmtree(root.parent, ignore_errors=True)
    share = root / "share"
    data, doc = share / "vantage", share / "doc" / "vantage"
    for folder in (root / "bin", data, doc, *(share / name for name in (
            "man/man1", "bash-completion/completions", "zsh/site-functions", "fish/vendor_completions.d"))):
        folder.mkdir(parents=True)
    installed = root / "bin" / "vantage"
    shutil.copy(program, installed)
    for folder, ending in (("proj", "*.db"), ("fonts", "*.ttf")):
        (data / folder).mkdir()
        files = list((prefix / "share" / folder).glob(ending))
        if not files:
            raise Failure(f"{prefix / 'share' / folder} has no {ending}")
        for file in files:
            shutil.copy(file, data / folder)
    pages = [PROJECT / "web" / "dist" / name for name in PAGES]
    if not all(page.is_file() for page in pages):
        raise Failure("the page of `vantage view` is not built: run make web first")
    (data / "web").mkdir()
    for page in pages:
        shutil.copy(page, data / "web")
    command = [*start, str(installed)]
    subprocess.run([*command, "docs", "man", str(share / "man" / "man1")], check=True)
    for shell, file in (("bash", "bash-completion/completions/vantage"), ("zsh", "zsh/site-functions/_vantage"),
                        ("fish", "fish/vendor_completions.d/vantage.fish")):
        subprocess.run([*command, "docs", "completion", shell, "-o", str(share / file)], check=True)
    copy_documents(doc)
    count = write_licences(target, build_folder, doc / "third-party")
    print(f"licences: {count} libraries, all listed")
    return root


def copy_documents(folder: pathlib.Path) -> None:
    """What the help of the program names: the documents, without their pictures, two examples, and what judges
    certificates."""
    tracked = subprocess.run(["git", "ls-files", "-z", *DOCUMENTS], cwd=PROJECT, capture_output=True, text=True, check=True).stdout
    for file in filter(None, tracked.split("\0")):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(PROJECT / file, folder / file)


def pack(root: pathlib.Path, tarball: pathlib.Path) -> None:
    """The same bytes for the same files: sorted, of nobody, of one time."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as archive:
        for file in [root, *sorted(root.rglob("*"))]:
            entry = archive.gettarinfo(str(file), file.relative_to(root.parent).as_posix())
            entry.uid = entry.gid = 0
            entry.uname = entry.gname = "root"
            entry.mtime = FIXED_TIME
            entry.mode = 0o755 if file.is_dir() or file.parent.name == "bin" else 0o644
            with file.open("rb") if file.is_file() else io.BytesIO() as content:
                archive.addfile(entry, content)
    half = tarball.with_suffix(".new")
    half.write_bytes(lzma.compress(packed.getvalue(), preset=9 | lzma.PRESET_EXTREME))
    half.replace(tarball)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--targets", nargs="+", default=TARGETS)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    dist = PROJECT / "dist"
    dist.mkdir(exist_ok=True)
    try:
        libraries = wheel_licences.read_list()
        for target in arguments.targets:
            subprocess.run([str(HERE / "build_wheel_libraries.py"), "--target", target, "--jobs", str(arguments.jobs)], check=True)
            print(f"building vantage for {target}", flush=True)
            build_folder = build(target, PROJECT / "build-wheel" / target, arguments.jobs, libraries)
            needs = check_binary(build_folder / "bin" / "vantage", target)
            tarball = dist / f"{tarball_name(target)}.tar.xz"
            pack(put_together(target, build_folder, starter(target, libraries)), tarball)
            print(f"{tarball.stat().st_size / 1e6:.1f} MB  {tarball} (needs {needs})", flush=True)
    except (Failure, wheel_licences.Failure, OSError, KeyError, ValueError, subprocess.CalledProcessError) as error:
        print(f"{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
