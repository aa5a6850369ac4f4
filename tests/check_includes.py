#!/usr/bin/env python3
"""Checks who includes what: third-party libraries stay behind the one room that uses them, and no room reaches up.

    check_includes.py [ROOT]     exit 1 and one line for each include that breaks a rule

With --self-test it breaks every rule on purpose, in a scratch tree, and fails unless each is noticed.
"""

import argparse
import pathlib
import re
import sys
import tempfile
from typing import NamedTuple

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]')


class OnlyIn(NamedTuple):
    """Headers that match `header` may be included only by files that match `allowed`."""

    header: str
    allowed: str
    reason: str


class NotIn(NamedTuple):
    """Files that match `place` may not include headers that match `header`."""

    place: str
    header: str
    reason: str


# Paths are relative to the root, with forward slashes; headers as written between the quotes. Rooms name each other's
# headers from src/ ("scene/bvh.h"), never by ../.
RULES = [
    OnlyIn(r"manifold/", r"src/solid/csg\.(h|cpp)", "only src/solid/csg.* sees Manifold"),
    OnlyIn(r"embree", r"src/(verify|render)/", "only src/verify and src/render see Embree"),
    OnlyIn(r"(EGL|GL|KHR)/", r"src/render/gl_", "only the files src/render/gl_* see OpenGL and EGL"),
    OnlyIn(r"cairo", r"src/render/", "only src/render sees Cairo"),
    OnlyIn(r"(CDT|CDTUtils|Triangulation|(Locator)?KDTree|predicates|remove_at|portable_nth_element)\.h",
           r"src/(exact|city|terrain)/", "only src/exact, src/city and src/terrain see CDT"),
    OnlyIn(r"(proj|proj_experimental|geodesic)\.h", r"src/geo/", "only src/geo sees PROJ"),
    OnlyIn(r"(osmium|protozero|expat|bzlib)", r"src/osm/", "only src/osm sees libosmium"),
    OnlyIn(r"polyclipping/|clipper\.hpp", r"src/city/footprint\.cpp", "only src/city/footprint.cpp sees Clipper"),
    OnlyIn(r"(oneapi/)?tbb[/.]", r"src/parallel/", "only src/parallel sees the thread library"),
    OnlyIn(r"CLI/", r"src/cli/", "only src/cli sees CLI11"),
    OnlyIn(r"yaml-cpp/", r"src/mission/", "only src/mission sees yaml-cpp"),
    OnlyIn(r"zlib\.h", r"src/scene/", "only src/scene sees zlib"),
    OnlyIn(r"nlohmann/", r"src/(scene|solid|cli)/", "only src/scene, src/solid and src/cli see nlohmann/json"),
    NotIn(r"src/exact/", r"(query|verify|render|cli|mission|spheres)/",
          "the engine knows nothing of the rooms above it"),
    NotIn(r"src/query/", r"(solid|verify|render|cli|mission|spheres)/", "queries know nothing of solids and missions"),
    NotIn(r"src/verify/", r"(scene|exact|query|solid|cli|mission|spheres|render)/",
          "the check shares no geometry code with what it checks"),
    NotIn(r"src/render/", r"(exact/|query/|solid/(?!atomic_file\.h)|verify/|cli/|mission/|spheres/)",
          "rendering knows scenes, and how files are written whole"),
    NotIn(r"src/spheres/", r"(query|verify|cli|mission)/", "the spheres method knows nothing of the rooms above it"),
    NotIn(r"src/core/", r"(?!(core|vantage)/)[a-z]+/", "the core knows nothing of the rooms above it"),
    NotIn(r"src/parallel/", r"(scene|exact|query|solid|verify|cli|mission|spheres|render)/",
          "threads know nothing of geometry"),
    NotIn(r"src/scene/", r"(exact|query|solid|verify|cli|mission|spheres|render|terrain|osm|city)/",
          "scenes know the earth, and nothing of what is made with them"),
    NotIn(r"src/solid/", r"(query|verify|cli|mission|spheres|render)/", "solids know nothing of the rooms above them"),
    NotIn(r"src/(geo|terrain|osm|city)/", r"(exact|query|verify|cli|mission|spheres|render)/",
          "making scenes knows nothing of what is done with them"),
    NotIn(r"src/geo/", r"(scene|terrain|osm|city)/", "the earth knows nothing of scenes"),
    NotIn(r"src/(terrain|osm)/", r"city/", "maps and terrain know nothing of buildings"),
    NotIn(r"src/mission/", r"(query|cli)/", "missions know nothing of queries and the command line"),
    NotIn(r"tests/attack/", r"(?!(vantage|Eigen|sys)/).*/",
          "the attack needs the public headers, Eigen and the standard library: it shares nothing with what it judges"),
    NotIn(r"include/", r"(?!(vantage|Eigen)/).*[./]", "public headers need each other, Eigen and the standard library"),
]


