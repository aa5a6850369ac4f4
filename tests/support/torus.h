// A mesh with a hole.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "vantage/geometry.h"

namespace vantage::testing {

/// About the axis through `centre` along z: a tube of radius `tube` about a circle of radius `ring`. `around` corners
/// on the circle, `across` on the tube.
inline Mesh make_torus(const Vec3& centre, double ring, double tube, std::uint32_t around, std::uint32_t across) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (std::uint32_t j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across, r = ring + tube * std::cos(v);
      mesh.vertices.push_back(centre + Vec3(r * std::cos(u), r * std::sin(u), tube * std::sin(v)));
    }
  }
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t a = i * across, b = (i + 1) % around * across;
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t k = (j + 1) % across;
      mesh.triangles.push_back({a + j, b + j, b + k});
      mesh.triangles.push_back({a + j, b + k, a + k});
    }
  }
  return mesh;
}

}  // namespace vantage::testing
