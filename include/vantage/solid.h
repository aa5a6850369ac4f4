// Closed meshes: sections, what they cover in plan, which points lie in them, how two of them differ.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"

namespace vantage {

/// A polygon with holes in plan: x and y of the scene frame, metres. Rings run round once, without repeating their
/// first corner, the outer one counter-clockwise and holes clockwise, seen from above. Rings may touch in points.
struct PlanPolygon {
  using Ring = std::vector<Eigen::Vector2d>;  ///< 3 corners or more, none between two others on one line
  Ring outer;
  std::vector<Ring> holes;
};

/// The polygon's area in square metres, holes taken off.
VANTAGE_API double area_m2(const PlanPolygon& polygon);

/// Where a closed, outward-oriented mesh meets the plane at the height `z_m`: the limit of the sections from above. So
/// corners of the mesh at exactly that height count as below it: a box from 0 to 10 m has its whole base at 0, and
/// nothing at 10. The polygons are disjoint but for points, the largest first.
///
/// What a corner is off: it lies on an edge of the mesh, moved by no more than 2^-50 of the mesh's largest coordinate
/// (4e-9 m at 5e6 m), or is a vertex at that height, to the bit. So no place of the section is farther than that from
/// the mesh's own section, nor the other way round. Rings may cross themselves or each other by so much where parts of
/// the surface are so near. Of a mesh that passes through itself the rings do so, too.
///
/// Throws Error(input) for a height that is not finite, and for a mesh that is not closed or not oriented, or has an
/// index or a coordinate that is out of range; vertices in one place count as one. Cost: linear in the triangles, and
/// besides n log n in those that cross the plane, and the square of the rings.
VANTAGE_API std::vector<PlanPolygon> slice_mesh(const Mesh& mesh, double z_m);

// ---- Closed meshes seen from above: the ground that lies under a volume

/// All places of the plan that have a point of a closed, outward-oriented mesh above or below them: its projection
/// along z. The polygons are disjoint but for points, the largest first; places between pieces of the mesh are holes.
///
/// Outlines are rounded to a grid of 2^-28 of half the longer side of the mesh's box (1.1 um for a volume of 600 m):
/// corners move by up to that, and where outlines cross, a little of theirs is cut off or filled in, of that width.
///
/// Throws Error(input) for a mesh that is not closed or not oriented, or has an index or a coordinate that is out of
/// range; vertices in one place count as one. Cost: O(n log n) in the triangles, and what the outlines cross each
/// other.
VANTAGE_API std::vector<PlanPolygon> footprint_of_mesh(const Mesh& mesh);

// ---- A closed mesh that is asked many times: which points lie in it, how deep, and whether others come near

/// Immutable and cheap to copy (a shared handle); any number of threads may ask one. The solid is what the mesh winds
/// round at least once, and its surface.
class VANTAGE_API SolidIndex {
 public:
  /// Copies the mesh. An empty one holds nothing. Throws Error(input) for a mesh that is not closed, has an index out
  /// of range or a coordinate that is not finite. Cost: O(n log n) in the triangles.
  explicit SolidIndex(const Mesh& mesh);

  /// The distance of each point (scene frame, metres) from the surface: positive inside, negative outside, 0 on it;
  /// minus infinity for an empty mesh. Rounding: some 1e-15 of the mesh's size and distance. Uses the threads of the
  /// caller's arena (TBB). Throws Error(input) for a point that is not finite. Cost: O(log n) each for ordinary meshes.
  std::vector<double> depths_m(std::span<const Vec3> points) const;

  /// 1 for each point (scene frame, metres) in the solid, else 0. Points on the surface are in it. Decided exactly, by
  /// the coordinates as they are: nothing is rounded. Uses the threads of the caller's arena (TBB). Throws Error(input)
  /// for a point that is not finite, and for a mesh whose triangles turn different ways. Cost: O(n log n) in the
  /// triangles with the first call, then O(log n) for each point, and the triangles straight above it.
  std::vector<std::uint8_t> contains(std::span<const Vec3> points) const;

  /// Whether the solids, both closed sets, have a common point or come as near as `within_m`, which must be at least 0;
  /// 1e-12 of the sizes and distances is added to it for what is rounded. So "no" is certain. Cost: a search for each
  /// triangle of the one in the box of the other, until a near pair is found.
  bool comes_near(const SolidIndex& other, double within_m) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

// ---- How two closed volumes differ
//
// The worst distance of A from B is the largest distance that any point of A has to the nearest point of B, both taken
// as solids: the one-sided Hausdorff distance. It is 0 where A claims nothing alone. It is known from below, by a point
// that was found, and from above, by a bound that no point exceeds.

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
