// Depth cube maps by OpenGL against the definition, in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

#include "depth/gl_depth.h"
#include "support/pyramid_oracle.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "vantage/error.h"
#include "vantage/scene.h"

namespace vantage::testing {
namespace {

using depth::Sampling;

constexpr double kRange = 5000;

class GlDepth : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string why_none;
    devices_ = depth::gl_devices(why_none);
    if (devices_.empty()) GTEST_SKIP() << why_none;
  }

  std::unique_ptr<depth::DepthRenderer> renderer(const Scene& scene) const {
    return depth::make_gl_depth_renderer(PreparedScene(scene), devices_.front());
  }

  std::vector<depth::GlDeviceInfo> devices_;
};

std::vector<float> cube_map(depth::DepthRenderer& renderer, const Vec3& eye, int face_size, Sampling sampling,
                            double range = kRange) {
  std::vector<float> result;
  renderer.render({std::span(&eye, 1), face_size, sampling, range},
                  [&](std::size_t, std::span<const float> depths) { result.assign(depths.begin(), depths.end()); });
  return result;
}

struct Texel {
  int face, row, column;
};

double centre_of(int index, int face_size) { return (2 * index + 1.0) / face_size - 1; }

/// All texels, or a random choice of them.
std::vector<Texel> some_texels(Random& random, int face_size, int most) {
  std::vector<Texel> texels;
  if (6 * face_size * face_size <= most) {
    for (int face = 0; face < 6; ++face) {
      for (int row = 0; row < face_size; ++row)
        for (int column = 0; column < face_size; ++column) texels.push_back({face, row, column});
    }
    return texels;
  }
  for (int i = 0; i < most; ++i) {
    texels.push_back({random.integer(0, 5), random.integer(0, face_size - 1), random.integer(0, face_size - 1)});
  }
  return texels;
}

std::array<FaceTriangles, 6> all_faces(const Scene& scene, const Vec3& eye) {
  std::array<FaceTriangles, 6> faces;
  for (int face = 0; face < 6; ++face) faces[face] = triangles_of_face(scene.mesh, eye, face);
  return faces;
}

struct Excess {
  std::size_t texels = 0, below = 0, loose = 0, invented = 0;
  double worst = 0;
};

/// Nearest depths against each triangle's part in the texel's pyramid.
Excess check_nearest(Random& random, depth::DepthRenderer& renderer, const Scene& scene, const Vec3& eye, int face_size,
                     int most) {
  const std::vector<float> depths = cube_map(renderer, eye, face_size, Sampling::nearest);
  const auto faces = all_faces(scene, eye);
  Excess result;
  for (const Texel& t : some_texels(random, face_size, most)) {
    const double u = centre_of(t.column, face_size), v = centre_of(t.row, face_size);
    const double reported = depths[(static_cast<std::size_t>(t.face) * face_size + t.row) * face_size + t.column];
    const double exact = std::min(inverse_depth_over(faces[t.face], u, v, 1.0 / face_size), 0x1p27);
    const double along = inverse_depth_along(faces[t.face], u + random.uniform(-1, 1) / face_size,
                                             v + random.uniform(-1, 1) / face_size);
    ++result.texels;
    if (reported < exact || reported < std::min(along, 0x1p27)) {
      ++result.below;
      ADD_FAILURE() << "face " << t.face << ", row " << t.row << ", column " << t.column << ": " << reported
                    << " but the truth is " << exact << " and " << along;
      if (result.below > 5) return result;
    }
    if (exact == 0 && reported > 0) ++result.invented;
    if (exact > 0 && reported > exact * 1.001) ++result.loose;
    if (exact > 0) result.worst = std::max(result.worst, reported / exact - 1);
  }
  std::cout << face_size << " texels a side: " << result.texels << " checked, " << result.invented << " invented, "
            << result.loose << " loose by more than 1e-3, the worst by " << result.worst << "\n";
  return result;
}

struct Agreement {
  std::size_t texels = 0, differ = 0;
};

