"""What modules for Python on Windows are compiled and linked with: headers, and the import library of python3.dll, from the
source of a Python in Debian's archive.
"""

import pathlib
import re
import shutil
import subprocess
import tarfile

from debian_archive import Failure, fetch

LIBRARY = "python3.dll"  # of the stable ABI: it hands calls on to the library of each version


def stable_names(text: str) -> list[str]:
    """The lines of a .def file for all that the stable ABI of a Python has: of PC/python3dll.c."""
    found = re.findall(r"^EXPORT_(FUNC|DATA)\((\w+)\)", text, re.MULTILINE)
    if not found:
        raise Failure("PC/python3dll.c lists no functions")
    return [name + (" DATA" if kind == "DATA" else "") for kind, name in found]


def unpack(archive: pathlib.Path, into: pathlib.Path) -> None:
    """The headers with pyconfig.h for Windows, and PC/python3dll.c."""
    with tarfile.open(archive) as tar:
        for member in tar:
            _, _, name = member.name.partition("/")
            place = {"PC/pyconfig.h.in": "include/pyconfig.h", "PC/python3dll.c": "python3dll.c"}.get(name)
            if name.startswith("Include/") and name.endswith(".h"):
                place = "include/" + name.removeprefix("Include/")
            file = tar.extractfile(member) if place else None
            if place and file:
                (into / place).parent.mkdir(parents=True, exist_ok=True)
                (into / place).write_bytes(file.read())


def prepare(source: dict, downloads: pathlib.Path, folder: pathlib.Path, zig: pathlib.Path) -> tuple[pathlib.Path, pathlib.Path]:
    """The folder of the headers, and the import library. Does nothing when they are there."""
    archive = fetch(source["source"], source["source_sha256"], downloads)
    into = folder / archive.name.removesuffix(".orig.tar.xz")
    library = into / "libpython3.a"
    if not into.exists():
        half = into.with_suffix(".new")
        shutil.rmtree(half, ignore_errors=True)
        half.mkdir(parents=True)
        unpack(archive, half)
        names = stable_names((half / "python3dll.c").read_text(encoding="utf-8"))
        (half / "python3.def").write_text("\n".join([f"LIBRARY {LIBRARY}", "EXPORTS", *names]) + "\n", encoding="utf-8")
        subprocess.run([str(zig), "dlltool", "-m", "i386:x86-64", "-D", LIBRARY, "-d", str(half / "python3.def"),
                        "-l", str(half / "libpython3.a")], check=True)
        half.rename(into)
    return into / "include", library
