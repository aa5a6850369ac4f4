#include "target/range_check.h"

#include "core/text.h"

namespace vantage::internal::target {

void set_out_of_range(const TargetFrame& frame, const Sensor& sensor, Volume& volume) {
  volume.outcome = Outcome::out_of_range;
  volume.reason = "no point within " + core::metres_text(range_limit_m(sensor)) +
                  " of all vertices: the target's enclosing circle has radius " +
                  core::metres_text(frame.enclosing_radius_m);
  volume.hint = "raise max_range, or split the target";
}

}  // namespace vantage::internal::target
