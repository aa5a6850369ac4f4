// PreparedScene: welding, cleaning, merging into convex polygons, the hierarchy.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/parallel.h"
#include "scene/prepared_data.h"
#include "support/internals.h"
#include "support/objects.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/scene.h"

namespace vantage {
namespace {

using testing::make_box_mesh;
using testing::Random;
using testing::random_city;
using testing::SceneBuilder;

using Polygon = std::vector<Vec3>;

/// Corners of a prepared polygon in the scene frame.
Polygon polygon_of(const PreparedScene& prepared, std::size_t i) {
  const auto& data = prepared.data();
  Polygon polygon;
  for (std::uint32_t k = data.first_vertex[i]; k < data.first_vertex[i + 1]; ++k)
    polygon.push_back(data.vertices[data.polygon_vertices[k]] + data.origin);
  return polygon;
}

Vec3 area_vector(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += 0.5 * (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  return sum;
}

double total_area(const PreparedScene& prepared) {
  double area = 0;
  for (std::size_t i = 0; i < prepared.data().polygon_count(); ++i) area += area_vector(polygon_of(prepared, i)).norm();
  return area;
}

/// Planar to rounding, convex, at least three corners, none in the middle of a side.
void expect_convex_polygons(const PreparedScene& prepared) {
  const auto& data = prepared.data();
  ASSERT_EQ(data.first_vertex.size(), data.polygon_count() + 1);
  ASSERT_EQ(prepared.statistics().polygons, data.polygon_count());
  for (std::size_t i = 0; i < data.polygon_count(); ++i) {
    const Polygon p = polygon_of(prepared, i);
    ASSERT_GE(p.size(), 3u);
    const Vec3 normal = area_vector(p).normalized();
    const std::size_t n = p.size();
    for (std::size_t k = 0; k < n; ++k) {
      ASSERT_LE(std::abs(normal.dot(p[k] - p[0])), 4e-9) << "polygon " << i;
      const Vec3 in = p[k] - p[(k + n - 1) % n], out = p[(k + 1) % n] - p[k];
      ASSERT_GT(normal.dot(in.cross(out)), 0) << "polygon " << i << " corner " << k;
      for (std::size_t m = 0; m < n; ++m)  // no winding twice: every corner is left of every side
        ASSERT_GE(normal.dot(out.cross(p[m] - p[k])) / out.norm(), -4e-9) << "polygon " << i;
    }
  }
}

/// How deep a point of the polygon's plane lies inside its outline; negative outside. Metres.
double depth_inside(const Polygon& polygon, const Vec3& point) {
  const Vec3 normal = area_vector(polygon).normalized();
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 side = (polygon[(k + 1) % polygon.size()] - polygon[k]).normalized();
    depth = std::min(depth, normal.cross(side).dot(point - polygon[k]));
  }
  return depth;
}

enum class RayHit { no, yes, unsure };

/// Whether a segment crosses a polygon; unsure within a micrometre of its outline.
RayHit crosses(const Polygon& polygon, const Vec3& from, const Vec3& to) {
  const Vec3 normal = area_vector(polygon).normalized();
  const double a = normal.dot(from - polygon[0]), b = normal.dot(to - polygon[0]);
  if (std::abs(a) < 1e-6 || std::abs(b) < 1e-6) return RayHit::unsure;
  if ((a > 0) == (b > 0)) return RayHit::no;
  const double depth = depth_inside(polygon, from + a / (a - b) * (to - from));
  return std::abs(depth) < 1e-6 ? RayHit::unsure : depth > 0 ? RayHit::yes : RayHit::no;
}

/// Yes if any polygon is crossed for certain; else unsure if any is unsure.
template <typename Polygons>
RayHit crosses_any(const Polygons& polygons, const Vec3& from, const Vec3& to) {
  RayHit result = RayHit::no;
  for (const Polygon& polygon : polygons) {
    const RayHit hit = crosses(polygon, from, to);
    if (hit == RayHit::yes) return hit;
    if (hit == RayHit::unsure) result = hit;
  }
  return result;
}

std::vector<Polygon> triangles_of(const Scene& scene) {
  std::vector<Polygon> polygons;
  for (const Triangle& t : scene.mesh.triangles) {
    polygons.push_back({scene.mesh.vertices[t[0]], scene.mesh.vertices[t[1]], scene.mesh.vertices[t[2]]});
    if (area_vector(polygons.back()).norm() < 1e-9) polygons.pop_back();
  }
  return polygons;
}

std::vector<Polygon> polygons_of(const PreparedScene& prepared) {
  std::vector<Polygon> polygons;
  for (std::size_t i = 0; i < prepared.data().polygon_count(); ++i) polygons.push_back(polygon_of(prepared, i));
  return polygons;
}

/// A wall of n x m cells, each cut into two triangles along a random diagonal, in random turns and order.
Mesh random_wall(Random& random, const Vec3& corner, const Vec3& across, const Vec3& up, int n, int m) {
  Mesh mesh;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) mesh.vertices.push_back(corner + i * across + j * up);
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + 1, c = a + static_cast<std::uint32_t>(n) + 1,
                 d = c + 1;
      std::array<Triangle, 2> two = {Triangle{a, b, d}, Triangle{a, d, c}};
      if (random.chance(0.5)) two = {Triangle{a, b, c}, Triangle{b, d, c}};
      for (Triangle t : two) {
        if (random.chance(0.5)) std::swap(t[0], t[1]);
        mesh.triangles.push_back(t);
      }
    }
  }
  for (std::size_t i = mesh.triangles.size(); i > 1; --i) {
    std::swap(mesh.triangles[i - 1],
              mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  }
  return mesh;
}

