#!/usr/bin/env python3
"""Builds the wheel for machines without a native one: python/vantage over the engine in WebAssembly, which wasmtime runs.

    scripts/build_wasm_wheel.py                 dist/vantage-VERSION-py3-none-any.whl, and the same unpacked in build-web/python

Needs build-web/package.wasm (scripts/build_web.sh --package), node and npm. The same input makes the same bytes.
"""

from __future__ import annotations

import base64
import hashlib
import pathlib
import shutil
import subprocess
import sys
import tomllib
import zipfile

from vantage_version import version

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build-web"
WASMTIME = "wasmtime>=50.0.1,<51"
"""Versions whose calls python/wasm uses; it was tried with the lowest."""
# What the engine is made of, as the linker made it; and that exceptions are rewritten, no more.
FEATURES = ["exception-handling", "reference-types", "bulk-memory", "multivalue", "sign-ext", "nontrapping-float-to-int",
            "mutable-globals"]
TIME = (2020, 1, 1, 0, 0, 0)


def engine() -> bytes:
    """The engine with the exceptions of WebAssembly 3.0: Emscripten 3.1.6 writes an older kind."""
    source = BUILD / "package.wasm"
    if not source.exists():
        sys.exit(f"{source} is missing: run scripts/build_web.sh --package")
    tools = BUILD / "tools"
    tools.mkdir(exist_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(ROOT / "python/wasm/tools" / name, tools / name)
    if not (tools / "node_modules/binaryen").is_dir():
        subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--silent"], cwd=tools, check=True)
    made = BUILD / "engine.wasm"
    subprocess.run(["node", tools / "node_modules/binaryen/bin/wasm-opt", *(f"--enable-{name}" for name in FEATURES),
                    "--strip-debug", "--emit-exnref", source, "-o", made], check=True)
    return made.read_bytes()


def metadata(number: str) -> str:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.4", "Name: vantage", f"Version: {number}", f"Summary: {project['description']}",
             f"License-Expression: {project['license']}", f"Requires-Python: {project['requires-python']}",
             f"Keywords: {','.join(project['keywords'])}", "Description-Content-Type: text/markdown"]
    lines += [f"License-File: {name}" for name in project["license-files"]]
    lines += [f"Classifier: {one}" for one in project["classifiers"]
              if not one.startswith(("Operating System", "Programming Language :: C++"))]
    lines += [f"Requires-Dist: {one}" for one in [*project["dependencies"], WASMTIME]]
    for extra, needs in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {one}; extra == "{extra}"' for one in needs)]
    return "\n".join(lines) + "\n\n" + (ROOT / "python/wasm/README.md").read_text()


def files(number: str) -> dict[str, bytes]:
    """All files of the wheel but its list of them."""
    made = {}
    for folder in (ROOT / "python/vantage", ROOT / "python/wasm/vantage"):
        for path in sorted(folder.rglob("*")):
            if path.is_file() and path.suffix in (".py", ".typed"):
                made[f"vantage/{path.relative_to(folder).as_posix()}"] = path.read_bytes()
    made["vantage/_core/engine.wasm"] = engine()
    info = f"vantage-{number}.dist-info"
    made[f"{info}/METADATA"] = metadata(number).encode()
    made[f"{info}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: build_wasm_wheel\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    for name in ("LICENSE", "THIRD-PARTY-NOTICES.txt"):
        made[f"{info}/licenses/{name}"] = (ROOT / name).read_bytes()
    for name, path in licences().items():
        made[f"{info}/licenses/third-party/{name}"] = path.read_bytes()
    return made


def licences() -> dict[str, pathlib.Path]:
    """Texts that the notices name, of what is compiled into the engine."""
    fetched = ROOT / ".deps"
    return {"LICENSE.Manifold": fetched / "manifold/LICENSE", "LICENSE.CDT": fetched / "cdt/LICENSE",
            "LICENSE.CDT-predicates": fetched / "cdt/LICENSE-predicates.txt", "LICENSE.CDT-LLVM": fetched / "cdt/LICENSE-LLVM.txt",
            "LICENSE.yaml-cpp": fetched / "web/yaml-cpp/LICENSE", "LICENSE.zlib": fetched / "web/zlib/LICENSE"}


def write(target: pathlib.Path, made: dict[str, bytes], number: str) -> None:
    record = f"vantage-{number}.dist-info/RECORD"
    rows = []
    for name, data in made.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        rows.append(f"{name},sha256={digest},{len(data)}\n")
    partial = target.with_suffix(".part")
    with zipfile.ZipFile(partial, "w") as wheel:
        for name, data in [*made.items(), (record, ("".join(rows) + f"{record},,\n").encode())]:
            entry = zipfile.ZipInfo(name, TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            wheel.writestr(entry, data, compresslevel=9)
    partial.replace(target)


def main() -> None:
    number = version()
    made = files(number)
    target = ROOT / "dist" / f"vantage-{number}-py3-none-any.whl"
    target.parent.mkdir(exist_ok=True)
    write(target, made, number)
    unpacked = BUILD / "python"
    shutil.rmtree(unpacked, ignore_errors=True)
    with zipfile.ZipFile(target) as wheel:
        wheel.extractall(unpacked)
    print(f"{target.relative_to(ROOT)}: {target.stat().st_size} bytes; the engine: {len(made['vantage/_core/engine.wasm'])} bytes")


if __name__ == "__main__":
    main()
