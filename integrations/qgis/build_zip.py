#!/usr/bin/env python3
"""Makes the zip that QGIS installs (Plugins > Manage and Install Plugins > Install from ZIP).

    build_zip.py [FOLDER]      writes FOLDER/vantage_processing-VERSION.zip (default: dist/), the same bytes each time
"""

import argparse
import configparser
import pathlib
import sys
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parent.parent
PLUGIN = HERE / "vantage_processing"
_ENDINGS = (".py", ".svg", ".txt")
_TIME = (2020, 1, 1, 0, 0, 0)


def files() -> dict[str, pathlib.Path]:
    """What is in the zip, by its name there."""
    own = [file for file in sorted(PLUGIN.rglob("*")) if file.suffix in _ENDINGS and "__pycache__" not in file.parts]
    named = {f"{PLUGIN.name}/{file.relative_to(PLUGIN).as_posix()}": file for file in own}
    return named | {f"{PLUGIN.name}/LICENSE": PROJECT / "LICENSE"}


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes the zip that QGIS installs.")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=PROJECT / "dist")
    folder = parser.parse_args().folder
    metadata = configparser.ConfigParser()
    metadata.read(PLUGIN / "metadata.txt", encoding="utf-8")
    folder.mkdir(parents=True, exist_ok=True)
    made = folder / f"{PLUGIN.name}-{metadata['general']['version']}.zip"
    draft = made.with_suffix(".part")
    with zipfile.ZipFile(draft, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, file in files().items():
            entry = zipfile.ZipInfo(name, _TIME)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, file.read_bytes())
    draft.replace(made)
    print(made)
    return 0


if __name__ == "__main__":
    sys.exit(main())
