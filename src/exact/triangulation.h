// From the creases to the closed mesh: docs/theory.md, "Triangulation".
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "exact/direction_tree.h"
#include "exact/envelope.h"
#include "exact/octahedral_grid.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// The boundary in the target's frame: closed, outward oriented, genus 0, star-shaped about the origin.
struct Boundary {
  static constexpr std::uint32_t kRange = ~0u;
  static constexpr std::uint32_t kTargetPlane = ~0u - 1;

  Mesh mesh;
  std::vector<std::uint32_t> blocker_of;  ///< per triangle: index of the blocker that causes it, or one of the above
  std::size_t constraint_edges = 0;
};

/// Cells of the grid that hold nothing but range sphere are cut in two; the rest of the octahedral map is triangulated
/// quadrant by quadrant. Every vertex is lifted to where the gauge says.
Boundary triangulate_boundary(const Skeleton& skeleton, const BlockerSet& blockers, const DirectionTree& tree,
                              const target::RangeRegion& range, OctahedralGrid& grid, double tolerance,
                              const core::ProgressReporter& progress);

}  // namespace vantage::internal::exact
