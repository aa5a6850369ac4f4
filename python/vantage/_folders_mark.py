"""The file by which a folder for a while says that vantage made it."""

from __future__ import annotations

MARK = ".vantage-temporary"
"""Its name; src/core/temporary_mark.cpp writes the same one."""

MARK_TEXT = b"vantage made this folder for a short time. It removes the folder with all that is in it.\n"
