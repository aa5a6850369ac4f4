#include <algorithm>
#include <cmath>
#include <limits>

#include "verify/sensor_probe.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

double distance_to_segment(const Vec3& point, const Vec3& start, const Vec3& end) {
  const Vec3 along = end - start;
  const double share = std::clamp((point - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - start - share * along).norm();
}

double distance_to(const TargetView& part, const Vec3& point) {
  const std::vector<Vec3>& vertices = part.vertices();
  if (part.is_point()) return (point - vertices[0]).norm();
  if (part.over(point, 0)) return std::abs(part.height(point));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    least = std::min(least, distance_to_segment(point, vertices[i], vertices[(i + 1) % vertices.size()]));
  }
  return least;
}

}  // namespace

template <>
std::unique_ptr<const SensorProbe> probe_of<Limit::min_range>(const double& min_range_m, const Sensor& /*sensor*/,
                                                              const std::vector<TargetView>& parts) {
  const double of_claimed = min_range_m * (1 - kRangeSlack), of_unclaimed = min_range_m * (1 + kMinRangeLoose);
  return probe_of_parts("min_range", parts, [=](const TargetView& part, const Vec3& own, Judged as) {
    return distance_to(part, own) < (as == Judged::claimed ? of_claimed : of_unclaimed);
  });
}

}  // namespace vantage::internal::verify
