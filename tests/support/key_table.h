// The keys of a section, as docs/mission-file.md lists them.
#pragma once

#include <string>

#include "vantage/mission_keys.h"

namespace vantage::testing {

/// The columns of UTF-8.
inline std::size_t columns(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return count;
}

/// An entry of a list, on lines of at most 120 columns.
inline std::string wrapped(std::string line) {
  constexpr std::size_t kMost = 120;
  std::string text;
  while (columns(line) > kMost) {
    std::size_t at = line.size();
    do {
      at = line.rfind(' ', at - 1);
    } while (columns(line.substr(0, at)) > kMost);
    text += line.substr(0, at) + "\n";
    line = "  " + line.substr(at + 1);
  }
  return text + line + "\n";
}

inline std::string key_table(const std::string& section) {
  std::string text;
  for (const MissionKey& key : mission_keys()) {
    if (key.section != section) continue;
    std::string line = "- `" + (section.empty() ? "" : section + ".") + key.path + "`";
    if (!key.unit.empty()) line += " (" + key.unit + ")";
    text += wrapped(line + ": " + key.text);
  }
  return text;
}

}  // namespace vantage::testing
