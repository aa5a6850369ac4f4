#include "exact/facet_table.h"

#include <algorithm>
#include <functional>

#include "core/parallel.h"

namespace vantage::internal::exact {
namespace {

struct VisiblePlane {
  std::uint32_t plane, blocker;
  LeafPlane at;
  bool operator<(const VisiblePlane& other) const {
    return plane != other.plane ? plane < other.plane : at.leaf < other.at.leaf;
  }
};

// Whether another blocker's surface is nowhere under plane k of the leaf. Of two that coincide the one with the lower
// index stays.
bool plane_hidden(const DirectionTree::Leaf& leaf, std::size_t own, std::uint32_t k) {
  for (std::size_t i = 0; i < leaf.count(); ++i) {
    if (i == own) continue;
    const auto values = leaf.values_of(i);
    if (!std::all_of(values.begin(), values.end(), [&](const auto& high) { return below(leaf.values[k], high); }))
      continue;
    const bool tie =
        std::any_of(values.begin(), values.end(), [&](const auto& high) { return below(high, leaf.values[k]); });
    if (!tie || leaf.blockers[i] < leaf.blockers[own]) return true;
  }
  return false;
}

}  // namespace

FacetTable find_facets(const BlockerSet& blockers, const std::vector<const DirectionTree::Leaf*>& leaves) {
  constexpr std::size_t kLeaves = 16;  // that one thread takes at a time
  std::vector<std::vector<VisiblePlane>> found(leaves.size() / kLeaves + 1);
  parallel::for_ranges(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      for (std::size_t l = c * kLeaves; l < std::min(leaves.size(), (c + 1) * kLeaves); ++l) {
        for (std::size_t i = 0; i < leaves[l]->count(); ++i) {
          for (std::uint32_t k = leaves[l]->first_plane[i]; k < leaves[l]->first_plane[i + 1]; ++k) {
            if (blockers.visible[leaves[l]->planes[k]] && !plane_hidden(*leaves[l], i, k))
              found[c].push_back({leaves[l]->planes[k], leaves[l]->blockers[i], {static_cast<std::uint32_t>(l), k}});
          }
        }
      }
    }
  });
  std::vector<VisiblePlane> visible_planes;
  for (const auto& some : found) visible_planes.insert(visible_planes.end(), some.begin(), some.end());
  parallel::sort(visible_planes, std::less<>());
  FacetTable table;
  for (const VisiblePlane& s : visible_planes) {
    if (table.facets.empty() || table.facets.back().plane != s.plane)
      table.facets.push_back({s.plane, s.blocker, static_cast<std::uint32_t>(table.leaf_planes.size()), 0});
    table.leaf_planes.push_back(s.at);
    ++table.facets.back().leaf_plane_count;
  }
  return table;
}

}  // namespace vantage::internal::exact
