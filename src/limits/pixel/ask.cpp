// A viewpoint keeps the limit of a corner in the ball that touches the target's plane there.
#include <algorithm>
#include <limits>

#include "query/point_limit.h"

namespace vantage::internal::query {

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::pixel>(const PixelLimit& pixel,
                                                            const std::shared_ptr<const sensor::SensorView>& view) {
  const double diameter = pixel.size_m * *view->sensor.camera->focal_px;
  return limit_of_parts("pixel", view, OneInterval::kept,
                        [diameter](const sensor::ViewedPart& part, const Vec3& point) {
                          double least = std::numeric_limits<double>::infinity();
                          for (const Vec3& corner : part.corners) {
                            const Vec3 x = point - corner;
                            least = std::min(least, part.normal->dot(x) - x.squaredNorm() / diameter);
                          }
                          return least;
                        });
}

}  // namespace vantage::internal::query
