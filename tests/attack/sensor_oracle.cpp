#include "sensor_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "closed_mesh.h"

namespace attack {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The greatest value of a concave function on [low, high], by golden sections. It is one that the function has.
template <typename Function>
double greatest_between(double low, double high, const Function& value) {
  constexpr int kSections = 64;  // down to the last bits
  const double share = std::numbers::phi - 1;
  double a = high - share * (high - low), b = low + share * (high - low);
  double at_a = value(a), at_b = value(b), best = std::max({value(low), value(high), at_a, at_b});
  for (int i = 0; i < kSections; ++i) {
    if (at_a > at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - share * (high - low);
      at_a = value(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + share * (high - low);
      at_b = value(b);
    }
    best = std::max({best, at_a, at_b});
  }
  return best;
}

/// Likewise on a triangle: the greatest of lines through one corner's weight is concave, too.
template <typename Function>
double greatest_on(const Corners& t, const Function& value) {
  return greatest_between(0, 1, [&](double u) {
    return greatest_between(0, 1 - u,
                            [&](double v) { return value(Vec3(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]))); });
  });
}

}  // namespace

double distance_to_target(const SeenTarget& target, const Vec3& point) {
  if (target.is_point()) return (point - target.corners[0]).norm();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < target.fan(); ++i)
    least = std::min(least, distance_to_triangle(point, target.fan_triangle(i)));
  return least;
}

// A concave function of the target's points, for angles up to 90 degrees.
double depth_in_sun(const vantage::SunLimit& sun, const SeenTarget& target, const Vec3& point) {
  const Vec3 to_sun = sun.direction.normalized();
  const double cosine = sun.exclude_deg < 90 ? std::cos(sun.exclude_deg * kDegree) : 0;
  const auto depth = [&](const Vec3& x) { return (x - point).dot(to_sun) - cosine * (x - point).norm(); };
  if (target.is_point()) return depth(target.corners[0]);
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < target.fan(); ++i) most = std::max(most, greatest_on(target.fan_triangle(i), depth));
  return most;
}

std::optional<std::size_t> entering_zone(const vantage::RadioLink& link, const Blockers& blockers, const Vec3& antenna,
                                         const Vec3& vehicle) {
  constexpr double kLightGhzMetres = 0.299792458;
  const double excess = link.clear * link.clear * kLightGhzMetres / link.frequency_ghz / 2;
  const double least = (vehicle - antenna).norm() + excess;
  const auto way = [&](const Vec3& x) { return (x - antenna).norm() + (x - vehicle).norm(); };
  for (std::size_t i = 0; i < blockers.triangles.size(); ++i) {
    const Corners& t = blockers.triangles[i].corners;
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
    const double reach = std::max({(t[0] - middle).norm(), (t[1] - middle).norm(), (t[2] - middle).norm()});
    if (way(middle) - 2 * reach > least) continue;
    if (-greatest_on(t, [&](const Vec3& x) { return -way(x); }) < least) return i;
  }
  return std::nullopt;
}

}  // namespace attack
