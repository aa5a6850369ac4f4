#!/usr/bin/env python3
"""Fetches the sources that the engine of the page is compiled with besides its own, into .deps/web/: libraries that a
program for WebAssembly cannot take from Debian's packages. Does nothing when they are there.

The sources come from the archive that apt uses on this machine, pinned by hash.
"""

import hashlib
import pathlib
import shutil
import sys
import tarfile

from debian_archive import Failure, fetch

FOLDER = pathlib.Path(__file__).resolve().parent.parent / ".deps" / "web"

# Folder, file of the pool, its SHA-256. Licences: MIT, Zlib.
SOURCES = [
    ("yaml-cpp", "pool/main/y/yaml-cpp/yaml-cpp_0.7.0+dfsg.orig.tar.xz",
     "dc63708605404e0b963e0ca3a9619d1c8270eda2839603e6fa0384e5e51e5312"),
    ("zlib", "pool/main/z/zlib/zlib_1.2.13.dfsg.orig.tar.bz2",
     "71feb7947e3c00ef125f83b79a4e529bde31171e5babe48b391f06758d1ab0a1"),
]


def put(name: str, path: str, sha256: str) -> None:
    downloads, unpacked = FOLDER / "downloads", FOLDER / "unpacked"
    for folder in (FOLDER / name, unpacked):
        shutil.rmtree(folder, ignore_errors=True)
    downloads.mkdir(parents=True, exist_ok=True)
    unpacked.mkdir()
    with tarfile.open(fetch(path, sha256, downloads)) as tar:
        tar.extractall(unpacked, filter="data") if hasattr(tarfile, "data_filter") else tar.extractall(unpacked)
    (top,) = unpacked.iterdir()
    top.rename(FOLDER / name)
    unpacked.rmdir()


def main() -> int:
    stamp = FOLDER / f"{hashlib.sha256(repr(SOURCES).encode()).hexdigest()[:16]}.stamp"
    if stamp.exists():
        return 0
    print("fetching sources into .deps/web/", flush=True)
    try:
        for source in SOURCES:
            put(*source)
    except (Failure, OSError, tarfile.TarError) as error:
        print(error, file=sys.stderr)
        return 1
    stamp.touch()
    return 0


if __name__ == "__main__":
    sys.exit(main())
