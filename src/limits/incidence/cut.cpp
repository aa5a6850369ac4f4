// A cone of as many sides, inside of the round one, at each corner.
#include <numbers>
#include <utility>

#include "core/portable_math.h"
#include "solid/sensor_region_builder.h"

namespace vantage::internal::solid {

template <>
void add_regions<Limit::incidence>(const double& incidence_deg, const sensor::ViewedPart& part,
                                   SensorRegionBuilder& builder) {
  constexpr int kSides = 128;
  const double angle = incidence_deg * (std::numbers::pi / 180);
  const double slope = portable::tan(angle) * portable::cos(std::numbers::pi / kSides);
  std::vector<HalfSpace> half_spaces;
  for (const Vec3& aside : ring(*part.normal, kSides)) {
    const Vec3 normal = aside - slope * *part.normal;
    half_spaces.push_back({normal, -most_along(part.corners, -normal)});
  }
  builder.keep("incidence", std::move(half_spaces));
}

}  // namespace vantage::internal::solid
