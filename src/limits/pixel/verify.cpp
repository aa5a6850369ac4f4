// d * d / (f h) <= size, as a condition on the height. What keeps it is a ball that touches the plane in the vertex.
#include <algorithm>

#include "verify/sensor_probe.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {

template <>
std::unique_ptr<const SensorProbe> probe_of<Limit::pixel>(const PixelLimit& pixel, const Sensor& sensor,
                                                          const std::vector<TargetView>& parts) {
  check_has_plane(parts, "sensor pixel");
  const double diameter = pixel.size_m * *sensor.camera->focal_px;
  // A ball with the same centre and a radius that is smaller by `loose` of it is that of all heights that are greater
  // by (2 loose - loose^2) / 4 of the diameter.
  const double unclaimed_height = diameter / 4 * (kPixelLoose * kPixelLoose - 2 * kPixelLoose);
  return probe_of_parts("pixel", parts, [=](const TargetView& part, const Vec3& own, Judged as) {
    const std::vector<Vec3>& vertices = part.vertices();
    return std::any_of(vertices.begin(), vertices.end(), [&](const Vec3& vertex) {
      const Vec3 x = own - vertex;
      const double too_low = x.squaredNorm() / diameter - part.normal().dot(x);
      return too_low > (as == Judged::claimed ? kRangeSlack * x.norm() : unclaimed_height);
    });
  });
}

}  // namespace vantage::internal::verify