/// Depths at the centres against rays.
Agreement check_centers(Random& random, depth::DepthRenderer& renderer, const Scene& scene, const Vec3& eye,
                        int face_size, int most) {
  const std::vector<float> depths = cube_map(renderer, eye, face_size, Sampling::centers);
  const auto faces = all_faces(scene, eye);
  Agreement result;
  for (const Texel& t : some_texels(random, face_size, most)) {
    const double reported = depths[(static_cast<std::size_t>(t.face) * face_size + t.row) * face_size + t.column];
    const double exact =
        inverse_depth_along(faces[t.face], centre_of(t.column, face_size), centre_of(t.row, face_size));
    ++result.texels;
    if (std::abs(reported - exact) > 1e-4 * exact) ++result.differ;
  }
  std::cout << face_size << " texels a side: " << result.texels << " checked, " << result.differ << " differ\n";
  return result;
}

Mesh one_triangle(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, {{0, 1, 2}}}; }

TEST_F(GlDepth, AWallStandsWhereItIs) {
  const Scene scene = SceneBuilder().polygon("wall", {{10, -40, -40}, {10, 40, -40}, {10, 40, 40}, {10, -40, 40}});
  const auto gl = renderer(scene);
  for (const Sampling sampling : {Sampling::centers, Sampling::nearest}) {
    const std::vector<float> depths = cube_map(*gl, Vec3::Zero(), 33, sampling);
    ASSERT_EQ(depths.size(), 6U * 33 * 33);
    for (int i = 0; i < 33 * 33; ++i) {
      EXPECT_NEAR(depths[i], 0.1, 0.1 * 5e-6);  // the whole of the face +x
      EXPECT_EQ(depths[33 * 33 + i], 0);        // nothing behind
    }
  }
}

TEST_F(GlDepth, FacesLieAsTheirAxesSay) {
  Random random(20240611);
  SceneBuilder builder;
  for (int i = 0; i < 30; ++i) {
    const Vec3 centre = random.uniform(5, 30) * random.direction();
    builder.add("triangle", one_triangle(centre, centre + random.point(-4, 4), centre + random.point(-4, 4)));
  }
  const Scene scene = builder;
  const auto gl = renderer(scene);
  for (const int face_size : {1, 2, 7, 64}) {
    const Agreement centers = check_centers(random, *gl, scene, Vec3::Zero(), face_size, 30000);
    EXPECT_LE(centers.differ, centers.texels / 500);
    const Excess nearest = check_nearest(random, *gl, scene, Vec3::Zero(), face_size, 30000);
    EXPECT_LE(nearest.invented + nearest.loose, nearest.texels / 500);
  }
}

TEST_F(GlDepth, GroundUnderTheEyeAndABoxRoundIt) {
  Random random(7);
  const Scene ground = SceneBuilder().ground("ground", 2000);
  const Scene box = SceneBuilder().box("box", {-3, -2, -1}, {4, 5, 6});
  for (const Scene* scene : {&ground, &box}) {
    const auto gl = renderer(*scene);
    for (const Vec3& eye : {Vec3(0.3, 0.1, 0.02), Vec3(1, 2, 1.7), Vec3(-1.5, 0.25, 5.99)}) {
      const Agreement centers = check_centers(random, *gl, *scene, eye, 50, 20000);
      EXPECT_LE(centers.differ, centers.texels / 1000);
      const Excess nearest = check_nearest(random, *gl, *scene, eye, 50, 20000);
      EXPECT_LE(nearest.invented, nearest.texels / 100);
      EXPECT_LE(nearest.loose, nearest.texels / 50);
    }
  }
}

TEST_F(GlDepth, SliversAndWallsSeenEdgeOnAreNotMissed) {
  Random random(99);
  SceneBuilder builder;
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = random.uniform(2, 60) * random.direction(), to = random.uniform(2, 60) * random.direction();
    const double width = std::pow(10, random.uniform(-7, -1));
    builder.add("sliver", one_triangle(from, to, from + width * random.direction()));
    // A wall whose plane holds the eye, or all but.
    const Vec3 near = random.uniform(1, 10) * random.direction();
    const Vec3 off = std::pow(10, random.uniform(-12, -3)) * random.direction();
    builder.add("edge on", one_triangle(near, 8 * near + random.direction(), 4.5 * near + 0.5 * random.direction()));
    builder.add("edge on", one_triangle(near + off, 3 * near + off, 2 * near + to - off));
  }
  const Scene scene = builder;
  const auto gl = renderer(scene);
  for (const int face_size : {5, 40, 300}) {
    const Excess nearest = check_nearest(random, *gl, scene, Vec3::Zero(), face_size, 20000);
    EXPECT_LE(nearest.invented, nearest.texels / 50);
    EXPECT_LE(nearest.loose, nearest.texels / 20);
  }
}

