// How the camera must turn to follow a target along a flight, and where it can.
#pragma once

#include <optional>
#include <vector>

#include "flight/flight_timeline.h"
#include "flight/gimbal.h"
#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/query.h"

namespace vantage::internal::flight {

/// All that is said holds for every position within `radius_m` of the flight, and on the curves that its legs stand
/// for.
class GimbalCheck {
 public:
  /// All must outlive it.
  GimbalCheck(const Flight& path, const FlightTimeline& along, double radius_m)
      : path_(path), along_(along), radius_m_(radius_m) {}

  /// Yaw is that of the flight itself.
  GimbalUse use(const Stretch& stretch, const Vec3& centre) const;

  /// The longest stretch in time on which the target is seen and the camera need not turn faster than it can.
  /// `seen`: of each leg.
  std::optional<FlightSpan> followed(const std::vector<std::vector<LegInterval>>& seen, const Vec3& centre,
                                     double rate_deg_s) const;

 private:
  Deviation off(std::size_t leg) const { return off_chord(path_.leg(leg), radius_m_, path_.chord_error_m); }

  const Flight& path_;
  const FlightTimeline& along_;
  double radius_m_;
};

}  // namespace vantage::internal::flight