TEST(PreparedScene, ABoxBecomesSixRectangles) {
  const PreparedScene prepared(SceneBuilder().box("block", {0, 0, 0}, {4, 5, 6}));
  const SceneStatistics& s = prepared.statistics();
  EXPECT_EQ(s.triangles, 12u);
  EXPECT_EQ(s.vertices, 8u);
  EXPECT_EQ(s.welded_vertices, 8u);
  EXPECT_EQ(s.objects, 1u);
  EXPECT_EQ(s.degenerate_triangles, 0u);
  EXPECT_EQ(s.duplicate_triangles, 0u);
  EXPECT_EQ(s.open_edges, 0u);
  EXPECT_EQ(s.nonmanifold_edges, 0u);
  EXPECT_EQ(s.misoriented_edges, 0u);
  EXPECT_EQ(s.polygons, 6u);
  EXPECT_EQ(s.bounds.min, Vec3(0, 0, 0));
  EXPECT_EQ(s.bounds.max, Vec3(4, 5, 6));
  EXPECT_EQ(names_of(prepared.objects()), std::vector<std::string>{"block"});
  expect_convex_polygons(prepared);
  EXPECT_DOUBLE_EQ(total_area(prepared), 2 * (20 + 24 + 30));
}

TEST(PreparedScene, WeldsEqualPositionsOnly) {
  Scene scene;  // two triangles of a square with six vertices of their own; -0 equals 0
  scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-0.0, 0, -0.0}, {1, 1, 0}, {0, 1, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(PreparedScene(scene).statistics().welded_vertices, 4u);
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 1u);
  scene.mesh.vertices[3].x() = 1e-7;
  EXPECT_EQ(PreparedScene(scene).statistics().welded_vertices, 5u);
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 2u);
}

TEST(PreparedScene, DropsDegenerateTrianglesAndCountsThem) {
  Scene scene;
  scene.mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 0, 0}, {2, 1e-15, 0}, {2, 1e-6, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 1, 1}, {2, 2, 2}, {0, 3, 1}, {0, 4, 1}, {0, 5, 1}};
  const PreparedScene prepared(scene);
  EXPECT_EQ(prepared.statistics().degenerate_triangles, 4u);  // the last one, a micrometre thin, is kept
  double area = 0;
  for (const Polygon& polygon : polygons_of(prepared)) area += area_vector(polygon).norm();
  EXPECT_NEAR(area, 8 + 2e-6, 1e-12);
}

TEST(PreparedScene, DropsDuplicatesInEitherTurnAndCountsThem) {
  SceneBuilder builder;
  builder.box("one", {0, 0, 0}, {1, 1, 1}).box("again", {0, 0, 0}, {1, 1, 1});
  Scene scene = builder;
  for (std::size_t i = 12; i < 24; ++i) std::swap(scene.mesh.triangles[i][0], scene.mesh.triangles[i][2]);
  const PreparedScene prepared(scene);
  EXPECT_EQ(prepared.statistics().duplicate_triangles, 12u);
  EXPECT_EQ(prepared.statistics().polygons, 6u);
  EXPECT_EQ(prepared.statistics().objects, 2u);
  for (const std::uint32_t object : prepared.data().polygon_object) EXPECT_EQ(object, 0u);
}

