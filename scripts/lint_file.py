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


def fingerprint(build, file):
    words, folder = command_of(build, file)
    # From the first option on: before it stand the compiler and what launches it.
    first = next(i for i, word in enumerate(words) if word.startswith("-") and i > 0 and words[i - 1].endswith("++"))
    options, skip = [], False
    for word in words[first:]:
        if skip or word in ("-c", "-MD", file):
            skip = False
        elif word in ("-o", "-MT", "-MF"):
            skip = True
        else:
            options.append(word)
    text = subprocess.run(["clang++", *options, "-E", "-CC", "-P", file], cwd=folder, check=True, capture_output=True,
                          timeout=TIMEOUT_S).stdout
    root = str(pathlib.Path(__file__).resolve().parents[1]).encode()
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
    rules = (pathlib.Path(__file__).resolve().parents[1] / ".clang-tidy").read_bytes()
    return hashlib.sha256(b"\0".join([text.replace(root, b""), version, rules])).hexdigest()


def main():
    build, file = pathlib.Path(sys.argv[1]), sys.argv[2]
    cache = pathlib.Path(os.environ.get("VANTAGE_LINT_CACHE", pathlib.Path.home() / ".cache" / "vantage-lint"))
    try:
        clean = cache / fingerprint(build, file)
    except (subprocess.SubprocessError, OSError, KeyError, StopIteration):
        clean = None  # it is checked every time then, and clang-tidy itself says what is wrong
    if clean and clean.exists():
        return 0
    result = subprocess.run(["clang-tidy", "--quiet", "-p", str(build), file], timeout=TIMEOUT_S)
    if result.returncode == 0 and clean:
        cache.mkdir(parents=True, exist_ok=True)
        clean.touch()
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
