// Level sections of closed meshes: which places of a volume lie at one height.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"

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

}  // namespace vantage
