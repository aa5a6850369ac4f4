// What tests of the clearance share: scenes of obstacles, and distances by brute force.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/random.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/scene.h"

namespace vantage::testing {

/// How far the polytope about a grown polygon reaches too far: beside edges, and round corners.
inline constexpr double kBesideEdges = 0.083, kRoundCorners = 0.16;

/// To a triangle, by its barycentric coordinates: of all points of a corner, a side or the plane.
inline double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_side = [&](const Vec3& from, const Vec3& to) {
    const double length = (to - from).squaredNorm();
    const double t = length > 0 ? std::clamp((p - from).dot(to - from) / length, 0.0, 1.0) : 0;
    return (p - from - t * (to - from)).norm();
  };
  double nearest = std::min({to_side(a, b), to_side(b, c), to_side(c, a)});
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Vector2d at = sides.colPivHouseholderQr().solve(p - a);
  if (at.minCoeff() >= 0 && at.sum() <= 1) nearest = std::min(nearest, (sides * at - (p - a)).norm());
  return nearest;
}

inline double distance(const Vec3& p, const Mesh& mesh) {
  double nearest = INFINITY;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    if ((p - a).norm() - std::max((b - a).norm(), (c - a).norm()) > nearest) continue;
    nearest = std::min(nearest, distance(p, a, b, c));
  }
  return nearest;
}

inline double distance_to_polygon(const Vec3& p, const std::vector<Vec3>& corners) {
  double nearest = INFINITY;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    nearest = std::min(nearest, distance(p, corners[0], corners[i], corners[(i + 1) % corners.size()]));
  }
  return nearest;
}

/// Houses, a wall that is open, a wire, over ground that does not count.
inline Scene make_town(Random& random, double scale, const Vec3& origin) {
  Scene scene;
  scene.objects = {{"ground", "", ObjectKind::ground}, {"town", "", ObjectKind::other}};
  const auto add = [&](const std::vector<Vec3>& corners, std::uint32_t object) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const Vec3& corner : corners) scene.mesh.vertices.push_back(origin + scale * corner);
    for (std::uint32_t i = 2; i < corners.size(); ++i) {
      scene.mesh.triangles.push_back({first, first + i - 1, first + i});
      scene.object_of.push_back(object);
    }
  };
  add({{-60, -60, -1}, {60, -60, -1}, {60, 60, -1}, {-60, 60, -1}}, 0);
  for (int house = 0; house < 6; ++house) {
    const double x = random.uniform(-40, 40), y = random.uniform(-40, 40), z = random.uniform(4, 20);
    const double w = random.uniform(2, 8), d = random.uniform(2, 8);
    add({{x, y, z}, {x + w, y, z}, {x + w, y + d, z}, {x, y + d, z}}, 1);
    add({{x, y, 0}, {x + w, y, 0}, {x + w, y, z}, {x, y, z}}, 1);
    add({{x + w, y, 0}, {x + w, y + d, 0}, {x + w, y + d, z}, {x + w, y, z}}, 1);
    add({{x, y, 0}, {x, y + d, 0}, {x, y + d, z}, {x, y, z}}, 1);
  }
  add({{-30, 0, 15}, {30, 10, 22}, {30, 10, 22}}, 1);
  for (int i = 0; i < 4; ++i) {
    const Vec3 at = random.in_box({Vec3(-40, -40, 5), Vec3(40, 40, 30)});
    add({at, at + random.point(-6, 6), at + random.point(-6, 6)}, 1);
  }
  return scene;
}

struct Case {
  double scale;
  Vec3 origin;
};
inline const std::vector<Case> kCases = {
    {1, Vec3(0, 0, 0)}, {1, Vec3(580000.1, 4785000.2, 1000.3)}, {1e-4, Vec3(0, 0, 0)}, {100, Vec3(-3000, 500, 80)}};

inline Navigation keeping(const Scene& scene, double distance_m) {
  Navigation navigation;
  navigation.clearance = {distance_m, obstacles_of(scene)};
  return navigation;
}

}  // namespace vantage::testing
