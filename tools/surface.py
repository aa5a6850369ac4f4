#!/usr/bin/env python3
"""Lists what users of vantage rely on: commands, options, exit codes, keys, members of JSON, names in Python.

    tools/surface.py PROGRAM > before.txt
    tools/surface.py PROGRAM --outputs FOLDER > before.txt        FOLDER: of tools/result_hashes.py --keep

A line each, sorted, so that diff shows what a change took away or added. Members of JSON are those of the outputs in
FOLDER: the more cases it has, the more it knows. Names in Python are those that the package exports, with the parameters of
functions and the members of classes.
"""

import argparse
import ast
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "vantage"


def run(program: str, *arguments: str) -> str:
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout


def commands(program: str) -> set[str]:
    top = run(program, "--help")
    names = re.findall(r"^  ([a-z-]+) ", top[top.index("Subcommands:"):top.index("EXAMPLES")], re.M)
    lines = {f"exit code {line.strip()}" for line in top[top.index("EXIT CODES"):].splitlines()[1:]}
    for name in names:
        text = run(program, name, "--help")
        head = text.split("EXAMPLES")[0]
        lines |= {f"command {name} {' '.join(option.split())}" for option in
                  re.findall(r"^  ((?:-\w,)?--[a-z-]+(?: [A-Z][^ ]*)?|[a-z]+ [A-Z\[][^ ]*)  ", head, re.M)}
    return lines | {f"command {name}" for name in names}


def keys(program: str) -> set[str]:
    return {f"key {line}" for line in run(program, "keys").splitlines() if line and not line.startswith(" ")}


def members(value, path: str) -> set[str]:
    if isinstance(value, dict):
        return {m for key, entry in value.items() for m in {f"{path}.{key}"} | members(entry, f"{path}.{key}")}
    return {m for entry in value for m in members(entry, path + "[]")} if isinstance(value, list) else set()


def json_members(folder: pathlib.Path) -> set[str]:
    found = set()
    for file in folder.rglob("*"):
        if not file.is_file() or file.suffix not in (".json", ".out", ".plan", ".czml", ".geojson", ".cert"):
            continue
        try:
            value = json.loads(file.read_text(encoding="utf-8"))
        except ValueError:
            continue
        kind = file.name.split()[0].removesuffix(".out") if file.suffix == ".out" else file.suffix[1:]
        found |= members(value, f"json {kind} ")
    return found


def python_names() -> set[str]:
    init = (PACKAGE / "__init__.py").read_text(encoding="utf-8")
    exported = ast.literal_eval(re.search(r"^__all__ = (\[.*?\])", init, re.M | re.S)[1])
    found = {f"python {name}" for name in exported}
    for file in PACKAGE.glob("*.py"):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or node.name not in exported:
                continue
            for one in node.body if isinstance(node, ast.ClassDef) else [node]:
                within = f"{node.name}." if one is not node else ""
                if isinstance(one, ast.FunctionDef) and (one.name == "__init__" or not one.name.startswith("_")):
                    found.add(f"python {within}{one.name}({ast.unparse(one.args)})")
                elif isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name):
                    found.add(f"python {within}{one.target.id}")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--outputs", type=pathlib.Path)
    arguments = parser.parse_args()
    lines = commands(arguments.program) | keys(arguments.program) | python_names()
    if arguments.outputs:
        lines |= json_members(arguments.outputs)
    print("\n".join(sorted(lines)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
