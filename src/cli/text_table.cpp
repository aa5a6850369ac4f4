#include "cli/text_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace vantage::cli {
namespace {

/// Characters, not bytes: names of buildings are seldom ASCII.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string count(std::size_t number) { return std::to_string(number); }

std::string fixed(double value, int digits) {
  constexpr int kMostDigits = 20;
  std::array<char, std::numeric_limits<double>::max_exponent10 + kMostDigits + 4> text;  // a sign, a point, the first
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed,
                                 std::clamp(digits, 0, kMostDigits));
  const std::string shown(text.data(), end.ptr);
  // "-0.00" is a rounding's sign, not the number's.
  return shown.find_first_of("123456789") == std::string::npos && shown.front() == '-' ? shown.substr(1) : shown;
}

std::string vector(const Vec3& value) {
  return fixed(value.x(), 2) + " " + fixed(value.y(), 2) + " " + fixed(value.z(), 2);
}

std::string duration(double seconds) {
  return seconds < 1 ? fixed(seconds * 1e3, seconds < 0.01 ? 2 : 0) + " ms" : fixed(seconds, 2) + " s";
}

std::string TextTable::text() const {
  std::size_t name_width = 0, value_width = 0;
  for (const Row& row : rows_) {
    if (row.is_heading) continue;
    name_width = std::max(name_width, width(row.name));
    value_width = std::max(value_width, width(row.value));
  }
  std::string text;
  for (const Row& row : rows_) {
    if (row.is_heading) {
      text += row.name + "\n";
      continue;
    }
    std::string line = "  " + row.name + std::string(name_width - width(row.name) + 2, ' ') +
                       std::string(value_width - width(row.value), ' ') + row.value;
    if (!row.remark.empty()) line += "  " + row.remark;
    text += line + "\n";
  }
  return text;
}

}  // namespace vantage::cli
