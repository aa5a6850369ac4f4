#include "query/leg_limit_of_parts.h"

namespace vantage::internal::query {

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::min_range>(const double& min_range_m,
                                                            const std::shared_ptr<const sensor::SensorView>& view) {
  const double least = min_range_m;
  return leg_limit_of_parts(
      {.name = "min_range",
       .unit = LegBreak::Unit::metres,
       .broken =
           [least](const sensor::ViewedPart& part, const Tube& tube) {
             return where_below([&](double share) { return sensor::distance_to(part, tube.at(share)); },
                                least + tube.radius);
           },
       .amount = [least](const sensor::ViewedPart& part, const Vec3& place,
                         double radius) { return least + radius - sensor::distance_to(part, place); }},
      view);
}

}  // namespace vantage::internal::query
