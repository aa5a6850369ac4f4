// Meshes with shorter sides: facets are halved across their longest sides.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// One round of bisection of longest sides (Rivara 1984) over the triangles of a closed mesh, which stays closed.
/// `wants(triangle)`: to be halved; others are halved where that is needed to stay closed. `length(a, b)`: of a side,
/// the same for (b, a). `middle(a, b)`: makes the vertex that halves a side, and returns its number; it is called once
/// for a side. `of_triangle`: for each triangle of the result, the one that it is a part of. False where none is
/// wanted.
template <typename Wants, typename Length, typename Middle>
bool halve_sides(std::vector<Triangle>& triangles, const Wants& wants, const Length& length, const Middle& middle,
                 std::vector<std::uint32_t>& of_triangle) {
  std::unordered_map<std::uint64_t, std::uint32_t> halves;
  const auto side = [](const Triangle& t, std::size_t k) {
    const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
    return std::uint64_t{low} << 32 | high;
  };
  const auto longest = [&](const Triangle& t) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (length(t[k], t[(k + 1) % 3]) > length(t[best], t[(best + 1) % 3])) best = k;
    }
    return best;
  };
  // Most triangles are told by their vertices, which costs less than looking up their sides.
  std::vector<char> is_end;
  for (const Triangle& t : triangles) {
    const std::size_t most = std::max({t[0], t[1], t[2]});
    if (most >= is_end.size()) is_end.resize(most + 1, 0);
  }
  const auto halve = [&](const Triangle& t) {
    const auto key = side(t, longest(t));
    const auto low = static_cast<std::uint32_t>(key >> 32), high = static_cast<std::uint32_t>(key);
    if (!halves.try_emplace(key, 0).second) return false;
    halves[key] = middle(low, high);
    is_end[low] = is_end[high] = 1;
    return true;
  };
  const auto is_touched = [&](const Triangle& t) {
    if (is_end[t[0]] + is_end[t[1]] + is_end[t[2]] < 2) return false;
    return halves.contains(side(t, 0)) || halves.contains(side(t, 1)) || halves.contains(side(t, 2));
  };
  for (const Triangle& t : triangles) {
    if (wants(t)) halve(t);
  }
  if (halves.empty()) return false;
  // A triangle with a halved side has its longest side halved too.
  for (bool is_done = false; !is_done;) {
    is_done = true;
    for (const Triangle& t : triangles) {
      if (is_touched(t) && halve(t)) is_done = false;
    }
  }
  std::vector<Triangle> halved;
  of_triangle.clear();
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (!is_touched(t)) {
      halved.push_back(t);
    } else {
      const std::size_t k = longest(t);
      const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = halves.at(side(t, k));
      const auto bc = halves.find(side(t, (k + 1) % 3)), ca = halves.find(side(t, (k + 2) % 3));
      if (ca == halves.end()) {
        halved.push_back({a, ab, c});
      } else {
        halved.insert(halved.end(), {{a, ab, ca->second}, {ca->second, ab, c}});
      }
      if (bc == halves.end()) {
        halved.push_back({ab, b, c});
      } else {
        halved.insert(halved.end(), {{ab, b, bc->second}, {ab, bc->second, c}});
      }
    }
    of_triangle.resize(halved.size(), i);
  }
  triangles = std::move(halved);
  return true;
}

}  // namespace vantage::internal::solid
