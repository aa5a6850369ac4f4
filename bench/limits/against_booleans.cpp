// Volumes with limits of the sensor, as they are made, against booleans of the same: random targets with random limits
// in real cities. Both are judged by prove_volume and verify_volume. A line of CSV for each mission, and a summary.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "limits/draws.h"
#include "support/cities.h"
#include "vantage/prove.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

struct Options {
  int missions = 250;
  std::size_t points = 1000;
  int prove_every = 1;
  std::uint64_t seed = 1;
  double tolerance_m = 0.05;
  std::vector<std::string> limits;  // empty: all
  std::vector<std::string> cities = {"charlotte", "munich", "florence", "openfoam"};
};

struct Tally {
  std::size_t missions = 0, empty = 0, in_chart = 0, fallbacks = 0, without_limits = 0;
  std::size_t tried = 0, proved = 0, proved_of_booleans = 0, inside = 0, over = 0, under = 0, under_of_booleans = 0,
              other_outcome = 0;
  std::size_t not_as_proved = 0;  ///< where the booleans are
  std::size_t facets = 0, facets_of_booleans = 0;
  double thicker_m = 0, thinner_m = 0;  ///< by how much, on average over the surface of a volume; at most
};

struct Judged {
  VerifyReport report;
  bool is_proved = false;  ///< where it was tried
};

Judged judged(const PreparedCity& city, const PreparedTarget& target, const Volume& volume, bool is_to_be_proved,
              const Options& options) {
  VerifyOptions verify;
  verify.points = options.points;
  verify.seed = options.seed;
  verify.lift_m = volume.lift_m;
  verify.tolerance_m = volume.tolerance_m;
  Judged result{verify_volume(city.scene, target.target(), target.sensor(), {}, volume.mesh, verify)};
  if (is_to_be_proved) {
    const ProveOptions prove{.lift_m = volume.lift_m};
    result.is_proved = prove_volume(city.scene, target.target(), target.sensor(), {}, volume.mesh, prove).verdict() ==
                       ProofVerdict::proved;
  }
  return result;
}

void run_mission(const char* name, const PreparedCity& city, const Options& options, Draw& draw, Tally& tally) {
  std::string names;
  const Sensor sensor = draw_sensor(draw, options.limits, names);
  const PreparedTarget target = draw_prepared(city, sensor, draw);
  const ExactOptions exact{.tolerance_m = options.tolerance_m};
  const Volume view = compute_view(target, exact);
  const bool in_chart = !view.kept_limits.empty();
  const Volume volume = compute_volume(target, {}, exact);
  const Volume wanted = cut_to_limits(compute_parts(target, exact), target, {});
  ++tally.missions;
  tally.in_chart += in_chart;
  tally.without_limits += names.empty();
  tally.fallbacks += volume.counts.boolean_fallbacks > 0;
  tally.other_outcome += volume.outcome != wanted.outcome;
  if (volume.outcome != Outcome::computed || wanted.outcome != Outcome::computed) {
    tally.empty += volume.outcome == wanted.outcome;
    std::printf("%s,%s,%d,%zu,%s,%s\n", name, names.c_str(), in_chart, volume.counts.boolean_fallbacks,
                name_of(volume.outcome), name_of(wanted.outcome));
    return;
  }
  const MeshMeasures one = measure(volume.mesh), other = measure(wanted.mesh);
  const double thicker_m = (one.volume_m3 - other.volume_m3) / other.area_m2;
  const bool is_to_be_proved = tally.missions % static_cast<std::size_t>(options.prove_every) == 0;
  const Judged found = judged(city, target, volume, is_to_be_proved, options),
               reference = judged(city, target, wanted, is_to_be_proved, options);
  tally.tried += is_to_be_proved;
  tally.thicker_m = std::max(tally.thicker_m, thicker_m);
  tally.thinner_m = std::max(tally.thinner_m, -thicker_m);
  tally.proved += found.is_proved;
  tally.proved_of_booleans += reference.is_proved;
  tally.not_as_proved += reference.is_proved && !found.is_proved;
  tally.inside += found.report.inside;
  tally.over += found.report.over_claimed;
  tally.under += found.report.under_claimed;
  tally.under_of_booleans += reference.report.under_claimed;
  tally.facets += one.facets;
  tally.facets_of_booleans += other.facets;
  std::printf("%s,%s,%d,%zu,%.6g,%.6g,%.3g,%zu,%zu,%d,%d,%zu,%zu,%zu,%d\n", name, names.c_str(), in_chart,
              volume.counts.boolean_fallbacks, one.volume_m3, other.volume_m3, thicker_m, one.facets, other.facets,
              found.is_proved, reference.is_proved, found.report.over_claimed, found.report.under_claimed,
              reference.report.under_claimed, one.closed && one.oriented);
  std::fflush(stdout);
}

int run(const Options& options) {
  std::printf("# seed %llu\n", static_cast<unsigned long long>(options.seed));
  std::printf(
      "city,limits,in_chart,fallbacks,volume_m3,of_booleans_m3,thicker_m,facets,of_booleans,proved,proved_of_booleans,"
      "over,under,under_of_booleans,closed\n");
  Draw draw(options.seed);
  Tally t;
  for (const City* city : {&kCharlotte, &kMunich, &kFlorence, &kOpenfoam}) {
    if (std::find(options.cities.begin(), options.cities.end(), city->name) == options.cities.end()) continue;
    const PreparedCity* const ready = prepared_city(*city);
    if (!ready) {
      std::cerr << absence(*city) << "\n";
      continue;
    }
    for (int i = 0; i < options.missions; ++i) run_mission(city->name, *ready, options, draw, t);
  }
  std::printf("# %zu missions, %zu without limits, %zu empty, %zu empty in one way only\n", t.missions,
              t.without_limits, t.empty, t.other_outcome);
  std::printf("# in the chart: %zu; booleans stood in for %zu\n", t.in_chart, t.fallbacks);
  std::printf("# %zu of %zu proved, %zu by booleans, of which %zu not as they are made\n", t.proved, t.tried,
              t.proved_of_booleans, t.not_as_proved);
  std::printf("# %zu points inside, %zu over-claimed, %zu under-claimed, %zu by booleans\n", t.inside, t.over, t.under,
              t.under_of_booleans);
  std::printf("# thicker by at most %.3g m, thinner by at most %.3g m; %zu facets, %zu by booleans\n", t.thicker_m,
              t.thinner_m, t.facets, t.facets_of_booleans);
  return t.over == 0 && t.not_as_proved == 0 ? 0 : 1;
}

}  // namespace
}  // namespace vantage::bench

int main(int argc, char** argv) {
  vantage::bench::Options options;
  CLI::App app(
      "Compares volumes with random limits of the sensor in real cities with booleans of the same. Exit 1 where one "
      "claims wrongly, or is not proved where the booleans are.");
  app.add_option("--missions", options.missions, "in each city")->capture_default_str();
  app.add_option("--points", options.points, "viewpoints for each volume")->capture_default_str();
  app.add_option("--prove-every", options.prove_every, "one of so many; a proof of a camera that turns takes a minute")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--tolerance", options.tolerance_m, "metres")->capture_default_str();
  app.add_option("--limits", options.limits, "that may be drawn; all if not given")->delimiter(',');
  app.add_option("--cities", options.cities)->capture_default_str()->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  return vantage::bench::run(options);
}
