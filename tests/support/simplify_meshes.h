// Volumes to simplify, and how flat their surfaces are folded.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "support/random.h"
#include "support/solids.h"
#include "vantage/geometry.h"

namespace vantage::testing {

/// A dome with deep and narrow notches, as visibility volumes have them.
inline Mesh spiky_dome(Random& random, int sectors, int rings, const Vec3& origin = Vec3::Zero(), double size = 1) {
  std::vector<double> radii;
  for (int i = 0; i <= sectors * rings; ++i) radii.push_back(random.chance(0.3) ? random.uniform(0.1, 0.9) : 1.0);
  std::size_t next = 0;
  return make_dome(origin, sectors, rings, [&](double, double) { return size * radii[next++]; }).mesh;
}

/// Of facets that share an edge and lie over each other: how near the tip of one comes to the plane of the other.
inline double narrowest_fold(const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    for (const Triangle& u : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) {
          if (t[k] != u[(j + 1) % 3] || t[(k + 1) % 3] != u[j]) continue;
          const Vec3 &from = mesh.vertices[t[k]], &to = mesh.vertices[u[j]];
          const Vec3 of_t = mesh.vertices[t[(k + 2) % 3]] - from, of_u = mesh.vertices[u[(j + 2) % 3]] - from;
          const Vec3 normal_t = (to - from).cross(of_t), normal_u = (to - from).cross(of_u);
          if (normal_t.dot(normal_u) <= 0) continue;
          least = std::min(
              least, std::min(std::abs(normal_t.normalized().dot(of_u)), std::abs(normal_u.normalized().dot(of_t))));
        }
      }
    }
  }
  return least;
}

}  // namespace vantage::testing
