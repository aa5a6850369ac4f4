#include "io/lod.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace vantage::internal::io {

std::optional<double> parse_lod(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value < 10)) return std::nullopt;
  return value;
}

bool meets_lod(double level, double asked) {
  return level == asked || (asked == std::floor(asked) && std::floor(level) == asked);
}

double choose_lod(const std::vector<double>& levels, std::optional<double> asked) {
  const double none = -std::numeric_limits<double>::infinity();
  double exact = none, refined = none, below = none, above = std::numeric_limits<double>::infinity();
  for (const double level : levels) {
    if (asked && level == *asked) {
      exact = level;
    } else if (asked && meets_lod(level, *asked)) {
      refined = std::max(refined, level);
    } else if (!asked || level < *asked) {
      below = std::max(below, level);
    } else {
      above = std::min(above, level);
    }
  }
  for (const double found : {exact, refined, below}) {
    if (found != none) return found;
  }
  return above;
}

}  // namespace vantage::internal::io
