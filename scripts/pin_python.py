#!/usr/bin/env python3
"""Writes, beside a file of requirements, the lock that scripts install from: every package that these need, with its
version and the hashes of its files for each Python and processor of MACHINES.

    pin_python.py python/requirements.txt [FILE...]
    pin_python.py --into FOLDER python/requirements.txt     for this Python and processor alone, as FOLDER/requirements.lock

For those who change requirements. Run it with CPython 3.11 on x86-64 Linux, for which the versions are worked out (for the
Python of Debian 12); the second form runs with any Python. pip works out the versions, and installs nothing.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

DEBIAN = "3.11.2"  # the Python of Debian 12; some packages need a later 3.11
MACHINES = [(python, processor) for processor in ("x86_64", "aarch64") for python in (DEBIAN, "3.12", "3.13")]
"""For which the lock has hashes."""
MISSING = re.compile(r"No matching distribution found for ([\w.-]+)==")


def pip_report(requirements: pathlib.Path, *options: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "pip", "install", "--disable-pip-version-check", "--dry-run", "--ignore-installed",
               "--quiet", "--only-binary=:all:", "--report", "-", *options, "--requirement", str(requirements)]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)


def packages_of(report: str) -> dict[str, tuple[str, str]]:
    """Of each package its version and the SHA-256 of its file."""
    found = {}
    for package in json.loads(report)["install"]:
        name = re.sub(r"[-_.]+", "-", package["metadata"]["name"]).lower()
        found[name] = package["metadata"]["version"], package["download_info"]["archive_info"]["hashes"]["sha256"]
    return found


def resolved(requirements: pathlib.Path, *options: str) -> dict[str, tuple[str, str]]:
    """What they need, on this machine unless the options say another."""
    result = pip_report(requirements, *options)
    if result.returncode:
        sys.exit(result.stderr)
    return packages_of(result.stdout)


def platforms(processor: str) -> list[str]:
    """The names of systems whose files run on Debian 12 with that processor."""
    return [f"manylinux_2_{minor}_{processor}" for minor in range(36, 4, -1)] + [f"manylinux2014_{processor}",
                                                                                 f"linux_{processor}"]


def options_for(python: str, processor: str) -> list[str]:
    """For pip to look for another machine's files. It asks for a folder then, which it does not use."""
    options = ["--implementation", "cp", "--python-version", python, "--target", "unused"]
    for platform in platforms(processor):
        options += ["--platform", platform]
    return options


def hashes_for(versions: dict[str, str], python: str, processor: str) -> tuple[dict[str, str], list[str]]:
    """The hash of each package's file for another machine, and the packages that have none for it."""
    options = ["--no-deps", *options_for(python, processor)]
    versions, missing = dict(versions), []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "pins.txt"
        while True:
            file.write_text("".join(f"{name}=={version}\n" for name, version in versions.items()), encoding="utf-8")
            result = pip_report(file, *options)
            if result.returncode == 0:
                return {name: sha256 for name, (_, sha256) in packages_of(result.stdout).items()}, missing
            told = MISSING.search(result.stderr)
            if told is None or versions.pop(told[1], None) is None:
                sys.exit(result.stderr)
            missing.append(told[1])


def lines_of(versions: dict[str, str], hashes: dict[str, set[str]]) -> list[str]:
    return [" ".join([f"{name}=={version}", *(f"--hash=sha256:{sha256}" for sha256 in sorted(hashes[name]))])
            for name, version in sorted(versions.items())]


def with_all_machines(versions: dict[str, str], hashes: dict[str, set[str]]) -> None:
    """Adds what MACHINES take."""
    for python, processor in MACHINES:
        found, missing = hashes_for(versions, python, processor)
        for name, sha256 in found.items():
            hashes[name].add(sha256)
        for name in missing:
            print(f"{name}: no file for CPython {python} on {processor}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("--into", type=pathlib.Path)
    arguments = parser.parse_args()
    for file in arguments.files:
        packages = resolved(file, *(options_for(DEBIAN, "x86_64") if arguments.into is None else []))
        versions = {name: version for name, (version, _) in packages.items()}
        hashes = {name: {sha256} for name, (_, sha256) in packages.items()}
        machines = "this machine"
        if arguments.into is None:
            with_all_machines(versions, hashes)
            machines = "CPython 3.11 to 3.13, x86-64 and aarch64 Linux"
        lock = (arguments.into or file.parent) / f"{file.stem}.lock"
        lock.write_text("\n".join([f"# Made by scripts/pin_python.py from {file.name}: {machines}.",
                                   *lines_of(versions, hashes)]) + "\n", encoding="utf-8")
        print(f"{lock}: {len(packages)} packages")
    return 0


if __name__ == "__main__":
    sys.exit(main())
