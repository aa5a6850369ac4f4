// How two closed volumes differ.
//
// The worst distance of A from B is the largest distance that any point of A has to the nearest point of B, both taken
// as solids: the one-sided Hausdorff distance. It is 0 where A claims nothing alone. It is known from below, by a point
// that was found, and from above, by a bound that no point exceeds.
#pragma once

#include <string>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage {

struct Comparison {
  double volume_a_m3 = 0, volume_b_m3 = 0;
  double intersection_m3 = 0;
  double only_a_m3 = 0;  ///< claimed by A alone
  double only_b_m3 = 0;
  double worst_only_a_m = 0;               ///< the largest distance from B of a point of A that was found
  double worst_only_a_bound_m = 0;         ///< no point of A is farther from B
  Vec3 worst_only_a_point = Vec3::Zero();  ///< the point that was found, scene frame
  double worst_only_b_m = 0;               ///< the same of B
  double worst_only_b_bound_m = 0;
  Vec3 worst_only_b_point = Vec3::Zero();
  Mesh only_a, only_b;  ///< closed, possibly empty, scene frame
};

/// Booleans of two closed, outward-oriented meshes. Throws Error(input) naming `name_a` or `name_b` for one that is
/// open, inside out or intersects itself (in more than 0.1 % of its area); Error(cancelled). Meshes of the same
/// triangles differ by exactly 0. The bounds of a worst distance lie within 1 % of it, or 1e-12 of the size of both;
/// where that would take too long, as between volumes that differ by a hair in very many places, they are farther
/// apart. Uses the threads of the caller's arena (TBB). Cost: the check of each mesh for self-intersections and two
/// boolean operations, O(n log n) in their facets, and the distances of what differs: seconds for half a million.
VANTAGE_API Comparison compare_volumes(const Mesh& a, const Mesh& b, const std::string& name_a = "A",
                                       const std::string& name_b = "B", const Progress& progress = {});

}  // namespace vantage
