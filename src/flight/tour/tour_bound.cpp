#include "flight/tour/tour_bound.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/format.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "flight/tour/cells.h"
#include "vantage/error.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kShareOfPairs = 0.3;  // of the time, where both bounds are asked for
constexpr double kWorthOfPairs = 0.9;  // of the bound that is asked for: from less it does not come near by branching
constexpr double kRounded = 1e-9;      // of the size: what an incumbent may be off by

void check_problem(const BoundProblem& problem) {
  if (problem.regions.empty()) {
    throw Error(ErrorCode::nothing_given, "there is no region to visit", "tour", "give one region or more");
  }
  if (!problem.closed && !problem.start) {
    throw Error(ErrorCode::nothing_given, "an open tour needs a start", "tour", "give home, or a closed tour");
  }
  if (!problem.dwell_m.empty() && problem.dwell_m.size() != problem.regions.size()) {
    throw Error(ErrorCode::array_sizes_differ, "there are lengths of stay for another number of regions", "dwell_m",
                "give one length for each region, or none");
  }
  if (!(problem.turn_radius_m >= 0) || !std::isfinite(problem.turn_radius_m)) {
    throw Error(ErrorCode::value_out_of_range, "a radius of turning is negative or not finite", "turn_radius_m",
                "give metres, 0 or more");
  }
  for (const double dwell : problem.dwell_m) {
    if (!(dwell >= 0) || !std::isfinite(dwell)) {
      throw Error(ErrorCode::value_out_of_range, "a length of stay is negative or not finite", "dwell_m",
                  "give metres, 0 or more");
    }
  }
}

void check_incumbent(const Incumbent& incumbent, std::size_t regions) {
  if (incumbent.order.empty()) return;
  std::vector<std::size_t> sorted = incumbent.order;
  std::sort(sorted.begin(), sorted.end());
  bool all = sorted.size() == regions && incumbent.points.size() == regions;
  for (std::size_t i = 0; all && i < regions; ++i) all = sorted[i] == i && incumbent.points[i].allFinite();
  if (!all) {
    throw Error(ErrorCode::array_sizes_differ, "the known tour does not visit each region once", "incumbent",
                "give each region and a finite point of it once");
  }
}

[[noreturn]] void refuse_region(const std::string& what, const std::string& name) {
  throw Error(ErrorCode::internal_defect, what + ": the region is smaller than what is to be visited", name,
              "bounds need outer volumes; tell the authors if this is one");
}

/// Each point of the known tour lies in its region: a region that is too small shows here at the latest.
void check_points(const Cells& cells, const BoundProblem& problem, const Incumbent& incumbent) {
  for (std::size_t k = 0; k < incumbent.order.size(); ++k) {
    const std::size_t region = incumbent.order[k];
    const Hull& hull = *cells[region].hull;
    const double allowed = kRounded * (hull.reach_m() + cells.origin().cwiseAbs().maxCoeff()) + 1e-6;
    const double off = cells.distance_m(region, incumbent.points[k] - cells.origin());
    if (off > allowed) {
      refuse_region(core::format("a point of the known tour lies {:.3g} m outside of its region", off),
                    problem.regions[region].name());
    }
  }
}

std::vector<Vec3> anchors_of(const Cells& cells, const Incumbent& incumbent) {
  std::vector<Vec3> anchors;
  for (std::size_t r = 0; r < cells.region_count(); ++r) anchors.push_back(cells[r].hull->inside());
  for (std::size_t k = 0; k < incumbent.order.size(); ++k) {
    anchors[incumbent.order[k]] = incumbent.points[k] - cells.origin();
  }
  return anchors;
}

/// The order of all regions that are not ends: the start of a closed tour stands at its beginning.
std::vector<std::size_t> order_of(const Incumbent& incumbent, const TourBound& result) {
  std::vector<std::size_t> order = incumbent.order;
  if (!order.empty() && result.space.closed && result.regions.size() > order.size()) order.push_back(order.size());
  return order;
}

void add_orders(const std::vector<std::vector<std::size_t>>& more, std::vector<std::vector<std::size_t>>& orders) {
  for (const std::vector<std::size_t>& order : more) {
    if (std::find(orders.begin(), orders.end(), order) == orders.end()) orders.push_back(order);
  }
}

}  // namespace

