// Roofs and facades of the objects of a scene: which there are, that they are whole, and that nothing lies on them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/target.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::make_box_mesh;
using testing::Random;
using testing::SceneBuilder;

const std::vector<std::uint32_t> kFirst = {0};

std::vector<Face> faces_of(const Scene& scene, FaceKind kind, std::uint32_t object = 0) {
  return FaceFinder(scene).faces(std::vector{object}, kind);
}

double area_of(const std::vector<Face>& faces) {
  double area = 0;
  for (const Face& face : faces) area += face.area_m2;
  return area;
}

/// Whether a point lies in a face, to `slack` metres.
bool holds(const Face& face, const Vec3& point, double slack) {
  return std::any_of(face.parts.begin(), face.parts.end(), [&](const std::vector<Vec3>& part) {
    if (std::abs(face.normal.dot(point - part[0])) > slack) return false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Vec3 side = part[(i + 1) % part.size()] - part[i];
      if (face.normal.cross(side).normalized().dot(point - part[i]) < -slack) return false;
    }
    return true;
  });
}

bool any_holds(const std::vector<Face>& faces, const Vec3& point, double slack) {
  return std::any_of(faces.begin(), faces.end(), [&](const Face& face) { return holds(face, point, slack); });
}

/// A closed prism over an outline that runs counter-clockwise; its caps are fans from the first corner, which must see
/// the others.
Mesh prism(const std::vector<Eigen::Vector2d>& outline, double low, double high) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {low, high}) {
    for (const auto& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({n, n + i, n + next});
  }
  return mesh;
}

const Sensor kSensor = Sensor{60};

/// Computes the volume of a face, and expects that the check finds nothing wrong with it.
Volume expect_right(const Scene& scene, const Target& target, double range = 60) {
  const PreparedTarget prepared(PreparedScene(scene), target, Sensor{range});
  Volume volume = compute_volume(prepared);
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  if (volume.mesh.empty()) return volume;
  VerifyOptions options;
  options.points = 2000;
  options.lift_m = volume.lift_m;
  const VerifyReport report = verify_volume(scene, target, Sensor{range}, {}, volume.mesh, options);
  EXPECT_TRUE(report.is_right()) << report.worst_over_depth_m << " m at " << report.worst_over_point.transpose() << ": "
                                 << report.worst_over_cause;
  // Where a wall stands in the plane of an edge what a viewpoint just behind it does not see falls between the samples.
  EXPECT_LE(report.worst_under_depth_m, 1e-4) << report.worst_under_point.transpose();
  return volume;
}

TEST(Faces, OfABlockAreItsSides) {
  const Scene scene = SceneBuilder().box("block", {1.1, 2.2, 0}, {11.3, 8.4, 12.5});
  const std::vector<Face> roofs = faces_of(scene, FaceKind::roof), walls = faces_of(scene, FaceKind::facade);
  ASSERT_EQ(roofs.size(), 1U);
  EXPECT_EQ(roofs[0].normal, Vec3::UnitZ());
  ASSERT_EQ(roofs[0].parts.size(), 1U);
  ASSERT_EQ(roofs[0].parts[0].size(), 4U);
  for (const Vec3& corner : roofs[0].parts[0]) {
    EXPECT_TRUE((corner.x() == 1.1 || corner.x() == 11.3) && (corner.y() == 2.2 || corner.y() == 8.4)) << "every bit";
    EXPECT_EQ(corner.z(), 12.5);
  }
  ASSERT_EQ(walls.size(), 4U);
  EXPECT_NEAR(area_of(walls), 2 * 12.5 * (10.2 + 6.2), 1e-9);
  const std::vector<std::pair<double, Vec3>> directions = {
      {0, Vec3::UnitY()}, {90, Vec3::UnitX()}, {180, -Vec3::UnitY()}, {-90, -Vec3::UnitX()}, {270, -Vec3::UnitX()}};
  for (const auto& [heading, normal] : directions) {
    const std::vector<Face> chosen = facing(walls, heading);
    ASSERT_EQ(chosen.size(), 1U) << heading;
    EXPECT_TRUE(chosen[0].normal.isApprox(normal)) << heading;
  }
  EXPECT_EQ(facing(walls, 45).size(), 2U) << "45 degrees to either side belong to it";
  EXPECT_EQ(facing(walls, 44.9).size(), 1U);
  EXPECT_TRUE(facing(roofs, 0).empty()) << "a level roof points nowhere";
}

