#include "maps/city/tree.h"

#include <array>
#include <cmath>
#include <numbers>

#include "maps/city/occluders.h"

namespace vantage::internal::city {
namespace {

constexpr std::uint32_t kSides = 8;

struct Girdle {
  double radius, z;
};

/// Rings one above the other, shut below by a disc and above by a tip.
Mesh revolved(const Vec2& centre, const std::vector<Girdle>& girdles, double tip_z) {
  Mesh mesh;
  for (const Girdle& girdle : girdles) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      mesh.vertices.emplace_back(centre.x() + girdle.radius * std::cos(angle),
                                 centre.y() + girdle.radius * std::sin(angle), girdle.z);
    }
  }
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(centre.x(), centre.y(), tip_z);
  for (std::uint32_t k = 1; k + 1 < kSides; ++k) mesh.triangles.push_back({0, k + 1, k});
  for (std::uint32_t below = 0; below < tip; below += kSides) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = below + k, b = below + (k + 1) % kSides;
      if (below + kSides == tip) {
        mesh.triangles.push_back({a, b, tip});
      } else {
        mesh.triangles.push_back({a, b, b + kSides});
        mesh.triangles.push_back({a, b + kSides, a + kSides});
      }
    }
  }
  return mesh;
}

}  // namespace

Mesh tree_mesh(const Tree& tree, double ground_m) {
  const double height = tree.top_m - tree.bottom_m, base = height * tree.crown_base_share, crown = height - base;
  const double bottom = ground_m + tree.bottom_m, trunk = tree.trunk_m / 2, radius = tree.crown_m / 2;
  std::vector<Girdle> girdles = {{trunk, bottom}, {trunk, bottom + base}};
  if (tree.needles) {
    girdles.push_back({radius, bottom + base + 0.05 * crown});
  } else {
    // Radius and height of an egg's girdles, of the crown's own.
    static constexpr std::array<Girdle, 4> egg = {{{0.75, 0.12}, {1, 0.4}, {0.85, 0.7}, {0.45, 0.93}}};
    for (const Girdle& girdle : egg) girdles.push_back({radius * girdle.radius, bottom + base + crown * girdle.z});
  }
  return revolved(tree.foot, girdles, ground_m + tree.top_m);
}

}  // namespace vantage::internal::city
