#include "core/edges.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>

#include "core/parallel.h"
#include "vantage/error.h"

namespace vantage::internal::core {
namespace {

void check_indices(const std::vector<Triangle>& triangles, std::size_t vertices) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) {
      if (v < vertices) continue;
      throw Error(ErrorCode::index_out_of_range,
                  "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + ", but there are only " +
                      std::to_string(vertices),
                  "", "number the vertices of a mesh from 0");
    }
  }
}

}  // namespace

std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles, std::size_t vertices) {
  check_indices(triangles, vertices);
  // Bucket by the lower vertex, then sort each bucket: a handful of edges.
  std::vector<std::size_t> next(vertices + 1, 0);
  for (const Triangle& t : triangles) {
    for (int i = 0; i < 3; ++i) ++next[std::min(t[i], t[(i + 1) % 3]) + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<EdgeUse> uses(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles[t][i], to = triangles[t][(i + 1) % 3];
      uses[next[std::min(from, to)]++] = {std::min(from, to), std::max(from, to), t, from < to};
    }
  }
  parallel::for_ranges(vertices, 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t vertex = first; vertex < last; ++vertex) {
      const std::size_t begin = vertex == 0 ? 0 : next[vertex - 1];
      std::sort(uses.begin() + static_cast<std::ptrdiff_t>(begin),
                uses.begin() + static_cast<std::ptrdiff_t>(next[vertex]), [](const EdgeUse& a, const EdgeUse& b) {
                  return std::tie(a.high, a.triangle, a.forward) < std::tie(b.high, b.triangle, b.forward);
                });
    }
  });
  return uses;
}

DisjointSets::DisjointSets(std::size_t size) : parent_(size), count_(size) {
  std::iota(parent_.begin(), parent_.end(), 0u);
}

std::uint32_t DisjointSets::find(std::uint32_t element) {
  while (parent_[element] != element) element = parent_[element] = parent_[parent_[element]];
  return element;
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b) {
  a = find(a);
  b = find(b);
  if (a == b) return;
  // The smaller index becomes the root, so that a set is named after its first element.
  parent_[std::max(a, b)] = std::min(a, b);
  --count_;
}

}  // namespace vantage::internal::core
