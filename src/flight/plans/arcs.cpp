#include "flight/plans/arcs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::internal::flight::plans {
namespace {

/// The largest angle of a chord whose sagitta is at most the error; a quarter turn at most.
double chord_angle(double radius_m, double error_m) {
  const double share = std::min(error_m / radius_m, 1.0);
  // 1 - cos(a / 2) = 2 sin^2(a / 4), without cancellation.
  return std::min(4 * std::asin(std::sqrt(share / 2)), std::numbers::pi / 2);
}

}  // namespace

double chord_count(double radius_m, double turns, double error_m) {
  return std::ceil(2 * std::numbers::pi * turns / chord_angle(std::abs(radius_m), error_m));
}

std::vector<Eigen::Vector2d> circle_points(const Eigen::Vector2d& towards, double radius_m, double turns,
                                           double error_m) {
  const double radius = std::abs(radius_m);
  const auto chords = static_cast<std::size_t>(chord_count(radius, turns, error_m));
  const double bearing = towards.norm() > 0 ? std::atan2(towards.x(), towards.y()) : 0;
  const double whole = 2 * std::numbers::pi * turns * (radius_m < 0 ? -1 : 1);
  std::vector<Eigen::Vector2d> points;
  points.reserve(chords + 1);
  for (std::size_t i = 0; i <= chords; ++i) {
    const double share = chords == 0 ? 0 : static_cast<double>(i) / static_cast<double>(chords);
    const double angle = bearing + whole * share;
    points.push_back(radius * Eigen::Vector2d(std::sin(angle), std::cos(angle)));
  }
  return points;
}

Eigen::Vector2d arc_centre(const Eigen::Vector2d& to, double angle_deg) {
  // Straight to the right of the middle of the chord, so far that half the chord is seen under half the angle.
  const Eigen::Vector2d right(to.y(), -to.x());
  return to / 2 + right / (2 * std::tan(angle_deg * std::numbers::pi / 360));
}

std::vector<Vec3> spline_points(const Vec3& from, const Vec3& to, const Vec3& from_tangent, const Vec3& to_tangent,
                                double error_m) {
  const Vec3 second = -3 * from - 2 * from_tangent + 3 * to - to_tangent;
  const Vec3 third = 2 * from + from_tangent - 2 * to + to_tangent;
  const double bend = std::max((2 * second).norm(), (2 * second + 6 * third).norm());
  constexpr double kTooMany = 1e6 + 1;  // more than a flight may have points
  const double wanted = std::ceil(std::sqrt(bend / (8 * error_m)));
  const auto chords = static_cast<std::size_t>(wanted < kTooMany ? std::max(wanted, 1.0) : kTooMany);
  std::vector<Vec3> points;
  points.reserve(chords);
  for (std::size_t i = 1; i < chords; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(chords);
    points.push_back(from + t * (from_tangent + t * (second + t * third)));
  }
  points.push_back(to);
  return points;
}

std::vector<Vec3> corner_points(const Vec3& before, const Vec3& corner, const Vec3& after, double cut_m,
                                double error_m) {
  const Vec3 in = before - corner, out = after - corner;
  constexpr double kLeastM = 1e-3;
  const double reach = std::min({cut_m, in.norm(), out.norm()});
  if (!(reach >= kLeastM)) return {corner};
  const Vec3 a = in.normalized(), b = out.normalized();
  const double half = std::atan2(a.cross(b).norm(), a.dot(b)) / 2;  // of the angle between the legs
  constexpr double kStraight = 1e-6;
  if (half < kStraight || std::numbers::pi / 2 - half < kStraight) return {corner};
  const double radius = reach * std::tan(half);
  const Vec3 centre = corner + (a + b).normalized() * (reach / std::cos(half));
  const double turn = std::numbers::pi - 2 * half;
  const auto chords = static_cast<int>(std::ceil(turn / chord_angle(radius, error_m)));
  const Vec3 first = (corner + reach * a - centre) / radius;
  const Vec3 axis = a.cross(b).normalized();  // turning from the first leg's side to the second's
  std::vector<Vec3> points{corner + reach * a};
  for (int i = 1; i < chords; ++i) {
    points.push_back(centre + radius * (Eigen::AngleAxisd(-turn * i / chords, axis) * first));
  }
  points.push_back(corner + reach * b);
  return points;
}

}  // namespace vantage::internal::flight::plans
