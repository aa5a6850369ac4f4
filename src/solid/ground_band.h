// The space between two heights above the ground, as a labelled solid.
#pragma once

#include <cstdint>

#include "solid/csg.h"
#include "vantage/geometry.h"

namespace vantage::internal::solid {

/// `edge`: of the walls where the ground ends.
struct GroundBandLabels {
  std::uint32_t min = 0, max = 0, edge = 0;
};

/// What lies from `min_m` to `max_m` above every triangle of `surface` that is above or below it, of those triangles
/// that reach into `near` in plan. About `origin`; `surface` and `near` are in the scene frame. Empty where there are
/// none, or where the triangles over each other leave nothing.
///
/// Exact but for rounding: triangles are shifted along z, and where a corner of one lies on a side of another one, to 8
/// roundings of the largest coordinate of `surface`, that side is led through the corner. Triangles narrower in plan
/// than rounding are left out: there is no ground on them. Cost: O(n log n) in the triangles near by; where some of
/// them lie over each other, booleans of as many prisms.
Solid make_ground_band(const Mesh& surface, double min_m, double max_m, const Box& near, const Vec3& origin,
                       const GroundBandLabels& labels, const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::solid
