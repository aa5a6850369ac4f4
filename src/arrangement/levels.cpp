// A forest of sets with potentials: each element knows by how much it differs from the root of its set (Tarjan,
// Applications of path compression on balanced trees, 1979).
#include "arrangement/levels.h"

#include <utility>

namespace vantage::internal::arrangement {
namespace {

class LevelSets {
 public:
  explicit LevelSets(std::size_t size) : parent_(size), size_(size, 1), above_(size, 0) {
    for (std::uint32_t i = 0; i < size; ++i) parent_[i] = i;
  }

  /// The root of an element's set, and by how much the element lies above it.
  std::pair<std::uint32_t, std::int64_t> find(std::uint32_t element) {
    std::uint32_t root = element;
    std::int64_t above = 0;
    while (parent_[root] != root) {
      above += above_[root];
      root = parent_[root];
    }
    for (std::int64_t rest = above; parent_[element] != root && element != root;) {
      const std::int64_t own = above_[element];
      above_[element] = rest;
      rest -= own;
      element = std::exchange(parent_[element], root);
    }
    return {root, above};
  }

  /// `upper` lies so much above `lower`. False where that contradicts what is known.
  bool join(std::uint32_t upper, std::uint32_t lower, std::int64_t by) {
    auto [root_of_upper, upper_above] = find(upper);
    auto [root_of_lower, lower_above] = find(lower);
    if (root_of_upper == root_of_lower) return upper_above == lower_above + by;
    std::int64_t difference = lower_above + by - upper_above;  // of the upper root above the lower one
    if (size_[root_of_upper] > size_[root_of_lower]) {
      std::swap(root_of_upper, root_of_lower);
      difference = -difference;
    }
    parent_[root_of_upper] = root_of_lower;
    above_[root_of_upper] = difference;
    size_[root_of_lower] += size_[root_of_upper];
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_, size_;
  std::vector<std::int64_t> above_;
};

/// Half-edges that follow each other have one level.
std::vector<std::uint32_t> loops_of(const Subdivision& subdivision, std::uint32_t& count) {
  std::vector<std::uint32_t> loops(subdivision.size(), kNone);
  count = 0;
  for (std::uint32_t begin = 0; begin < loops.size(); ++begin) {
    if (loops[begin] != kNone) continue;
    for (std::uint32_t half = begin; loops[half] == kNone; half = subdivision.next(half)) loops[half] = count;
    ++count;
  }
  return loops;
}

bool join_across(const Soup& soup, const Subdivision& subdivision, std::span<const Operand> operands,
                 const std::vector<std::uint32_t>& loops, LevelSets& sets) {
  for (std::uint32_t half = 0; half < subdivision.first_of_meetings(); half += 2) {
    if (!sets.join(loops[half], loops[half + 1], 0)) return false;
  }
  const auto weight_of = [&](std::uint32_t half) {
    return static_cast<std::int64_t>(operands[soup.facets()[subdivision.facet(half)].mesh].weight);
  };
  for (std::uint32_t half = subdivision.first_of_meetings(); half < subdivision.size(); half += 4) {
    if (!sets.join(loops[half], loops[half + 1], weight_of(half + 2)) ||
        !sets.join(loops[half + 2], loops[half + 3], weight_of(half)) ||
        !sets.join(loops[half + 1], loops[half + 3], 0)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<std::uint64_t>> find_levels(const Soup& soup, const Subdivision& subdivision,
                                                      std::span<const Operand> operands) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> loops = loops_of(subdivision, count);
  LevelSets sets(count);
  if (!join_across(soup, subdivision, operands, loops, sets)) return std::nullopt;
  // Every set has a corner of a mesh: what encloses a part of a facet, and meets no edge of it, crosses edges of the
  // mesh that it comes from, and these end at corners.
  std::vector<std::int64_t> of_root(count);
  std::vector<char> is_known(count, 0);
  for (std::uint32_t e = 0; e < soup.edges().size(); ++e) {
    const auto [root, above] = sets.find(loops[subdivision.first_of_edge(e)]);
    if (is_known[root]) continue;
    const auto level = soup.level_at(soup.edges()[e].from, soup.mesh_of_edge(e), operands);
    if (!level) return std::nullopt;
    of_root[root] = static_cast<std::int64_t>(*level) - above;
    is_known[root] = 1;
  }
  std::vector<std::uint64_t> levels(subdivision.size());
  for (std::uint32_t half = 0; half < levels.size(); ++half) {
    const auto [root, above] = sets.find(loops[half]);
    if (!is_known[root] || of_root[root] + above < 0) return std::nullopt;
    levels[half] = static_cast<std::uint64_t>(of_root[root] + above);
  }
  return levels;
}

}  // namespace vantage::internal::arrangement
