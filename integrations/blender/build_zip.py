#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the add-on: one zip for Blender 3.4 and newer, which 4.2 and newer also take as an extension.

    build_zip.py [-o dist/vantage_blender.zip] [--wheel dist/vantage-...whl]

With --wheel the package itself is in it: Blender 4.2 and newer installs it with the extension, where the wheel fits its
Python and its system. Older ones ignore it. The same sources give the same bytes.
"""

import argparse
import ast
import os
import pathlib
import re
import sys
import tomllib
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FOLDER = HERE / "vantage_blender"


def versions():
    """The version in every place that states it."""
    header = (ROOT / "include" / "vantage" / "version.h").read_text(encoding="utf-8")
    module = ast.parse((FOLDER / "__init__.py").read_text(encoding="utf-8"))
    info = next(ast.literal_eval(node.value) for node in module.body
                if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
    manifest = tomllib.loads((FOLDER / "blender_manifest.toml").read_text(encoding="utf-8"))
    return {"include/vantage/version.h": re.search(r'VANTAGE_VERSION "([^"]+)"', header)[1],
            "__init__.py": ".".join(map(str, info["version"])), "blender_manifest.toml": manifest["version"]}


def files(wheel):
    """(name in the zip, bytes), in order."""
    found = {f"vantage_blender/{file.name}": file.read_bytes() for file in FOLDER.iterdir()
             if file.suffix in (".py", ".toml") or file.name == "LICENSE"}
    if wheel:
        manifest = found["vantage_blender/blender_manifest.toml"].decode()
        line = f'wheels = ["./wheels/{wheel.name}"]\n'
        found["vantage_blender/blender_manifest.toml"] = manifest.replace("\n[permissions]", f"{line}\n[permissions]").encode()
        found[f"vantage_blender/wheels/{wheel.name}"] = wheel.read_bytes()
    return sorted(found.items())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "dist" / "vantage_blender.zip")
    parser.add_argument("--wheel", type=pathlib.Path)
    arguments = parser.parse_args()
    stated = versions()
    if len(set(stated.values())) != 1:
        sys.exit(f"the versions differ: {stated}")
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    part = arguments.output.with_suffix(".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, data in files(arguments.wheel):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, data, zipfile.ZIP_DEFLATED)
    os.replace(part, arguments.output)
    print(f"add-on: {arguments.output}")


main()
