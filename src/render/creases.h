// The edges of a volume that a drawing shows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::render {

struct Crease {
  Vec3 a, b;
  double strength = 0;  ///< 0 (not to be seen) to 1
};

/// Edges where facets of different kind meet, at full strength; edges where facets meet at an angle, stronger the
/// sharper; and contours, where a facet that faces the viewer meets one that does not. `kind_of`: per triangle, or
/// empty. `to_viewer(point)`: any vector from a point towards the viewer. The facets of a curved face are not told
/// apart, nor are facets too thin for their normal to mean anything. Cost: O(n log n).
std::vector<Crease> find_creases(const Mesh& mesh, std::span<const std::uint8_t> kind_of, const Vec3& eye,
                                 const Vec3& back, bool perspective);

}  // namespace vantage::render
