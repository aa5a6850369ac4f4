#include <algorithm>
#include <cmath>
#include <numbers>

#include "verify/sensor_probe.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

/// The least angle between a direction of unit length and that to a point of the segment, both from 0. The angle's
/// cosine, (x . d) / |x| with x = start + t (end - start), has one stationary point.
double least_angle_to_segment(const Vec3& start, const Vec3& end, const Vec3& direction) {
  const Vec3 along = end - start;
  const double s = start.dot(direction), a = along.dot(direction), across = start.dot(along);
  const double t = (a * start.squaredNorm() - s * across) / (s * along.squaredNorm() - a * across);
  double least = std::min(angle_between(start, direction), angle_between(end, direction));
  if (t > 0 && t < 1) least = std::min(least, angle_between(start + t * along, direction));  // false for NaN
  return least;
}

/// The least angle at which a point of the part is seen from the direction. The sets nearer than an angle of at most 90
/// degrees are convex cones: so it is 0 where the direction meets the polygon, or else that to its outline.
double least_angle(const TargetView& part, const Vec3& point, const Vec3& direction) {
  const std::vector<Vec3>& vertices = part.vertices();
  if (part.is_point()) return angle_between(vertices[0] - point, direction);
  const double sinking = -part.normal().dot(direction), height = part.height(point);
  const double distance = height / sinking;
  if (distance > 0 && std::isfinite(distance) && part.over(point + distance * direction, 0)) return 0;
  double least = std::numbers::pi;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 &start = vertices[i], &end = vertices[(i + 1) % vertices.size()];
    least = std::min(least, least_angle_to_segment(start - point, end - point, direction));
  }
  return least;
}

}  // namespace

template <>
std::unique_ptr<const SensorProbe> probe_of<Limit::sun>(const SunLimit& limit, const Sensor& /*sensor*/,
                                                        const std::vector<TargetView>& parts) {
  const Vec3 sun = unit(limit.direction);
  const double angle = limit.exclude_deg * kDegree;
  const double of_claimed = angle - kAngleSlack;
  const double of_unclaimed = with_tangent_times(angle, 1 / std::cos(std::numbers::pi / kConeSides));
  return probe_of_parts("sun", parts, [=](const TargetView& part, const Vec3& own, Judged as) {
    return least_angle(part, own, sun) < (as == Judged::claimed ? of_claimed : of_unclaimed);
  });
}

}  // namespace vantage::internal::verify
