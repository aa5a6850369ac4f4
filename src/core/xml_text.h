// Texts and numbers for XML.
#pragma once

#include <string>
#include <string_view>

namespace vantage::internal::core {

/// "&lt;" and so on; characters that XML cannot hold become blanks.
std::string xml_text(std::string_view text);

/// A number with so many decimals at most, none that are zero: "48.1", "-0.5", "0".
std::string decimal(double number, int decimals);

}  // namespace vantage::internal::core
