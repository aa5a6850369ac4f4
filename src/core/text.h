// Numbers and places in messages.
#pragma once

#include <string>

#include "vantage/geometry.h"

namespace vantage::internal::core {

/// At most three decimals, none that are zero: "612.3", "20", "-0.005".
std::string number_text(double number);

/// "(1, 2.5, 3)".
std::string point_text(const Vec3& point);

/// "1 edge has", "12 edges have".
std::string count_text(std::size_t count, const char* one, const char* many);

}  // namespace vantage::internal::core
