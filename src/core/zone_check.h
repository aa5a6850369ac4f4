// Whether a zone is one: a simple polygon, apart from its holes, between two heights.
#pragma once

#include <optional>
#include <string>

#include "vantage/constraints.h"
#include "vantage/error.h"

namespace vantage::internal::core {

struct ZoneFault {
  ErrorCode code;
  std::string problem;  ///< without the zone's name: "side 2 crosses side 5 near [3, 4]"
  std::string fix;
};

/// What is wrong with a zone first. Sides that pass each other within rounding count as touching. Cost: O(n log n) in
/// the corners where sides are short, O(n^2) at worst.
std::optional<ZoneFault> fault_of(const Zone& zone);

}  // namespace vantage::internal::core
