// The creases of the boundary: where two surfaces of the envelope meet. docs/theory.md, "Computing the envelope".
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "exact/direction_tree.h"
#include "exact/octahedral_grid.h"
#include "target/range_region.h"

namespace vantage::internal::exact {

/// The one-skeleton of the envelope as points in the target's frame. Between creases the boundary is a plane or a ball.
struct Skeleton {
  struct Edge {
    Vec3 from, to;
  };
  /// Where a plane meets the range sphere.
  struct Curve {
    Vec3 normal;  ///< of the plane normal . x = height, unit length
    double height;
    std::vector<Vec3> points;  ///< a polyline with points on the curve
  };
  std::vector<Edge> planar;  ///< between two planes: straight
  std::vector<Curve> curved;
  std::size_t visible_blockers = 0;
  std::size_t visible_facets = 0;
};

struct CurveSampling {
  double sagitta_m;  ///< a chord lies at most this far from its arc,
  double length_m;   ///< and is at most this long
};

/// Every crease inside one blocker that bounds the volume is in the result in full: leaving one out would over-claim.
/// Creases between balls of the range region are in it where `grid` is too coarse for them. Parallel over facets; the
/// result does not depend on the number of threads.
Skeleton trace_envelope(const BlockerSet& blockers, const DirectionTree& tree, const target::RangeRegion& range,
                        const CurveSampling& sampling, OctahedralGrid& grid, const core::ProgressReporter& progress);

}  // namespace vantage::internal::exact
