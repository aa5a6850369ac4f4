#include <algorithm>
#include <limits>
#include <utility>

#include "common/input.h"

namespace vantage {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the usual table: the swap of neighbours looks two rows back.
  std::vector<int> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(previous);
    previous.swap(row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = lower(a[i - 1]), y = lower(b[j - 1]);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (x == y ? 0 : 1)});
      if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string_view nearest_name(std::string_view word, const std::vector<std::string_view>& names) {
  // A word longer than this is not a slip of the pen; its beginning is enough to compare and keeps the cost bounded.
  constexpr std::size_t kLongest = 100;
  constexpr std::size_t kShortest = 3;  // a letter or two are in most names
  word = word.substr(0, kLongest);
  const auto holds_word = [&](std::string_view name) {
    const auto same = [](char a, char b) { return lower(a) == lower(b); };
    return std::search(name.begin(), name.end(), word.begin(), word.end(), same) != name.end();
  };
  std::string_view nearest;
  std::pair<bool, int> least(true, std::numeric_limits<int>::max());
  for (const std::string_view name : names) {
    const bool lacks_word = word.size() < kShortest || !holds_word(name);
    const std::pair<bool, int> distance(lacks_word, edit_distance(word, name));
    if (distance < least) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

}  // namespace vantage
