// The planes of blockers that may be seen, and where.
#pragma once

#include <cstdint>
#include <vector>

#include "exact/direction_tree.h"

namespace vantage::internal::exact {

/// A plane of a blocker that may be seen, and the blockers that may cut it.
struct Facet {
  std::uint32_t plane, blocker;
  std::uint32_t first_leaf_plane, leaf_plane_count;  // into FacetTable::leaf_planes
};

/// Where a facet may be seen: a leaf, and the facet's plane among those of the leaf.
struct LeafPlane {
  std::uint32_t leaf, plane;
};

struct FacetTable {
  std::vector<Facet> facets;
  std::vector<LeafPlane> leaf_planes;
};

/// Facets by plane. A plane that another blocker's surface is nowhere under, in any leaf, is not among them. Parallel
/// over leaves; the result does not depend on the number of threads.
FacetTable find_facets(const BlockerSet& blockers, const std::vector<const DirectionTree::Leaf*>& leaves);

}  // namespace vantage::internal::exact
