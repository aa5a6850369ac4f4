// Scenes made by hand for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/solids.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage::testing {

/// Adds named objects one after another.
class SceneBuilder {
 public:
  SceneBuilder& add(const std::string& name, const Mesh& mesh) {
    append(scene_.mesh, mesh);
    scene_.object_of.insert(scene_.object_of.end(), mesh.triangles.size(),
                            static_cast<std::uint32_t>(scene_.objects.size()));
    scene_.objects.push_back({name});
    return *this;
  }
  SceneBuilder& box(const std::string& name, const Vec3& min, const Vec3& max) {
    return add(name, make_box_mesh(min, max));
  }
  /// A convex polygon as a fan of triangles.
  SceneBuilder& polygon(const std::string& name, const std::vector<Vec3>& corners) {
    Mesh mesh;
    mesh.vertices = corners;
    for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) mesh.triangles.push_back({0, i, i + 1});
    return add(name, mesh);
  }
  /// Two triangles in a horizontal plane.
  SceneBuilder& ground(const std::string& name, double half_width, double z = 0) {
    const double w = half_width;
    return polygon(name, {{-w, -w, z}, {w, -w, z}, {w, w, z}, {-w, w, z}});
  }

  operator const Scene&() const { return scene_; }  // NOLINT(google-explicit-constructor): so that it reads as a scene
  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
};

inline Target target_of(std::vector<Vec3> vertices) {
  Target target;
  target.parts[0] = std::move(vertices);
  return target;
}

/// `corners` points on a circle, at irregular angles that increase; the first three are spread so that any of them is a
/// target. In the plane through `centre`, counter-clockwise seen from `normal`.
inline Target random_target(Random& random, int corners, double radius, const Vec3& centre, const Vec3& normal) {
  const Vec3 n = normal.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  const double start = random.uniform(0, 2 * std::numbers::pi), step = 2 * std::numbers::pi / corners;
  Target target;
  for (int k = 0; k < corners; ++k) {
    const double angle = start + step * (k + random.uniform(-0.3, 0.3));
    target.parts[0].push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return target;
}

/// Blocks on a ground of half width 100 about the origin, none nearer than `clearing` to it: some share walls, some
/// overlap, some stand on others, some lack a floor; triangles in either turn. Corners on a grid of half a metre.
inline Scene random_city(Random& random, int blocks, double clearing) {
  SceneBuilder builder;
  builder.ground("ground", 100);
  const auto grid = [&](double low, double high) { return std::round(2 * random.uniform(low, high)) / 2; };
  Vec3 previous_min = Vec3::Zero(), previous_max = Vec3::Zero();
  for (int made = 0; made < blocks;) {
    Vec3 min(grid(-90, 80), grid(-90, 80), 0), size(grid(1, 20), grid(1, 20), grid(2, 40));
    const int kind = made == 0 ? 0 : random.integer(0, 4);
    if (kind == 1) min = {previous_max.x(), previous_min.y(), 0};                         // wall to wall
    if (kind == 2) min = {previous_min.x() + 1, previous_min.y() + 1, previous_max.z()};  // on the roof
    const Vec3 max = min + size;
    const Vec3 nearest = Vec3::Zero().cwiseMax(min).cwiseMin(max);
    if (nearest.head<2>().norm() < clearing || max.head<2>().cwiseAbs().maxCoeff() > 100) {
      if (kind != 0) previous_min = previous_max = Vec3(-90, -90, 0);
      continue;
    }
    Mesh mesh = make_box_mesh(min, max);
    if (random.chance(0.3)) mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
    for (Triangle& t : mesh.triangles)
      if (random.chance(0.2)) std::swap(t[0], t[1]);
    builder.add("block " + std::to_string(made++), mesh);
    previous_min = min;
    previous_max = max;
  }
  return builder;
}

}  // namespace vantage::testing