TEST(Faces, DoNotDependOnHowTrianglesAreTurned) {
  Random random(101);
  const Mesh box = make_box_mesh({0, 0, 0}, {9, 7, 8});
  for (int round = 0; round < 20; ++round) {
    Mesh mesh = box;
    if (random.chance(0.5)) mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);  // the floor
    for (Triangle& t : mesh.triangles) {
      if (random.chance(0.5)) std::swap(t[0], t[1]);
    }
    const Scene scene = SceneBuilder().add("block", mesh);
    const std::vector<Face> walls = faces_of(scene, FaceKind::facade);
    ASSERT_EQ(walls.size(), 4U);
    for (const Face& wall : walls) {
      EXPECT_GT(wall.normal.dot(wall.parts[0][0] - Vec3(4.5, 3.5, 4)), 0) << "out of the block";
      EXPECT_GT(make_target_frame(target_of(std::vector{wall}, "wall")).normal.dot(wall.normal), 0.999);
    }
    EXPECT_EQ(faces_of(scene, FaceKind::roof).size(), 1U) << "a floor is no roof";
  }
}

TEST(Faces, NotConvexOnesAreInPartsOfOnePlane) {
  // An L, whose first corner sees all others.
  const Mesh mesh = prism({{0, 0}, {0, -10}, {20, -10}, {20, 0}, {0, 0.5}, {0, 15}, {-8, 15}, {-8, 0}}, 0, 9.25);
  const Scene scene = SceneBuilder().add("hall", mesh);
  const std::vector<Face> roofs = faces_of(scene, FaceKind::roof);
  ASSERT_EQ(roofs.size(), 1U);
  EXPECT_GT(roofs[0].parts.size(), 1U);
  double area = 0;
  const Target target = target_of(roofs, "roof");
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    for (const Vec3& corner : target.parts[i]) EXPECT_EQ(corner.z(), 9.25);
    const TargetFrame frame = make_target_frame(target, i);  // throws unless convex
    for (std::size_t k = 0; k < frame.polygon.size(); ++k) {
      const auto &a = frame.polygon[k], &b = frame.polygon[(k + 1) % frame.polygon.size()];
      area += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
  }
  EXPECT_NEAR(area, roofs[0].area_m2, 1e-9);
  EXPECT_NEAR(area, 20 * 10 + 8 * 15 + 20 * 0.5 / 2, 1e-9);
  expect_right(scene, target);
}

TEST(Faces, OfAGableRoofAreBothSlopes) {
  Mesh mesh = make_box_mesh({0, 0, 0}, {10, 8, 6});
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the top
  const auto ridge = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 4, 9);
  mesh.vertices.emplace_back(10, 4, 9);
  for (const Triangle& t : {Triangle{4, 5, ridge + 1},
                            {4, ridge + 1, ridge},
                            {7, 6, ridge},
                            {7, ridge, ridge + 1},
                            {4, ridge, 6},
                            {5, 7, ridge + 1}}) {
    mesh.triangles.push_back(t);
  }
  const Scene scene = SceneBuilder().add("house", mesh);
  const std::vector<Face> slopes = faces_of(scene, FaceKind::roof);
  ASSERT_EQ(slopes.size(), 2U);
  EXPECT_EQ(facing(slopes, 180).size(), 1U);
  EXPECT_EQ(faces_of(scene, FaceKind::facade).size(), 4U) << "gables belong to the walls below them";
  const Target both = target_of(slopes, "roof");
  EXPECT_EQ(both.parts.size(), 2U);
  const Volume volume = expect_right(scene, both);
  for (const Vec3& vertex : volume.mesh.vertices) EXPECT_GT(vertex.z(), 8.9) << "both slopes are seen from above only";
}

TEST(Faces, OfTwoDirectionsAreSeenTogether) {
  const Scene scene = SceneBuilder().ground("ground", 100).box("block", {0, 0, 0}, {10, 10, 12});
  const std::vector<Face> walls = faces_of(scene, FaceKind::facade, 1);
  std::vector<Face> chosen = facing(walls, 180);
  const std::vector<Face> east = facing(walls, 90);
  chosen.insert(chosen.end(), east.begin(), east.end());
  const Target target = target_of(chosen, "corner");
  const Volume volume = expect_right(scene, target);
  for (const Vec3& vertex : volume.mesh.vertices) {
    EXPECT_GT(vertex.x(), 9.99);
    EXPECT_LT(vertex.y(), 0.01);
  }
}

