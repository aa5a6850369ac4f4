#include <algorithm>
#include <cmath>
#include <numbers>

#include "verify/sensor_probe.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {

template <>
std::unique_ptr<const SensorProbe> probe_of<Limit::incidence>(const double& incidence_deg, const Sensor& /*sensor*/,
                                                              const std::vector<TargetView>& parts) {
  check_has_plane(parts, "sensor incidence");
  const double angle = incidence_deg * kDegree;
  const double of_claimed = angle + kAngleSlack;
  const double of_unclaimed = with_tangent_times(angle, std::cos(std::numbers::pi / kConeSides));
  return probe_of_parts("incidence", parts, [=](const TargetView& part, const Vec3& own, Judged as) {
    const double most = as == Judged::claimed ? of_claimed : of_unclaimed;
    const std::vector<Vec3>& vertices = part.vertices();
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](const Vec3& vertex) { return angle_between(own - vertex, part.normal()) > most; });
  });
}

}  // namespace vantage::internal::verify
