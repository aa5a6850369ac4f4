#!/usr/bin/env python3
"""Writes, beside a file of requirements, the file that scripts install from: every package that these need, with its
version and the hash of the file that pip takes on this machine.

    pin_python.py python/requirements.txt [FILE...]

For those who change requirements. Run it with CPython 3.11 on x86-64 Linux, for which the project is built. pip works out
the versions, and installs nothing.
"""

import json
import pathlib
import re
import subprocess
import sys


def resolved(requirements: pathlib.Path) -> dict[str, tuple[str, str]]:
    """Of each package that they need its version and the SHA-256 of its file."""
    command = [sys.executable, "-m", "pip", "install", "--disable-pip-version-check", "--dry-run", "--ignore-installed",
               "--quiet", "--only-binary=:all:", "--report", "-", "--requirement", str(requirements)]
    report = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)
    found = {}
    for package in report["install"]:
        name = re.sub(r"[-_.]+", "-", package["metadata"]["name"]).lower()
        found[name] = package["metadata"]["version"], package["download_info"]["archive_info"]["hashes"]["sha256"]
    return found


def main() -> int:
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    for file in map(pathlib.Path, sys.argv[1:]):
        packages = resolved(file)
        lines = [f"# Made by scripts/pin_python.py from {file.name}: CPython 3.11, x86-64 Linux."]
        for name, (version, sha256) in sorted(packages.items()):
            lines += [f"{name}=={version} --hash=sha256:{sha256}"]
        file.with_suffix(".lock").write_text("\n".join(lines) + "\n", encoding="utf-8")
        print(f"{file.with_suffix('.lock')}: {len(packages)} packages")
    return 0


if __name__ == "__main__":
    sys.exit(main())