TEST(Faces, NeighboursCoverPartyWalls) {
  SceneBuilder builder;
  builder.ground("ground", 100).box("town hall", {0, 0, 0}, {10, 10, 12});
  builder.box("low", {10, 2, 0}, {16, 10, 5}).box("high", {-7, 0, 0}, {0, 10, 20}).box("hut", {0, 8, 12}, {2, 10, 14});
  const Scene& scene = builder.scene();
  const FaceFinder finder(scene);
  const std::vector<Face> walls = finder.faces(std::vector<std::uint32_t>{1}, FaceKind::facade);
  EXPECT_TRUE(facing(walls, 270).empty()) << "all of it is covered";
  const std::vector<Face> east = facing(walls, 90);
  ASSERT_EQ(east.size(), 1U);
  EXPECT_NEAR(east[0].area_m2, 10 * 12 - 8 * 5, 1e-9);
  EXPECT_FALSE(holds(east[0], {10, 5, 2}, 1e-9));
  EXPECT_TRUE(holds(east[0], {10, 1, 2}, 1e-9));
  EXPECT_TRUE(holds(east[0], {10, 5, 5.001}, 1e-9));
  const std::vector<Face> roof = finder.faces(std::vector<std::uint32_t>{1}, FaceKind::roof);
  ASSERT_EQ(roof.size(), 1U);
  EXPECT_NEAR(roof[0].area_m2, 100 - 4, 1e-9) << "but for what the hut stands on";
  expect_right(scene, target_of(east, "east"));
  expect_right(scene, target_of(roof, "roof"));
  // What covers nearly all of a wall leaves two pieces, each a face.
  builder.box("slab", {2, 10, 0}, {8, 14, 12});
  const std::vector<Face> north = facing(faces_of(builder, FaceKind::facade, 1), 0);
  ASSERT_EQ(north.size(), 2U);
  EXPECT_NEAR(area_of(north), 2 * 2 * 12, 1e-9);
}

TEST(Faces, NothingIsRightInFrontOfThem) {
  // A wall that leans over the facade from its foot, at 60 degrees, and one that ends 2 mm in front of it.
  SceneBuilder builder;
  builder.box("block", {0, 0, 0}, {10, 10, 12});
  builder.polygon("leaning", {{2, 0, 0}, {8, 0, 0}, {8, -4 / std::tan(1.0472), 4}, {2, -4 / std::tan(1.0472), 4}});
  builder.box("close", {12, 0, 0}, {14, 10, 12});
  builder.box("near", {10.002, 3, 0}, {11, 7, 12});
  const Scene& scene = builder.scene();
  const std::vector<Face> walls = faces_of(scene, FaceKind::facade);
  const std::vector<Face> south = facing(walls, 180);
  ASSERT_EQ(south.size(), 1U);
  EXPECT_NEAR(south[0].area_m2, 120 - 6 * 3e-3 * std::tan(1.0472), 1e-4) << "a strip of 5 mm along the slope's foot";
  const std::vector<Face> east = facing(walls, 90);
  ASSERT_EQ(east.size(), 2U);
  EXPECT_NEAR(area_of(east), 6 * 12, 1e-9);
  for (const Face& face : walls) {
    const Target target = target_of(std::vector{face}, "wall");
    EXPECT_NO_THROW(PreparedTarget(PreparedScene(scene), target, kSensor));
  }
}

TEST(Faces, EndWhereTheGroundBegins) {
  SceneBuilder builder;
  builder.box("block", {0, 0, -5}, {10, 10, 12});
  // Rises to the east by 30 cm in a metre, in two slopes.
  builder.polygon("ground", {{-50, -50, -15}, {4, -50, 1.2}, {4, 50, 1.2}, {-50, 50, -15}});
  builder.polygon("ground", {{4, -50, 1.2}, {60, -50, 18}, {60, 50, 18}, {4, 50, 1.2}});
  Scene scene = builder;
  for (std::size_t i = 1; i < 3; ++i) scene.objects[i].kind = ObjectKind::ground;
  const std::vector<Face> south = facing(faces_of(scene, FaceKind::facade), 180);
  ASSERT_EQ(south.size(), 1U);
  EXPECT_NEAR(south[0].area_m2, 120 - 10 * 3.0 / 2, 1e-6);
  EXPECT_FALSE(holds(south[0], {9, 0, 2.6}, 1e-9));
  EXPECT_TRUE(holds(south[0], {9, 0, 2.71}, 1e-9));
  expect_right(scene, target_of(south, "south"));
}

