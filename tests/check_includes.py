#!/usr/bin/env python3
"""Checks who includes what: third-party libraries stay behind the module that uses them, and no module includes one
above it.

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


# The rooms of src/limits/. Files verify*.cpp and prove*.cpp stand on the modules of these names, ask*.cpp and leg*.cpp on
# src/query, cut*.cpp on src/solid.
LIMITS = sorted(room.name for room in (pathlib.Path(__file__).parent.parent / "src/limits").iterdir())

# The modules of src/, and those whose headers each may include besides its own. Modules name each other's headers from
# src/ ("scene/prepared_data.h"), never by ../. What a module may include comes before it: there are no circles. Headers
# of src/common declare what the program, the server, the Python package and the benchmarks use besides the public API:
# all may include them, but for those who judge, and public headers.
MODULES = {
    "common": [],
    "core": [],
    "request": ["core"],
    "options": ["core", "request"],
    "geo": ["core"],
    "camera": ["core"],
    "io": ["core", "request", "geo", "camera"],
    "tiles": ["core", "geo", "io"],
    "scene": ["core"],
    "target": ["core", "request", "scene"],
    "sensor": ["core"],
    "arrangement": ["core"],
    "exact": ["core", "scene", "target"],
    "solid": ["core", "sensor", "arrangement", "exact"],
    "query": ["core", "scene", "target", "sensor", "exact"],
    # What missions need of other libraries: these register it (enable_maps, enable_spheres).
    "app/providers": ["core", "geo"],
    "depth": ["core", "scene"],
    "spheres": ["core", "options", "scene", "target", "solid", "depth", "app/providers"],
    "picture": ["core", "depth"],
    "verify": [],
    "prove": [],
    **{f"limits/{limit}": [] for limit in LIMITS},  # a room: how far each of its files sees, its name says
    "simplify": ["core"],
    "maps/osm": ["core", "geo"],
    "maps/terrain": ["core", "geo", "scene"],
    "maps/city": ["core", "geo", "scene", "solid", "app/providers", "maps/osm", "maps/terrain"],
    "app": ["core", "request", "options", "geo", "io", "tiles", "scene", "target", "app/providers"],
    "flight": ["core", "geo", "io", "scene"],
    "flight/plans": ["core", "geo", "io", "flight"],
    "flight/tour": ["core", "scene", "flight"],
    # It judges bounds of tours, and shares nothing with what finds them.
    "flight/judge": ["core"],
    # The program and what serves the page stand on the public API and src/common.
    "live": [],
    "cli": ["live"],
}
# The check shares no geometry code with what it checks: of the core it has threads, progress and text alone.
VERIFY_HEADERS = ["core/format.h", "core/parallel.h", "core/progress_reporter.h", "common/input.h"]

# Paths are relative to the root, with forward slashes; headers as written between the quotes.
RULES = [
    OnlyIn(r"manifold/", r"src/solid/csg\.(h|cpp)|bench/support/plain_union\.cpp",
           "only src/solid/csg.*, and the benchmarks' plain union, see Manifold"),
    OnlyIn(r"embree", r"src/(verify|depth|picture)/", "only src/verify, src/depth and src/picture see Embree"),
    OnlyIn(r"(EGL|GL|KHR)/", r"src/(depth|picture)/gl_", "only the files gl_* see OpenGL and EGL"),
    OnlyIn(r"cairo", r"src/picture/", "only src/picture sees Cairo"),
    OnlyIn(r"ft2build|freetype", r"src/picture/resource_font\.cpp", "only resource_font.cpp sees FreeType"),
    OnlyIn(r"(CDT|CDTUtils|Triangulation|(Locator)?KDTree|predicates|remove_at|portable_nth_element)\.h",
           r"src/(exact|maps/city|maps/terrain)/|src/(core|prove)/orientation\.cpp",
           "only src/exact, src/maps/city, src/maps/terrain and orientation.cpp see CDT"),
    OnlyIn(r"(proj|proj_experimental|geodesic)\.h", r"src/geo/", "only src/geo sees PROJ"),
    OnlyIn(r"(osmium|protozero|bzlib)", r"src/maps/osm/", "only src/maps/osm sees libosmium"),
    OnlyIn(r"draco/", r"src/io/draco_library\.cpp", "only src/io/draco_library.cpp sees Draco"),
    OnlyIn(r"meshoptimizer\.h", r"src/io/meshopt_library\.cpp", "only src/io/meshopt_library.cpp sees meshoptimizer"),
    OnlyIn(r"expat", r"src/(maps/osm/|flight/plans/|app/kml_zones_expat\.cpp)",
           "only src/maps/osm, src/flight/plans and kml_zones_expat.cpp see Expat"),
    OnlyIn(r"polyclipping/|clipper\.hpp", r"src/maps/city/clipping\.cpp",
           "only src/maps/city/clipping.cpp sees Clipper"),
    OnlyIn(r"Highs", r"src/flight/tour/linear_program_highs\.cpp", "only linear_program_highs.cpp sees HiGHS"),
    OnlyIn(r"(oneapi/)?tbb[/.]", r"src/core/threads_tbb\.cpp", "only src/core/threads_tbb.cpp sees oneTBB"),
    OnlyIn(r"CLI/", r"src/cli/|bench/(gap|limits|tours)/", "only programs see CLI11"),
    OnlyIn(r"yaml-cpp/", r"src/app/", "only src/app sees yaml-cpp"),
    OnlyIn(r"zlib\.h", r"src/io/|src/live/report_page\.cpp|src/maps/osm/text_input\.cpp",
           "only src/io, report_page.cpp and text_input.cpp see zlib"),
    OnlyIn(r"fmt/", r"src/core/format\.h", "only src/core/format.h sees libfmt"),
    OnlyIn(r"core/format\.h", r".*\.cpp", "only source files include libfmt: it takes long to compile"),
    OnlyIn(r"nlohmann/", r"src/(io|tiles|app|live|flight|maps/osm)/|bench/support/cities\.cpp",
           "only src/io, src/tiles, src/maps/osm, src/app, src/live, src/flight and bench see nlohmann/json"),
    OnlyIn(r"boost/", r"src/live/(websocket_connection|page_server)\.", "only the server in src/live sees Boost"),
    NotIn(r"src/(verify/|limits/[^/]*/verify)", rf"(?!(verify|vantage)/|({'|'.join(map(re.escape, VERIFY_HEADERS))})$)({'|'.join(MODULES)})/",
          "the check shares no geometry code with what it checks"),
    NotIn(r"src/(prove/|limits/[^/]*/prove)", rf"(?!(prove|vantage)/|({'|'.join(map(re.escape, VERIFY_HEADERS))})$)({'|'.join(MODULES)})/",
          "the proof shares no geometry code with what it proves"),
    NotIn(r"tests/attack/", r"(?!(vantage|Eigen|sys)/).*/",
          "the attack needs the public headers, Eigen and the standard library: it shares nothing with what it judges"),
    NotIn(r"bench/(?!(kernels|progress|tours)/)", rf"(?!common/)({'|'.join(MODULES)})/|support/internals\.h",
          "benchmarks stand on the public API and src/common; only bench/kernels, bench/progress and bench/tours look behind it"),
    OnlyIn(r"nanobind/", r"python/src/", "only python/src sees nanobind"),
    NotIn(r"python/src/", rf"(?!cli/program\.h$|common/)({'|'.join(MODULES)})/",
          "the Python package stands on the public API and src/common, and on the program for `python -m vantage`"),
    NotIn(r"include/", r"(?!(vantage|Eigen)/).*[./]", "public headers need each other, Eigen and the standard library"),
] + [
    NotIn(rf"src/{module}/[^/]*$", rf"(?!({'|'.join([module, 'common', *below])})/[^/]*$)({'|'.join(MODULES)})/",
          f"{module} may include {', '.join(['common', *below])} only")
    for module, below in MODULES.items() if module not in ("verify", "prove") and not module.startswith("limits/")
] + [
    NotIn(r"src/limits/[^/]*/(ask|leg)", rf"(?!(core|sensor|query)/[^/]*$)({'|'.join(MODULES)})/",
          "what answers for a limit may include core, sensor and query only"),
    NotIn(r"src/limits/[^/]*/cut", rf"(?!(core|sensor|solid)/[^/]*$)({'|'.join(MODULES)})/",
          "what cuts to a limit may include core, sensor and solid only"),
    NotIn(r"src/limits/[^/]*/(?!ask|cut|leg|verify|prove)", r".*",
          "files of a limit are called after what they do: ask, cut, leg, verify, prove"),
]


def violations(root: pathlib.Path) -> list[str]:
    """One line for each include under src/, include/, python/, bench/ and tests/attack/ that breaks a rule."""
    found = []
    for folder in ("src", "include", "python/src", "bench", "tests/attack"):
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
    ("src/core/measure.cpp", "manifold/manifold.h", False),
    ("src/verify/occluders.cpp", "embree3/rtcore.h", True),
    ("src/scene/prepared_scene.cpp", "embree3/rtcore.h", False),
    ("src/depth/gl_depth.cpp", "GL/glcorearb.h", True),
    ("src/depth/choose.cpp", "EGL/egl.h", False),
    ("src/picture/canvas.cpp", "cairo.h", True),
    ("src/cli/command_render.cpp", "cairo.h", False),
    ("src/picture/resource_font.cpp", "ft2build.h", True),
    ("src/picture/canvas.cpp", "ft2build.h", False),
    ("src/exact/triangulation.cpp", "CDT.h", True),
    ("src/maps/city/building_solid.cpp", "CDT.h", True),
    ("src/core/orientation.cpp", "CDT.h", True),
    ("src/simplify/exact.cpp", "CDT.h", False),
    ("src/io/triangulate_polygon.cpp", "predicates.h", False),
    ("src/geo/local_frame.cpp", "proj.h", True),
    ("src/io/place.cpp", "proj.h", False),
    ("src/maps/osm/extract.cpp", "osmium/io/reader.hpp", True),
    ("src/maps/city/city.cpp", "osmium/io/reader.hpp", False),
    ("src/app/kml_zones_expat.cpp", "expat.h", True),
    ("src/app/zone_file.cpp", "expat.h", False),
    ("src/maps/city/clipping.cpp", "polyclipping/clipper.hpp", True),
    ("src/maps/city/building_solid.cpp", "polyclipping/clipper.hpp", False),
    ("src/flight/tour/linear_program_highs.cpp", "Highs.h", True),
    ("src/flight/tour/pairs_bound.cpp", "Highs.h", False),
    ("src/core/threads_tbb.cpp", "oneapi/tbb/parallel_for.h", True),
    ("src/exact/envelope.cpp", "tbb/parallel_for.h", False),
    ("src/cli/main.cpp", "CLI/CLI.hpp", True),
    ("src/app/reader.cpp", "CLI/CLI.hpp", False),
    ("src/app/reader.cpp", "yaml-cpp/yaml.h", True),
    ("src/cli/main.cpp", "yaml-cpp/yaml.h", False),
    ("src/io/draco_library.cpp", "draco/compression/decode.h", True),
    ("src/io/gltf.cpp", "draco/compression/decode.h", False),
    ("src/io/meshopt_library.cpp", "meshoptimizer.h", True),
    ("src/tiles/content.cpp", "meshoptimizer.h", False),
    ("src/io/gzip.cpp", "zlib.h", True),
    ("src/app/report.cpp", "zlib.h", False),
    ("src/maps/osm/text_input.cpp", "zlib.h", True),
    ("src/maps/osm/extract.cpp", "zlib.h", False),
    ("src/core/format.h", "fmt/format.h", True),
    ("src/cli/text_table.cpp", "fmt/format.h", False),
    ("src/app/report.cpp", "fmt/format.h", False),
    ("src/verify/verify.cpp", "core/format.h", True),
    ("src/exact/engine.h", "core/format.h", False),
    ("src/app/report.cpp", "nlohmann/json.hpp", True),
    ("src/exact/engine.cpp", "nlohmann/json.hpp", False),
    ("src/live/page_server.cpp", "boost/beast/core.hpp", True),
    ("src/live/session.cpp", "boost/beast/core.hpp", False),
    ("src/live/session.cpp", "app/schema.h", False),
    ("src/verify/verify.cpp", "core/progress_reporter.h", True),
    ("src/verify/verify.cpp", "core/bvh.h", False),
    ("src/verify/verify.cpp", "maps/city/city.h", False),
    ("src/maps/city/city.cpp", "maps/osm/extract.h", True),
    ("src/maps/osm/extract.cpp", "maps/city/footprint.h", False),
    ("src/verify/verify.cpp", "../exact/numerics.h", False),
    ("include/vantage/scene.h", "vantage/geometry.h", True),
    ("include/vantage/scene.h", "Eigen/Core", True),
    ("include/vantage/scene.h", "vector", True),
    ("include/vantage/scene.h", "core/bvh.h", False),
    ("include/vantage/scene.h", "boost/any.hpp", False),
    ("include/vantage/scene.h", "common/input.h", False),
    ("src/common/json.h", "vantage/scene.h", True),
    ("src/cli/main.cpp", "common/input.h", True),
    ("src/verify/verify.cpp", "common/input.h", True),
    ("src/verify/verify.cpp", "common/json.h", False),
    ("python/src/volume.cpp", "common/json.h", True),
    ("bench/bench_query.cpp", "common/resources.h", True),
    ("tests/attack/judge.cpp", "common/input.h", False),
    ("bench/bench_query.cpp", "vantage/query.h", True),
    ("bench/bench_query.cpp", "support/internals.h", False),
    ("bench/kernels/bench_depth_images.cpp", "depth/depth.h", True),
    ("tests/attack/judge.cpp", "vantage/volume.h", True),
    ("python/src/volume.cpp", "nanobind/nanobind.h", True),
    ("src/app/report.cpp", "nanobind/nanobind.h", False),
    ("python/src/program.cpp", "cli/program.h", True),
    ("python/src/volume.cpp", "vantage/volume.h", True),
    ("python/src/volume.cpp", "core/bvh.h", False),
    ("src/limits/zones/verify.cpp", "verify/limit_probe.h", True),
    ("src/limits/zones/verify.cpp", "vantage/each_limit.h", True),
    ("src/limits/zones/verify.cpp", "prove/prism.h", False),
    ("src/limits/zones/verify.cpp", "core/bvh.h", False),
    ("src/limits/zones/prove.cpp", "prove/prism.h", True),
    ("src/limits/zones/prove.cpp", "query/zone_place.h", False),
    ("src/limits/zones/prove.cpp", "limits/zones/verify.h", False),
    ("src/limits/zones/ask.cpp", "query/zone_place.h", True),
    ("src/limits/zones/leg.cpp", "prove/prism.h", False),
    ("src/limits/zones/cut.cpp", "solid/region_builder.h", True),
    ("src/limits/zones/cut.cpp", "query/zone_place.h", False),
    ("src/limits/frame/cut.cpp", "sensor/best_aim.h", True),
    ("src/limits/zones/text.cpp", "vector", False),
    ("src/verify/verify.cpp", "limits/zones/verify.h", False),
    ("tests/attack/judge.cpp", "trial.h", True),
    ("tests/attack/judge.cpp", "exact/blocker.h", False),
] + [
    (f"src/{module}/any.cpp", f"{other}/any.h", other == module or other in below or (other == "common" and module != "prove"))
    for module, below in MODULES.items() for other in MODULES if module != "verify" and not module.startswith("limits/")
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