TEST_F(GlDepth, TrianglesThroughThePlaneOfTheEye) {
  Random random(5);
  SceneBuilder builder;
  for (int i = 0; i < 12; ++i) {  // big ones that pass the eye at centimetres to metres, on all sides
    const Vec3 normal = random.direction(), u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vec3 foot = std::pow(10, random.uniform(-2, 1)) * normal;
    const double turn = random.uniform(0, 6.28), size = std::pow(10, random.uniform(0, 3));
    const auto corner = [&](double angle) -> Vec3 {
      return foot + size * random.uniform(0.3, 1) * (std::cos(turn + angle) * u + std::sin(turn + angle) * v);
    };
    builder.add("triangle", one_triangle(corner(0), corner(2), corner(4)));
  }
  const Scene scene = builder;
  for (int i = 0; i < 6; ++i) {
    const Vec3 eye = i == 0 ? Vec3(0, 0, 0) : random.point(-5, 5);
    const auto gl = renderer(scene);
    const Agreement centers = check_centers(random, *gl, scene, eye, 60, 5000);
    EXPECT_LE(centers.differ, centers.texels / 200);
    check_nearest(random, *gl, scene, eye, 60, 5000);
  }
}

TEST_F(GlDepth, RandomSoup) {
  Random random(31337);
  for (int round = 0; round < 8; ++round) {
    SceneBuilder builder;
    for (int i = 0; i < 80; ++i) {
      const double size = std::pow(10, random.uniform(-3, 2));
      const Vec3 a = random.point(-50, 50);
      builder.add("triangle", one_triangle(a, a + random.point(-size, size), a + random.point(-size, size)));
    }
    const Scene scene = builder;
    const auto gl = renderer(scene);
    const int face_size = random.integer(1, 400);
    const Vec3 eye = random.point(-40, 40);
    const Excess nearest = check_nearest(random, *gl, scene, eye, face_size, 6000);
    EXPECT_LE(nearest.invented + nearest.loose, nearest.texels / 50);
    const Agreement centers = check_centers(random, *gl, scene, eye, face_size, 6000);
    EXPECT_LE(centers.differ, centers.texels / 100);
  }
}

TEST_F(GlDepth, RadialErrorFarAwayAndAtMapCoordinates) {
  // Small walls all round, each facing the eye, 600 m away, at coordinates of a map projection.
  Random random(600);
  const Vec3 eye(580000.123456, 4785000.654321, 1000.987);
  SceneBuilder builder;
  constexpr int kWalls = 400;  // on a spiral, so that none stands before another
  for (int i = 0; i < kWalls; ++i) {
    const double height = 1 - (2 * i + 1.0) / kWalls, width = std::sqrt(1 - height * height), turn = 2.399963 * i;
    const Vec3 d(width * std::cos(turn), width * std::sin(turn), height), u = d.unitOrthogonal(), v = d.cross(u);
    const Vec3 centre = eye + random.uniform(590, 600) * d;
    builder.add("wall", one_triangle(centre + 40 * u, centre - 30 * u + 35 * v, centre - 30 * u - 35 * v));
  }
  const Scene scene = builder;
  const auto gl = renderer(scene);
  const int n = 128;
  const std::vector<float> depths = cube_map(*gl, eye, n, Sampling::centers);
  const auto faces = all_faces(scene, eye);
  double worst = 0;
  std::size_t seen = 0, silhouettes = 0;
  for (const Texel& t : some_texels(random, n, 1 << 20)) {
    const double u = centre_of(t.column, n), v = centre_of(t.row, n);
    const double reported = depths[(static_cast<std::size_t>(t.face) * n + t.row) * n + t.column];
    const double exact = inverse_depth_along(faces[t.face], u, v);
    if (exact == 0 && reported == 0) continue;
    ++seen;
    const double error = std::abs(1 / reported - 1 / exact) * std::sqrt(1 + u * u + v * v);
    if (error < 0.5) {
      worst = std::max(worst, error);  // beyond: one wall for another, at a silhouette
    } else {
      ++silhouettes;
    }
  }
  std::cout << "worst radial error at 600 m: " << worst << " m over " << seen << " texels, " << silhouettes
            << " at silhouettes\n";
  EXPECT_GT(seen, 10000U);
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(silhouettes, seen / 200);
  check_nearest(random, *gl, scene, eye, n, 3000);
}

