// Which known word did the user mean?
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage::app {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal string
/// alignment distance), upper and lower case taken as equal. Cost: O(|a| |b|).
int edit_distance(std::string_view a, std::string_view b);

/// The entry of `names` with the smallest edit distance to `word`, the first one on a tie; empty for no names.
std::string_view nearest_name(std::string_view word, const std::vector<std::string_view>& names);

}  // namespace vantage::app