TEST(PreparedScene, CountsOpenNonManifoldAndMisorientedEdges) {
  Mesh lidless = make_box_mesh({0, 0, 0}, {1, 1, 1});
  lidless.triangles.erase(lidless.triangles.begin() + 2, lidless.triangles.begin() + 4);  // the top
  EXPECT_EQ(PreparedScene(SceneBuilder().add("box", lidless)).statistics().open_edges, 4u);
  Mesh turned = make_box_mesh({0, 0, 0}, {1, 1, 1});
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  EXPECT_EQ(PreparedScene(SceneBuilder().add("box", turned)).statistics().misoriented_edges, 3u);
  Mesh finned = make_box_mesh({0, 0, 0}, {1, 1, 1});
  finned.vertices.emplace_back(2, 0, 2);
  finned.triangles.push_back({1, 5, 8});
  const SceneStatistics s = PreparedScene(SceneBuilder().add("box", finned)).statistics();
  EXPECT_EQ(s.nonmanifold_edges, 1u);
  EXPECT_EQ(s.open_edges, 2u);
}

TEST(PreparedScene, MergesAcrossTurnsButNotAcrossObjects) {
  Scene scene;
  scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 3, 2}};
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 1u);
  scene.objects = named({"left", "right"});
  scene.object_of = {0, 1};
  const PreparedScene prepared(scene);
  EXPECT_EQ(prepared.statistics().polygons, 2u);
  EXPECT_NE(prepared.data().polygon_object[0], prepared.data().polygon_object[1]);
}

TEST(PreparedScene, DoesNotMergeWhatIsNotConvexOrNotPlanar) {
  Scene scene;  // a kite folded in: two triangles on one side of their shared edge
  scene.mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {2, 3, 0}, {2, 1, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 2u);
  scene.mesh.triangles = {{0, 1, 3}, {1, 2, 3}};  // side by side, reflex at vertex 3
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 2u);
  scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-6}, {0, 1, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(PreparedScene(scene).statistics().polygons, 2u);  // bent by a micrometre
}

/// The least distance within which the plane of some triangle has all of the vertices.
double flatness(const Polygon& polygon, const std::vector<Polygon>& triangles) {
  double least = std::numeric_limits<double>::infinity();
  for (const Polygon& t : triangles) {
    const Vec3 normal = area_vector(t).normalized();
    double farthest = 0;
    for (const Vec3& v : polygon) farthest = std::max(farthest, std::abs(normal.dot(v - t[0])));
    least = std::min(least, farthest);
  }
  return least;
}

TEST(PreparedScene, DeviationsFromAPlaneDoNotAddUp) {
  // A strip of 14 squares, the second half of which rises by 0.9 nm a metre: each square is within a nanometre of the
  // one before it, and the last one 6 nm above the first one's plane.
  Scene scene;
  for (int x = 0; x <= 14; ++x)
    for (const double y : {0.0, 1.0}) scene.mesh.vertices.emplace_back(x, y, 0.9e-9 * std::max(0, x - 7));
  for (std::uint32_t x = 0; x < 14; ++x) {
    scene.mesh.triangles.push_back({2 * x, 2 * x + 2, 2 * x + 1});
    scene.mesh.triangles.push_back({2 * x + 1, 2 * x + 2, 2 * x + 3});
  }
  const PreparedScene prepared(scene);
  EXPECT_LT(prepared.statistics().polygons, 6u);
  for (const Polygon& polygon : polygons_of(prepared)) EXPECT_LT(flatness(polygon, triangles_of(scene)), 1.01e-9);
}