TEST_F(GlDepth, ManyViewpointsComeInOrderAndAreThoseOfOne) {
  Random random(12);
  const Scene scene = random_city(random, 12, 10);
  const auto gl = renderer(scene);
  std::vector<Vec3> eyes;
  for (int i = 0; i < 7; ++i) eyes.push_back(random.point(-8, 8) + Vec3(0, 0, 12));
  std::vector<std::vector<float>> batch;
  gl->render({eyes, 30, Sampling::nearest, 300}, [&](std::size_t viewpoint, std::span<const float> depths) {
    EXPECT_EQ(viewpoint, batch.size());
    batch.emplace_back(depths.begin(), depths.end());
  });
  ASSERT_EQ(batch.size(), eyes.size());
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    EXPECT_EQ(batch[i], cube_map(*gl, eyes[i], 30, Sampling::nearest, 300)) << i;
  }
  gl->render({{}, 30, Sampling::nearest, 300}, [&](std::size_t, std::span<const float>) { FAIL(); });
}

TEST_F(GlDepth, FewerFacesAtOnceChangeNothing) {
  Random random(13);
  const Scene scene = random_city(random, 12, 10);
  const PreparedScene prepared(scene);
  const Vec3 eye(1, 2, 15);
  const int n = 64;
  const auto all = depth::make_gl_depth_renderer(prepared, devices_.front());
  const std::vector<float> expected = cube_map(*all, eye, n, Sampling::nearest);
  for (const std::size_t faces : {1, 2, 3, 4}) {
    depth::GlDepthLimits limits;
    limits.image_bytes = 12 * faces * n * n;
    const auto some = depth::make_gl_depth_renderer(prepared, devices_.front(), limits);
    EXPECT_EQ(cube_map(*some, eye, n, Sampling::nearest), expected) << faces;
  }
}

TEST_F(GlDepth, WhatIsOutOfRangeMayBeLeftOut) {
  Random random(14);
  const Scene scene = random_city(random, 40, 10);
  const auto gl = renderer(scene);
  const Vec3 eye(0, 0, 5);
  const std::vector<float> all = cube_map(*gl, eye, 40, Sampling::nearest);
  const std::vector<float> near = cube_map(*gl, eye, 40, Sampling::nearest, 30);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_LE(near[i], all[i]);
    const int column = static_cast<int>(i % 40), row = static_cast<int>(i / 40 % 40);
    const double reach = std::hypot(1.0, centre_of(column, 40), centre_of(row, 40));
    if (reach / all[i] < 28) {
      EXPECT_EQ(near[i], all[i]);
    }
  }
}

TEST_F(GlDepth, AViewpointOnASurfaceSeesWhatIsAbove) {
  Random random(16);
  const Scene scene = SceneBuilder().ground("ground", 50).box("block", {5, -2, 0}, {9, 2, 3});
  const auto gl = renderer(scene);
  const int n = 31;
  for (const Vec3& eye : {Vec3(0.25, 0.5, 0), Vec3(-50, 3, 0), Vec3(50, 50, 0)}) {  // within, on a side, on a corner
    const std::vector<float> depths = cube_map(*gl, eye, n, Sampling::nearest);
    const auto faces = all_faces(scene, eye);
    for (const Texel& t : some_texels(random, n, 1 << 20)) {
      const double u = centre_of(t.column, n), v = centre_of(t.row, n);
      const depth::CubeFace& axes = depth::cube_faces()[t.face];
      const double upward = (axes.forward + u * axes.right + v * axes.up).z();
      const double q = depths[(static_cast<std::size_t>(t.face) * n + t.row) * n + t.column];
      EXPECT_GE(q, inverse_depth_along(faces[t.face], u, v));  // of the block
      if (upward > 3.0 / n) {
        EXPECT_LT(q, 1) << "face " << t.face << ", " << u << ", " << v;
      }
    }
  }
}

