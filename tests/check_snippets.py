#!/usr/bin/env python3
"""Compiles and runs the snippets of the documents: README.md, CONTRIBUTING.md and docs/.

    check_snippets.py --program build/bin/vantage [--library FILE... --compiler C++ --include FOLDER...] [ROOT] [FILE...]
    check_snippets.py --self-test

Each fenced block has a language:

- sh      runs in bash, in a scratch folder with a copy of examples/ and of the missions of docs/. The blocks of a document
          share the folder. `vantage` and `build/bin/vantage` are the program that was built. It must end with code 0.
- cpp     is compiled against the public headers. A block with main() is linked and run in the folder examples/plaza.
- python  runs in the same folder as sh.
- yaml, text, json, csv, cmake   are not run.
- {...}                          is of the site: `make site` runs the cells of tutorials.

A comment on the line before the block says what is different:

    <!-- snippet: fragment -->              C++ statements; they are compiled inside a function
    <!-- snippet: not run: REASON -->       what it needs that is not there
    <!-- snippet: exit 2 -->                sh: the exit code that it must end with
    <!-- snippet: mission in FOLDER -->     yaml: a mission, computed as if it lay in FOLDER
    <!-- snippet: mission keys -->          yaml: a mission or a part of one, whose files are absent: all its keys are known
    <!-- snippet: configuration keys -->    yaml: the same of a file for `vantage spheres`

Indented blocks may not hold commands of vantage: nobody would run them.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

FENCE = re.compile(r"^(\s*)```(\w*|\{.*)\s*$")
MARK = re.compile(r"^\s*<!-- snippet: (.*?) -->\s*$")
INDENTED_COMMAND = re.compile(r"^    (?:\S*/)?vantage [a-z-]|^    python3 ")
LANGUAGES = {"sh", "cpp", "python", "yaml", "text", "json", "csv", "cmake"}
MARKS = {"sh": r"not run: \S.*|exit \d+", "cpp": r"not run: \S.*|fragment", "python": r"not run: \S.*",
         "yaml": r"mission in \S+|mission keys|configuration keys"}
# What a part of a mission lacks.
MISSION = {"scene": "{osm: absent.osm}", "target": "{point: [0, 0, 9]}", "sensor": "{max_range: 9}"}
SECONDS_A_BLOCK = 120
# Lines that need OpenGL are left out where there is none.
NEEDS_OPENGL = re.compile(r"vantage render\b")


class Snippet(NamedTuple):
    place: str  # "README.md:15"
    language: str
    mark: str  # empty without one
    text: str


class Tools(NamedTuple):
    program: pathlib.Path | None = None
    libraries: tuple[pathlib.Path, ...] = ()
    compiler: str = "c++"
    includes: tuple[str, ...] = ()


def snippets(text: str, name: str) -> tuple[list[Snippet], list[str]]:
    """The fenced blocks of a document, and what is wrong with them."""
    found, problems = [], []
    lines = text.splitlines()
    mark, position = "", 0
    while position < len(lines):
        line, place = lines[position], f"{name}:{position + 1}"
        position += 1
        if INDENTED_COMMAND.match(line):
            problems.append(f"{place}: commands belong into a fenced block: ```sh")
        marked = MARK.match(line)
        fence = FENCE.match(line)
        if not fence:
            if mark and not marked:
                problems.append(f"{place}: no block follows the mark '{mark}'")
            mark = marked[1] if marked else ""
            continue
        indent, language = fence[1], fence[2]
        body = []
        while position < len(lines) and lines[position].strip() != "```":
            body.append(lines[position].removeprefix(indent))
            position += 1
        if position == len(lines):
            problems.append(f"{place}: the block does not end")
        position += 1
        if language.startswith("{"):
            pass
        elif language not in LANGUAGES:
            problems.append(f"{place}: '{language}' is none of {', '.join(sorted(LANGUAGES))}")
        elif mark and not re.fullmatch(MARKS.get(language, ""), mark):
            problems.append(f"{place}: the mark '{mark}' says nothing of a block of {language}")
        else:
            found.append(Snippet(place, language, mark, "\n".join(body) + "\n"))
        mark = ""
    return found, problems


def run(command: list[str], folder: pathlib.Path, environment: dict[str, str]) -> tuple[int, str]:
    try:
        result = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS_A_BLOCK, check=False)
    except subprocess.TimeoutExpired:
        return -1, f"not done after {SECONDS_A_BLOCK} s"
    return result.returncode, result.stdout


class Checker:
    """Runs the snippets of one document after another, each in a scratch folder of its own."""

    def __init__(self, root: pathlib.Path, tools: Tools, scratch: pathlib.Path):
        self.root, self.tools, self.scratch = root, tools, scratch
        self.environment = os.environ | {"VANTAGE_PROGRESS": "never"}  # what is said of it is no part of a block's output
        self.has_opengl = False
        if tools.program:
            self.environment["PATH"] = f"{tools.program.parent}:{os.environ['PATH']}"
            self.has_opengl = run([str(tools.program), "devices", "--device", "opengl"], scratch, self.environment)[0] == 0

    def folder_for(self, document: str) -> pathlib.Path:
        folder = self.scratch / document.replace("/", "_")
        folder.mkdir()
        if (self.root / "examples").is_dir():
            shutil.copytree(self.root / "examples", folder / "examples")
        for mission in sorted((self.root / "docs").rglob("*.yaml")):
            copy = folder / mission.relative_to(self.root)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(mission, copy)
        (folder / "build" / "bin").mkdir(parents=True)
        if self.tools.program:
            (folder / "build" / "bin" / "vantage").symlink_to(self.tools.program)
        return folder

    def check(self, snippet: Snippet, folder: pathlib.Path) -> str:
        """What went wrong; empty if nothing did."""
        if snippet.language == "cpp":
            return self.check_cpp(snippet, folder)
        if snippet.mark.endswith(" keys"):
            return self.check_keys(snippet, folder)
        if snippet.language == "yaml":
            mission = folder / snippet.mark.removeprefix("mission in ") / "snippet.yaml"
            mission.write_text(snippet.text, encoding="utf-8")
            command, expected = ["vantage", "compute", str(mission), "-o", "snippet.ply", "-q"], 0
        elif snippet.language == "python":
            command, expected = [sys.executable, "-c", snippet.text], 0
        else:
            lines = snippet.text.splitlines()
            text = "\n".join(line for line in lines if self.has_opengl or not NEEDS_OPENGL.search(line))
            command = ["bash", "-e", "-o", "pipefail", "-c", text]
            expected = int(snippet.mark.removeprefix("exit ")) if snippet.mark else 0
        code, output = run(command, folder, self.environment)
        return "" if code == expected else f"ended with {code}, not {expected}\n{output}"

    def check_keys(self, snippet: Snippet, folder: pathlib.Path) -> str:
        """Keys are read before files: the one complaint is that a file is missing."""
        text = snippet.text
        is_mission = snippet.mark == "mission keys"
        for key, value in MISSION.items() if is_mission else ():
            if not re.search(rf"^{key}{'s?' if key == 'target' else ''}:", text, re.MULTILINE):
                text += f"{key}: {value}\n"
        file = folder / "keys.yaml"
        file.write_text(text, encoding="utf-8")
        command = ["compute", str(file), "-o", "keys.ply"] if is_mission else ["spheres", "-c", str(file)]
        code, output = run(["vantage", *command], folder, self.environment)
        return "" if code == 2 and "does not exist" in output.split("\n")[0] else f"ended with {code}\n{output}"

    def check_cpp(self, snippet: Snippet, folder: pathlib.Path) -> str:
        text = snippet.text
        if snippet.mark == "fragment":
            includes = "".join(f'#include "vantage/{h.name}"\n' for h in sorted((self.root / "include/vantage").glob("*.h")))
            text = f"{includes}void snippet() {{\n{text}}}\n"
        source = folder / "snippet.cpp"
        source.write_text(text, encoding="utf-8")
        command = [self.tools.compiler, "-std=c++20", str(source), f"-I{self.root / 'include'}"]
        command += [f"-isystem{include}" for include in self.tools.includes]
        is_program = re.search(r"\bint main\(", text) and self.tools.libraries
        if not is_program:
            code, output = run([*command, "-fsyntax-only"], folder, self.environment)
            return "" if code == 0 else f"does not compile\n{output}"
        command += ["-o", str(folder / "snippet"), *map(str, self.tools.libraries)]
        command += [f"-Wl,-rpath,{place}" for place in sorted({library.parent for library in self.tools.libraries})]
        code, output = run(command, folder, self.environment)
        if code != 0:
            return f"does not compile\n{output}"
        code, output = run([str(folder / "snippet")], folder / "examples" / "plaza", self.environment)
        return "" if code == 0 else f"ended with {code}\n{output}"

    def check_document(self, document: str) -> tuple[list[str], int, int]:
        """The problems, and how many blocks were run and not run."""
        blocks, problems = snippets((self.root / document).read_text(encoding="utf-8"), document)
        folder = self.folder_for(document)
        done = left = 0
        for block in blocks:
            is_run = block.language in ("sh", "cpp", "python") or block.mark
            if not is_run:
                continue
            if block.mark.startswith("not run"):
                left += 1
                print(f"  {block.place}: {block.mark}")
                continue
            start = time.monotonic()
            problem = self.check(block, folder)
            done += 1
            print(f"  {block.place}: {block.language}, {time.monotonic() - start:.1f} s", flush=True)
            if problem:
                problems.append(f"{block.place}: {problem}")
        return problems, done, left


def documents(root: pathlib.Path) -> list[str]:
    files = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    return [file.relative_to(root).as_posix() for file in files if file.is_file()]


# (document, what is said of it; empty: nothing)
SELF_TEST = [
    ("```sh\ntrue\n```\n", ""),
    ("```sh\nfalse\ntrue\n```\n", "ended with 1, not 0"),
    ("```sh\nfalse | true\n```\n", "ended with 1, not 0"),
    ("<!-- snippet: exit 2 -->\n```sh\nexit 2\n```\n", ""),
    ("<!-- snippet: exit 2 -->\n```sh\ntrue\n```\n", "ended with 0, not 2"),
    ("<!-- snippet: not run: it needs a map -->\n```sh\nfalse\n```\n", ""),
    ("<!-- snippet: not run -->\n```sh\nfalse\n```\n", "says nothing"),
    ("<!-- snippet: fragment -->\n\n```sh\ntrue\n```\n", "no block follows"),
    ("<!-- snippet: fragment -->\n```sh\ntrue\n```\n", "says nothing"),
    ("```sh\ntest $VANTAGE_PROGRESS = never\n```\n", ""),
    ("```sh\ntouch a\n```\n```sh\ntest -e a\n```\n", ""),
    ("```python\nprint(1)\n```\n", ""),
    ("```python\nraise SystemExit(3)\n```\n", "ended with 3"),
    ("- item\n\n  ```sh\n  true\n  ```\n", ""),
    ("```\ntrue\n```\n", "is none of"),
    ("```sh\ntrue\n", "does not end"),
    ("    vantage compute mission.yaml -o volume.ply\n", "fenced block"),
    ("    vantage: unknown key\n", ""),
    ("```cpp\n#include <vector>\nstd::vector<int> v;\n```\n", ""),
    ("```cpp\nint x = y;\n```\n", "does not compile"),
    ("<!-- snippet: fragment -->\n```cpp\nint x = 1;\nx += 1;\n```\n", ""),
    ("<!-- snippet: fragment -->\n```cpp\nx += 1;\n```\n", "does not compile"),
]


def self_test(tools: Tools) -> list[str]:
    wrong = []
    for number, (text, expected) in enumerate(SELF_TEST):
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            (root / "docs").mkdir()
            (root / "work").mkdir()
            (root / "docs" / "a.md").write_text(text, encoding="utf-8")
            problems = Checker(root, tools, root / "work").check_document("docs/a.md")[0]
        if bool(problems) != bool(expected) or any(expected not in problem for problem in problems):
            wrong.append(f"case {number}: expected '{expected}', got {problems}")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description="Compiles and runs the snippets of the documents.")
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent)
    parser.add_argument("files", nargs="*", help="documents, as paths from ROOT; default: all")
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--library", type=pathlib.Path, action="append", default=[])
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("--include", action="append", default=[])
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    tools = Tools(arguments.program and arguments.program.resolve(), tuple(file.resolve() for file in arguments.library),
                  arguments.compiler, tuple(filter(None, arguments.include)))
    if arguments.self_test:
        problems = self_test(tools)
        print("\n".join(problems) if problems else "the check notices what it should")
        return 1 if problems else 0
    if not tools.program:
        parser.error("--program is missing")
    problems, done, left = [], 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        checker = Checker(arguments.root.resolve(), tools, pathlib.Path(scratch))
        if not checker.has_opengl:
            print("no OpenGL: lines with 'vantage render' are left out")
        for document in arguments.files or documents(arguments.root):
            more, run_here, left_here = checker.check_document(document)
            problems, done, left = problems + more, done + run_here, left + left_here
    print("\n".join(problems))
    print(f"snippets: {done} compiled or run, {left} not run, {len(problems)} problems")
    return 1 if problems or done == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
