#include <algorithm>
#include <cmath>
#include <numbers>

#include "query/leg_limit_of_parts.h"

namespace vantage::internal::query {
namespace {

double slant_deg(const sensor::ViewedPart& part, const Vec3& place, double radius) {
  double worst = -INFINITY;
  for (const Vec3& corner : part.corners) {
    const Vec3 x = place - corner;
    const double height = part.normal->dot(x), aside = (x - height * *part.normal).norm();
    const double angle = std::atan2(aside, height) * (180 / std::numbers::pi);
    worst = std::max(worst, std::min(180.0, angle + turn_by(radius, x.norm())));
  }
  return worst;
}

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::incidence>(const double& incidence_deg,
                                                            const std::shared_ptr<const sensor::SensorView>& view) {
  const double most_deg = incidence_deg;
  return leg_limit_of_parts(
      {.name = "incidence",
       .unit = LegBreak::Unit::degrees,
       .broken =
           [most_deg](const sensor::ViewedPart& part, const Tube& tube) {
             return rest_of(where_below(
                 [&](double share) { return -sensor::cone_margin(part, tube.at(share), most_deg); }, -tube.radius));
           },
       .amount = [most_deg](const sensor::ViewedPart& part, const Vec3& place,
                            double radius) { return slant_deg(part, place, radius) - most_deg; }},
      view);
}

}  // namespace vantage::internal::query
