#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"
#include "query/leg_limit_of_parts.h"

namespace vantage::internal::query {
namespace {

constexpr double kInDegrees = 180 / std::numbers::pi;

double nearest_corner(const sensor::ViewedPart& part, const Vec3& place) {
  double nearest = INFINITY;
  for (const Vec3& corner : part.corners) nearest = std::min(nearest, (corner - place).norm());
  return nearest;
}

/// Distance of y from a round cone about `axis`, of unit length, with the angle a <= 90 degrees between.
double distance_to_cone(const Vec3& y, const Vec3& axis, double sine, double cosine) {
  const double along = y.dot(axis), aside = (y - along * axis).norm();
  if (aside * cosine <= along * sine) return 0;
  if (aside * sine + along * cosine <= 0) return y.norm();
  return aside * cosine - along * sine;
}

/// What no point of the target may be seen in: the target minus the cone about the sun. It is convex, so is the
/// distance from it along the leg, and over the target the distance of a point minus the place from the cone. The least
/// of these is in the part's interior only straight over the place, unless it is 0.
class SunShade {
 public:
  SunShade(const SunLimit& sun, const sensor::ViewedPart& part)
      : part_(part), axis_(unit(sun.direction)), angle_(sun.exclude_deg / kInDegrees) {
    const portable::SineCosine both = portable::sine_cosine(angle_);
    sine_ = both.sine;
    cosine_ = std::max(0.0, both.cosine);
  }

  double distance(const Vec3& place) const {
    if (sensor::least_angle(part_, place, axis_) <= angle_) return 0;
    const auto at = [&](const Vec3& t) { return distance_to_cone(t - place, axis_, sine_, cosine_); };
    double least = at(part_.corners[0]);
    for (std::size_t i = 0; i < part_.corners.size(); ++i) {
      const Vec3& a = part_.corners[i];
      const Vec3 side = part_.corners[(i + 1) % part_.corners.size()] - a;
      const auto along = [&](double share) { return at(a + share * side); };
      least = std::min(least, along(least_place(along)));
    }
    if (part_.corners.size() < 3) return least;
    const double height = part_.normal->dot(place - part_.corners[0]);
    const Vec3 foot = place - height * *part_.normal;
    if (sensor::distance_to(part_, foot) <= 1e-12 * (std::abs(height) + foot.norm())) least = std::min(least, at(foot));
    return least;
  }

  double angle_deg() const { return angle_ * kInDegrees; }
  double seen_at_deg(const Vec3& place) const { return sensor::least_angle(part_, place, axis_) * kInDegrees; }

 private:
  const sensor::ViewedPart& part_;
  Vec3 axis_;
  double angle_, sine_ = 0, cosine_ = 0;
};

LegIntervals too_bright(const SunShade& shade, const Tube& tube) {
  const double rounding = 1e-12 * (tube.leg.from.norm() + tube.leg.to.norm());
  return where_below([&](double share) { return shade.distance(tube.at(share)); }, tube.radius + rounding);
}

double brightness_deg(const SunShade& shade, const Vec3& place, double turn_deg) {
  return std::min(shade.angle_deg(), shade.angle_deg() - shade.seen_at_deg(place) + turn_deg);
}

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::sun>(const SunLimit& sun,
                                                      const std::shared_ptr<const sensor::SensorView>& view) {
  return leg_limit_of_parts({.name = "sun",
                             .unit = LegBreak::Unit::degrees,
                             .broken = [sun](const sensor::ViewedPart& part,
                                             const Tube& tube) { return too_bright(SunShade(sun, part), tube); },
                             .amount =
                                 [sun](const sensor::ViewedPart& part, const Vec3& place, double radius) {
                                   return brightness_deg(SunShade(sun, part), place,
                                                         turn_by(radius, nearest_corner(part, place)));
                                 }},
                            view);
}

}  // namespace vantage::internal::query
