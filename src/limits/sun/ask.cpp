#include <numbers>

#include "query/point_limit.h"

namespace vantage::internal::query {

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::sun>(const SunLimit& limit,
                                                          const std::shared_ptr<const sensor::SensorView>& view) {
  const Vec3 sun = unit(limit.direction);
  const double angle = limit.exclude_deg * (std::numbers::pi / 180);
  return limit_of_parts("sun", view, OneInterval::broken, [=](const sensor::ViewedPart& part, const Vec3& point) {
    return sensor::least_angle(part, point, sun) - angle;
  });
}

}  // namespace vantage::internal::query
