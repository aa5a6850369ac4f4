// The volumes of a mission's targets as files of regions, for cities.py: computed volumes, which lie inside, for tours;
// outer volumes for bounds.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/stopwatch.h"
#include "region_files.h"
#include "vantage/city.h"
#include "vantage/mission.h"
#include "vantage/result.h"

namespace {

struct Asked {
  std::string mission, inner, outer;
  std::size_t count = 0;  // 0: all
  int threads = 2;
  vantage::OuterOptions how;
};

void run(const Asked& asked) {
  const vantage::Mission mission = vantage::resolve_mission(vantage::read_mission(asked.mission));
  vantage::RunOptions options;
  options.threads = asked.threads;
  options.prepared = vantage::PreparedScene(mission.scene());
  const vantage::internal::core::Stopwatch watch;
  std::vector<vantage::Result> results;
  if (vantage::volume_count(mission) == 1) {
    results.push_back(vantage::run_mission(mission, options));
  } else {
    results = vantage::run_missions(mission, options);
  }
  const double inner_s = watch.seconds();
  std::vector<vantage::Mesh> inner, outer;
  for (std::size_t i = 0; i < results.size() && (asked.count == 0 || inner.size() < asked.count); ++i) {
    if (results[i].volume.mesh.empty()) {
      std::cerr << "target " << i << " is left out: " << results[i].volume.reason << "\n";
      continue;
    }
    inner.push_back(std::move(results[i].volume.mesh));
    outer.push_back(vantage::outer_volume(vantage::one_volume(mission, i), options, asked.how).volume.mesh);
  }
  if (inner.size() < asked.count) throw std::runtime_error("too few targets are seen from anywhere");
  std::cout << inner.size() << " " << inner_s << " " << watch.seconds() - inner_s << "\n";
  vantage::bench::write_regions(inner, asked.inner);
  vantage::bench::write_regions(outer, asked.outer);
}

}  // namespace

int main(int count, char** words) {
  vantage::enable_maps();
  CLI::App app("Writes the volumes of a mission's targets as regions; prints how many, and seconds of both kinds.");
  Asked asked;
  app.add_option("MISSION", asked.mission)->required();
  app.add_option("INNER", asked.inner, "computed volumes, to be written")->required();
  app.add_option("OUTER", asked.outer, "outer volumes, to be written")->required();
  app.add_option("--count", asked.count, "the first ones that are seen from somewhere; 0: all")->capture_default_str();
  app.add_option("--outer-tolerance", asked.how.tolerance_m, "m; 0: a thousandth of the range")->capture_default_str();
  app.add_option("--threads", asked.threads, "at most")->capture_default_str();
  CLI11_PARSE(app, count, words);
  try {
    run(asked);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
