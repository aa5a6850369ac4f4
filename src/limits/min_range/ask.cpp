#include "query/point_limit.h"

namespace vantage::internal::query {

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::min_range>(const double& min_range_m,
                                                                const std::shared_ptr<const sensor::SensorView>& view) {
  return limit_of_parts("min_range", view, OneInterval::broken,
                        [min_range_m](const sensor::ViewedPart& part, const Vec3& point) {
                          return sensor::distance_to(part, point) - min_range_m;
                        });
}

}  // namespace vantage::internal::query
