// How two closed volumes differ.
#pragma once

#include <string>

#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage {

struct Comparison {
  double volume_a_m3 = 0, volume_b_m3 = 0;
  double intersection_m3 = 0;
  double only_a_m3 = 0;  ///< claimed by A alone
  double only_b_m3 = 0;
  double worst_only_a_m = 0;               ///< the largest distance from B's surface of a corner of what A alone claims
  Vec3 worst_only_a_point = Vec3::Zero();  ///< where, scene frame
  double worst_only_b_m = 0;
  Vec3 worst_only_b_point = Vec3::Zero();
  Mesh only_a, only_b;  ///< closed, possibly empty, scene frame
};

/// Booleans of two closed, outward-oriented meshes. Throws Error(input) naming `name_a` or `name_b` for one that is
/// open, inside out or intersects itself (in more than 0.1 % of its area); Error(cancelled). Meshes of the same
/// triangles differ by exactly 0. Uses the threads of the caller's arena (TBB). Cost: the check of each mesh for
/// self-intersections and two boolean operations, O(n log n) in their facets: seconds for half a million.
Comparison compare_volumes(const Mesh& a, const Mesh& b, const std::string& name_a = "A",
                           const std::string& name_b = "B", const Progress& progress = {});

}  // namespace vantage
