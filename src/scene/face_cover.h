// What of a face is not free: the scene lies on it, or stands right in front.
#pragma once

#include <vector>

#include "scene/plane_pieces.h"
#include "scene/triangle_index.h"

namespace vantage::internal::scene {

/// A plane of a face, and which of the scene's triangles make it up.
struct FacePlane {
  Vec3 normal;    ///< unit, out of the object
  double at = 0;  ///< normal . p of its points
  bool is_facade = false;
  std::vector<std::uint32_t> triangles;  ///< its own, sorted
};

/// Nearer in front of a face than this nothing of the scene may be, metres: a target is raised by up to 2.01 mm to
/// clear the surface that it lies on, and nothing may stand in it there.
inline constexpr double kInFront = 3e-3;

/// Triangles that are within this of a plane with all their corners lie in it, metres.
inline constexpr double kInPlane = 1e-3;

/// Cuts out of `pieces`, which lie in the plane, what is not free. `boxes`: of the scene's objects.
void cut_covered(const TriangleIndex& index, const std::vector<Box>& boxes, const FacePlane& plane, double sliver,
                 PlanePieces& pieces);

}  // namespace vantage::internal::scene
