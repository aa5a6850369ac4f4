#include "core/text.h"

#include <array>
#include <charconv>
#include <cmath>

#include "core/format.h"
#include "vantage/input.h"

namespace vantage::internal::core {

std::string number_text(double number) {
  // Beyond 2^53 there are no decimals, and fixed notation would only be long.
  if (std::abs(number) >= 9007199254740992.0) return shortest(number);
  const double rounded = std::round(number * 1000) / 1000;
  // libfmt writes the fewest digits only where it may choose the notation.
  std::array<char, 64> text;
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), rounded == 0 ? 0.0 : rounded, std::chars_format::fixed)
              .ptr};
}

std::string metres_text(double metres) { return format("{:.4g} m", metres); }

std::string point_text(const Vec3& point) {
  return format("({}, {}, {})", number_text(point.x()), number_text(point.y()), number_text(point.z()));
}

std::string fixed_text(const Vec3& point, int decimals) {
  return format("({1:.{0}f}, {2:.{0}f}, {3:.{0}f})", decimals, point.x(), point.y(), point.z());
}

std::string count_text(std::size_t count, const char* one, const char* many) {
  return format("{} {}", count, count == 1 ? one : many);
}

}  // namespace vantage::internal::core
