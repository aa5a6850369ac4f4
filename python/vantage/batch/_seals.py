"""Of what was written for a shard, the sizes and the hashes: damage and loss show when the run goes on.

Beside `rows/000012.parquet` lies `rows/000012.json`, written after it: a shard without one is not whole.
"""

from __future__ import annotations

import hashlib
import json
from typing import Any

from ._store import Store

Seal = dict[str, Any]
"""{"bytes": ..., "sha256": ...} of one file."""


def seal_of(content: bytes) -> Seal:
    """Of a file that was written with this content."""
    return {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def name_of(rows: str) -> str:
    """Of the file beside these rows."""
    return rows.removesuffix(".parquet") + ".json"


def write(store: Store, rows: str, content: bytes, volumes: dict[str, Seal]) -> None:
    """Call it last: it makes the shard a whole one."""
    told = {"rows": seal_of(content), "volumes": volumes}
    store.put(name_of(rows), (json.dumps(told, indent=1, sort_keys=True) + "\n").encode())


def read(store: Store, rows: str) -> tuple[Seal, dict[str, Seal]] | None:
    """Of the rows, and of each volume; None where there is none that can be read."""
    try:
        told = json.loads(store.read(name_of(rows)) or b"")
        seals = [told["rows"], *told["volumes"].values()]
        if all(isinstance(seal["bytes"], int) and isinstance(seal["sha256"], str) for seal in seals):
            return told["rows"], told["volumes"]
    except (ValueError, KeyError, TypeError, AttributeError):  # it is damaged
        pass
    return None


def is_right(content: bytes | None, seal: Seal) -> bool:
    """Whether this is what was written."""
    return content is not None and seal_of(content) == seal


def are_volumes_right(store: Store, seals: dict[str, Seal]) -> bool:
    """Whether the files of volumes are as they were written. Those of an object store are not fetched: it keeps hashes
    itself, so that their sizes are enough."""
    for name, seal in seals.items():
        if not (is_right(store.read(name), seal) if store.is_local else store.size(name) == seal["bytes"]):
            return False
    return True
