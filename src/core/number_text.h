// Numbers in messages, whatever the locale of the program that uses the library.
#pragma once

#include <charconv>
#include <string>

namespace vantage::internal::core {

/// With so many decimals: fixed_text(3, 3) is "3.000".
inline std::string fixed_text(double value, int decimals) {
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
  return {text, end};
}

/// Four digits and the unit: "0.1234 m".
inline std::string metres_text(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 4).ptr;
  return std::string(text, end) + " m";
}

}  // namespace vantage::internal::core
