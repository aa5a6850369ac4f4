// The facets of a surface that is being changed, by place.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bvh.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

/// A hierarchy of boxes. A facet that changes keeps its leaf, whose box and those above it change: what is near on the
/// surface stays near in the tree. Built anew now and then.
class FacetTree {
 public:
  /// A tree of the facets whose box is not empty.
  explicit FacetTree(const std::vector<Box>& facets);

  /// The facet's box from now on; an empty one takes it out. It must have been in the tree.
  void update(std::uint32_t facet, const Box& box);

  /// Appends the facets whose boxes have a point in common with `box`, in a fixed order.
  void find(const Box& box, std::vector<std::uint32_t>& found) const;

 private:
  void fit(std::uint32_t node);

  core::Bvh tree_;
  std::vector<std::uint32_t> order_;    // the facets of leaves, one after another
  std::vector<std::uint32_t> leaf_of_;  // per facet
  std::vector<std::uint32_t> parent_;   // per node; the root is its own
  std::vector<core::Bounds> boxes_;     // per facet
};

}  // namespace vantage::internal::simplify
