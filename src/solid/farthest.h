// How far one solid reaches out of another: from below by a point, from above by a proof.
#pragma once

#include "core/progress_reporter.h"
#include "solid/csg.h"
#include "vantage/geometry.h"

namespace vantage::internal::solid {

struct Farthest {
  double at_least_m = 0;  ///< the distance of `point` from the other solid
  double at_most_m = 0;   ///< no point has a larger one
  Vec3 point = Vec3::Zero();
};

/// The largest distance that any point of `region` has from the solid inside `other`, which it lies outside of. Facets
/// of the region with label `own` are those that do not lie on the surface of `other`. Both must be closed, and lie
/// about the origin. Both bounds agree to numerics::kFarthestPart unless that would take more than some millions of
/// steps. Throws Error(cancelled) when told to stop. docs/theory.md, "The farthest point", has the argument.
Farthest farthest_point(const LabelledMesh& region, std::uint32_t own, const Mesh& other,
                        const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::solid
