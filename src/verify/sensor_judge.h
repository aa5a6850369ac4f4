// What the sensor asks of a viewpoint, each limit by its definition in vantage/sensor.h.
#pragma once

#include <memory>
#include <vector>

#include "vantage/sensor.h"
#include "verify/sensor_probe.h"

namespace vantage::internal::verify {

class SensorJudge {
 public:
  /// Keeps a reference to the parts. `tolerance_m`: how far inside the range its facets may lie. Throws Error(input)
  /// for a sensor that is wrong in itself, and for a limit that needs a plane where a point has none.
  SensorJudge(const Sensor& sensor, const std::vector<TargetView>& parts, double tolerance_m);

  /// To every vertex of the target, at most; metres, finite.
  double range() const { return range_; }

  /// Judges a viewpoint in the first part's frame.
  SensorJudgement of_claimed(const Vec3& position) const { return judge(position, Judged::claimed); }
  SensorJudgement of_unclaimed(const Vec3& position) const { return judge(position, Judged::unclaimed); }

 private:
  SensorJudgement judge(const Vec3& position, Judged as) const;
  bool is_too_far(const Vec3& position, Judged as) const;

  const std::vector<TargetView>& parts_;
  double range_ = 0;                                        ///< metres
  double claimed_range_ = 0, unclaimed_range_ = 0;          ///< that are kept
  std::vector<std::unique_ptr<const SensorProbe>> probes_;  ///< what is searched comes last
};

}  // namespace vantage::internal::verify
