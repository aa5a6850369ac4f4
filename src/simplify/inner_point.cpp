#include "simplify/inner_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace vantage::internal::simplify {
namespace {

constexpr double kParallel = 1e-12;  // sine of an angle below which planes do not cut each other in numbers

bool is_outside(const HalfSpace& half, const Vec3& point) { return half.normal.dot(point) > half.offset; }

/// On the line where two planes cut each other.
std::optional<Vec3> nearest_on_line(std::span<const HalfSpace> before, const Vec3& on_line, const Vec3& direction) {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  for (const HalfSpace& half : before) {
    const double slope = half.normal.dot(direction), room = half.offset - half.normal.dot(on_line);
    if (std::abs(slope) <= kParallel) {
      if (room < 0) return std::nullopt;
    } else if (slope > 0) {
      high = std::min(high, room / slope);
    } else {
      low = std::max(low, room / slope);
    }
  }
  if (low > high) return std::nullopt;
  return Vec3(on_line + std::clamp(0.0, low, high) * direction);
}

/// On the plane of `plane`, in the half-spaces before it.
std::optional<Vec3> nearest_on_plane(std::span<const HalfSpace> before, const HalfSpace& plane, const Vec3& wanted) {
  const Vec3 foot = wanted - (plane.normal.dot(wanted) - plane.offset) * plane.normal;
  Vec3 best = foot;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const HalfSpace& half = before[i];
    if (!is_outside(half, best)) continue;
    const Vec3 within = half.normal - half.normal.dot(plane.normal) * plane.normal;
    const double steep = within.norm();
    if (steep <= kParallel) return std::nullopt;
    const Vec3 on_line = foot - (half.normal.dot(foot) - half.offset) / (steep * steep) * within;
    const Vec3 direction = plane.normal.cross(within / steep);
    const std::optional<Vec3> found = nearest_on_line(before.first(i), on_line, direction);
    if (!found) return std::nullopt;
    best = *found;
  }
  return best;
}

}  // namespace

std::optional<Vec3> nearest_inner_point(const std::vector<HalfSpace>& half_spaces, const Vec3& wanted) {
  Vec3 best = wanted;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    if (!is_outside(half_spaces[i], best)) continue;
    const std::optional<Vec3> found = nearest_on_plane(std::span(half_spaces).first(i), half_spaces[i], wanted);
    if (!found) return std::nullopt;
    best = *found;
  }
  return best;
}

}  // namespace vantage::internal::simplify