def violations(root: pathlib.Path) -> list[str]:
    """One line for each include under src/, include/ and tests/attack/ that breaks a rule."""
    found = []
    for folder in ("src", "include", "tests/attack"):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            place = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                if match:
                    found += [f"{place}:{number}: includes {match[1]}: {reason}" for reason in broken(place, match[1])]
    return found


def broken(place: str, header: str) -> list[str]:
    """Why the file at `place` may not include `header`; empty if it may."""
    reasons = []
    for rule in RULES:
        if isinstance(rule, OnlyIn):
            bad = re.match(rule.header, header) and not re.match(rule.allowed, place)
        else:
            bad = re.match(rule.place, place) and re.match(rule.header, header)
        if bad:
            reasons.append(rule.reason)
    if header.startswith("../"):
        reasons.append("name headers from src/ or include/, not by ../")
    return reasons


# (file, header, whether it is allowed): each rule broken and kept.
CASES = [
    ("src/solid/csg.cpp", "manifold/manifold.h", True),
    ("src/solid/measure.cpp", "manifold/manifold.h", False),
    ("src/exact/engine.cpp", "manifold/manifold.h", False),
    ("src/verify/occluders.cpp", "embree3/rtcore.h", True),
    ("src/scene/bvh.cpp", "embree3/rtcore.h", False),
    ("src/render/cpu_depth.cpp", "embree3/rtcore.h", True),
    ("src/render/gl_depth.cpp", "GL/glcorearb.h", True),
    ("src/render/choose.cpp", "EGL/egl.h", False),
    ("src/render/picture.cpp", "cairo.h", True),
    ("src/cli/command_render.cpp", "cairo.h", False),
    ("src/render/depth.cpp", "scene/prepared_data.h", True),
    ("src/render/depth.cpp", "solid/csg.h", False),
    ("src/render/picture.cpp", "solid/atomic_file.h", True),
    ("src/spheres/algorithm.cpp", "solid/csg.h", True),
    ("src/spheres/algorithm.cpp", "mission/schema.h", False),
    ("src/exact/triangulation.cpp", "CDT.h", True),
    ("src/solid/csg.cpp", "CDT.h", False),
    ("src/city/building_solid.cpp", "CDT.h", True),
    ("src/geo/local_frame.cpp", "proj.h", True),
    ("src/city/city.cpp", "proj.h", False),
    ("src/osm/extract.cpp", "osmium/io/reader.hpp", True),
    ("src/city/city.cpp", "osmium/io/reader.hpp", False),
    ("src/city/footprint.cpp", "polyclipping/clipper.hpp", True),
    ("src/city/building_solid.cpp", "polyclipping/clipper.hpp", False),
    ("src/city/city.cpp", "osm/extract.h", True),
    ("src/osm/extract.cpp", "city/footprint.h", False),
    ("src/geo/local_frame.cpp", "osm/extract.h", False),
    ("src/geo/local_frame.cpp", "scene/mesh_file.h", False),
    ("src/scene/place.cpp", "geo/local_frame.h", True),
    ("src/scene/place.cpp", "proj.h", False),
    ("src/scene/place.cpp", "city/footprint.h", False),
    ("src/solid/write_scene.cpp", "scene/georeference_text.h", True),
    ("src/terrain/height_grid.cpp", "geo/local_frame.h", True),
    ("src/city/city.cpp", "mission/schema.h", False),
    ("src/scene/triangulate_polygon.cpp", "predicates.h", False),
    ("src/exact/triangulation.cpp", "exact/triangulation.h", True),
    ("src/parallel/parallel.cpp", "oneapi/tbb/parallel_for.h", True),
    ("src/exact/envelope.cpp", "tbb/parallel_for.h", False),
    ("src/scene/bvh.cpp", "oneapi/tbb/parallel_for.h", False),
    ("src/query/query.cpp", "oneapi/tbb.h", False),
    ("src/cli/main.cpp", "CLI/CLI.hpp", True),
    ("src/mission/reader.cpp", "CLI/CLI.hpp", False),
    ("src/mission/reader.cpp", "yaml-cpp/yaml.h", True),
    ("src/cli/main.cpp", "yaml-cpp/yaml.h", False),
    ("src/scene/gzip.cpp", "zlib.h", True),
    ("src/solid/write.cpp", "zlib.h", False),
    ("src/solid/report.cpp", "nlohmann/json.hpp", True),
    ("src/mission/reader.cpp", "nlohmann/json.hpp", False),
    ("src/exact/engine.cpp", "scene/bvh.h", True),
    ("src/exact/engine.cpp", "query/limits.h", False),
    ("src/exact/engine.cpp", "verify/segment.h", False),
    ("src/exact/engine.cpp", "render/depth.h", False),
    ("src/exact/engine.cpp", "cli/main.h", False),
    ("src/query/query.cpp", "exact/collect.h", True),
    ("src/query/query.cpp", "solid/regions.h", False),
    ("src/verify/verify.cpp", "query/limits.h", False),
    ("src/verify/verify.cpp", "scene/bvh.h", False),
    ("src/verify/verify.cpp", "exact/numerics.h", False),
    ("src/verify/verify.cpp", "solid/csg.h", False),
    ("src/scene/bvh.cpp", "exact/numerics.h", False),
    ("src/scene/bvh.cpp", "query/limits.h", False),
    ("src/solid/csg.cpp", "query/limits.h", False),
    ("src/solid/csg.cpp", "mission/reader.h", False),
    ("src/core/progress_reporter.cpp", "vantage/error.h", True),
    ("src/core/progress_reporter.cpp", "core/progress_reporter.h", True),
    ("src/core/progress_reporter.cpp", "parallel/parallel.h", False),
    ("src/core/progress_reporter.cpp", "scene/bvh.h", False),
    ("src/verify/verify.cpp", "core/progress_reporter.h", True),
    ("src/parallel/parallel.cpp", "scene/bvh.h", False),
    ("src/parallel/parallel.cpp", "query/limits.h", False),
    ("src/mission/reader.cpp", "cli/main.h", False),
    ("src/mission/reader.cpp", "query/limits.h", False),
    ("src/mission/reader.cpp", "scene/mesh_file.h", True),
    ("include/vantage/scene.h", "vantage/geometry.h", True),
    ("include/vantage/scene.h", "Eigen/Core", True),
    ("include/vantage/scene.h", "scene/bvh.h", False),
    ("include/vantage/query.h", "query/limits.h", False),
    ("include/vantage/scene.h", "tbb/parallel_for.h", False),
    ("include/vantage/scene.h", "boost/any.hpp", False),
    ("include/vantage/scene.h", "vector", True),
    ("src/verify/verify.cpp", "../exact/numerics.h", False),
    ("tests/attack/judge.cpp", "vantage/volume.h", True),
    ("tests/attack/judge.cpp", "trial.h", True),
    ("tests/attack/judge.cpp", "exact/blocker.h", False),
    ("tests/attack/judge.cpp", "support/oracle.h", False),
]


def self_test() -> list[str]:
    """What the checker got wrong on CASES, each in a file of its own, and the rules that no case breaks."""
    wrong = []
    unbroken = {rule.reason for rule in RULES}
    for place, header, allowed in CASES:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            file = root / place
            file.parent.mkdir(parents=True)
            file.write_text(f'#include <vector>\n#include "{header}"\n', encoding="utf-8")
            noticed = violations(root)
        unbroken -= {reason for reason in unbroken if any(line.endswith(f": {reason}") for line in noticed)}
        if bool(noticed) == allowed:
            expected = "nothing" if allowed else "a complaint"
            wrong.append(f"{place} including {header}: expected {expected}, got {noticed}")
    return wrong + [f"no case breaks the rule: {reason}" for reason in sorted(unbroken)]


def main() -> int:
    parser = argparse.ArgumentParser(description="Checks who includes what.")
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent)
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if not arguments.self_test and not (arguments.root / "src").is_dir():
        print(f"{arguments.root}: no src/ there", file=sys.stderr)
        return 2
    problems = self_test() if arguments.self_test else violations(arguments.root)
    print("\n".join(problems) if problems else "includes are in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
