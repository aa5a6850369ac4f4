#include "core/text.h"

#include <array>
#include <charconv>
#include <cmath>

#include "common/input.h"
#include "core/characters.h"
#include "core/format.h"

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

std::string metres_text(double metres) { return fmt::format("{:.4g} m", metres); }

std::string point_text(const Vec3& point) {
  return fmt::format("({}, {}, {})", number_text(point.x()), number_text(point.y()), number_text(point.z()));
}

std::string fixed_text(const Vec3& point, int decimals) {
  return fmt::format("({1:.{0}f}, {2:.{0}f}, {3:.{0}f})", decimals, point.x(), point.y(), point.z());
}

std::string escaped_json(const std::string& json) {
  std::string escaped;
  std::size_t copied = 0;
  constexpr const char* kFirst = "\x7f\xc2\xe2";
  for (std::size_t at = json.find_first_of(kFirst); at != std::string::npos; at = json.find_first_of(kFirst, at + 1)) {
    const auto byte = [&](std::size_t i) {
      return at + i < json.size() ? static_cast<unsigned char>(json[at + i]) : 0U;
    };
    const unsigned first = byte(0), second = byte(1), third = byte(2);
    const unsigned code = first == 0x7f   ? first
                          : first == 0xc2 ? second
                                          : 0x2000U | (second & 0x3fU) << 6U | (third & 0x3fU);
    // Below U+0020 none begin with these bytes.
    if (!is_control(code) && !is_reordering(code)) continue;
    escaped.append(json, copied, at - copied).append(fmt::format("\\u{:04x}", code));
    copied = at + (first == 0x7f ? 1 : first == 0xc2 ? 2 : 3);
  }
  return escaped.append(json, copied);
}

std::string count_text(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace vantage::internal::core
