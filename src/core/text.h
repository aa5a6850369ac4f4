// Numbers and places in messages, the same in every locale.
#pragma once

#include <string>
#include <string_view>

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// At most three decimals, none that are zero: "612.3", "20", "-0.005".
std::string number_text(double number);

/// Four digits and the unit: "0.1234 m".
VANTAGE_INTERNAL_API std::string metres_text(double metres);

/// "(1, 2.5, 3)".
std::string point_text(const Vec3& point);

/// With so many decimals: fixed_text({1, 2.5, 3}, 2) is "(1.00, 2.50, 3.00)".
VANTAGE_INTERNAL_API std::string fixed_text(const Vec3& point, int decimals);

/// "1 edge has", "12 edges have".
std::string count_text(std::size_t count, const char* one, const char* many);

/// JSON in which what printable() would replace is written \uXXXX: it means the same. `json` is UTF-8.
std::string escaped_json(const std::string& json);

}  // namespace vantage::internal::core
