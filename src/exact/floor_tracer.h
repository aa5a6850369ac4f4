// Where the floor meets what bounds the volume, and the creases of the floor in between.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "exact/direction_tree.h"
#include "exact/envelope.h"
#include "exact/floor.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// As points in the target's frame. Curves lie on the range sphere.
struct FloorSkeleton {
  std::vector<Skeleton::Edge> rim;          ///< where the floor meets a blocker
  std::vector<Skeleton::Curve> curved_rim;  ///< where it meets the range sphere
  std::vector<Skeleton::Edge> creases;      ///< between two planes of the floor, where it is below the envelope
};

/// Parallel over facets; the result does not depend on the number of threads. Cost: for each facet of the floor, its
/// planes and those of the blockers that are seen over it.
FloorSkeleton trace_floor(const Floor& floor, const BlockerSet& blockers, const DirectionTree& tree,
                          const target::RangeRegion& range, const CurveSampling& sampling,
                          const core::ProgressReporter& progress);

/// Where the rim leaves the range sphere it ends on a curve of the envelope: makes that point one of its polyline,
/// which passes it by a chord's depth.
void add_rim_ends(const FloorSkeleton& floor, double reach, const CurveSampling& sampling, Skeleton& skeleton);

}  // namespace vantage::internal::exact
