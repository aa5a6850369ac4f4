// Legs and the limits of a sensor: what is kept is convex, or what is broken.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"
#include "query/leg_convex.h"
#include "query/leg_limits.h"

namespace vantage::internal::query {
namespace {

constexpr double kInDegrees = 180 / std::numbers::pi;

using sensor::SensorLimits;
using sensor::ViewedPart;

/// The angle that the radius subtends at a distance, degrees.
double turn_by(double radius, double distance) {
  if (radius == 0) return 0;
  return distance > radius ? std::asin(radius / distance) * kInDegrees : 90;
}

double nearest_corner(const ViewedPart& part, const Vec3& place) {
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
  SunShade(const SensorLimits& limits, const ViewedPart& part)
      : part_(part), axis_(limits.sun()), angle_(limits.sensor().sun->exclude_deg / kInDegrees) {
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
  const ViewedPart& part_;
  Vec3 axis_;
  double angle_, sine_ = 0, cosine_ = 0;
};

/// The limits of the parts along one leg. Positions are about the target's origin.
class PartsLook {
 public:
  PartsLook(const SensorLimits& limits, const Tube& local) : limits_(limits), local_(local) {}

  /// `parts_of(part)`: where one part breaks it; `amount_of(part, place)`: by how much.
  template <typename Parts, typename AmountOf>
  void add(const char* name, LegBreak::Unit unit, std::vector<LegBreak>& breaks, const Parts& parts_of,
           const AmountOf& amount_of) const {
    LegIntervals broken;
    for (const ViewedPart& part : limits_.viewed().parts) {
      const LegIntervals of_part = parts_of(part);
      broken.insert(broken.end(), of_part.begin(), of_part.end());
    }
    add_break(breaks, name, unit, joined(std::move(broken)), [&](double share) {
      double worst = -INFINITY;
      for (const ViewedPart& part : limits_.viewed().parts) worst = std::max(worst, amount_of(part, local_.at(share)));
      return worst;
    });
  }

  LegIntervals too_close(const ViewedPart& part) const {
    return below([&](double share) { return sensor::distance_to(part, local_.at(share)); },
                 limits_.sensor().min_range_m + local_.radius);
  }

  LegIntervals too_slanted(const ViewedPart& part) const {
    return rest_of(
        below([&](double share) { return -limits_.incidence_margin(part, local_.at(share)); }, -local_.radius));
  }
  double slant(const ViewedPart& part, const Vec3& place) const {
    double worst = -INFINITY;
    for (const Vec3& corner : part.corners) {
      const Vec3 x = place - corner;
      const double height = part.normal->dot(x), aside = (x - height * *part.normal).norm();
      const double angle = std::atan2(aside, height) * kInDegrees;
      worst = std::max(worst, std::min(180.0, angle + turn_by(local_.radius, x.norm())));
    }
    return worst - *limits_.sensor().incidence_deg;
  }

  /// The ball that touches the part's plane in a corner.
  Vec3 ball_of(const ViewedPart& part, const Vec3& corner) const { return corner + ball_radius() * *part.normal; }
  double ball_radius() const { return 0.5 * limits_.sensor().pixel->size_m * *limits_.sensor().camera->focal_px; }
  LegIntervals too_coarse(const ViewedPart& part) const {
    LegIntervals kept{{0, 1}};
    for (const Vec3& corner : part.corners) {
      const Vec3 centre = ball_of(part, corner);
      const auto in_ball = ball_part(local_.leg.from, local_.leg.to, centre, ball_radius() - local_.radius);
      kept = in_ball ? common(kept, {*in_ball}) : LegIntervals{};
    }
    return rest_of(kept);
  }
  double beyond_balls(const ViewedPart& part, const Vec3& place) const {
    double worst = -INFINITY;
    for (const Vec3& corner : part.corners) worst = std::max(worst, (place - ball_of(part, corner)).norm());
    return worst - ball_radius() + local_.radius;
  }

  LegIntervals too_bright(const ViewedPart& part) const {
    const SunShade shade(limits_, part);
    const double rounding = 1e-12 * (local_.leg.from.norm() + local_.leg.to.norm());
    return below([&](double share) { return shade.distance(local_.at(share)); }, local_.radius + rounding);
  }
  double brightness(const ViewedPart& part, const Vec3& place) const {
    const SunShade shade(limits_, part);
    const double turn = turn_by(local_.radius, nearest_corner(part, place));
    return std::min(shade.angle_deg(), shade.angle_deg() - shade.seen_at_deg(place) + turn);
  }

 private:
  template <typename Function>
  static LegIntervals below(const Function& value, double level) {
    const auto part = below_level(value, level);
    return part ? LegIntervals{*part} : LegIntervals{};
  }

  const SensorLimits& limits_;
  Tube local_;
};

}  // namespace

// All members of Sensor are named: a limit that is added does not compile before it is answered.
void add_sensor_breaks(const SensorLimits& limits, const Tube& tube, std::vector<LegBreak>& breaks) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = limits.sensor();
  const PartsLook look(limits, tube.moved(-limits.viewed().origin));
  using Unit = LegBreak::Unit;
  const double least_range = min_range_m;
  if (min_range_m > 0) {
    look.add(
        "min_range", Unit::metres, breaks, [&](const ViewedPart& part) { return look.too_close(part); },
        [&](const ViewedPart& part, const Vec3& place) {
          return least_range + tube.radius - sensor::distance_to(part, place);
        });
  }
  if (incidence_deg) {
    look.add(
        "incidence", Unit::degrees, breaks, [&](const ViewedPart& part) { return look.too_slanted(part); },
        [&](const ViewedPart& part, const Vec3& place) { return look.slant(part, place); });
  }
  if (pixel && pixel->kind == PixelLimit::Kind::worst) {
    look.add(
        "pixel", Unit::metres, breaks, [&](const ViewedPart& part) { return look.too_coarse(part); },
        [&](const ViewedPart& part, const Vec3& place) { return look.beyond_balls(part, place); });
  }
  if (camera) add_aim_breaks(limits, tube, breaks);
  if (sun) {
    look.add(
        "sun", Unit::degrees, breaks, [&](const ViewedPart& part) { return look.too_bright(part); },
        [&](const ViewedPart& part, const Vec3& place) { return look.brightness(part, place); });
  }
}

}  // namespace vantage::internal::query
