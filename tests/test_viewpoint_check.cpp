// Viewpoints on surfaces and inside solids: open, closed, inside out, and those that only look like it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/viewpoint_check.h"
#include "support/mesh_reading.h"

namespace vantage::testing {
namespace {

/// A scene of one object per mesh that is added.
class Pieces {
 public:
  Pieces& add(const std::string& name, const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
    const auto first = static_cast<std::uint32_t>(scene_.mesh.vertices.size());
    scene_.mesh.vertices.insert(scene_.mesh.vertices.end(), vertices.begin(), vertices.end());
    for (const Triangle& t : triangles) {
      scene_.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      scene_.object_of.push_back(static_cast<std::uint32_t>(scene_.objects.size()));
    }
    scene_.objects.push_back({name});
    return *this;
  }

  /// A cube of 2 x 2 x 2 m at the origin; its first two triangles, which are the floor, may be left out.
  Pieces& add_cube(const std::string& name, bool has_floor = true, bool is_inside_out = false) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    std::vector<Triangle> faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    if (!has_floor) faces.erase(faces.begin(), faces.begin() + 2);
    if (is_inside_out) {
      for (Triangle& t : faces) std::swap(t[1], t[2]);
    }
    return add(name, corners, faces);
  }

  void expect_open(const Vec3& viewpoint) const {
    EXPECT_NO_THROW(scene::ViewpointCheck(scene_).check(viewpoint, "the viewpoint"));
  }
  void expect_refused(const Vec3& viewpoint, ErrorCode code, const std::string& object) const {
    expect_error([&] { scene::ViewpointCheck(scene_).check(viewpoint, "the viewpoint"); }, code, object);
  }

 private:
  Scene scene_;
};

TEST(ViewpointCheck, TellsInsideFromOutside) {
  const Pieces cube = Pieces().add_cube("Building17");
  cube.expect_refused({0, 0, 0}, ErrorCode::viewpoint_inside_solid, "Building17");
  cube.expect_refused({0.9, -0.9, 0.9}, ErrorCode::viewpoint_inside_solid, "Building17");
  for (const Vec3& outside : {Vec3(1.1, 0, 0), Vec3(-1.01, -1.01, -1.01), Vec3(0, 0, 1.01), Vec3(50, 2, 1)}) {
    cube.expect_open(outside);
  }
}

TEST(ViewpointCheck, KnowsSolidsTurnedInsideOut) {
  const Pieces cube = Pieces().add_cube("box", true, true);
  cube.expect_refused({0.2, 0.3, -0.4}, ErrorCode::viewpoint_inside_solid, "box");
  cube.expect_open({1.1, 0, 0});
}

TEST(ViewpointCheck, KnowsBuildingsWithoutFloor) {
  const Pieces building = Pieces().add_cube("hall", false);
  building.expect_refused({0, 0, -0.95}, ErrorCode::viewpoint_inside_solid, "hall");
  building.expect_open({0, 0, -1.05});
  building.expect_open({1.05, 0, -0.95});
}

TEST(ViewpointCheck, StandsOnOpenGroundAndInValleys) {
  // A funnel that opens upward: from its bottom it spans far more than half of all directions.
  Pieces valley;
  std::vector<Vec3> vertices = {{0, 0, 0}};
  std::vector<Triangle> triangles;
  constexpr std::uint32_t kSides = 16;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    vertices.emplace_back(10 * std::cos(angle), 10 * std::sin(angle), 20);
    triangles.push_back({0, 1 + i, 1 + (i + 1) % kSides});
  }
  valley.add("valley", vertices, triangles);
  valley.expect_open({0, 0, 1});
  valley.expect_open({0, 0, 19});
  valley.expect_open({0, 0, 30});
  // A cube on a ground: pieces are judged one by one.
  Pieces city;
  city.add("ground", {{-50, -50, -1.5}, {50, -50, -1.5}, {50, 50, -1.5}, {-50, 50, -1.5}}, {{0, 1, 2}, {0, 2, 3}});
  city.add_cube("block");
  city.expect_open({3, 0, -1});
  city.expect_open({3, 0, -1.4});
  city.expect_refused({0.5, 0.5, -0.5}, ErrorCode::viewpoint_inside_solid, "block");
}

TEST(ViewpointCheck, RefusesSurfaces) {
  const Pieces cube = Pieces().add_cube("block");
  cube.expect_refused({1, 0.3, 0.2}, ErrorCode::viewpoint_on_surface, "block");
  cube.expect_refused({1.0005, 0.3, 0.2}, ErrorCode::viewpoint_on_surface, "block");
  cube.expect_refused({1, 1, 1}, ErrorCode::viewpoint_on_surface, "block");         // a corner
  cube.expect_refused({1, 1.0009, 0.4}, ErrorCode::viewpoint_on_surface, "block");  // beside an edge
  cube.expect_open({1.002, 0.3, 0.2});
  cube.expect_open({1.001, 1.001, 0.4});
  // In the plane of a face, beside it.
  cube.expect_open({1, 1.5, 0});
}

TEST(ViewpointCheck, BearsDegenerateTriangles) {
  Pieces needle;
  needle.add("needle", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}}, {{0, 1, 2}, {3, 3, 3}});
  needle.expect_refused({0.5, 0, 0}, ErrorCode::viewpoint_on_surface, "needle");
  needle.expect_refused({5, 5, 5}, ErrorCode::viewpoint_on_surface, "needle");
  needle.expect_open({0.5, 0.01, 0});
  needle.expect_open({-1, 0, 0});
}

}  // namespace
}  // namespace vantage::testing
