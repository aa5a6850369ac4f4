// Whether a limit of navigation is one: the same words for all who check it.
#pragma once

#include <optional>
#include <string>

#include "vantage/error.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

struct LimitFault {
  ErrorCode code;
  std::string problem;  ///< without the limit's name, after a colon: "it is reversed: 5 is above 3"
  std::string fix;
};

/// "navigation.altitude: it is reversed: 5 is above 3".
inline std::string problem_of(const std::string& name, const LimitFault& fault) { return name + ": " + fault.problem; }

/// Of two heights.
std::optional<LimitFault> fault_of_band(double low_m, double high_m);

std::optional<LimitFault> fault_of(const Box& box);

/// Of a distance to be kept.
std::optional<LimitFault> fault_of_clearance(double distance_m);

}  // namespace vantage::internal::core
