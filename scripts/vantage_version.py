"""The version of vantage."""

import pathlib
import re

HEADER = pathlib.Path(__file__).resolve().parent.parent / "include" / "vantage" / "version.h"


def version() -> str:
    """What the header says. Raises ValueError where it says nothing."""
    found = re.search(r'VANTAGE_VERSION "([^"]+)"', HEADER.read_text(encoding="utf-8"))
    if found is None:
        raise ValueError("include/vantage/version.h names no VANTAGE_VERSION")
    return found[1]
