#include "prove/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vantage::internal::prove {
namespace {

/// On the octahedron's map of directions, and how far, in a measure that makes facets behind one edge stay together.
using Place = std::array<double, 3>;

constexpr double kFarApart = 0.15;  // of the map's side: how much a distance e times as large counts

Place place_of(const Vec3& at) {
  const double sum = at.cwiseAbs().sum();
  if (!(sum > 0)) return {};
  const Vec3 d = at / sum;
  const double far = kFarApart * std::log(sum);
  if (d.z() >= 0) return {d.x(), d.y(), far};
  return {(1 - std::abs(d.y())) * (d.x() < 0 ? -1 : 1), (1 - std::abs(d.x())) * (d.y() < 0 ? -1 : 1), far};
}

class Halving {
 public:
  Halving(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets, Patches& patches)
      : vertices_(vertices), facets_(facets), patches_(patches) {
    for (const auto& [a, b, c] : facets) places_.push_back(place_of((vertices[a] + vertices[b] + vertices[c]) / 3));
  }

  void halve(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = patches_.tree.size();
    patches_.tree.push_back({begin, end, 0, 0});
    if (end - begin == 1) {
      patches_.tree[index].extent = width(facets_[patches_.order[begin]]);
      return;
    }
    Place low = places_[patches_.order[begin]], high = low;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], places_[patches_.order[i]][k]);
        high[k] = std::max(high[k], places_[patches_.order[i]][k]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    }
    const std::uint32_t half = begin + (end - begin) / 2;
    const auto at = [&](std::uint32_t i) { return patches_.order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
      return places_[a][axis] < places_[b][axis] || (places_[a][axis] == places_[b][axis] && a < b);
    });
    halve(begin, half);
    const auto second = static_cast<std::uint32_t>(patches_.tree.size());
    halve(half, end);
    patches_.tree[index].second = second;
    patches_.tree[index].extent =
        std::max({high[0] - low[0], high[1] - low[1], patches_.tree[index + 1].extent, patches_.tree[second].extent});
  }

 private:
  double width(const Triangle& facet) const {
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max(most, (vertices_[facet[k]].normalized() - vertices_[facet[(k + 1) % 3]].normalized()).norm());
    }
    return most;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& facets_;
  Patches& patches_;
  std::vector<Place> places_;
};

}  // namespace

Patches make_patches(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets) {
  Patches patches;
  patches.order.resize(facets.size());
  std::iota(patches.order.begin(), patches.order.end(), 0u);
  if (!facets.empty()) Halving(vertices, facets, patches).halve(0, static_cast<std::uint32_t>(facets.size()));
  return patches;
}

}  // namespace vantage::internal::prove
