// Plans a tour of some regions and bounds it, for published.py and cities.py. Tours go through inner regions, bounds
// are over outer ones: region_files.h has the format. Prints the tour's length, the bound, which bound it is, and
// seconds: of all, of the tour, and those that the processors spent.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "flight/tour/tour_bound.h"
#include "flight/tour/tour_certificate.h"
#include "region_files.h"
#include "vantage/tour.h"

namespace {

namespace tour = vantage::internal::flight::tour;

struct Asked {
  std::string inner, outer, certificate, only;
  double seconds = 60, gap = 0.001;
  double share_of_tour = 0.4;  // of the time, at most
  int threads = 1;
  bool wing = false;
  vantage::TourVehicle vehicle;
  std::uint64_t seed = 1;
};

vantage::Tour planned(const std::vector<vantage::Mesh>& inner, const Asked& asked) {
  vantage::TourRequest request;
  request.settings.dwell_s = request.settings.margin_m = request.settings.clearance_m = 0;
  request.settings.simultaneous = true;
  request.settings.time_limit_s = asked.share_of_tour * asked.seconds;
  request.settings.vehicle = asked.vehicle;
  request.settings.vehicle.kind =
      asked.wing ? vantage::TourVehicle::Kind::fixed_wing : vantage::TourVehicle::Kind::multirotor;
  request.chord_error_m = 0.01;
  request.seed = asked.seed;
  for (std::size_t i = 0; i < inner.size(); ++i) request.targets.push_back({std::to_string(i), inner[i], {}});
  return vantage::plan_tour(request);
}

void run(const Asked& asked) {
  const vantage::internal::core::Stopwatch watch;
  const vantage::Tour flown = planned(vantage::bench::read_regions(asked.inner), asked);
  if (!flown.problems.empty()) throw std::runtime_error("a region was left out");
  tour::BoundProblem problem;
  for (vantage::Mesh& mesh : vantage::bench::read_regions(asked.outer)) {
    problem.regions.push_back(tour::OuterRegion::given(std::move(mesh), std::to_string(problem.regions.size())));
  }
  if (asked.wing) problem.turn_radius_m = asked.vehicle.turn_radius_m;
  tour::Incumbent incumbent;
  incumbent.length_m = flown.length_m;
  for (const vantage::TourVisit& visit : flown.visits) {
    incumbent.order.push_back(visit.target);
    incumbent.points.push_back(flown.flight.points[visit.first_point].position);
  }
  const double planned_s = watch.seconds();
  tour::BoundOptions options;
  options.gap = asked.gap;
  options.threads = asked.threads;
  options.by_insertion = asked.only != "pairs";
  options.by_pairs = asked.only != "insertion";
  options.time_limit_s = std::max(1.0, asked.seconds - planned_s);
  const tour::TourBound bound = tour::bound_tour(problem, incumbent, options);
  std::cout.precision(12);
  std::cout << flown.length_m << " " << bound.length_m << " " << name_of(bound.kind) << " " << watch.seconds() << " "
            << planned_s << " " << static_cast<double>(std::clock()) / CLOCKS_PER_SEC << "\n";
  if (!asked.certificate.empty()) tour::write_tour_certificate(bound, asked.certificate);
}

}  // namespace

int main(int count, char** words) {
  CLI::App app("Plans a tour of some regions and bounds it.");
  Asked asked;
  app.add_option("INNER", asked.inner)->required();
  app.add_option("OUTER", asked.outer)->required();
  app.add_option("--seconds", asked.seconds)->capture_default_str();
  app.add_option("--gap", asked.gap, "at which it ends")->capture_default_str();
  app.add_option("--threads", asked.threads)->capture_default_str();
  app.add_option("--seed", asked.seed)->capture_default_str();
  app.add_flag("--wing", asked.wing, "a fixed wing, not a multirotor");
  app.add_option("--radius", asked.vehicle.turn_radius_m, "m, of a fixed wing")->capture_default_str();
  app.add_option("--descent", asked.vehicle.min_climb_deg, "degrees, negative")->capture_default_str();
  app.add_option("--climb", asked.vehicle.max_climb_deg, "degrees")->capture_default_str();
  app.add_option("--only", asked.only, "one of the two bounds")->check(CLI::IsMember({"insertion", "pairs"}));
  app.add_option("--certificate", asked.certificate, "to be written");
  CLI11_PARSE(app, count, words);
  try {
    vantage::internal::parallel::with_threads(asked.threads, [&] { run(asked); });
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
