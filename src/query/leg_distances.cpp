// LegDistances: the nearest of all polygons, best first through the hierarchy.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/walk_bvh.h"
#include "query/leg_check.h"
#include "query/leg_segment.h"
#include "scene/prepared_data.h"
#include "vantage/error.h"

namespace vantage {
namespace {

/// What rounding may have moved the ends of a leg and the corners of polygons by, and these out of their plane.
double rounding_of(const PreparedScene::Data& scene, const Leg& leg) {
  constexpr double kRoundings = 16 * std::numeric_limits<double>::epsilon(), kBent = 0x1p-46, kMostBent = 1e-9;
  const Vec3 extent = scene.statistics.bounds.empty() ? Vec3(Vec3::Zero())
                                                      : Vec3(scene.statistics.bounds.max - scene.statistics.bounds.min);
  const double largest = std::max({leg.from.norm(), leg.to.norm(), scene.origin.norm(), extent.norm()});
  return kRoundings * largest + std::min(kMostBent, kBent * extent.norm());
}

/// What is nearer than `result` takes its place. `first_object`: what objects are numbered from.
template <typename IsLeftOut>
void find_nearer(const PreparedScene::Data& scene, const Leg& leg, const IsLeftOut& is_left_out,
                 std::uint32_t first_object, double cutoff_m, LegDistance& result) {
  const Vec3 from = leg.from - scene.origin, to = leg.to - scene.origin;
  const double rounding = rounding_of(scene, leg);
  double least = std::min(cutoff_m, result.distance_m) + rounding;
  LegDistance found;
  std::vector<Vec3> corners;
  internal::core::walk_nearest_first(
      scene.bvh,
      [&](const internal::core::Bounds& bounds) { return internal::query::distance_to_box(from, to, bounds); },
      least + rounding, [&](const internal::core::BvhNode&, double distance) { return distance <= least + rounding; },
      [&](std::uint32_t polygon) {
        const std::uint32_t object = scene.polygon_object[polygon];
        if (is_left_out(object)) return;
        corners.clear();
        for (const std::uint32_t vertex : scene.corners_of(polygon)) corners.push_back(scene.vertices[vertex]);
        const internal::query::NearestPair pair = internal::query::nearest_to_polygon(from, to, corners);
        const double distance = std::sqrt(pair.squared_distance);
        const bool is_first = found.distance_m == std::numeric_limits<double>::infinity();
        if (!(distance < least || (is_first && distance <= least))) return;
        least = distance;
        found.distance_m = distance;
        found.share = pair.share;
        found.point = scene.origin + pair.point;
        found.object = object;
      });
  if (!std::isfinite(found.distance_m)) return;
  found.distance_m = std::max(0.0, found.distance_m - rounding);
  if (!(found.distance_m < result.distance_m)) return;
  found.name = display_name(scene.objects[found.object]);
  found.object += first_object;
  result = std::move(found);
}

}  // namespace

LegDistances::LegDistances(const PreparedScene& scene, const LegDistanceOptions& options)
    : scene_(scene),
      cutoff_m_(options.cutoff_m),
      with_overhead_(!options.without_overhead),
      is_left_out_(scene.objects().size(), false) {
  if (!(cutoff_m_ >= 0)) {
    throw Error(ErrorCode::value_out_of_range, "the cut-off of distances is negative or not a number", "cutoff_m",
                "give 0 metres or more");
  }
  for (std::size_t i = 0; i < is_left_out_.size(); ++i) {
    is_left_out_[i] = options.without_ground && scene.objects()[i].kind == ObjectKind::ground;
  }
  for (const std::uint32_t object : options.without_objects) {
    if (object >= is_left_out_.size()) {
      throw Error(ErrorCode::index_out_of_range, "the scene has no object " + std::to_string(object), "without_objects",
                  "give indices of its objects: there are " + std::to_string(is_left_out_.size()));
    }
    is_left_out_[object] = true;
  }
}

LegDistance LegDistances::nearest(const Leg& leg) const {
  internal::query::check_leg(leg, 0);
  const PreparedScene::Data& scene = scene_.data();
  LegDistance result;
  find_nearer(
      scene, leg, [&](std::uint32_t object) { return is_left_out_[object]; }, 0, cutoff_m_, result);
  if (with_overhead_ && scene.overhead) {
    const auto none = [](std::uint32_t) { return false; };
    find_nearer(*scene.overhead, leg, none, static_cast<std::uint32_t>(is_left_out_.size()), cutoff_m_, result);
  }
  return result;
}

std::vector<LegDistance> LegDistances::nearest(std::span<const Leg> legs, const Progress& progress) const {
  for (std::size_t i = 0; i < legs.size(); ++i) internal::query::check_leg(legs[i], 0, i);
  const internal::core::ProgressReporter reporter(progress, "legs");
  reporter.begin("measuring legs");
  internal::core::ProgressCounter done(reporter, legs.size());
  std::vector<LegDistance> distances(legs.size());
  internal::parallel::for_ranges(legs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      distances[i] = nearest(legs[i]);
      done.add();
    }
  });
  reporter.finish();
  return distances;
}

}  // namespace vantage
