// Whether a facet is hidden where it touches its polygon, and so everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "exact/blocker_set.h"
#include "exact/direction_tree.h"

namespace vantage::internal::exact {

/// The facet of a plane is swept from the corners where the plane touches its polygon, away from the target. For a
/// point o of B(C) and a target point t every plane g of C has g . o >= 1 >= g . t, so o + s (o - t) is in B(C) too:
/// where a competitor holds those corners it hides the whole facet, if it does not coincide with it. Of a target of
/// several polygons both must be of the same one.
class ContactTest {
 public:
  ContactTest(const BlockerSet& blockers, const DirectionTree& tree, double reach)
      : blockers_(blockers), tree_(tree), reach_(reach) {}

  /// The facet of the plane `index`, which is one of the blocker's.
  bool hidden(std::uint32_t blocker, std::uint32_t index);

 private:
  bool hides(std::uint32_t competitor, const Plane& own, bool owns_ties) const;

  const BlockerSet& blockers_;
  const DirectionTree& tree_;
  double reach_;
  std::vector<Vec3> touched_;
};

}  // namespace vantage::internal::exact
