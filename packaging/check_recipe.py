#!/usr/bin/env python3
"""Parses and renders the recipe beside it with rattler-build, and compares its version with that of vantage.

    .deps/packaging/bin/python packaging/check_recipe.py
"""

import pathlib
import re
import sys

from rattler_build import RattlerBuildError, Stage0Recipe

HERE = pathlib.Path(__file__).resolve().parent


def main() -> int:
    header = (HERE.parent / "include" / "vantage" / "version.h").read_text(encoding="utf-8")
    wanted = re.search(r'VANTAGE_VERSION "([^"]+)"', header)
    try:
        rendered = Stage0Recipe.from_file(HERE / "recipe.yaml").render()
    except RattlerBuildError as error:
        print(f"packaging/recipe.yaml: {error}", file=sys.stderr)
        return 1
    versions = {variant.recipe.package.version for variant in rendered}
    if wanted is None or versions != {wanted[1]}:
        print(f"packaging/recipe.yaml is of version {', '.join(map(str, versions)) or 'none'}, and "
              f"include/vantage/version.h of {wanted[1] if wanted else 'none'}", file=sys.stderr)
        return 1
    print(f"packaging/recipe.yaml: version {wanted[1]}, {len(rendered)} package")
    return 0


if __name__ == "__main__":
    sys.exit(main())
