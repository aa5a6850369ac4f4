#!/usr/bin/env python3
"""All of a city on a local Dask cluster, one worker killed in the middle: rows per second, memory, nothing lost, nothing twice.

    PYTHONPATH=build/python .deps/python/bin/python bench/python/city.py [--roofs 2000] [--areas] [--workers 2]

The city is Manhattan midtown. Roofs are drawn from its buildings with a seed; areas are its named squares, its pitches and its
parking areas. Needs ../shared or VANTAGE_SHARED.
"""

import argparse
import collections
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import numpy as np
import vantage as vt
import vantage.batch

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", PROJECT.parent / "shared"))
MIDTOWN = SHARED / "data" / "osm" / "manhattan-midtown.osm.pbf"
SEED = 1


def targets_of(scene, roofs, areas):
    """Rows: areas of the map, and roofs of buildings of it."""
    rows = []
    if areas:
        found = [*vt.areas(MIDTOWN, "place=square", named=True), *vt.areas(MIDTOWN, "leisure=pitch"),
                 *vt.areas(MIDTOWN, "amenity=parking")]
        rows += [{"id": id, "osm": id} for id in sorted({area.source_id for area in found})]
    buildings = sorted({one.source_id for one in scene.objects if one.kind == "building"})
    chosen = np.random.default_rng(SEED).choice(buildings, min(roofs, len(buildings)), replace=False)
    return rows + [{"id": f"roof of {id}", "osm": str(id), "part": "roof"} for id in chosen]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--roofs", type=int, default=2000)
    parser.add_argument("--areas", action="store_true", help="areas of the map, too")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--range", type=float, default=300)
    parser.add_argument("--no-kill", action="store_true", help="kill no worker")
    parser.add_argument("-o", "--output", help="keep the results here")
    options = parser.parse_args()
    import distributed

    commit = subprocess.run(["git", "-C", PROJECT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    scene = vt.Scene.from_osm(MIDTOWN)
    rows = targets_of(scene, options.roofs, options.areas)
    print(f"commit {commit.stdout.strip()}, {len(os.sched_getaffinity(0))} cores, load {os.getloadavg()[0]:.1f}; {scene}; "
          f"{len(rows)} targets, range {options.range:g} m, seed {SEED}; {options.workers} workers", flush=True)
    del scene
    with tempfile.TemporaryDirectory() as folder, \
            distributed.LocalCluster(n_workers=options.workers, threads_per_worker=1, host="127.0.0.1",
                                     dashboard_address=None, silence_logs=50) as cluster, \
            distributed.Client(cluster) as client:
        victims = [] if options.no_kill else list(client.run(os.getpid).values())[:1]
        last = [0.0]

        def tell(stage, fraction):
            if fraction >= 0.5 and victims:
                print(f"killing worker {victims[0]} at {stage}", flush=True)
                os.kill(victims.pop(), signal.SIGKILL)
            if time.monotonic() - last[0] > 30:
                last[0] = time.monotonic()
                print(f"  {stage}, load {os.getloadavg()[0]:.1f}", flush=True)

        report = vantage.batch.run(rows, MIDTOWN, options.output or folder, max_range=options.range, cluster=client,
                                   shard_rows=16, progress=tell)
        table = report.table()
    print(report)
    cpu = sum(worker.cpu_seconds for worker in report.workers.values())
    print(f"{report.rows_per_s:.3f} rows/s; {cpu / report.computed:.3f} s of a processor for a row, with reading the scene")
    for name, worker in report.workers.items():
        print(f"  {name}: {worker.rows} rows, busy {worker.seconds:.0f} s, {worker.cpu_seconds:.0f} s of a processor, at most {worker.peak_mib:.0f} MiB")
    ids = sorted(row["id"] for row in rows)
    if table["id"].tolist() != ids:
        raise SystemExit("rows were lost, or are there twice")
    print(f"each of the {len(ids)} ids is there once; outcomes: {dict(collections.Counter(table['outcome']))}; "
          f"errors: {dict(collections.Counter(table['error_code'].dropna()))}")
    seconds = table["seconds"]
    print(f"seconds of a target: median {seconds.median():.2f}, mean {seconds.mean():.2f}, 95 % {seconds.quantile(.95):.2f}, "
          f"most {seconds.max():.1f}; result {report.result_hash}")


if __name__ == "__main__":
    main()
