// How far the spheres method is from the exact volume: for targets of real scenes, over face sizes and splits, what it
// claims too much and what it misses, by booleans of both meshes. One line of CSV a case on standard output.
//   vantage_gap [--cities charlotte,munich,...] [--targets 20] [--range 300] [--sizes 40,100,200] [--splits 0,...,6]
//               [--spheres conservative,centers] [--split euler|always]
// The city "baseline" means the three targets of charlotte/baseline.json; of the others the targets are drawn at random
// with a fixed seed (support/street_targets.h). The splits go up: a case that no further split can change is not
// computed again, its figures are repeated.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/cities.h"
#include "vantage/error.h"
#include "vantage/spheres.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

struct Request {
  std::vector<std::string> cities{"baseline", "charlotte", "munich", "florence", "etoile"};
  int targets = 20, skip = 0;
  std::vector<double> ranges{300};
  std::vector<int> sizes{40, 100, 200}, splits{0, 1, 2, 3, 4, 5, 6};
  std::vector<std::string> spheres{"conservative", "centers"};
  std::string split = "euler";
  double merge = SpheresOptions().merge;
};

const City kEtoile{"etoile", "mesh/etoile_merged.ply", UpAxis::z, {}, 0};

const City& city_named(const std::string& name) {
  static const std::map<std::string, const City*> kCities = {{"baseline", &kCharlotte},
                                                             {"charlotte", &kCharlotte},
                                                             {"munich", &kMunich},
                                                             {"florence", &kFlorence},
                                                             {"etoile", &kEtoile}};
  const auto found = kCities.find(name);
  if (found == kCities.end()) {
    throw Error(ErrorCode::unknown_choice, "no city is called " + name, "--cities",
                "see the first lines of bench/gap/gap.cpp");
  }
  return *found->second;
}

/// What a run came to, but for the name of the case.
struct RunFigures {
  std::string text;
  bool settled = false;  ///< more splits would change nothing: no pair was left that fails the test
};

RunFigures run_case(const Volume& exact, const PreparedTarget& target, const SpheresOptions& options) {
  SpheresReport report;
  const Volume claimed = compute_visibility_spheres(target, options, &report);
  const double exact_m3 = enclosed_volume(exact.mesh), claimed_m3 = enclosed_volume(claimed.mesh);
  const double both_m3 = claimed.mesh.empty() ? 0 : enclosed_volume(intersect_volumes({claimed, exact}).mesh);
  // With max_splits 0 no pair is tested, and nothing is known of them.
  const bool is_tested = options.split == SpheresOptions::Split::euler && report.pairs > 0;
  char text[256];
  std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f,%.6f,%zu,%zu,%zu,%zu,%ld,%.4f", exact_m3, claimed_m3,
                claimed_m3 - both_m3, exact_m3 - both_m3, report.spheres, report.pairs, report.splits,
                report.unresolved_pairs, measure(claimed.mesh).euler, claimed.seconds.total);
  return {text, is_tested && report.unresolved_pairs == 0};
}

void run_target(const Request& request, const std::string& city, std::size_t number, double range,
                const PreparedScene& scene, const Target& target) {
  const PreparedTarget prepared(scene, target, {range});
  const Volume exact = compute_visibility(prepared, {1e-3, 0});
  for (const std::string& sphere : request.spheres) {
    for (const int size : request.sizes) {
      RunFigures figures;
      for (const int splits : request.splits) {
        SpheresOptions options;
        options.sphere = sphere == "centers" ? SpheresOptions::Sphere::centers : SpheresOptions::Sphere::conservative;
        options.split = request.split == "always" ? SpheresOptions::Split::always : SpheresOptions::Split::euler;
        options.merge = request.merge;
        options.cubemap = size;
        options.max_splits = splits;
        if (!figures.settled) figures = run_case(exact, prepared, options);
        std::printf("%s,%zu,%g,%s,%s,%d,%d,%s\n", city.c_str(), number, range, sphere.c_str(), request.split.c_str(),
                    size, splits, figures.text.c_str());
        std::fflush(stdout);
      }
    }
  }
}

void run(const Request& request) {
  std::puts(
      "city,target,range_m,sphere,split,texels,max_splits,exact_m3,spheres_m3,over_m3,missing_m3,spheres,pairs,splits,"
      "unresolved,euler,seconds");
  for (const std::string& name : request.cities) {
    const City& city = city_named(name);
    if (!is_there(city)) {
      std::fprintf(stderr, "%s\n", absence(city).c_str());
      continue;
    }
    const Scene scene = read_city(city);
    const PreparedScene prepared(scene);
    const auto targets = name == "baseline"
                             ? prepared_city(kCharlotte)->targets
                             : find_street_targets(scene, prepared, {}, static_cast<std::size_t>(request.targets));
    std::fprintf(stderr, "%s: %zu targets\n", name.c_str(), targets.size());
    for (std::size_t i = static_cast<std::size_t>(request.skip); i < targets.size(); ++i)
      for (const double range : request.ranges) run_target(request, name, i + 1, range, prepared, targets[i].target);
  }
}

}  // namespace
}  // namespace vantage::bench

int main(int argument_count, char** arguments) {
  vantage::bench::Request request;
  CLI::App app("What the spheres method claims too much and misses, against the exact volume");
  app.add_option("--cities", request.cities)->delimiter(',');
  app.add_option("--targets", request.targets, "of each city");
  app.add_option("--skip", request.skip, "leave out so many of them, from the first");
  app.add_option("--range", request.ranges, "metres")->delimiter(',');
  app.add_option("--sizes", request.sizes, "texels a face side")->delimiter(',');
  app.add_option("--splits", request.splits, "max_splits")->delimiter(',');
  app.add_option("--spheres", request.spheres, "conservative, centers")->delimiter(',');
  app.add_option("--split", request.split, "euler or always");
  app.add_option("--merge", request.merge, "as in missions");
  CLI11_PARSE(app, argument_count, arguments);
  try {
    vantage::bench::run(request);
  } catch (const vantage::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
