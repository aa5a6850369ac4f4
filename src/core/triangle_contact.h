// How two triangles in space meet.
#pragma once

#include <array>

#include "vantage/geometry.h"

namespace vantage::internal::core {

enum class Contact {
  none,      ///< apart, or they meet in a point, or they are neighbours
  touching,  ///< they meet along a line or over an area without passing through each other
  crossing,  ///< they pass through each other
};

/// How triangles with corners `a` and `b` meet; `shared` is the number of corners that are one vertex of the mesh.
/// `distance` is the depth or length up to which a contact is not counted. Triangles narrower than it have no contact:
/// the mesh around them shows it. After T. Moeller, "A fast triangle-triangle intersection test" (1997), with distances
/// for signs.
Contact contact_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, int shared, double distance);

/// Whether a triangle may touch a box that its own box meets: no normal of the triangle, and no product of an edge and
/// an axis, separates the two (T. Akenine-Moeller, "Fast 3D triangle-box overlap testing", 2001).
bool may_touch(const std::array<Vec3, 3>& triangle, const Box& box);

}  // namespace vantage::internal::core
