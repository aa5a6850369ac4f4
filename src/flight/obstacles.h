// The scene without its ground: how far it is, and what of it is nearest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/triangle_tree.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"

namespace vantage::internal::flight {

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
  Vec3 origin_ = Vec3::Zero();
  std::vector<std::uint32_t> object_of_;
  std::vector<std::string> names_;  ///< of all objects
  Mesh mesh_;
  core::TriangleTree tree_;
};

}  // namespace vantage::internal::flight
