// How right volumes with limits of the sensor are in real cities: random targets with random limits, each judged by
// verify_volume, which shares no geometry with the engine; and whether the judge notices a limit that was loosened.
// A line of CSV for each volume, and a summary. docs/camera.md, "How right it is", has the figures.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "limits/draws.h"
#include "support/cities.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

/// Where a loosened limit adds a part of the volume that holds so many of the points, the judge must find one of them.
constexpr double kLeastWrongPoints = 5;

struct Tally {
  std::size_t volumes = 0, empty = 0, points = 0, inside = 0, over = 0, under = 0, undecided = 0;
  std::size_t with_over = 0;  ///< volumes
  std::size_t unnoticed = 0;  ///< volumes with nothing over-claimed where much is

  void add(const VerifyReport& report) {
    ++volumes;
    points += report.points;
    inside += report.inside;
    over += report.over_claimed;
    under += report.under_claimed;
    undecided += report.undecided;
    with_over += report.over_claimed > 0;
  }
  void print(const std::string& name) const {
    const double all = static_cast<double>(std::max<std::size_t>(inside + under, 1));
    std::printf(
        "# %s: %zu volumes with over-claims in %zu, %zu empty; %zu points, %zu inside, %zu over-claimed, "
        "%zu under-claimed (%.3f %% of what is right), %zu undecided\n",
        name.c_str(), with_over, volumes, empty, points, inside, over, under, 100.0 * static_cast<double>(under) / all,
        undecided);
  }
};

struct Options {
  int targets = 25;
  std::size_t points = 10000;
  std::uint64_t seed = 1;
  std::vector<std::string> cities = {"charlotte", "munich", "florence", "openfoam"};
};

VerifyReport judged(const PreparedCity& city, const PreparedTarget& target, const Sensor& asked, const Volume& volume,
                    const Options& options) {
  VerifyOptions verify;
  verify.points = options.points;
  verify.seed = options.seed;
  verify.lift_m = volume.lift_m;
  verify.tolerance_m = volume.tolerance_m;
  return verify_volume(city.scene, target.target(), asked, {}, volume.mesh, verify);
}

void print_row(const char* city, int number, const std::string& names, const Volume& volume,
               const VerifyReport& report) {
  std::printf("%s,%d,%s,%zu,%.6g,%zu,%zu,%zu,%zu,%.3g,%s\n", city, number, names.c_str(), volume.mesh.triangles.size(),
              enclosed_volume(volume.mesh), report.inside, report.over_claimed, report.under_claimed, report.undecided,
              report.worst_over_depth_m, report.worst_over_cause.c_str());
  std::fflush(stdout);
}

/// Random limits together, as asked.
void run_together(const char* name, const PreparedCity& city, const Options& options, Draw& draw, Tally& tally) {
  for (int i = 0; i < options.targets; ++i) {
    std::string names;
    const Sensor sensor = draw_sensor(draw, {}, names);
    const PreparedTarget target = draw_prepared(city, sensor, draw);
    const Volume volume = compute_volume(target);
    if (volume.outcome != Outcome::computed) {
      ++tally.empty;
      --i;
      continue;
    }
    const VerifyReport report = judged(city, target, sensor, volume, options);
    print_row(name, i, names.empty() ? "none" : names, volume, report);
    tally.add(report);
  }
}

/// One limit, of which the engine is told 1 % less than the judge.
void run_loosened(const char* name, const PreparedCity& city, const Limit& limit, const Options& options, Draw& draw,
                  Tally& tally) {
  for (int done = 0, tries = 0; done < 3 && tries < 100; ++tries) {
    Sensor asked{.max_range_m = 100};
    limit.add(asked, draw);
    Sensor loose = asked;
    limit.loosen(loose);
    const PreparedTarget target = draw_prepared(city, loose, draw);
    const Volume volume = compute_volume(target);
    const bool is_limited = std::any_of(volume.causes.begin(), volume.causes.end(),
                                        [](const Cause& cause) { return cause.kind == CauseKind::sensor; });
    if (!is_limited) continue;  // the sun is behind the target
    const VerifyReport report = judged(city, target, asked, volume, options);
    // Where the limit ends little of the volume, too little is wrong for a sample to hit it.
    const PreparedTarget as_asked(city.prepared, target.target(), asked);
    const double wrong_share = 1 - enclosed_volume(compute_volume(as_asked).mesh) / enclosed_volume(volume.mesh);
    const bool adds_enough = wrong_share * static_cast<double>(report.inside) >= kLeastWrongPoints;
    print_row(name, done++, std::string("loosened ").append(limit.name).append(adds_enough ? "" : " a little"), volume,
              report);
    tally.add(report);
    tally.unnoticed += adds_enough && report.over_claimed == 0;
  }
}

int run(const Options& options) {
  std::printf("# seed %llu\ncity,target,limits,facets,volume_m3,inside,over,under,undecided,worst_over_m,worst_cause\n",
              static_cast<unsigned long long>(options.seed));
  Draw draw(options.seed);
  Tally together;
  std::vector<Tally> loosened(limits().size());
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence, &kOpenfoam}) {
    if (std::find(options.cities.begin(), options.cities.end(), city->name) == options.cities.end()) continue;
    const PreparedCity* const ready = prepared_city(*city);
    if (!ready) {
      std::cerr << absence(*city) << "\n";
      continue;
    }
    run_together(city->name, *ready, options, draw, together);
    for (std::size_t i = 0; i < limits().size(); ++i) {
      run_loosened(city->name, *ready, limits()[i], options, draw, loosened[i]);
    }
  }
  together.print("limits together");
  bool noticed = true;
  for (std::size_t i = 0; i < limits().size(); ++i) {
    loosened[i].print(std::string("loosened by 1 %: ") + limits()[i].name);
    noticed = noticed && loosened[i].unnoticed == 0;
  }
  std::printf("# %s\n", noticed ? "every loosened limit was noticed" : "NOT every loosened limit was noticed");
  return together.over == 0 && noticed ? 0 : 1;
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  vantage::bench::Options options;
  CLI::App app(
      "Judges volumes with random limits of the sensor in real cities. Exit 1 where one claims wrongly, or "
      "where the judge does not notice a limit that was loosened by 1 %.");
  app.add_option("--targets", options.targets, "of each city")->capture_default_str();
  app.add_option("--points", options.points, "viewpoints for each volume")->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--cities", options.cities)->capture_default_str()->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  return vantage::bench::run(options);
}
