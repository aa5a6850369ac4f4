// What is nearer to obstacles than a vehicle may be, as a labelled solid.
#pragma once

#include <cstdint>
#include <optional>

#include "solid/csg.h"
#include "vantage/navigation.h"

namespace vantage::internal::solid {

/// Holds all that is nearer to an obstacle than the clearance, as far as it reaches into `volume`, a closed mesh about
/// `origin`, all of which can be reached from the point `from`, where that is known: without it each polygon grows by
/// itself, which takes longer. Obstacles and point are in the scene frame, the result is about `origin`. May hold what
/// is inside of closed obstacles, and in gaps of obstacles no wider than 0.6 of the clearance. Facets that face a flat
/// obstacle are at the clearance but for rounding; beside its edges the solid reaches up to 8.3 % of the clearance too
/// far, over gaps 13 %, beside edges that span a gap 38 %, round corners 16 % (core/grown_polygon.h, grown_hull.h,
/// obstacle_shape.h). Cost: linear in the obstacles, then booleans of as many polytopes as there are convex polygons
/// near the volume, of closed obstacles polygons of their roofs (obstacle_shape.h); throws Error(work_too_large) before
/// the first where that would be too much.
Solid make_clearance(const Clearance& clearance, const Mesh& volume, const std::optional<Vec3>& from,
                     const Vec3& origin, std::uint32_t label, const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::solid
