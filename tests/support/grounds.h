// Grounds made by hand, and their heights by brute force.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "support/random.h"
#include "vantage/volume.h"

namespace vantage::testing {

/// Hills over [-extent, extent]^2: a grid with its posts moved aside, two triangles for each cell.
inline Mesh make_hills(Random& random, double extent, double height, int cells, const Vec3& origin) {
  Mesh mesh;
  const double cell = 2 * extent / cells;
  for (int row = 0; row <= cells; ++row) {
    for (int column = 0; column <= cells; ++column) {
      const bool is_inside = row > 0 && column > 0 && row < cells && column < cells;
      const double aside = is_inside ? random.uniform(-0.3, 0.3) * cell : 0;
      const double along = is_inside ? random.uniform(-0.3, 0.3) * cell : 0;
      mesh.vertices.push_back(
          origin + Vec3(column * cell - extent + aside, row * cell - extent + along, random.uniform(-height, height)));
    }
  }
  const auto post = [&](int row, int column) { return static_cast<std::uint32_t>(row * (cells + 1) + column); };
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      mesh.triangles.push_back({post(row, column), post(row, column + 1), post(row + 1, column + 1)});
      // Soups have triangles of either turn.
      const bool faces_up = random.chance(0.5);
      const Triangle other{post(row, column), post(row + 1, column + 1), post(row + 1, column)};
      mesh.triangles.push_back(faces_up ? other : Triangle{other[0], other[2], other[1]});
    }
  }
  return mesh;
}

struct Heights {
  bool any = false;
  double lowest = INFINITY, highest = -INFINITY;
};

/// Of all triangles that a vertical line meets, in long double.
inline Heights heights_at(const Mesh& mesh, const Vec3& p) {
  Heights heights;
  for (const Triangle& t : mesh.triangles) {
    long double weight[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.vertices[t[(k + 1) % 3]], &b = mesh.vertices[t[(k + 2) % 3]];
      weight[k] = (static_cast<long double>(b.x()) - a.x()) * (static_cast<long double>(p.y()) - a.y()) -
                  (static_cast<long double>(b.y()) - a.y()) * (static_cast<long double>(p.x()) - a.x());
    }
    const long double sum = weight[0] + weight[1] + weight[2];
    if (sum == 0 || weight[0] / sum < 0 || weight[1] / sum < 0 || weight[2] / sum < 0) continue;
    long double z = 0;
    for (std::size_t k = 0; k < 3; ++k) z += weight[k] / sum * mesh.vertices[t[k]].z();
    heights.any = true;
    heights.lowest = std::min(heights.lowest, static_cast<double>(z));
    heights.highest = std::max(heights.highest, static_cast<double>(z));
  }
  return heights;
}

inline Navigation above(Mesh ground, double min_m, double max_m) {
  Navigation navigation;
  navigation.above_ground = {min_m, max_m, Ground{0, std::make_shared<const Mesh>(std::move(ground))}};
  return navigation;
}

/// By how much a point keeps the limit: negative where it breaks it, metres along z.
inline double slack(const AboveGround& limit, const Vec3& p) {
  const Heights heights = heights_at(*limit.ground.surface, p);
  if (!heights.any) return -INFINITY;
  return std::min(p.z() - heights.highest - limit.min_m, heights.lowest + limit.max_m - p.z());
}

struct GroundCase {
  double scale;
  Vec3 origin;
};
inline const std::vector<GroundCase> kGroundCases = {
    {1, Vec3(0, 0, 0)}, {1, Vec3(580000.1, 4785000.2, 1000.3)}, {1e-4, Vec3(0, 0, 0)}, {100, Vec3(-3000, 500, 80)}};

/// Of the facets that bound the volume where the ground ends, but are not at the border of [-extent, extent]^2.
inline int walls_inside(const Volume& cut, const Vec3& origin, double extent) {
  int count = 0;
  for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = cut.mesh.triangles[t];
    const Vec3 middle = (cut.mesh.vertices[a] + cut.mesh.vertices[b] + cut.mesh.vertices[c]) / 3 - origin;
    count +=
        cut.causes[cut.cause_of[t]].name == "ground edge" && middle.head<2>().cwiseAbs().maxCoeff() < 0.999 * extent;
  }
  return count;
}

}  // namespace vantage::testing
