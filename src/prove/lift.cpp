// How far a target may have been raised: docs/proof.md, "The lift". The same is said of the engine in docs/theory.md,
// "Numerics"; here it is worked out again, from triangles, and never comes out less.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "prove/convex_polygon.h"
#include "vantage/prove.h"

namespace vantage {
namespace {

namespace prove = internal::prove;

/// Metres. In worlds with a range below the full one the first three are smaller in proportion.
constexpr double kOwnSurface = 2e-3;   ///< what rises no higher over the target is the surface that it lies on
constexpr double kClear = 1e-6;        ///< so far over it the target is raised
constexpr double kPointRadius = 5e-4;  ///< of what stands for a point
constexpr double kFullRange = 20;

struct OwnLengths {
  double own_m = 0, clear_m = 0;
};

/// `radius_m`: of the target.
OwnLengths own_lengths(const Scene& scene, const TargetFrame& frame, double radius_m, double range_m) {
  constexpr double kOnTarget = 1e-9, kRoundings = 8;
  double largest = frame.origin.cwiseAbs().maxCoeff();
  for (const Vec3& vertex : scene.mesh.vertices) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  // Of the target, of the scene about a middle of its own, and of the two about each other.
  const double rounded = kRoundings * std::numeric_limits<double>::epsilon() *
                         (3 * largest + radius_m + (std::isfinite(range_m) ? range_m : 0));
  const double small = std::min(1.0, range_m / kFullRange);
  const double clear = std::max(kClear * small, 4 * std::max(rounded, kOnTarget * std::min(1.0, radius_m)));
  return {std::max(kOwnSurface * small, 4 * clear), clear};
}

/// What of the scene lies straight over and under a convex polygon, and how high.
class Surroundings {
 public:
  /// Nothing that reaches higher than `ceiling_m` is asked for.
  Surroundings(const Scene& scene, const TargetFrame& frame, const std::vector<Eigen::Vector2d>& polygon,
               double ceiling_m)
      : ceiling_m_(ceiling_m) {
    Box box;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d& from = polygon[i];
      const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - from;
      const Vec3 outward = Vec3(along.y(), -along.x(), 0).stableNormalized();
      column_.push_back({outward, outward.head<2>().dot(from)});
      box.extend(Vec3(from.x(), from.y(), 0));
    }
    for (const Triangle& t : scene.mesh.triangles) see(scene, t, frame, box);
    std::sort(highest_.begin(), highest_.end());
  }

  /// The highest of what reaches more than `above_m` and at most `to_m` high over the polygon.
  std::optional<double> top_over(double above_m, double to_m) const {
    std::optional<double> top;
    for (const double height : over_) {
      if (height > above_m && height <= to_m && (!top || height > *top)) top = height;
    }
    return top;
  }
  /// Heights above 0 of the highest corners of all triangles, beside the polygon as well, ascending.
  const std::vector<double>& highest() const { return highest_; }

 private:
  void see(const Scene& scene, const Triangle& t, const TargetFrame& frame, const Box& box) {
    prove::ConvexPolygon corners;
    Box around;
    for (const std::uint32_t v : t) {
      corners.push_back(frame.to_local(scene.mesh.vertices[v]));
      around.extend(corners.back());
    }
    if (around.max.z() > 0 && around.max.z() <= ceiling_m_) highest_.push_back(around.max.z());
    if (around.min.x() > box.max.x() || around.max.x() < box.min.x()) return;
    if (around.min.y() > box.max.y() || around.max.y() < box.min.y()) return;
    corners = prove::part_within(std::move(corners), column_);
    if (corners.empty()) return;
    over_.push_back(prove::box_of(corners).max.z());
  }

  double ceiling_m_;
  std::vector<prove::HalfSpace> column_;
  std::vector<double> over_, highest_;
};

std::vector<Eigen::Vector2d> square(double half) { return {{-half, -half}, {half, -half}, {half, half}, {-half, half}}; }

}  // namespace

double lift_needed_m(const Scene& scene, const Target& target, std::size_t part, double range_m) {
  const TargetFrame frame = make_target_frame(target, part);
  const bool is_point = frame.polygon.size() < 3;
  const double point_radius = kPointRadius * std::min(1.0, range_m / kFullRange);
  const double radius = is_point ? point_radius : frame.enclosing_radius_m;
  const OwnLengths lengths = own_lengths(scene, frame, radius, range_m);
  const Surroundings near(scene, frame, is_point ? square(point_radius) : frame.polygon,
                          3 * (lengths.own_m + 3 * lengths.clear_m) + 4 * point_radius);
  double needed = 0;
  if (frame.all_sides) {
    // So high over a ridge that a small polygon about the point is clear of it, however it is turned.
    const double clear = lengths.clear_m + 4 * point_radius;
    if (const auto top = near.top_over(-clear, lengths.own_m)) needed = *top + clear;
  }
  const double most = needed + lengths.own_m + 3 * lengths.clear_m;
  if (const auto top = near.top_over(needed - lengths.clear_m, needed + lengths.own_m)) {
    needed = std::max(needed, *top + lengths.clear_m);
  }
  // What hardly rises above the plane, beside the target as well, is cleared for the sake of its shadow.
  for (const double top : near.highest()) {
    if (top > needed + lengths.clear_m) break;
    needed = std::max(needed, top + lengths.clear_m);
  }
  // And a little, as polygons of several triangles are not flat to the last digit.
  return std::min(needed, most) + lengths.clear_m;
}

}  // namespace vantage
