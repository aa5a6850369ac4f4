// Versions in what vantage writes: "0.1.0".
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace vantage::internal::core {

/// Whether the text is that of a version, of this one or another: three numbers with dots between them.
inline bool is_version(std::string_view text) {
  for (int part = 0; part < 3; ++part) {
    if (part > 0 && !text.starts_with('.')) return false;
    if (part > 0) text.remove_prefix(1);
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    if (digits == 0) return false;
    text.remove_prefix(digits);
  }
  return text.empty();
}

}  // namespace vantage::internal::core
