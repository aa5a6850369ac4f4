#include "sensor/viewed.h"

#include <algorithm>

namespace vantage::internal::sensor {

double Viewed::radius() const {
  double radius = 0;
  for (const Vec3& corner : corners) radius = std::max(radius, corner.norm());
  return radius;
}

Viewed viewed_of(const PreparedTarget& target) {
  Viewed viewed;
  viewed.origin = target.frame(0).origin;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    const TargetFrame& frame = target.frame(i);
    ViewedPart& part = viewed.parts.emplace_back();
    if (!frame.all_sides) part.normal = frame.normal;
    part.centre = frame.origin - viewed.origin;
    for (const Eigen::Vector2d& corner : frame.polygon) {
      part.corners.push_back(part.centre + frame.axis_u * corner.x() + frame.axis_v * corner.y());
    }
    viewed.corners.insert(viewed.corners.end(), part.corners.begin(), part.corners.end());
  }
  return viewed;
}

}  // namespace vantage::internal::sensor
