#!/usr/bin/env python3
"""Checks one source file with clang-tidy, unless the same text was found clean before.

    lint_file.py BUILD_FOLDER FILE     exit 1 on a finding

What is compared is the preprocessed text with its comments (NOLINT lives in them), without the paths of the folder that
it was compiled in, the rules, and clang-tidy's version.
"""

import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys

TIMEOUT_S = 600


def command_of(build, file):
    """The compiler's arguments for `file`, and the folder that they count from."""
    for entry in json.loads((build / "compile_commands.json").read_text()):
        if entry["file"] == file:
            return shlex.split(entry["command"]), entry["directory"]
    raise SystemExit(f"{file} is not among the compile commands")


def options_of(build, file):
    """The compiler's options for `file`, without output files; and the folder."""
    words, folder = command_of(build, file)
    # From the first option on: before it stand the compiler and what launches it.
    first = next(i for i, word in enumerate(words) if word.startswith("-") and i > 0 and words[i - 1].endswith("++"))
    options, skip = [], 0
    for i, word in enumerate(words[first:], first):
        if skip > 0:
            skip -= 1
        elif word in ("-o", "-MT", "-MF"):
            skip = 1
        elif word not in ("-c", "-MD", file):
            options.append(word)
    return [*options, "-Wno-unknown-warning-option"], folder  # they may be another compiler's


def fingerprint(options, folder, file, checks):
    text = subprocess.run(["clang++", *options, "-E", "-CC", "-P", file], cwd=folder, check=True, capture_output=True,
                          timeout=TIMEOUT_S).stdout
    root = str(pathlib.Path(__file__).resolve().parents[1]).encode()
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
    rules = (pathlib.Path(__file__).resolve().parents[1] / ".clang-tidy").read_bytes()
    return hashlib.sha256(b"\0".join([text.replace(root, b""), version, rules, checks.encode()])).hexdigest()


def main():
    build, file = pathlib.Path(sys.argv[1]), sys.argv[2]
    checks = ""
    cache = pathlib.Path(os.environ.get("VANTAGE_LINT_CACHE", pathlib.Path.home() / ".cache" / "vantage-lint"))
    options, folder = options_of(build, file)
    if "/Unity/" in file:  # made by CMake, and joins several sources, whose names shadow each other's
        options.append("-Wno-shadow")
        checks = "-bugprone-suspicious-include"
    try:
        clean = cache / fingerprint(options, folder, file, checks)
    except (subprocess.SubprocessError, OSError):
        clean = None  # it is checked every time then, and clang-tidy itself says what is wrong
    if clean and clean.exists():
        return 0
    # Named: what joins several sources lies in the folder of the build, which may be anywhere.
    rules = f"--config-file={pathlib.Path(__file__).resolve().parents[1] / '.clang-tidy'}"
    command = ["clang-tidy", "--quiet", rules, *([f"--checks={checks}"] if checks else []), file, "--", *options]
    result = subprocess.run(command, cwd=folder, timeout=TIMEOUT_S)
    if result.returncode == 0 and clean:
        cache.mkdir(parents=True, exist_ok=True)
        clean.touch()
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