TEST(Faces, TheNearestIsOneOfAll) {
  Random random(7);
  const Scene scene = testing::random_city(random, 12, 5);
  const FaceFinder finder(scene);
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t i = 1; i < scene.objects.size(); ++i) blocks.push_back(i);
  const auto distance_of = [](const Face& face, const Vec3& point) {
    double least = INFINITY;
    for (const std::vector<Vec3>& part : face.parts) {
      Mesh mesh;
      mesh.vertices = part;
      // A fine net of the part is as near as the part, to its width.
      for (std::size_t i = 1; i + 1 < part.size(); ++i) {
        for (int u = 0; u <= 40; ++u) {
          for (int v = 0; u + v <= 40; ++v) {
            const Vec3 at = part[0] + (part[i] - part[0]) * (u / 40.0) + (part[i + 1] - part[0]) * (v / 40.0);
            least = std::min(least, (at - point).norm());
          }
        }
      }
    }
    return least;
  };
  for (const FaceKind kind : {FaceKind::roof, FaceKind::facade}) {
    const std::vector<Face> all = finder.faces(blocks, kind);
    ASSERT_FALSE(all.empty());
    for (int i = 0; i < 20; ++i) {
      const double x = random.uniform(-90, 90), y = random.uniform(-90, 90);
      const Vec3 point(x, y, random.uniform(0, 40));
      const auto nearest = finder.nearest(blocks, kind, point);
      ASSERT_TRUE(nearest);
      const double distance = distance_of(*nearest, point);
      for (const Face& face : all) EXPECT_GE(distance_of(face, point), distance - 1.5) << point.transpose();
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Face& face) { return face.parts == nearest->parts; }));
    }
  }
}

/// Whether a place is in a box, or on it where `margin` is 0.
bool is_in(const Box& box, const Vec3& place, double margin) {
  return ((place - box.min).array() > margin).all() && ((box.max - place).array() > margin).all();
}

/// Whatever is free of a block's surface, by its corners alone, is in a face; and nothing lies on a face.
TEST(Faces, HoldAllThatIsFree) {
  Random random(20261122);
  for (int round = 0; round < 12; ++round) {
    const Scene scene = testing::random_city(random, 10, 5);
    std::vector<Box> boxes(scene.objects.size());
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : scene.mesh.triangles[t]) boxes[scene.object_of[t]].extend(scene.mesh.vertices[v]);
    }
    const FaceFinder finder(scene);
    const PreparedScene prepared(scene);
    for (std::uint32_t object = 1; object < boxes.size(); ++object) {
      const Box& box = boxes[object];
      const std::vector<Face> roofs = finder.faces(std::vector{object}, FaceKind::roof);
      const std::vector<Face> walls = finder.faces(std::vector{object}, FaceKind::facade);
      for (const Face& face : walls) {
        EXPECT_NO_THROW(PreparedTarget(prepared, target_of(std::vector{face}, "wall"), kSensor)) << object;
      }
      for (int i = 0; i < 60; ++i) {
        Vec3 at = random.in_box(box);
        const int side = random.integer(0, 4);
        const int axis = side == 4 ? 2 : side / 2;
        at[axis] = side == 4 || side % 2 == 1 ? box.max[axis] : box.min[axis];
        Vec3 out = Vec3::Zero();
        out[axis] = side == 4 || side % 2 == 1 ? 1 : -1;
        const Vec3 before = at + 0.3 * out;
        bool is_free = true, is_covered = false;
        for (std::uint32_t other = 1; other < boxes.size(); ++other) {
          if (other == object) continue;
          is_free = is_free && !is_in(boxes[other], before, -0.25);
          is_covered = is_covered || is_in(boxes[other], at + 1e-3 * out, 1e-4);
        }
        const std::vector<Face>& faces = axis == 2 ? roofs : walls;
        // A piece of 1 m2 or less is no face, and all of a block's corners are on a grid of half a metre.
        if (is_free) {
          EXPECT_TRUE(any_holds(faces, at, 1e-9)) << object << ": " << at.transpose();
        }
        if (is_covered) {
          EXPECT_FALSE(any_holds(faces, at, -1e-6)) << object << ": " << at.transpose();
        }
      }
    }
  }
}