const char* name_of(BoundKind kind) { return kind == BoundKind::insertion ? "insertion" : "pairs"; }

TourBound bound_tour(const BoundProblem& problem, const Incumbent& incumbent, const BoundOptions& options,
                     const Progress& progress) {
  check_problem(problem);
  check_incumbent(incumbent, problem.regions.size());
  const core::ProgressReporter reporter(progress, "tour");
  core::Stopwatch watch;
  TourBound result;
  result.regions = problem.regions;
  result.space.closed = problem.closed;
  result.space.dwell_m = problem.dwell_m;
  result.space.turn_radius_m = problem.turn_radius_m;
  const auto add_place = [&](const Vec3& place, const char* name) {
    result.regions.push_back(OuterRegion::point(place, name));
    if (!result.space.dwell_m.empty()) result.space.dwell_m.push_back(0);
    return result.regions.size() - 1;
  };
  if (problem.start) {
    const std::size_t at = add_place(*problem.start, "start");
    if (!problem.closed) result.space.first = at;
  }
  if (problem.finish && !problem.closed) result.space.last = add_place(*problem.finish, "finish");

  parallel::with_threads(options.threads, [&] {
    Cells cells(result.regions);
    check_points(cells, problem, incumbent);
    const double enough = std::isfinite(incumbent.length_m) ? incumbent.length_m * (1 - options.gap)
                                                            : std::numeric_limits<double>::infinity();
    const bool pairs = options.by_pairs && has_pairs_bound() && cells.region_count() >= 5;
    // By pairs first: it takes a second or two where it is any good, that is, where regions are small and far apart.
    if (pairs) {
      reporter.begin("bound by pairs");
      PairsOptions how;
      how.enough_m = enough;
      how.worth_m = std::isfinite(enough) && options.by_insertion ? kWorthOfPairs * enough : 0;
      how.time_limit_s = options.time_limit_s * (options.by_insertion ? kShareOfPairs : 1);
      PairsBound bound =
          pairs_bound(cells, result.space, anchors_of(cells, incumbent), order_of(incumbent, result), how, reporter);
      reporter.finish();
      result.pairs_m = result.length_m = bound.bound_m;
      result.kind = BoundKind::pairs;
      result.proof = std::move(bound.proof);
      add_orders(bound.orders, result.orders);
    }
    if (!pairs || (options.by_insertion && result.length_m < enough)) {
      reporter.begin("bound by insertion");
      InsertionOptions how;
      how.enough_m = enough;
      how.gap = options.gap;
      how.most_nodes = options.most_nodes;
      how.time_limit_s = std::max(0.0, options.time_limit_s - watch.seconds());
      InsertionBound bound = insertion_bound(cells, result.space, how, reporter);
      reporter.finish();
      result.insertion_m = bound.bound_m;
      add_orders(bound.orders, result.orders);
      if (!pairs || bound.bound_m > result.length_m) {
        result.length_m = bound.bound_m;
        result.kind = BoundKind::insertion;
        result.proof = std::move(bound.tree);
      }
    }
  });
  // A stretch in a region that serves it alone leaves no room to turn there.
  const auto has_none = [](const std::vector<double>& dwell_m) {
    return dwell_m.empty() || std::find(dwell_m.begin(), dwell_m.end(), 0.0) != dwell_m.end();
  };
  const bool has_turning = problem.turn_radius_m > 0 && has_none(problem.dwell_m);
  result.ignored = {"obstacles between the regions", has_turning ? "climbing" : "turning and climbing", "acceleration"};
  result.length_m = std::max(0.0, result.length_m);
  if (!std::isfinite(incumbent.length_m)) {
    result.gap = 1;
    return result;
  }
  result.gap = incumbent.length_m > 0 ? (incumbent.length_m - result.length_m) / incumbent.length_m : 0;
  if (result.length_m > incumbent.length_m * (1 + kRounded) + 1e-6) {
    refuse_region(core::format("the bound, {:.6g} m, is above the length of a known tour, {:.6g} m", result.length_m,
                               incumbent.length_m),
                  "tour");
  }
  result.gap_reached = result.gap <= options.gap;
  return result;
}

}  // namespace vantage::internal::flight::tour
