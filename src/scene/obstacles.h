// What clearance is kept from.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/scene.h"

namespace vantage::internal::scene {

/// The mesh of obstacles_of, and whose each triangle is: an index into Scene::objects, or behind these into
/// Scene::overhead.
struct Obstacles {
  Mesh mesh;
  std::vector<std::uint32_t> object_of;
};
Obstacles obstacles_in(const Scene& scene, const std::vector<std::uint32_t>& ground);

/// A scene of the lines overhead, an object each.
Scene overhead_alone(const Scene& scene);

}  // namespace vantage::internal::scene