TEST(PreparedScene, MergingKeepsAreaAndWhatIsHidden) {
  Random random(23);
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(draw);
    SceneBuilder builder;
    const Vec3 normal = random.direction(), u = normal.unitOrthogonal(), v = normal.cross(u);
    builder.add("tilted", random_wall(random, random.point(-5, 0), u, 0.7 * v, 5, 4));
    builder.add("upright", random_wall(random, {0, 1, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 8, 6));
    builder.add("crossing", random_wall(random, {1, -2, 1}, {0, 1, 0}, {0.25, 0, 1}, 4, 3));
    Scene scene = builder;
    const std::size_t clean = scene.mesh.triangles.size();
    const double area = surface_area(scene.mesh);
    for (int k = 0; k < 6; ++k) {  // dirt: doubled and degenerate triangles
      const Triangle t = scene.mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(clean) - 1))];
      scene.mesh.triangles.push_back(k % 2 ? Triangle{t[2], t[1], t[0]} : Triangle{t[0], t[1], t[0]});
      scene.object_of.push_back(0);
    }
    const PreparedScene prepared(scene);
    EXPECT_EQ(prepared.statistics().degenerate_triangles, 3u);
    EXPECT_EQ(prepared.statistics().duplicate_triangles, 3u);
    EXPECT_LT(prepared.statistics().polygons, clean / 2);
    expect_convex_polygons(prepared);
    EXPECT_NEAR(total_area(prepared), area, 1e-9 * area);

    const std::vector<Polygon> before = triangles_of(scene), after = polygons_of(prepared);
    int hidden = 0, free = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 from = random.point(-8, 8), to = random.point(-8, 8);
      const RayHit was = crosses_any(before, from, to), is = crosses_any(after, from, to);
      hidden += was == RayHit::yes;
      free += was == RayHit::no;
      // A segment through a diagonal that merging removed is unsure before and not after; never yes against no.
      EXPECT_FALSE((was == RayHit::yes && is == RayHit::no) || (was == RayHit::no && is == RayHit::yes));
    }
    EXPECT_GT(hidden, 100);
    EXPECT_GT(free, 100);
  }
}

TEST(PreparedScene, PolygonsOfRandomCitiesAreConvex) {
  Random random(29);
  for (int draw = 0; draw < 10; ++draw) {
    const Scene scene = random_city(random, 60, 5);
    const PreparedScene prepared(scene);
    expect_convex_polygons(prepared);
    EXPECT_LE(prepared.statistics().polygons, scene.mesh.triangles.size() / 2 + 60);
    if (prepared.statistics().duplicate_triangles > 0) continue;
    EXPECT_NEAR(total_area(prepared), surface_area(scene.mesh), 1e-6);
  }
}

TEST(PreparedScene, NamesGoWithTheirPolygons) {
  Random random(31);
  const Scene scene = random_city(random, 40, 5);
  const PreparedScene prepared(scene);
  ASSERT_EQ(prepared.objects(), scene.objects);
  std::vector<double> before(scene.objects.size()), after(scene.objects.size());
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    const Triangle& t = scene.mesh.triangles[i];
    const auto& v = scene.mesh.vertices;
    before[scene.object_of[i]] += area_vector({v[t[0]], v[t[1]], v[t[2]]}).norm();
  }
  for (std::size_t i = 0; i < prepared.data().polygon_count(); ++i)
    after[prepared.data().polygon_object[i]] += area_vector(polygon_of(prepared, i)).norm();
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(before[i], after[i], 1e-9) << display_name(scene.objects[i]);
}

/// Every polygon is in one leaf, and every node holds all that is below it.
TEST(PreparedScene, TheHierarchyHoldsEverything) {
  Random random(37);
  Scene scene = random_city(random, 300, 5);
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(580000.3, 4785000.7, 1000.1)}) {
    for (Vec3& vertex : scene.mesh.vertices) vertex += shift;
    const PreparedScene prepared(scene);
    const auto& data = prepared.data();
    std::vector<int> seen(data.polygon_count());
    const auto holds = [](const core::Bounds& outer, const Vec3& min, const Vec3& max) {
      for (int a = 0; a < 3; ++a)
        if (static_cast<double>(outer.min[a]) > min[a] || static_cast<double>(outer.max[a]) < max[a]) return false;
      return true;
    };
    std::size_t visited = 0;
    const auto visit = [&](auto&& self, std::uint32_t at) -> void {
      const core::BvhNode& node = data.bvh.nodes.at(at);
      ++visited;
      if (!node.leaf()) {
        for (const std::uint32_t child : {node.first, node.first + 1}) {
          const auto& b = data.bvh.nodes.at(child).bounds;
          EXPECT_TRUE(holds(node.bounds, Vec3(b.min[0], b.min[1], b.min[2]), Vec3(b.max[0], b.max[1], b.max[2])));
          self(self, child);
        }
        return;
      }
      for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon) {
        ++seen.at(polygon);
        for (std::uint32_t k = data.first_vertex[polygon]; k < data.first_vertex[polygon + 1]; ++k) {
          const Vec3& v = data.vertices[data.polygon_vertices[k]];
          EXPECT_TRUE(holds(node.bounds, v, v));
        }
      }
    };
    visit(visit, 0);
    EXPECT_EQ(visited, data.bvh.nodes.size());
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
  }
}

