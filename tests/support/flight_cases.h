// Missions made in memory, for tests of flights.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/triangle_distance.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage::testing {

inline Mission mission_in(Scene scene, Target target, double range_m) {
  Mission mission;
  auto loaded = std::make_shared<LoadedScene>();
  loaded->scene = std::move(scene);
  mission.loaded = std::move(loaded);
  mission.target = std::move(target);
  mission.sensor.max_range_m = range_m;
  mission.as_written.exact.tolerance_m = 0.2;  // few facets: the tests look at all of them
  return mission;
}

/// A square of 4 m about `centre`, facing up, and a far away block: positions within the range see the square.
inline Mission open_square(const Vec3& centre, double range_m) {
  SceneBuilder builder;
  builder.box("far block", centre + Vec3(3 * range_m, -5, 0), centre + Vec3(3 * range_m + 10, 5, 10));
  Target target;
  for (const auto& [x, y] : {std::pair(-2, -2), {2, -2}, {2, 2}, {-2, 2}}) {
    target.parts[0].push_back(centre + Vec3(x, y, 0));
  }
  return mission_in(builder, target, range_m);
}

/// A mission with its volume, ready to be asked.
struct FlightCase {
  explicit FlightCase(Mission of)
      : mission(std::move(of)), scene(mission.scene()), volume(run_mission(mission).volume) {}

  Mission mission;
  PreparedScene scene;
  Volume volume;

  std::vector<PointAnswer> ask(const std::vector<Vec3>& points) const {
    return ViewsQuery(prepare_views(mission, scene), mission.navigation).answer(points);
  }
};

/// By all triangles, one after another.
inline double plain_distance(const Mesh& mesh, const Vec3& p) {
  double squared = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    squared = std::min(squared, internal::core::squared_distance_to_triangle(p, a, b, c));
  }
  return std::sqrt(squared);
}

inline double plain_depth(const Mesh& mesh, const Vec3& p) {
  return holds(mesh, p) ? plain_distance(mesh, p) : -plain_distance(mesh, p);
}

}  // namespace vantage::testing
