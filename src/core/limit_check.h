// What is wrong with a limit of navigation by itself, without a scene. The reader of mission files, the engine, the
// query and the checks all ask here, so the same limit is refused by all, with the same code and the same words.
#pragma once

#include <optional>
#include <string>

#include "vantage/error.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

struct LimitFault {
  ErrorCode code;
  std::string problem;  ///< follows the limit's name and a colon: "it is reversed: 5 is above 3"
  std::string fix;      ///< what to do: "write [3, 5], in metres"
};

/// The sentence of an error: "navigation.altitude: it is reversed: 5 is above 3".
inline std::string problem_of(const std::string& name, const LimitFault& fault) { return name + ": " + fault.problem; }

/// Two heights, the lower one first: both finite, and not equal.
std::optional<LimitFault> fault_of_band(double low_m, double high_m);

/// A box to stay in or out of: the same of each axis.
std::optional<LimitFault> fault_of(const Box& box);

/// A distance to be kept: positive, at most kMaxCoordinate.
std::optional<LimitFault> fault_of_clearance(double distance_m);

}  // namespace vantage::internal::core
