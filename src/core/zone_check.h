// Whether a zone is one: a simple polygon, apart from its holes, between two heights.
#pragma once

#include <cstddef>
#include <optional>

#include "core/limit_check.h"
#include "vantage/navigation.h"

namespace vantage::internal::core {

/// What is wrong with a zone first. Sides that pass each other within rounding count as touching. Cost: O(n log n) in
/// the corners.
std::optional<LimitFault> fault_of(const Zone& zone);

/// Whether a ring that does not meet itself runs counter-clockwise: as it turns at an outermost corner. The sign of
/// its area would drown in rounding where one corner is far away.
bool is_counter_clockwise(const Zone::Ring& ring);

/// That there are more zones than Navigation::kMostZones.
std::optional<LimitFault> fault_of_count(std::size_t zones);

}  // namespace vantage::internal::core
