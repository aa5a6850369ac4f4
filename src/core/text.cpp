#include "core/text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace vantage::internal::core {

std::string number_text(double number) {
  // Beyond 2^53 there are no decimals, and fixed notation would only be long.
  if (std::abs(number) >= 9007199254740992.0) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
  }
  const double rounded = std::round(number * 1000) / 1000;
  std::array<char, 64> text;
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), rounded == 0 ? 0.0 : rounded, std::chars_format::fixed)
              .ptr};
}

std::string point_text(const Vec3& point) {
  std::string text("(");
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    text.append(axis == 0 ? "" : ", ").append(number_text(point[axis]));
  }
  return text.append(")");
}

std::string count_text(std::size_t count, const char* one, const char* many) {
  return std::to_string(count).append(" ").append(count == 1 ? one : many);
}

}  // namespace vantage::internal::core
