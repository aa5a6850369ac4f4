#include "target/range_check.h"

#include <cmath>

#include "core/text.h"
#include "vantage/error.h"

namespace vantage::internal::target {

void check_sensor(const Sensor& sensor) {
  if (sensor.max_range_m > 0 && std::isfinite(sensor.max_range_m)) return;
  throw Error(ErrorCode::value_out_of_range, "max_range must be a positive, finite number of metres", "sensor",
              "give the farthest distance at which the target can be seen");
}

bool can_reach(const TargetFrame& frame, const Sensor& sensor) {
  return frame.enclosing_radius_m * (1 + 1e-9) < sensor.max_range_m;
}

void set_out_of_range(const TargetFrame& frame, const Sensor& sensor, Volume& volume) {
  volume.outcome = Outcome::out_of_range;
  volume.reason = "no point within " + core::metres_text(sensor.max_range_m) +
                  " of all vertices: the target's enclosing circle has radius " +
                  core::metres_text(frame.enclosing_radius_m);
  volume.hint = "raise max_range, or split the target";
}

}  // namespace vantage::internal::target
