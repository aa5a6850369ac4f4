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
/// Exact but for rounding: triangles are shifted along z, and where a corner of one stands at a corner or on a side of
/// another one, to 8 roundings of the largest coordinate of that other triangle, its corner or side is led there.
/// Triangles narrower in plan than rounding are left out: there is no ground on them. Cost: O(n log n) in the triangles
/// near by; where some of them lie over each other, or corners beside each other that this does not join, booleans of
/// as many prisms. Throws Error(cancelled) when told to stop.
Solid make_ground_band(const Mesh& surface, double min_m, double max_m, const Box& near, const Vec3& origin,
                       const GroundBandLabels& labels, const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::solid
