#include "core/stars.h"

#include <algorithm>
#include <numeric>

namespace vantage::internal::core {

Stars::Stars(const std::vector<Triangle>& triangles, std::size_t vertices)
    : first_(vertices + 1, 0), triangles_(3 * triangles.size()), changed_(vertices, kNone) {
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) ++first_[v + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) triangles_[next[v]++] = t;
  }
}

std::span<const std::uint32_t> Stars::of(std::uint32_t vertex) const {
  if (changed_[vertex] != kNone) return stars_[changed_[vertex]];
  if (vertex + 1 >= first_.size()) return {};  // added since, and without triangles
  return std::span(triangles_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
}

std::vector<std::uint32_t>& Stars::editable(std::uint32_t vertex) {
  if (changed_[vertex] == kNone) {
    const std::span<const std::uint32_t> built = of(vertex);
    stars_.emplace_back(built.begin(), built.end());
    changed_[vertex] = static_cast<std::uint32_t>(stars_.size() - 1);
  }
  return stars_[changed_[vertex]];
}

void Stars::remove(std::uint32_t vertex, std::uint32_t triangle) {
  std::vector<std::uint32_t>& star = editable(vertex);
  star.erase(std::remove(star.begin(), star.end(), triangle), star.end());
}

}  // namespace vantage::internal::core
