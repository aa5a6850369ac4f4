// Booleans of a large mesh and a solid that meets little of it: only what is near the solid goes through the boolean.
#pragma once

#include <cstddef>

#include "solid/csg.h"

namespace vantage::internal::solid {

enum class CutKind {
  keep_inside,  ///< the intersection
  keep_outside  ///< the difference
};

/// What the solid keeps or takes away of `volume`, a closed mesh; both are about one origin. Facets that the solid's
/// surface is not near come out bit for bit as they are. What the boolean makes is right to its epsilon, which is given
/// too.
///
/// Groups of facets whose boxes the surface of the solid does not touch are wholly inside of it or outside. Before the
/// boolean each is replaced by a fan from its border to one point of its box. Group and fan together bound no point of
/// the solid's surface, so that the boolean does the same elsewhere; afterwards the group takes the place of its fan
/// again. Where the two do not fit together, the whole meshes go through the boolean. Cost: linear in the facets, and
/// the boolean of those nearby.
struct LocalCut {
  LabelledMesh mesh;
  double epsilon = 0;       ///< metres
  std::size_t through = 0;  ///< facets of the volume and of the fans that went through the boolean
};
LocalCut cut_locally(const LabelledMesh& volume, const Solid& solid, CutKind kind,
                     const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::solid
