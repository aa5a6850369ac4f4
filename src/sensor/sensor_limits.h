// Which limits of the sensor a point breaks: each by its definition, for answers about points.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sensor/viewed.h"
#include "vantage/sensor.h"

namespace vantage::internal::sensor {

/// Distance from a point to a convex polygon (of one corner: to the point), metres. `normal`: of its plane.
double distance_to(const ViewedPart& part, const Vec3& point);

/// The least angle, in radians, between a direction of unit length and that in which a point of the part is seen from
/// `point`.
double least_angle(const ViewedPart& part, const Vec3& point, const Vec3& direction);

/// All limits but the range.
class SensorLimits {
 public:
  SensorLimits(const Viewed& viewed, const Sensor& sensor);

  bool none() const { return !sensor_.limits_view(); }

  /// Names as causes have them, in this order: "min_range", "incidence", "pixel", "frame", "gimbal", "sun". `point`:
  /// scene frame. Borders are allowed. "gimbal" where a camera of the same picture would do that could look anywhere.
  std::vector<std::string> broken(const Vec3& point) const;

  /// Distances along a line (scene frame, direction of unit length), each > 0 and < reach, between which a limit
  /// changes from kept to broken or back.
  std::vector<double> changes(const Vec3& origin, const Vec3& direction, double reach) const;

  /// For a sensor with an incidence, and a point about Viewed::origin: metres from the nearest of the cones; negative
  /// outside.
  double incidence_margin(const ViewedPart& part, const Vec3& point) const;

  const Viewed& viewed() const { return viewed_; }
  const Sensor& sensor() const { return sensor_; }
  const Vec3& sun() const { return sun_; }  ///< its direction, of unit length

 private:
  double pixel_margin(const ViewedPart& part, const Vec3& point) const;
  double sun_margin(const ViewedPart& part, const Vec3& point) const;
  bool fits(const Vec3& point, const Mount& mount) const;

  Viewed viewed_;
  Sensor sensor_;
  Vec3 sun_ = Vec3::UnitZ();  ///< unit length
};

}  // namespace vantage::internal::sensor
