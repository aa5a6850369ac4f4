// Where a viewpoint may not be: on a surface, or inside a solid.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/scene.h"

namespace vantage::internal::scene {

/// Nearer than this to a triangle a viewpoint lies on it, metres. Single-precision depths and the rounding of files
/// tell no less apart.
inline constexpr double kOnSurface = 1e-3;

/// Checks viewpoints against one scene, which must outlive this.
///
/// Inside a solid is told by the winding number (the solid angle that a surface spans around the viewpoint, over 4
/// pi) of each connected piece of the mesh, and of each object, whose faces may not meet: 1 inside a closed surface,
/// above 1/2 above the missing floor of a building that has none, -1 inside one whose normals point inward. An open
/// ground spans 1/2 from below and -1/2 from above. Pieces whose triangles are turned at random are not noticed.
/// Cost: linear in the triangles, each time.
class ViewpointCheck {
 public:
  VANTAGE_INTERNAL_API explicit ViewpointCheck(const Scene& scene);

  /// The object that a place lies on, or else one that it lies inside of; neither in the open.
  struct Place {
    std::optional<std::uint32_t> on, inside;
  };
  Place look(const Vec3& viewpoint) const;

  /// Throws Error(input) that names the object. `name` begins the message: "the viewpoint of volume 2".
  VANTAGE_INTERNAL_API void check(const Vec3& viewpoint, const std::string& name) const;

 private:
  const Scene& scene_;
  std::vector<std::uint32_t> piece_of_;  // per triangle
  std::size_t pieces_ = 0;
};

}  // namespace vantage::internal::scene
