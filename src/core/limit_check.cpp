#include "core/limit_check.h"

#include <array>
#include <cmath>

#include "common/input.h"
#include "core/read_limits.h"

namespace vantage::internal::core {
namespace {

/// `of_axis`: " in x", or nothing. `swapped`: what to write where the two are reversed.
std::optional<LimitFault> fault_of_pair(double low, double high, const std::string& of_axis,
                                        const std::string& swapped) {
  if (!std::isfinite(low) || !std::isfinite(high)) {
    return LimitFault{ErrorCode::value_out_of_range, "it is not finite" + of_axis,
                      "give numbers; leave a limit out where there is none"};
  }
  if (low > high) {
    return LimitFault{ErrorCode::limits_reversed,
                      "it is reversed" + of_axis + ": " + shortest(low) + " is above " + shortest(high), swapped};
  }
  if (low == high) {
    return LimitFault{ErrorCode::limits_empty, "it leaves no room" + of_axis + ": both ends are " + shortest(low),
                      "give an upper end above the lower one"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<LimitFault> fault_of_band(double low_m, double high_m) {
  return fault_of_pair(low_m, high_m, "", "write [" + shortest(high_m) + ", " + shortest(low_m) + "], in metres");
}

std::optional<LimitFault> fault_of(const Box& box) {
  constexpr std::array kAxes = {"x", "y", "z"};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    const std::string name = kAxes[axis];
    const std::string swapped = "write " + name + " = " + shortest(high) + " in min and " + shortest(low) + " in max";
    if (auto fault = fault_of_pair(low, high, " in " + name, swapped)) return fault;
  }
  return std::nullopt;
}

std::optional<LimitFault> fault_of_clearance(double distance_m) {
  if (distance_m > kMaxCoordinate && std::isfinite(distance_m)) {
    return LimitFault{ErrorCode::value_out_of_range, "it is more than 1,000,000 km: " + shortest(distance_m),
                      "give metres"};
  }
  if (distance_m > 0 && std::isfinite(distance_m)) return std::nullopt;
  return LimitFault{ErrorCode::value_out_of_range,
                    "it is not a positive, finite number of metres: " + shortest(distance_m),
                    "leave it out where nothing is to be kept away from"};
}

}  // namespace vantage::internal::core
