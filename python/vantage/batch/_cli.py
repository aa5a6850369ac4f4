"""`vantage batch`: a run from the shell."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from typing import Any

from .._errors import CancelledError, Error, input_error
from .._requests import Navigation, Sensor
from ._manifest import REPORT
from ._run import run
from ._scenes import request_of
from ._store import Store

_EXAMPLES = """\
examples:
  vantage batch squares.parquet --scene city.osm.pbf --max-range 300 -o results/
  vantage batch pitches.geojson --scene city.osm.pbf --center 40.7484,-73.9857 --radius 900 \\
      --max-range 300 --navigation '{"altitude": {"agl": [30, 120]}}' --volumes ply -o results/
  vantage batch roofs.parquet --scene city.osm.pbf --sensor '{"max_range": 300, "incidence": 60}' \\
      --dask tcp://10.0.0.5:8786 --storage '{"key": "..."}' -o s3://bucket/results

Stopped, by Ctrl-C or by a power cut, and called again, it goes on where it was.

exit codes:
  0  all targets were computed
  1  some targets failed: see the columns error_* of results.parquet
  2  wrong input, or output that cannot be written
  3  a defect of vantage
  130  stopped by Ctrl-C
"""

_CODES = {"input": 2, "output": 2, "cancelled": 130, "internal": 3}


def main(arguments: Sequence[str]) -> int:
    """Runs `vantage batch` with these arguments; its exit code."""
    options = _parser().parse_args(arguments)
    try:
        return _run(options)
    except KeyboardInterrupt:
        print("stopped; call it again to go on", file=sys.stderr)
        return 130
    except CancelledError as error:
        print(f"vantage: {error}", file=sys.stderr)
        return 130
    except Error as error:
        print(f"vantage: {error}", file=sys.stderr)
        return _CODES[error.kind]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="vantage batch", epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter,
        description="The volume of each target of a table: one row a target, in OUTPUT/results.parquet.")
    parser.add_argument("targets", help="GeoParquet, Parquet or GeoJSON, with a column id, and geometry, osm, object, ...")
    parser.add_argument("-o", "--output", required=True, help="a folder, or s3://bucket/folder")
    scene = parser.add_argument_group("scene")
    scene.add_argument("--scene", required=True, help="the map, mesh, raster or tileset.json")
    scene.add_argument("--center", type=_pair, metavar="LAT,LON", help="the middle of the part that is used")
    scene.add_argument("--radius", type=float, metavar="M", help="its radius")
    scene.add_argument("--bbox", type=_four, metavar="W,S,E,N", help="instead of these, degrees")
    scene.add_argument("--terrain", metavar="FILE", help="heights of a map's ground")
    scene.add_argument("--without", metavar="KINDS", help="of a map: walls,towers,bridges,trees")
    scene.add_argument("--scene-keys", type=_json, metavar="JSON", help="other keys of a mission file's scene")
    asked = parser.add_argument_group("what is asked")
    asked.add_argument("--max-range", type=float, metavar="M", help="of the sensor")
    asked.add_argument("--sensor", type=_json, metavar="JSON", help="instead, keys of a mission file's sensor")
    asked.add_argument("--navigation", type=_json, metavar="JSON", help="keys of a mission file's navigation")
    asked.add_argument("--tolerance", type=float, metavar="M", help="of range facets")
    asked.add_argument("--work-limit", type=float, metavar="N", help="of the boolean operations of a volume (1e7)")
    asked.add_argument("--crs", help="of the geometries, where the table does not say it; 'scene': metres of its frame")
    work = parser.add_argument_group("how it is done")
    work.add_argument("--volumes", choices=("ply", "zarr"), help="write the volumes, too")
    work.add_argument("--workers", type=int, default=0, metavar="N", help="processes; 0: as many as processors")
    work.add_argument("--dask", metavar="ADDRESS", help="instead, the scheduler of a Dask cluster")
    work.add_argument("--shard-rows", type=int, default=64, metavar="N", help="rows that are written together (64)")
    work.add_argument("--attempts", type=int, default=3, metavar="N",
                      help="how often a target may end its worker (3)")
    work.add_argument("--storage", type=_json, metavar="JSON", help="options of fsspec, for object stores")
    work.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    work.add_argument("--json", action="store_true", help="print the report as JSON")
    return parser


def _run(options: argparse.Namespace) -> int:
    keys: dict[str, Any] = {"center": options.center, "radius": options.radius, "bbox": options.bbox,
                            "terrain": options.terrain, **(options.scene_keys or {})}
    if options.without:
        keys["without"] = options.without.split(",")
    given = {key: value for key, value in keys.items() if value is not None}
    report = run(options.targets, request_of({**request_of(options.scene), **given}), options.output,
                 max_range=options.max_range, sensor=_made(Sensor, options.sensor, "sensor"),
                 navigation=_made(Navigation, options.navigation, "navigation"), tolerance=options.tolerance,
                 work_limit=options.work_limit, crs=options.crs, volumes=options.volumes, workers=options.workers, cluster=options.dask,
                 shard_rows=options.shard_rows, attempts=options.attempts, storage_options=options.storage,
                 progress=None if options.quiet else _ProgressLine().tell)
    if options.json:
        print((Store(options.output, options.storage).read(REPORT) or b"").decode(), end="")
    elif not options.quiet:
        print(_summary(report))
    return 1 if report.errors else 0


def _summary(report: Any) -> str:
    lines = [f"{report.rows:,} targets, {report.errors:,} failed; {report.computed:,} done by this run in {report.seconds:.1f} s"
             f" ({report.rows_per_s:.2f} a second)"]
    lines += [f"  {name}: {worker.rows:,} targets, {worker.peak_mib:.0f} MiB" for name, worker in
              sorted(report.workers.items())]
    if report.deaths:
        lines.append(f"  {report.deaths} tasks were lost with their workers, and done again")
    return "\n".join([*lines, f"{report.output.rstrip('/')}/results.parquet"])


class _ProgressLine:
    """Progress: a line that is written anew on a terminal, a line every ten seconds elsewhere."""

    def __init__(self) -> None:
        self._last = 0.0
        self._is_terminal = sys.stderr.isatty()

    def tell(self, stage: str, fraction: float) -> None:
        now = time.monotonic()
        if now - self._last < (0.2 if self._is_terminal else 10) and fraction < 1:
            return
        self._last = now
        end = "\r" if self._is_terminal and fraction < 1 else "\n"
        print(f"{100 * fraction:5.1f} %  {stage}  ", end=end, file=sys.stderr, flush=True)


def _made(kind: Any, keys: Any, name: str) -> Any:
    if keys is None:
        return None
    try:
        return kind(**keys)
    except TypeError as error:
        raise input_error("unknown-key", str(error).split("() ")[-1], name,
                          "use the keys of the mission file: docs/mission-file.md") from None


def _numbers(text: str, count: int) -> list[float]:
    numbers = [float(part) for part in text.split(",")]
    if len(numbers) != count:
        raise argparse.ArgumentTypeError(f"{text!r} is not {count} numbers with commas between them")
    return numbers


def _pair(text: str) -> list[float]:
    return _numbers(text, 2)


def _four(text: str) -> list[float]:
    return _numbers(text, 4)


def _json(text: str) -> dict[str, Any]:
    try:
        value = json.loads(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"is not JSON: {error}") from None
    if not isinstance(value, dict):
        raise argparse.ArgumentTypeError('is no JSON object: write {"key": value}')
    return value
