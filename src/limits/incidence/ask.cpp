#include "query/point_limit.h"

namespace vantage::internal::query {

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::incidence>(const double& incidence_deg,
                                                                const std::shared_ptr<const sensor::SensorView>& view) {
  return limit_of_parts("incidence", view, OneInterval::kept,
                        [incidence_deg](const sensor::ViewedPart& part, const Vec3& point) {
                          return sensor::cone_margin(part, point, incidence_deg);
                        });
}

}  // namespace vantage::internal::query
