// The plain alternative to the engine: a region minus the union of one closed solid per scene triangle. Slow, and
// shares nothing with src/exact/ but the target's frame.
#pragma once

#include <array>
#include <vector>

#include "solid/csg.h"
#include "support/internals.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::testing {

/// The part of `box` from which a scene triangle hides some of the target; all in the target's frame, box.min.z >= 0.
/// The facets are found by brute force: every three of the cone's generators that have all others on one side.
solid::Solid blocker_solid(const std::array<Vec3, 3>& triangle, const std::vector<Eigen::Vector2d>& target,
                           const Box& box);

/// A volume's mesh in its target's frame.
solid::Solid local_solid(const Volume& volume);

/// The box that holds everything within `reach` of the target, in its frame.
solid::Solid local_box(const TargetFrame& frame, double reach, double height);

struct UnionComparison {
  double volume = 0;     ///< of the region minus all blockers
  double missing = 0;    ///< of that, what the engine's volume lacks
  double excessive = 0;  ///< what the engine's volume has in the region beyond that
  std::size_t blockers = 0;

  double error() const { return (missing + excessive) / volume; }
};

/// Compares a computed volume with region minus union of blockers, inside `region` (in the target's frame, z >= 0, all
/// of it within range by more than the volume's tolerance).
UnionComparison compare_with_union(const Scene& scene, const Volume& volume, const solid::Solid& region);

}  // namespace vantage::testing
