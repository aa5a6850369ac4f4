#include "verify/ground_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::verify {
namespace {

/// In units of the last place of the largest coordinate: heights are sums and products of few coordinates.
constexpr double kRoundings = 64;

/// Heights above a triangle where the vertical line through the point meets it, or passes it by no more than
/// `allowance`.
std::optional<double> height_above(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c, double allowance) {
  const auto cross = [](const Vec3& from, const Vec3& to, const Vec3& at) {
    return (to.x() - from.x()) * (at.y() - from.y()) - (to.y() - from.y()) * (at.x() - from.x());
  };
  const double weight_a = cross(b, c, point), weight_b = cross(c, a, point), weight_c = cross(a, b, point);
  const double sum = weight_a + weight_b + weight_c;
  if (sum == 0) return std::nullopt;
  const auto is_beside = [&](double weight, const Vec3& from, const Vec3& to) {
    return (sum > 0 ? weight : -weight) < -allowance * (to - from).head<2>().norm();
  };
  if (is_beside(weight_a, b, c) || is_beside(weight_b, c, a) || is_beside(weight_c, a, b)) return std::nullopt;
  return point.z() - (weight_a * a.z() + weight_b * b.z() + weight_c * c.z()) / sum;
}

}  // namespace

GroundProbe::GroundProbe(const AboveGround& limit) : min_m_(limit.min_m), max_m_(limit.max_m), ground_(limit.ground) {
  double largest = std::abs(ground_.plane_z_m);
  if (ground_.surface) {
    std::vector<Box> boxes;
    for (const Triangle& triangle : ground_.surface->triangles) {
      Box& box = boxes.emplace_back();
      for (const std::uint32_t vertex : triangle) {
        const Vec3& at = ground_.surface->vertices[vertex];
        box.extend(Vec3(at.x(), at.y(), 0));
        largest = std::max(largest, at.cwiseAbs().maxCoeff());
      }
      bounds_.extend(box);
    }
    index_.emplace(boxes, 2 * largest + 1);
  }
  allowance_m_ = kRoundings * std::numeric_limits<double>::epsilon() * largest;
}

/// For rounding, at one of the two heights: a far upper one lets nothing be lower than the other one.
double GroundProbe::allowance_at(double height_m) const {
  const double of_height = kRoundings * std::numeric_limits<double>::epsilon() * std::abs(height_m);
  return std::isfinite(height_m) ? std::max(allowance_m_, of_height) : 0;
}

/// The heights of the point above the pieces of ground there.
std::optional<GroundProbe::Heights> GroundProbe::heights(const Vec3& point) const {
  if (!index_) return Heights{point.z() - ground_.plane_z_m, point.z() - ground_.plane_z_m};
  Heights result{INFINITY, -INFINITY};
  const Vec3 place(point.x(), point.y(), 0);
  if ((place.array() < bounds_.min.array()).any() || (place.array() > bounds_.max.array()).any()) return std::nullopt;
  index_->any_along(place - Vec3::UnitZ(), place + Vec3::UnitZ(), [&](std::uint32_t t) {
    const Triangle& corners = ground_.surface->triangles[t];
    const auto& at = ground_.surface->vertices;
    const auto height = height_above(point, at[corners[0]], at[corners[1]], at[corners[2]], allowance_m_);
    if (height) {
      result.lowest = std::min(result.lowest, *height);
      result.highest = std::max(result.highest, *height);
    }
    return false;
  });
  if (result.lowest > result.highest) return std::nullopt;
  return result;
}

std::optional<const char*> GroundProbe::broken_by(const Vec3& point) const {
  const auto above = heights(point);
  if (!above) return "ground edge";
  if (above->lowest < min_m_ - allowance_at(min_m_)) return "agl min";
  if (above->highest > max_m_ + allowance_at(max_m_)) return "agl max";
  return std::nullopt;
}

bool GroundProbe::is_outside_band(const Vec3& point) const {
  const auto above = heights(point);
  if (!above) return false;
  return above->highest <= min_m_ + allowance_at(min_m_) || above->lowest >= max_m_ - allowance_at(max_m_);
}

}  // namespace vantage::internal::verify
