// Levels of detail of CityJSON: "1", "2.2".
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace vantage::internal::io {

/// A level of detail as a number: 2.2. Nothing for a text that is none.
std::optional<double> parse_lod(std::string_view text);

/// Which of the levels that an object has is taken when `asked` is wanted: itself; of a whole number the highest of its
/// refinements (2.2 for 2); the nearest below; the nearest above. Without `asked` the highest. `levels` is not empty.
double choose_lod(const std::vector<double>& levels, std::optional<double> asked);

/// Whether a level is what was asked for, or refines it.
bool meets_lod(double level, double asked);

}  // namespace vantage::internal::io
