// The scene without its ground, and with what hangs over it: how far it is, and what of it is nearest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/triangle_tree.h"
#include "vantage/geometry.h"
#include "vantage/ground.h"
#include "vantage/mission.h"

namespace vantage::internal::flight {

/// The objects that the mission calls its ground.
std::vector<std::uint32_t> named_ground(const Mission& mission);

/// What heights of the mission are above; nothing where the scene does not say what of it is ground.
std::optional<Ground> ground_if_known(const Mission& mission);

class Obstacles {
 public:
  /// Cost: O(n log n) in the triangles. Copies them, about an origin in their middle.
  explicit Obstacles(const Mission& mission);
  Obstacles(const Obstacles&) = delete;
  Obstacles& operator=(const Obstacles&) = delete;

  bool empty() const { return mesh_.empty(); }
  /// Metres; scene frame. Not of none.
  double distance_m(const Vec3& point) const { return tree_.distance(point - origin_); }
  struct Nearest {
    double distance_m;
    std::string name;  ///< display_name
  };
  Nearest nearest(const Vec3& point) const;

 private:
  Obstacles(const Scene& scene, const std::vector<std::uint32_t>& ground);

  Vec3 origin_ = Vec3::Zero();
  std::vector<std::uint32_t> object_of_;
  std::vector<std::string> names_;  ///< of all objects, and of what is overhead
  Mesh mesh_;
  core::TriangleTree tree_;
};

}  // namespace vantage::internal::flight