TEST(Faces, ThatAreNotPlanarAreLaidOutside) {
  Random random(31);
  for (const double scale : {3.0, 1e2, 1e4}) {
    for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(4'512'345.6, 5'012'345.6, 812.3)}) {
      for (int round = 0; round < 10; ++round) {
        // A roof as a grid whose corners are off by up to 0.02 mm, tilted.
        constexpr std::uint32_t kSteps = 5;
        const Vec3 normal = Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1).normalized();
        const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
        Mesh mesh;
        for (std::uint32_t i = 0; i <= kSteps; ++i) {
          for (std::uint32_t k = 0; k <= kSteps; ++k) {
            const double off = random.uniform(-2e-5, 2e-5);
            mesh.vertices.push_back(origin + scale * (i * u + k * v) + off * normal);
          }
        }
        for (std::uint32_t i = 0; i < kSteps; ++i) {
          for (std::uint32_t k = 0; k < kSteps; ++k) {
            const std::uint32_t a = i * (kSteps + 1) + k, b = a + kSteps + 1;
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
          }
        }
        const Scene scene = SceneBuilder().add("roof", mesh);
        const std::vector<Face> faces = faces_of(scene, FaceKind::roof);
        ASSERT_EQ(faces.size(), 1U);
        const double rounding = 1e-9 + 1e-15 * origin.norm() + 1e-15 * scale;
        EXPECT_NEAR(faces[0].area_m2, std::pow(scale * kSteps, 2), 1e-3 * scale * kSteps);
        for (const Vec3& vertex : mesh.vertices) {
          const double above = faces[0].normal.dot(faces[0].parts[0][0] - vertex);
          EXPECT_GE(above, -8 * rounding) << "never in the object";
          EXPECT_LE(above, 1e-3);
          EXPECT_TRUE(holds(faces[0], vertex + above * faces[0].normal, 8 * rounding)) << "never smaller";
        }
        const PreparedTarget target(PreparedScene(scene), target_of(faces, "roof"), Sensor{10 * scale});
        EXPECT_LT(target.lift_m(), 2.01e-3);
      }
    }
  }
}

TEST(Faces, ThatFaceDownAreSeenFromOutside) {
  // A tower that widens upward: its walls are 6 degrees out of the vertical, and face down.
  Mesh mesh = make_box_mesh({-5, -5, 0}, {5, 5, 20});
  for (Vec3& vertex : mesh.vertices) vertex.head<2>() *= 1 + vertex.z() / 50;
  const Scene scene = SceneBuilder().add("tower", mesh);
  const std::vector<Face> walls = faces_of(scene, FaceKind::facade);
  ASSERT_EQ(walls.size(), 4U);
  const Target one = target_of(facing(walls, 180), "south"), all = target_of(walls, "all");
  EXPECT_TRUE(one.front);
  EXPECT_TRUE(all.front_by_order);
  for (std::size_t i = 0; i < 4; ++i) {
    const TargetFrame frame = make_target_frame(all, i);
    EXPECT_GT(frame.normal.dot(Vec3(frame.origin.x(), frame.origin.y(), 0)), 0);
  }
  expect_right(scene, one);
}

TEST(Faces, NeedObjectsThatAreThere) {
  const Scene scene = SceneBuilder().box("block", {0, 0, 0}, {1, 1, 1});
  testing::expect_error([&] { faces_of(scene, FaceKind::roof, 1); }, ErrorCode::index_out_of_range);
  testing::expect_error([&] { FaceFinder(scene).nearest(kFirst, FaceKind::roof, Vec3(NAN, 0, 0)); },
                        ErrorCode::coordinate_not_finite);
  testing::expect_error([&] { target_of(std::vector<Face>{}, "nothing"); }, ErrorCode::nothing_given);
  EXPECT_TRUE(faces_of(scene, FaceKind::roof).empty()) << "1 square metre is no roof";
  EXPECT_FALSE(FaceFinder(scene).nearest(kFirst, FaceKind::roof, Vec3::Zero()));
}

/// A wall of narrow columns, each of two quadrilaterals that meet at another height than those beside it.
TEST(Faces, WallsWithoutWholeSharedEdgesHangTogether) {
  Scene scene;
  const auto add = [&](double x0, double x1, double z0, double z1) {
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const auto& [x, z] : {std::pair{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}) {
      scene.mesh.vertices.emplace_back(x, 0, z);
    }
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
    scene.mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (int i = 0; i < 50; ++i) {
    const double split = i % 2 == 0 ? 4 : 4.01;
    add(0.125 * i, 0.125 * (i + 1), 0, split);
    add(0.125 * i, 0.125 * (i + 1), split, 8);
  }
  add(6.25, 12, 0, 8);
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  scene.objects = {{"wall", "", ObjectKind::other}};
  const std::vector<Face> faces = faces_of(scene, FaceKind::facade);
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_NEAR(faces[0].area_m2, 96, 1e-6);
}

}  // namespace
}  // namespace vantage
