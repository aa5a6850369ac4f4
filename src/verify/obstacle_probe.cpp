#include "verify/obstacle_probe.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/error.h"

namespace vantage::internal::verify {
namespace {

constexpr double kProbeRoundings = 64;  // as for heights above the ground

double distance_to_side(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 side = b - a;
  const double squared = side.squaredNorm();
  const double along = squared > 0 ? std::clamp((point - a).dot(side) / squared, 0.0, 1.0) : 0;
  return (a + along * side - point).norm();
}

/// The nearest point lies on a side, or straight below the point and between all three planes that stand on the sides.
double distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double beside =
      std::min({distance_to_side(point, a, b), distance_to_side(point, b, c), distance_to_side(point, c, a)});
  const Vec3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  const auto is_left = [&](const Vec3& from, const Vec3& to) {
    return normal.dot((to - from).cross(point - from)) > 0;
  };
  if (!(length > 0) || !is_left(a, b) || !is_left(b, c) || !is_left(c, a)) return beside;
  // In a sliver, whose normal may be off by any angle, no point is farther from the sides than it is wide.
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const double width = length / longest + kProbeRoundings * std::numeric_limits<double>::epsilon() * longest;
  return std::clamp(std::abs(normal.dot(point - a)) / length, beside - width, beside);
}

}  // namespace

ObstacleProbe::ObstacleProbe(const Clearance& clearance) : clearance_(clearance) {
  if (!(clearance.distance_m > 0) || !std::isfinite(clearance.distance_m) || !clearance.obstacles) {
    throw Error(ErrorCode::value_out_of_range, "the clearance is not positive and finite, or has no obstacles",
                "navigation clearance", "give metres, and the obstacles of the scene");
  }
  std::vector<Box> boxes;
  double largest = clearance_.distance_m;
  for (const Triangle& triangle : clearance_.obstacles->triangles) {
    Box& box = boxes.emplace_back();
    for (const std::uint32_t vertex : triangle) box.extend(clearance_.obstacles->vertices[vertex]);
    bounds_.extend(box);
  }
  if (boxes.empty()) return;
  bounds_.min.array() -= 2 * clearance_.distance_m;
  bounds_.max.array() += 2 * clearance_.distance_m;
  largest = std::max({largest, bounds_.min.cwiseAbs().maxCoeff(), bounds_.max.cwiseAbs().maxCoeff()});
  allowance_m_ = kProbeRoundings * std::numeric_limits<double>::epsilon() * largest;
  index_.emplace(boxes, largest);
}

bool ObstacleProbe::is_too_near(const Vec3& point, double slack) const {
  const bool is_far = (point.array() < bounds_.min.array()).any() || (point.array() > bounds_.max.array()).any();
  if (!index_ || is_far) return false;
  const Mesh& mesh = *clearance_.obstacles;
  const double wanted = (1 + slack) * clearance_.distance_m - allowance_m_;
  double nearest = 2 * clearance_.distance_m;
  index_->nearest(point, [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    nearest = std::min(nearest, distance_to_triangle(point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
    return nearest;
  });
  return nearest < wanted;
}

}  // namespace vantage::internal::verify
