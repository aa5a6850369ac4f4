// compare_volumes: volumes, differences and distances of solids whose answers are known.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "core/stopwatch.h"
#include "core/triangle_tree.h"
#include "solid/csg.h"
#include "support/internals.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/scene.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

Mesh box(const Vec3& min, const Vec3& max) { return make_box_mesh(min, max); }

/// Points on circles of latitude, joined: a closed mesh with all corners on the sphere.
Mesh ball(const Vec3& centre, double radius, int sectors, int rings) {
  Mesh mesh;
  mesh.vertices.push_back(centre + Vec3(0, 0, radius));
  for (int ring = 1; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const double polar = std::numbers::pi * ring / rings, azimuth = 2 * std::numbers::pi * sector / sectors;
      mesh.vertices.push_back(centre + radius * Vec3(std::sin(polar) * std::cos(azimuth),
                                                     std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  mesh.vertices.push_back(centre - Vec3(0, 0, radius));
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  const auto at = [&](int ring, int sector) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * sectors + sector % sectors);
  };
  for (int sector = 0; sector < sectors; ++sector) {
    mesh.triangles.push_back({0, at(1, sector), at(1, sector + 1)});
    mesh.triangles.push_back({last, at(rings - 1, sector + 1), at(rings - 1, sector)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
      mesh.triangles.push_back({at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
    }
  }
  return mesh;
}

Mesh moved(Mesh mesh, const Vec3& shift) {
  for (Vec3& v : mesh.vertices) v += shift;
  return mesh;
}

/// What holds for any comparison.
Comparison compared(const Mesh& a, const Mesh& b) {
  Comparison c = compare_volumes(a, b);
  const double scale = 1e-9 * (c.volume_a_m3 + c.volume_b_m3);
  EXPECT_NEAR(c.volume_a_m3, enclosed_volume(a), scale);
  EXPECT_NEAR(c.volume_b_m3, enclosed_volume(b), scale);
  EXPECT_NEAR(c.intersection_m3 + c.only_a_m3, c.volume_a_m3, scale);
  EXPECT_NEAR(c.intersection_m3 + c.only_b_m3, c.volume_b_m3, scale);
  EXPECT_NEAR(enclosed_volume(c.only_a), c.only_a_m3, scale);
  EXPECT_NEAR(enclosed_volume(c.only_b), c.only_b_m3, scale);
  EXPECT_EQ(first_open_edge(c.only_a), "");
  EXPECT_EQ(first_open_edge(c.only_b), "");
  const Comparison swapped = compare_volumes(b, a);
  EXPECT_NEAR(swapped.only_a_m3, c.only_b_m3, scale);
  EXPECT_NEAR(swapped.worst_only_a_m, c.worst_only_b_m, 1e-9 * (1 + c.worst_only_b_m));
  return c;
}

TEST(Compare, ShiftedBoxes) {
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(580000, 4785000, 300)}) {
    const Comparison c =
        compared(box(origin, origin + Vec3(4, 3, 2)), box(origin + Vec3(1, 0, 0), origin + Vec3(5, 3, 2)));
    EXPECT_NEAR(c.volume_a_m3, 24, 1e-8);
    EXPECT_NEAR(c.intersection_m3, 18, 1e-8);
    EXPECT_NEAR(c.only_a_m3, 6, 1e-8);
    EXPECT_NEAR(c.only_b_m3, 6, 1e-8);
    EXPECT_NEAR(c.worst_only_a_m, 1, 1e-9);
    EXPECT_NEAR(c.worst_only_a_point.x(), origin.x(), 1e-9);
    EXPECT_NEAR(c.worst_only_b_m, 1, 1e-9);
    EXPECT_NEAR(c.worst_only_b_point.x(), origin.x() + 5, 1e-9);
    EXPECT_NEAR(bounding_box(c.only_a).max.x(), origin.x() + 1, 1e-9);
    EXPECT_NEAR(bounding_box(c.only_b).min.x(), origin.x() + 4, 1e-9);
  }
}

TEST(Compare, RandomBoxes) {
  Random random(3);
  for (int round = 0; round < 30; ++round) {
    const Vec3 min_a = random.point(-5, 0), max_a = random.point(1, 5), min_b = random.point(-5, 0),
               max_b = random.point(1, 5);
    const Comparison c = compared(box(min_a, max_a), box(min_b, max_b));
    const double both = (max_a.cwiseMin(max_b) - min_a.cwiseMax(min_b)).prod();
    EXPECT_NEAR(c.intersection_m3, both, 1e-9);
    EXPECT_NEAR(c.only_a_m3, (max_a - min_a).prod() - both, 1e-9);
  }
}

TEST(Compare, NestedBoxes) {
  const Comparison c = compared(box({0, 0, 0}, {10, 10, 10}), box({2, 3, 4}, {5, 5, 5}));
  EXPECT_NEAR(c.intersection_m3, 6, 1e-9);
  EXPECT_NEAR(c.only_a_m3, 994, 1e-9);
  EXPECT_EQ(c.only_b_m3, 0);
  EXPECT_TRUE(c.only_b.empty());
  EXPECT_EQ(c.worst_only_b_m, 0);
  EXPECT_NEAR(c.worst_only_a_m, std::sqrt(25.0 + 25 + 25), 1e-9) << "from (10, 10, 10) to (5, 5, 5)";
}

TEST(Compare, FindsTheBottomOfAPit) {
  // Every corner of the pit lies on the box with the pit; the farthest point is in the middle of its mouth.
  const Mesh whole = box({0, 0, 0}, {100, 100, 60}), pit = box({20, 20, 40}, {80, 80, 60});
  const Mesh with_pit = solid::subtract(solid::Solid({whole, std::vector<std::uint32_t>(whole.triangles.size())}),
                                        solid::Solid({pit, std::vector<std::uint32_t>(pit.triangles.size())}))
                            .to_mesh()
                            .mesh;
  const Comparison c = compared(whole, with_pit);
  EXPECT_NEAR(c.only_a_m3, 60 * 60 * 20, 1e-6);
  EXPECT_NEAR(c.worst_only_a_m, 20, 0.2);
  EXPECT_GE(c.worst_only_a_bound_m, 20 - 1e-9);
  EXPECT_LE(c.worst_only_a_bound_m, 20.4);
  EXPECT_NEAR(c.worst_only_a_point.z(), 60, 1);
  EXPECT_EQ(c.worst_only_b_m, 0);
}

TEST(Compare, DisjointAndTouching) {
  for (const double gap : {0.0, 1e-6, 3.0}) {
    const Comparison c = compared(box({0, 0, 0}, {1, 1, 1}), box({1 + gap, 0, 0}, {2 + gap, 1, 1}));
    EXPECT_EQ(c.intersection_m3, 0) << gap;
    EXPECT_NEAR(c.only_a_m3, 1, 1e-12);
    EXPECT_NEAR(c.only_b_m3, 1, 1e-12);
    EXPECT_NEAR(c.worst_only_a_m, 1 + gap, 1e-9);
    EXPECT_NEAR(c.worst_only_b_m, 1 + gap, 1e-9);
  }
}

TEST(Compare, Balls) {
  // The lens of two unit balls at distance 1 has volume 5 pi / 12.
  const Comparison c = compared(ball({0, 0, 0}, 1, 400, 200), ball({1, 0, 0}, 1, 400, 200));
  EXPECT_NEAR(c.intersection_m3, 5 * std::numbers::pi / 12, 2e-3);
  EXPECT_NEAR(c.worst_only_a_m, 1, 1e-3);
  EXPECT_NEAR(c.worst_only_a_point.x(), -1, 1e-3);
  EXPECT_NEAR(c.worst_only_b_point.x(), 2, 1e-3);
  const Comparison shell = compared(ball({5, 5, 5}, 3, 90, 45), ball({5, 5, 5}, 2, 90, 45));
  EXPECT_EQ(shell.only_b_m3, 0);
  EXPECT_NEAR(shell.worst_only_a_m, 1, 1e-2);
}

TEST(Compare, IdenticalMeshesDifferInNothing) {
  const Mesh mesh = moved(ball({0, 0, 0}, 17, 60, 30), {123.456, -9e5, 7});
  Mesh other;  // the same triangles, numbered and turned differently, with corners doubled
  std::vector<Triangle> order = mesh.triangles;
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  for (const Triangle& t : order) {
    const auto base = static_cast<std::uint32_t>(other.vertices.size());
    for (int k = 0; k < 3; ++k) other.vertices.push_back(mesh.vertices[t[(k + 1) % 3]]);
    other.triangles.push_back({base, base + 1, base + 2});
  }
  const Comparison c = compare_volumes(mesh, other);
  EXPECT_EQ(c.only_a_m3, 0);
  EXPECT_EQ(c.only_b_m3, 0);
  EXPECT_EQ(c.intersection_m3, c.volume_a_m3);
  EXPECT_EQ(c.intersection_m3, c.volume_b_m3);
  EXPECT_EQ(c.worst_only_a_m, 0);
  EXPECT_TRUE(c.only_a.empty() && c.only_b.empty());
  EXPECT_NEAR(c.volume_a_m3, enclosed_volume(mesh), 1e-6);
}

TEST(Compare, OneCornerMoved) {
  const Mesh a = ball({0, 0, 0}, 10, 60, 30);
  Mesh b = a;
  b.vertices[0].z() += 0.25;
  const Comparison c = compared(a, b);
  EXPECT_EQ(c.only_a_m3, 0);
  EXPECT_GT(c.only_b_m3, 0);
  EXPECT_NEAR(c.only_b_m3, enclosed_volume(b) - enclosed_volume(a), 1e-9);
  EXPECT_NEAR(c.worst_only_b_m, 0.25, 1e-3);
  EXPECT_EQ(c.worst_only_b_point, b.vertices[0]);
}

TEST(Compare, RefusesWhatIsNoSolid) {
  const Mesh good = box({0, 0, 0}, {1, 1, 1});
  Mesh open = good;
  open.triangles.pop_back();
  Mesh inside_out = good;
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  Mesh crossing = good;
  append(crossing, box({0.5, 0.5, 0.5}, {2, 2, 2}));
  Mesh index = good;
  index.triangles[3][1] = 99;
  Mesh infinite = good;
  infinite.vertices[2].x() = INFINITY;
  const std::pair<const Mesh*, ErrorCode> cases[] = {{&open, ErrorCode::mesh_not_closed},
                                                     {&inside_out, ErrorCode::mesh_inside_out},
                                                     {&crossing, ErrorCode::mesh_intersects_itself},
                                                     {&index, ErrorCode::index_out_of_range},
                                                     {&infinite, ErrorCode::coordinate_not_finite}};
  const Mesh empty;
  for (const auto& [mesh, expected] : cases) {
    const Mesh& bad = *mesh;
    for (const bool is_first : {true, false}) {
      const Error error = testing::error_of(
          [&] { compare_volumes(is_first ? bad : good, is_first ? good : bad, "first.ply", "second.ply"); });
      EXPECT_EQ(error.code(), expected) << error.what();
      EXPECT_EQ(error.where().rfind(is_first ? "first.ply" : "second.ply", 0), 0U) << error.what();
    }
  }
  testing::expect_error([&] { compare_volumes(empty, good, "first.ply", "second.ply"); }, ErrorCode::mesh_empty,
                        "first.ply");
}

// What booleans of jagged surfaces leave: a ball of 3,600 facets with a speck of a box through one of them.
TEST(Compare, TakesAMeshWithAFewFolds) {
  const Mesh smooth = ball({0, 0, 0}, 10, 60, 30);
  Mesh folded = smooth;
  append(folded, box({9.98, 0.2, 0.2}, {10.02, 0.3, 0.3}));
  const Comparison c = compare_volumes(folded, smooth);
  EXPECT_NEAR(c.volume_a_m3, c.volume_b_m3, 1e-3);
  EXPECT_NEAR(c.only_a_m3, 0, 1e-3);
  EXPECT_NEAR(c.only_b_m3, 0, 1e-3);
}

/// Two facets lie on each other, but for a part of their size of 1e-14. Booleans turn their common edge, and so another
/// one, over which the surface is bent.
TEST(Compare, KeepsWhatIsFoldedFlat) {
  const Vec3 tip(-181.78137499809492, -47.53697044929186, 47.055396690679984), apex(-12.4, -101.4, 17.5);
  const Mesh folded{{Vec3(0, 0, 0), Vec3(0, 0, 116), Vec3(42.8, 39.2, 0), Vec3(4.78, 1.25, 32), tip, apex},
                    {{0, 1, 2}, {1, 0, 3}, {1, 3, 4}, {2, 1, 5}, {0, 2, 5}, {3, 0, 5}, {4, 3, 5}, {1, 4, 5}}};
  const Mesh other = box({-1, -1, -1}, {1, 1, 1});
  const double volume_m3 = enclosed_volume(folded);
  for (const bool is_first : {true, false}) {
    const Comparison found = is_first ? compare_volumes(folded, other) : compare_volumes(other, folded);
    EXPECT_NEAR(is_first ? found.volume_a_m3 : found.volume_b_m3, volume_m3, 1e-9 * volume_m3);
    EXPECT_NEAR((is_first ? found.only_a_m3 : found.only_b_m3) + found.intersection_m3, volume_m3, 1e-9 * volume_m3);
  }
}

TEST(Compare, CanBeFollowedAndCancelled) {
  const Mesh a = ball({0, 0, 0}, 10, 60, 30), b = ball({1, 0, 0}, 10, 60, 30);
  const auto story =
      testing::check_progress([&](const Progress& progress) { compare_volumes(a, b, "A", "B", progress); });
  EXPECT_EQ(story.stages.size(), 5U);
  EXPECT_EQ(story.last_fraction.at("measuring distances"), 1);
}

TEST(TriangleTree, DistanceIsThatOfTheNearestTriangle) {
  Random random(8);
  Mesh mesh;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Vec3 place = random.point(-10, 10);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(place + random.point(-1, 1) * (i % 7 == 0 ? 1e-6 : 1.0));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh.vertices.push_back(mesh.vertices[0]);
  mesh.triangles.push_back({0, 0, 900});  // a triangle that is a point
  const core::TriangleTree tree(mesh);
  for (int round = 0; round < 200; ++round) {
    const Vec3 point = random.point(-12, 12);
    double best = INFINITY;  // by points spread over each triangle, so from above
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      for (int i = 0; i <= 40; ++i) {
        for (int j = 0; i + j <= 40; ++j)
          best = std::min(best, (a + (b - a) * i / 40.0 + (c - a) * j / 40.0 - point).norm());
      }
    }
    const double distance = tree.distance(point);
    EXPECT_LE(distance, best + 1e-12);
    EXPECT_GE(distance, best - 0.05);
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(random.integer(0, 299))];
    EXPECT_NEAR(tree.distance((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3), 0, 1e-12);
  }
}

TEST(HeavyCompare, BigMeshesThatShareMostFacets) {
  // Two balls of half a million triangles that are the same but for one octant, which is drawn in a little.
  const Mesh a = ball({0, 0, 0}, 300, 720, 360);
  Mesh b = a;
  for (Vec3& v : b.vertices) {
    if (v.minCoeff() > 0) v *= 0.99;
  }
  ASSERT_GT(a.triangles.size(), 500000U);
  const core::Stopwatch stopwatch;
  const Comparison c = compare_volumes(a, b);
  const double seconds = stopwatch.seconds();
  std::cout << "seconds " << seconds << "\n";
  EXPECT_EQ(c.only_b_m3, 0);
  EXPECT_NEAR(c.only_a_m3, enclosed_volume(a) - enclosed_volume(b), 1e-3);
  EXPECT_NEAR(c.worst_only_a_m, 3, 0.05);
}

}  // namespace
}  // namespace vantage::testing