bool same_bits(const PreparedScene& one, const PreparedScene& other) {
  const auto &a = one.data(), &b = other.data();
  const auto same_nodes = [](const core::BvhNode& m, const core::BvhNode& n) {
    return m.bounds.min == n.bounds.min && m.bounds.max == n.bounds.max && m.first == n.first && m.count == n.count;
  };
  return a.origin == b.origin && a.vertices == b.vertices && a.first_vertex == b.first_vertex &&
         a.polygon_vertices == b.polygon_vertices && a.polygon_object == b.polygon_object &&
         std::equal(a.bvh.nodes.begin(), a.bvh.nodes.end(), b.bvh.nodes.begin(), b.bvh.nodes.end(), same_nodes);
}

TEST(PreparedScene, IsTheSameForAnyNumberOfThreads) {
  Random random(41);
  const Scene scene = random_city(random, 2000, 5);  // large enough that the hierarchy is built in parallel
  std::vector<PreparedScene> prepared;
  for (const int threads : {1, 2, 4}) {
    parallel::with_threads(threads, [&] { prepared.emplace_back(scene); });
    EXPECT_TRUE(same_bits(prepared.front(), prepared.back())) << threads << " threads";
  }
}

TEST(PreparedScene, AnEmptySceneIsFine) {
  const PreparedScene prepared{Scene{}};
  EXPECT_EQ(prepared.statistics().triangles, 0u);
  EXPECT_EQ(prepared.statistics().polygons, 0u);
  EXPECT_TRUE(prepared.statistics().bounds.empty());
  EXPECT_TRUE(prepared.data().bvh.nodes.empty());
  EXPECT_EQ(prepared.objects().size(), 1u);  // triangles without a name belong to "scene"
}

TEST(PreparedScene, RefusesSoupThatDoesNotHoldTogether) {
  const auto refused = [](const std::function<void(Scene&)>& change) {
    Scene scene = SceneBuilder().box("block", {0, 0, 0}, {1, 1, 1});
    change(scene);
    return testing::code_of([&] { const PreparedScene prepared(scene); });
  };
  EXPECT_EQ(refused([](Scene&) {}), std::nullopt);
  EXPECT_EQ(refused([](Scene& s) { s.mesh.triangles[3][1] = 8; }), ErrorCode::index_out_of_range);
  EXPECT_EQ(refused([](Scene& s) { s.object_of[3] = 1; }), ErrorCode::index_out_of_range);
  EXPECT_EQ(refused([](Scene& s) { s.object_of.pop_back(); }), ErrorCode::array_sizes_differ);
  EXPECT_EQ(refused([](Scene& s) { s.mesh.vertices[3].z() = std::nan(""); }), ErrorCode::coordinate_not_finite);
  EXPECT_EQ(refused([](Scene& s) { s.mesh.vertices[5].x() = -1.001e9; }), ErrorCode::coordinate_too_large);
  EXPECT_EQ(refused([](Scene& s) { s.mesh.vertices[5].x() = -1e9; }), std::nullopt);
}

TEST(PreparedScene, WhatHidesNothingDoesNotMoveTheOrigin) {
  const Vec3 utm(580000.3, 4785000.7, 1000.1);
  Scene scene = SceneBuilder().box("block", utm, utm + Vec3(4, 2, 6));
  const PreparedScene clean(scene);
  scene.mesh.vertices.push_back(Vec3::Zero());  // used by no triangle
  EXPECT_EQ(PreparedScene(scene).data().origin, clean.data().origin);
  EXPECT_EQ(PreparedScene(scene).statistics().bounds.min, utm);
  const auto stray = static_cast<std::uint32_t>(scene.mesh.vertices.size() - 1);
  scene.mesh.triangles.push_back({stray, stray, stray});
  scene.object_of.push_back(0);
  const PreparedScene prepared(scene);
  EXPECT_EQ(prepared.statistics().degenerate_triangles, 1u);
  EXPECT_EQ(prepared.data().origin, clean.data().origin);
  EXPECT_EQ(prepared.data().vertices.front(), clean.data().vertices.front());
}

TEST(PreparedScene, ReportsProgressAndStops) {
  const Scene scene = SceneBuilder().box("block", {0, 0, 0}, {1, 1, 1});
  const auto story = testing::check_progress([&](const Progress& progress) { const PreparedScene p(scene, progress); });
  ASSERT_EQ(story.stages.size(), 1U);
  EXPECT_EQ(story.last_fraction.at(story.stages[0]), 1);
  testing::expect_wording(story.stages[0]);
}

}  // namespace
}  // namespace vantage
