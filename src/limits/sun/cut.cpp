// From the target away from the sun, by a pyramid round the cone that is asked for: it takes away a little more.
#include <numbers>

#include "core/portable_math.h"
#include "solid/convex_hull.h"
#include "solid/sensor_region_builder.h"

namespace vantage::internal::solid {

template <>
void add_regions<Limit::sun>(const SunLimit& limit, const sensor::ViewedPart& part, SensorRegionBuilder& builder) {
  constexpr int kSides = 128;
  const Vec3 sun = unit(limit.direction);
  const double angle = limit.exclude_deg * (std::numbers::pi / 180);
  // At a right angle the cone is a half-space, and the tangent large but finite.
  const double slope = portable::tan(angle) / portable::cos(std::numbers::pi / kSides);
  const double sides_angle = limit.exclude_deg < 90 ? portable::atan(slope) : std::numbers::pi / 2;
  const double length = 4 * (builder.reach() + builder.viewed().radius());
  std::vector<Vec3> points;
  for (const Vec3& corner : part.corners) {
    points.push_back(corner);
    points.push_back(corner - length * sun);
    for (const Vec3& aside : ring(sun, kSides)) {
      points.push_back(corner - length * (portable::cos(sides_angle) * sun + portable::sin(sides_angle) * aside));
    }
  }
  builder.forbid("sun", convex_hull(points));
}

}  // namespace vantage::internal::solid