TEST_F(GlDepth, TwoRenderersOnTwoThreads) {
  Random random(15);
  const PreparedScene prepared(random_city(random, 20, 10));
  const Vec3 eye(0, 0, 6);
  std::array<std::vector<float>, 2> maps;
  std::vector<std::thread> threads;
  for (std::vector<float>& map : maps) {
    threads.emplace_back([&] {
      const auto gl = depth::make_gl_depth_renderer(prepared, devices_.front());
      for (int i = 0; i < 5; ++i) map = cube_map(*gl, eye, 50, Sampling::nearest);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(maps[0].size(), 6U * 50 * 50);
  EXPECT_EQ(maps[0], maps[1]);
}

TEST_F(GlDepth, AnEmptySceneHidesNothing) {
  const auto gl = renderer(Scene{});
  for (const float depth : cube_map(*gl, Vec3(1, 2, 3), 8, Sampling::nearest)) EXPECT_EQ(depth, 0);
}

TEST_F(GlDepth, BadRequestsAreRefused) {
  const auto gl = renderer(SceneBuilder().ground("ground", 10).scene());
  const Vec3 eye(0, 0, 1), nowhere(0, std::nan(""), 1);
  const auto sink = [](std::size_t, std::span<const float>) { FAIL(); };
  EXPECT_THROW(gl->render({std::span(&eye, 1), 0, Sampling::centers, 10}, sink), Error);
  EXPECT_THROW(gl->render({std::span(&eye, 1), 100000, Sampling::centers, 10}, sink), Error);
  EXPECT_THROW(gl->render({std::span(&eye, 1), 10, Sampling::centers, 0}, sink), Error);
  EXPECT_THROW(gl->render({std::span(&eye, 1), 10, Sampling::centers, std::nan("")}, sink), Error);
  EXPECT_THROW(gl->render({std::span(&nowhere, 1), 10, Sampling::centers, 10}, sink), Error);
  EXPECT_EQ(cube_map(*gl, eye, 10, Sampling::centers).size(), 600U);  // and it goes on
}

TEST_F(GlDepth, ASinkThatThrowsLeavesTheRendererUsable) {
  const auto gl = renderer(SceneBuilder().ground("ground", 10).scene());
  const std::vector<Vec3> eyes(3, Vec3(0, 0, 1));
  const auto sink = [](std::size_t, std::span<const float>) { throw std::runtime_error("full"); };
  EXPECT_THROW(gl->render({eyes, 10, Sampling::centers, 10}, sink), std::runtime_error);
  const std::vector<float> depths = cube_map(*gl, eyes[0], 11, Sampling::centers);
  EXPECT_NEAR(depths[(5 * 11 + 5) * 11 + 5], 1, 1e-6);  // straight down
}

TEST_F(GlDepth, CharlotteAgainstTheDefinition) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  Random random(704);
  const Scene scene = read_scene(shared_data("charlotte/uptownCharlotte.obj"), {.up = UpAxis::y});
  const auto gl = renderer(scene);
  const Box bounds = bounding_box(scene.mesh);
  for (int i = 0; i < 3; ++i) {
    Vec3 eye = random.in_box(bounds) * 0.5;
    eye.z() = random.uniform(1, 60);
    const int face_size = i == 0 ? 40 : i == 1 ? 200 : 1024;
    const Excess nearest = check_nearest(random, *gl, scene, eye, face_size, 500);
    EXPECT_LE(nearest.invented + nearest.loose, nearest.texels / 20);
    const Agreement centers = check_centers(random, *gl, scene, eye, face_size, 1000);
    EXPECT_LE(centers.differ, centers.texels / 200);
  }
}

}  // namespace
}  // namespace vantage::testing
