// Characters that printable() replaces and escaped_json() writes as \uXXXX.
#pragma once

namespace vantage::internal::core {

/// C0, DEL and C1: a terminal obeys them.
constexpr bool is_control(unsigned code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }

/// U+2028 to U+202E and U+2066 to U+2069: separators of lines, and what turns the order of the characters that follow.
constexpr bool is_reordering(unsigned code) {
  return (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace vantage::internal::core
