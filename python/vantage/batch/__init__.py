"""Many targets, on all processors of a machine or of a cluster: one row a target (docs/python-batch.md).

    import vantage.batch
    report = vantage.batch.run("targets.parquet", "city.osm.pbf", "results/", max_range=300)
    report.table()

From the shell: python -m vantage batch targets.parquet --scene city.osm.pbf --max-range 300 -o results/
"""

from __future__ import annotations

import sys

if sys.platform == "win32":
    raise ImportError("vantage.batch needs Linux or macOS: it locks files and ends processes as these do. On Windows, call "
                      "vantage.compute_many")

from ._run import Report, WorkerReport, results, run

__all__ = ["Report", "WorkerReport", "results", "run"]
