// The triangles of a scene as they were given, none dropped or merged, by place.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/bvh.h"
#include "vantage/scene.h"

namespace vantage::internal::scene {

using TriangleCorners = std::array<Vec3, 3>;

/// Which side of an object's surface is inside.
enum class Side { outside, inside };

class TriangleIndex {
 public:
  /// Keeps a reference to the scene.
  explicit TriangleIndex(const Scene& scene);

  const Scene& scene() const { return scene_; }
  TriangleCorners corners(std::uint32_t triangle) const;
  std::uint32_t object_of(std::uint32_t triangle) const {
    return scene_.object_of.empty() ? 0 : scene_.object_of[triangle];
  }

  /// Calls `visit` with every triangle whose box, which single precision has widened, meets `box`.
  void near(const Box& box, const std::function<void(std::uint32_t)>& visit) const;

  /// Whether a place that is not on the surface of an object is in it: an odd number of crossings on two of three steep
  /// rays upward and two of four nearly level ones. So no floor need be there, and the terrain round a valley is none.
  Side side_of(const Vec3& place, std::uint32_t object) const;

 private:
  int crossings(const Vec3& from, const Vec3& direction, std::uint32_t object) const;

  const Scene& scene_;
  std::vector<std::uint32_t> order_;  // of the triangles in the hierarchy's leaves
  core::Bvh bvh_;
  std::vector<core::Bounds> objects_;  // of each one's triangles
};

}  // namespace vantage::internal::scene
