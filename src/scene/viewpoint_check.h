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
/// ground spans 1/2 from below and -1/2 from above; ground is no piece with what stands on it. Not inside is a place
/// with nothing above it, or in the cavity of an object that is solid round it. Pieces whose triangles are turned at
/// random, and buildings turned inside out that have no floor, are not noticed.
/// Cost: linear in the triangles, each time.
class ViewpointCheck {
 public:
  /// `ground`: objects that are ground beside those of its kind.
  VANTAGE_INTERNAL_API explicit ViewpointCheck(const Scene& scene, const std::vector<std::uint32_t>& ground = {});

  /// The object that a place is inside of; one that is ground only where it is inside of no other.
  std::optional<std::uint32_t> solid_around(const Vec3& viewpoint) const;
  bool is_ground(std::uint32_t object) const { return is_ground_[object]; }
  /// display_name; "scene" in a scene without objects.
  std::string name_of(std::uint32_t object) const;

  /// Throws Error(input) that names the object. `name` begins the message: "the viewpoint of volume 2".
  VANTAGE_INTERNAL_API void check(const Vec3& viewpoint, const std::string& name) const;

 private:
  const Scene& scene_;
  std::vector<bool> is_ground_;                      // per object
  std::vector<std::uint32_t> object_of_, piece_of_;  // per triangle
  struct Piece {
    std::uint32_t object;  // the first
    bool is_of_one = true;
    Box box = {};
  };
  std::vector<Piece> pieces_;
};

}  // namespace vantage::internal::scene
