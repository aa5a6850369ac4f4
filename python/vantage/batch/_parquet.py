"""Parquet files that are in memory."""

from __future__ import annotations

from typing import Any

from .._extras import require


def memory_file(data: bytes) -> Any:
    """For the readers of pyarrow, in memory of its own: its threads let go of what they read at some later time. Where
    that is an object of Python, and Python is about to end, they abort the process."""
    arrow = require("pyarrow", "batch")
    copy = arrow.BufferOutputStream()
    copy.write(data)
    return arrow.BufferReader(copy.getvalue())


def read(data: bytes) -> Any:
    """A table of pyarrow. Raises ArrowInvalid or OSError of a file that is not whole."""
    return require("pyarrow.parquet", "batch").read_table(memory_file(data))
