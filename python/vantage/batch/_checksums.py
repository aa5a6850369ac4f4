"""Sizes and hashes of what was written for a shard: damage and loss show when the run goes on.

Beside `rows/000012.parquet` lies `rows/000012.json`, written after it: a shard without one is not whole.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from ._store import Store

Checksum = dict[str, Any]
"""{"bytes": ..., "sha256": ...} of one file."""


def checksum_of(content: bytes) -> Checksum:
    """The checksum of a file that was written with this content."""
    return {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def name_of(rows: str) -> str:
    """The name of the file of checksums beside these rows."""
    return rows.removesuffix(".parquet") + ".json"


def write(store: Store, rows: str, content: bytes, volumes: dict[str, Checksum]) -> None:
    """Call it last: it makes the shard a whole one."""
    told = {"rows": checksum_of(content), "volumes": volumes}
    store.put(name_of(rows), (json.dumps(told, indent=1, sort_keys=True) + "\n").encode())


def read(store: Store, rows: str) -> tuple[Checksum, dict[str, Checksum]] | None:
    """The checksums of the rows and of each volume; None where there are none that can be read."""
    try:
        told = json.loads(store.read(name_of(rows)) or b"")
        checksums = [told["rows"], *told["volumes"].values()]
        if all(isinstance(checksum["bytes"], int) and isinstance(checksum["sha256"], str) for checksum in checksums):
            return told["rows"], told["volumes"]
    except (ValueError, KeyError, TypeError, AttributeError):  # it is damaged
        pass
    return None


def matches(content: bytes | None, checksum: Checksum) -> bool:
    """Whether this is what was written."""
    return content is not None and checksum_of(content) == checksum


def volumes_match(store: Store, checksums: dict[str, Checksum]) -> bool:
    """Whether the files of volumes are as they were written. Those of an object store are not fetched: it keeps hashes
    itself, so that their sizes are enough."""
    for name, checksum in checksums.items():
        if not (matches(store.read(name), checksum) if store.is_local else store.size(name) == checksum["bytes"]):
            return False
    return True
