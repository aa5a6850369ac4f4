#include "sensor/viewed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/portable_math.h"

namespace vantage::internal::sensor {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return a + share * along;
}

/// Whether a point lies over or under the polygon, along its normal.
bool is_over(const ViewedPart& part, const Vec3& point) {
  for (std::size_t i = 0; i < part.corners.size(); ++i) {
    const Vec3& a = part.corners[i];
    const Vec3 edge = part.corners[(i + 1) % part.corners.size()] - a;
    if (part.normal->cross(edge).dot(point - a) < 0) return false;
  }
  return true;
}

/// The cosine of the angle between `direction`, of unit length, and `x`; 1 for no x.
double cosine_to(const Vec3& x, const Vec3& direction) {
  const double length = x.norm();
  return length > 0 ? x.dot(direction) / length : 1.0;
}

/// The largest cosine to `direction` on the segment from a to b: at an end, or where the derivative, which is linear
/// but for a positive factor, vanishes.
double largest_cosine(const Vec3& a, const Vec3& b, const Vec3& direction) {
  double largest = std::max(cosine_to(a, direction), cosine_to(b, direction));
  const Vec3 e = b - a;
  const double ae = a.dot(e), as = a.dot(direction), es = e.dot(direction);
  const double share = (es * a.squaredNorm() - as * ae) / (as * e.squaredNorm() - es * ae);
  if (share > 0 && share < 1) largest = std::max(largest, cosine_to(a + share * e, direction));
  return largest;
}

void add_part(const TargetFrame& frame, const std::vector<Eigen::Vector2d>& polygon, Viewed& viewed) {
  ViewedPart& part = viewed.parts.emplace_back();
  if (!frame.all_sides) part.normal = frame.normal;
  part.centre = frame.origin - viewed.origin;
  for (const Eigen::Vector2d& corner : polygon) {
    part.corners.push_back(part.centre + frame.axis_u * corner.x() + frame.axis_v * corner.y());
  }
  viewed.corners.insert(viewed.corners.end(), part.corners.begin(), part.corners.end());
}

}  // namespace

double Viewed::radius() const {
  double radius = 0;
  for (const Vec3& corner : corners) radius = std::max(radius, corner.norm());
  return radius;
}

Viewed viewed_of(const PreparedTarget& target) {
  Viewed viewed;
  viewed.origin = target.frame(0).origin;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    add_part(target.frame(i), target.frame(i).polygon, viewed);
  }
  return viewed;
}

Viewed viewed_of(const TargetFrame& frame, std::span<const std::vector<Eigen::Vector2d>> polygons) {
  Viewed viewed;
  viewed.origin = frame.origin;
  for (const auto& polygon : polygons) add_part(frame, polygon, viewed);
  return viewed;
}

double distance_to(const ViewedPart& part, const Vec3& point) {
  const std::vector<Vec3>& corners = part.corners;
  if (corners.size() > 1 && is_over(part, point)) return std::abs(part.normal->dot(point - corners[0]));
  double least = kUnlimited;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    least = std::min(least, (point - nearest_on_segment(corners[i], corners[(i + 1) % corners.size()], point)).norm());
  }
  return least;
}

double least_angle(const ViewedPart& part, const Vec3& point, const Vec3& direction) {
  const std::vector<Vec3>& corners = part.corners;
  if (corners.size() > 1) {
    const double towards = part.normal->dot(direction);
    const double distance = part.normal->dot(corners[0] - point) / towards;
    if (towards != 0 && distance >= 0 && is_over(part, point + distance * direction)) return 0;
  }
  double largest = -1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    largest =
        std::max(largest, largest_cosine(corners[i] - point, corners[(i + 1) % corners.size()] - point, direction));
  }
  return portable::acos(std::clamp(largest, -1.0, 1.0));
}

double cone_margin(const ViewedPart& part, const Vec3& point, double angle_deg) {
  const double angle = angle_deg * (std::numbers::pi / 180);
  double least = kUnlimited;
  for (const Vec3& corner : part.corners) {
    const Vec3 x = point - corner;
    const double height = part.normal->dot(x);
    const double aside = (x - height * *part.normal).norm();
    least = std::min(least, height * portable::sin(angle) - aside * portable::cos(angle));
  }
  return least;
}

}  // namespace vantage::internal::sensor
