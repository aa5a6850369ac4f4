// Networks of triangles over rasters: Delaunay, within the error, and what stands on them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/raster_writer.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "terrain/post_positions.h"
#include "terrain/surface.h"
#include "terrain/tin.h"
#include "vantage/error.h"

namespace vantage::terrain {
namespace {

using testing::make_raster;
using testing::TestRaster;
using testing::write_raster;

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double area(const Mesh& mesh, const Triangle& t) {
  const Vec2 a = mesh.vertices[t[0]].head<2>();
  return cross(mesh.vertices[t[1]].head<2>() - a, mesh.vertices[t[2]].head<2>() - a) / 2;
}

/// A mesh that covers [min, max] once: no triangle is turned over, their areas add up, and every edge is shared by two
/// triangles or lies on the border.
void expect_tiling(const Mesh& mesh, const Vec2& min, const Vec2& max) {
  double sum = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    ASSERT_GT(area(mesh, t), 0);
    sum += area(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  EXPECT_NEAR(sum, (max - min).prod(), 1e-9 * (max - min).prod());
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    if (edges.count({edge.second, edge.first})) continue;
    const Vec2 a = mesh.vertices[edge.first].head<2>(), b = mesh.vertices[edge.second].head<2>();
    const bool on_border = (a.x() == b.x() && (a.x() == min.x() || a.x() == max.x())) ||
                           (a.y() == b.y() && (a.y() == min.y() || a.y() == max.y()));
    ASSERT_TRUE(on_border) << a.transpose() << " - " << b.transpose();
  }
}

/// The height over a place, by trying every triangle.
std::optional<double> slow_height(const Mesh& mesh, const Vec2& at) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double whole = area(mesh, t) * 2;
    const double u = cross(b.head<2>() - at, c.head<2>() - at) / whole,
                 v = cross(c.head<2>() - at, a.head<2>() - at) / whole;
    if (u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9) return u * a.z() + v * b.z() + (1 - u - v) * c.z();
  }
  return std::nullopt;
}

Mesh mesh_of_all(const Tin& tin) {
  Mesh mesh;
  mesh.vertices = tin.points();
  for (const Tin::Facet& facet : tin.facets()) mesh.triangles.push_back(facet.corner);
  return mesh;
}

Tin unit_square(double side = 1) {
  return Tin({Vec3(0, 0, 0), Vec3(side, 0, 0), Vec3(side, side, 0), Vec3(0, side, 0)});
}

// ---- the network -------------------------------------------------------------------------------------------------

/// No vertex lies inside the circle round a triangle, beyond rounding.
void expect_delaunay(const Mesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    const Vec2 a = mesh.vertices[t[0]].head<2>(), b = mesh.vertices[t[1]].head<2>() - a,
               c = mesh.vertices[t[2]].head<2>() - a;
    const double d = 2 * cross(b, c);
    const Vec2 center(  // of the circle, from a
        (c.y() * b.squaredNorm() - b.y() * c.squaredNorm()) / d,
        (b.x() * c.squaredNorm() - c.x() * b.squaredNorm()) / d);
    for (const Vec3& vertex : mesh.vertices) {
      const double distance = (vertex.head<2>() - a - center).norm();
      ASSERT_GT(distance, center.norm() * (1 - 1e-7));
    }
  }
}

TEST(Tin, IsDelaunayWhateverTheOrder) {
  testing::Random random(11);
  for (int run = 0; run < 30; ++run) {
    Tin tin = unit_square(16);
    const bool on_grid = run % 2 == 0;  // four points on a circle, points on edges and on the border, doubled points
    for (int i = 0; i < 120; ++i) {
      const double x = on_grid ? random.integer(0, 16) : random.uniform(0, 16);
      const double y = on_grid ? random.integer(0, 16) : random.chance(0.1) ? 16 : random.uniform(0, 16);
      const std::uint32_t vertex = tin.insert({x, y, 0});
      EXPECT_EQ(tin.points()[vertex].head<2>(), Vec2(x, y));
    }
    const Mesh mesh = mesh_of_all(tin);
    expect_tiling(mesh, {0, 0}, {16, 16});
    expect_delaunay(mesh);
    for (std::uint32_t f = 0; f < tin.facets().size(); ++f) {  // neighbours know each other
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t beyond = tin.facets()[f].neighbour[i];
        if (beyond == Tin::kNone) continue;
        const auto& back = tin.facets()[beyond].neighbour;
        ASSERT_NE(std::find(back.begin(), back.end(), f), back.end());
      }
    }
  }
}

TEST(Tin, TakesTheWorstFirstAndStopsAtTheError) {
  Tin tin = unit_square(10);
  tin.add_candidates({{3, 3, -5}, {7, 2, -8}, {5, 8, 0.4}, {0, 5, 2}, {5, 10, 0.5}});
  std::vector<double> errors;
  tin.refine(8, [](double) { FAIL() << "nothing is worse than 8"; });
  EXPECT_EQ(tin.facets().size(), 2u);
  tin.refine(7.9, [&](double error) { errors.push_back(error); });
  EXPECT_EQ(errors, (std::vector<double>{8}));  // the point at (7, 2)
  EXPECT_EQ(tin.facets().size(), 4u);
  tin.refine(0, [](double) {});
  EXPECT_EQ(tin.facets().size(), 2u * 5 + 2 - 2);  // two a point, but one a point on the border
  expect_tiling(mesh_of_all(tin), {0, 0}, {10, 10});
}

TEST(Tin, KeepsThePromisedErrorOnRandomHeights) {
  testing::Random random(12);
  for (int run = 0; run < 20; ++run) {
    Tin tin = unit_square(30);
    std::vector<Vec3> candidates;
    for (int y = 0; y <= 30; ++y) {
      for (int x = 0; x <= 30; ++x) {
        const bool corner = (x == 0 || x == 30) && (y == 0 || y == 30);  // these are there already
        candidates.emplace_back(x, y, corner ? 0 : random.chance(0.2) ? random.uniform(0, 9) : 1.0);
      }
    }
    const double error = random.uniform(0, 4);
    tin.add_candidates(candidates);
    tin.refine(error, [](double) {});
    const Mesh mesh = mesh_of_all(tin);
    for (const Vec3& candidate : candidates) {
      ASSERT_LE(std::abs(slow_height(mesh, candidate.head<2>()).value() - candidate.z()), error + 1e-9);
    }
  }
}

// ---- positions ---------------------------------------------------------------------------------------------------

TEST(PostPositions, AreRightToATenthOfAMillimetre) {
  const testing::TemporaryDirectory folder;
  for (const char* srs : {"EPSG:4326", "EPSG:28992", "EPSG:32632", "EPSG:3857"}) {
    TestRaster raster = make_raster(70, 60, [](int, int) { return 1; });
    raster.srs = srs;
    raster.transform = {5.0, 0.005, 0, 52.3, 0, -0.005};  // 24 x 33 km
    if (raster.srs == "EPSG:28992") raster.transform = {85000, 500, 0, 447000, 0, -500};
    if (raster.srs == "EPSG:32632") raster.transform = {500000, 500, 0, 5000000, 0, -500};
    if (raster.srs == "EPSG:3857") raster.transform = {800000, 500, 0, 5400000, 0, -500};
    const HeightGrid grid = read_height_grid(write_raster(folder.path(), "dem", raster));
    const geo::LocalFrame frame(grid.position({20, 30}));
    const std::vector<Vec2> positions = post_positions(grid, frame);
    ASSERT_EQ(positions.size(), 70u * 60u);
    double worst_m = 0;
    for (int row = 0; row < 60; ++row) {
      for (int column = 0; column < 70; ++column) {
        const Vec2 exact = frame.to_local(grid.position(Vec2(column, row)));
        const auto post = std::size_t(row) * 70 + std::size_t(column);
        worst_m = std::max(worst_m, (positions[post] - exact).norm());
      }
    }
    std::cout << srs << ": " << worst_m * 1000 << " mm\n";
    EXPECT_LT(worst_m, 1e-4) << srs;
    EXPECT_GT(worst_m, 0) << srs;  // interpolated, not transformed one by one
  }
}

// ---- the surface -------------------------------------------------------------------------------------------------

/// Hills and single spikes over a square of `side` metres, in few triangles.
Surface random_surface(testing::Random& random, double side) {
  Tin tin = unit_square(side);
  for (int i = 0; i < 60; ++i) {
    tin.insert({random.uniform(0, side), random.uniform(0, side), random.uniform(-20, 20)});
  }
  for (int i = 0; i < 8; ++i) tin.insert({random.uniform(0, side), 0, random.uniform(-20, 20)});
  for (int i = 0; i <= 10; ++i) tin.insert({side / 2, side * i / 10, random.uniform(-20, 20)});  // vertices in line
  return Surface(mesh_of_all(tin));
}

TEST(Surface, HeightIsThatOfTheTriangleThere) {
  testing::Random random(21);
  for (int run = 0; run < 20; ++run) {
    const Surface surface = random_surface(random, 100);
    for (int i = 0; i < 200; ++i) {
      const Vec2 at(random.chance(0.1) ? 100 : random.uniform(0, 100), random.chance(0.1) ? 0 : random.uniform(0, 100));
      ASSERT_TRUE(surface.height(at)) << at.transpose();
      ASSERT_NEAR(*surface.height(at), slow_height(surface.mesh(), at).value(), 1e-6);
    }
    for (const Vec3& vertex : surface.mesh().vertices) {
      ASSERT_NEAR(surface.height(vertex.head<2>()).value(), vertex.z(), 1e-6);
    }
    for (const Vec2& outside : {Vec2(-0.01, 50), Vec2(100.01, 50), Vec2(50, -0.01), Vec2(50, 100.01),
                                Vec2(std::numeric_limits<double>::quiet_NaN(), 5)}) {
      EXPECT_FALSE(surface.height(outside));
    }
  }
}

bool inside_ring(const std::vector<Vec2>& ring, const Vec2& at) {
  double turn = 0;  // the angle that the ring runs round the place
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i] - at, b = ring[(i + 1) % ring.size()] - at;
    turn += std::atan2(cross(a, b), a.dot(b));
  }
  return std::abs(turn) > 3;
}

TEST(Surface, RangeOverAPolygonIsExact) {
  testing::Random random(22);
  for (int run = 0; run < 60; ++run) {
    const Surface surface = random_surface(random, 100);
    const double size = random.chance(0.5) ? random.uniform(1, 10) : random.uniform(10, 45);
    const Vec2 middle(random.uniform(size, 100 - size), random.uniform(size, 100 - size));
    std::vector<Vec2> ring;  // a star, convex or not
    const int corners = random.integer(3, 9);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * M_PI * i / corners, radius = size * random.uniform(0.2, 1);
      ring.push_back(middle + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    if (random.chance(0.3)) std::reverse(ring.begin(), ring.end());
    const std::optional<Surface::Range> range = surface.range(ring);
    ASSERT_TRUE(range);
    // No place is beyond it, and places near those that reach it come close: all vertices inside, many places along the
    // sides, and many inside.
    double lowest = 1e9, highest = -1e9;
    const auto look = [&](const Vec2& at) {
      const double height = slow_height(surface.mesh(), at).value();
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    };
    for (const Vec3& vertex : surface.mesh().vertices) {
      if (inside_ring(ring, vertex.head<2>())) look(vertex.head<2>());
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
      for (int k = 0; k < 400; ++k) look(ring[i] + (ring[(i + 1) % ring.size()] - ring[i]) * k / 400);
    }
    EXPECT_LE(range->lowest, lowest + 1e-6);
    EXPECT_GE(range->highest, highest - 1e-6);
    EXPECT_NEAR(range->lowest, lowest, 1.5);  // a 400th of a side of up to 90 m, on slopes of up to 8 in 1
    EXPECT_NEAR(range->highest, highest, 1.5);
  }
}

TEST(Surface, RangeMeetsEdgesBetweenCornersOfThePolygon) {
  // A ridge along x = 50, 10 high: a polygon across it has its corners lower, and no vertex of the terrain inside.
  const Surface roof(Mesh{{{0, 0, 0}, {50, 0, 10}, {100, 0, 0}, {100, 100, 0}, {50, 100, 10}, {0, 100, 0}},
                          {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}}});
  const auto across = roof.range({{40, 40}, {60, 40}, {60, 60}, {40, 60}});
  EXPECT_NEAR(across->lowest, 8, 1e-12);
  EXPECT_NEAR(across->highest, 10, 1e-12);
  const auto beside = roof.range({{10, 10}, {20, 10}, {20, 20}});
  EXPECT_NEAR(beside->lowest, 2, 1e-12);
  EXPECT_NEAR(beside->highest, 4, 1e-12);
  EXPECT_NEAR(roof.range({{0, 0}, {100, 0}, {100, 100}, {0, 100}})->highest, 10, 1e-12);  // all of it
  EXPECT_NEAR(roof.range({{30, 30}})->highest, 6, 1e-12);                                 // a point
  EXPECT_FALSE(roof.range({{40, 40}, {101, 40}, {60, 60}}));
  EXPECT_FALSE(roof.range({}));
  EXPECT_EQ(roof.height({50, 30}), 10.0);
}

// ---- from rasters ------------------------------------------------------------------------------------------------

double hills(double x, double y) { return 40 * std::sin(x / 90) * std::cos(y / 60) + 5 * std::sin(x / 13 + y / 17); }

TEST(Triangulate, KeepsTheErrorOverTheExactRectangle) {
  const testing::TemporaryDirectory folder;
  const auto file =
      write_raster(folder.path(), "dem", make_raster(120, 100, [](int c, int r) { return hills(10 * c, 10 * r); }));
  const HeightGrid all = read_height_grid(file);
  const geo::LonLat origin = all.position({60, 50});
  const geo::LocalFrame frame(origin);
  const Vec2 min(-400.5, -333.25), max(450, 300);
  const HeightGrid grid = read_height_grid(file, Window{origin, min, max});
  std::size_t before = 0;
  for (const double error_m : {4.0, 1.0, 0.25, 0.0}) {
    const Triangulation result = triangulate(grid, frame, min, max, error_m);
    const Mesh& mesh = result.surface.mesh();
    expect_tiling(mesh, min, max);
    EXPECT_LE(result.largest_error_m, error_m + 1e-3);
    EXPECT_NEAR(double(result.posts), 85 * 63, 200);
    EXPECT_GT(mesh.triangles.size(), before);
    before = mesh.triangles.size();
    // At every post, by other means.
    double worst_m = 0;
    for (int row = 0; row < all.rows; ++row) {
      for (int column = 0; column < all.columns; ++column) {
        const Vec2 at = frame.to_local(all.position(Vec2(column, row)));
        if ((at - min).minCoeff() < 0 || (max - at).minCoeff() < 0) continue;
        worst_m = std::max(worst_m, std::abs(*result.surface.height(at) - hills(10 * column, 10 * row)));
      }
    }
    EXPECT_NEAR(worst_m, result.largest_error_m, 1e-3 + (error_m > 0 ? 0.1 * error_m : 0));
    // Along the border and at the corners, where the grid is bilinear.
    for (int i = 0; i <= 200; ++i) {
      const Vec2 at(min.x() + (max.x() - min.x()) * i / 200, i % 2 ? min.y() : max.y());
      const double bilinear = all.height_m(all.column_row(frame.to_lonlat(at)));
      EXPECT_NEAR(*result.surface.height(at), bilinear, error_m + 0.1);
    }
  }
  EXPECT_GT(before, 2u * 5000);  // error 0: every post
}

TEST(Triangulate, NeedsTwoTrianglesForAPlane) {
  const testing::TemporaryDirectory folder;
  TestRaster raster = make_raster(200, 200, [](int, int) { return 12.5; });
  const HeightGrid grid = read_height_grid(write_raster(folder.path(), "flat", raster));
  const geo::LocalFrame frame(grid.position({100, 100}));
  const Triangulation flat = triangulate(grid, frame, {-500, -500}, {500, 500}, 0);
  EXPECT_EQ(flat.surface.mesh().triangles.size(), 2u);
  EXPECT_EQ(flat.largest_error_m, 0);
}

TEST(Triangulate, RefusesWhatMakesNoTerrain) {
  const testing::TemporaryDirectory folder;
  const HeightGrid grid =
      read_height_grid(write_raster(folder.path(), "dem", make_raster(9, 9, [](int, int) { return 1; })));
  const geo::LocalFrame frame(grid.position({4, 4}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(triangulate(grid, frame, {-10, -10}, {-10, 10}, 1), Error);
  EXPECT_THROW(triangulate(grid, frame, {-10, nan}, {10, 10}, 1), Error);
  EXPECT_THROW(triangulate(grid, frame, {-10, -10}, {10, 10}, -1), Error);
  EXPECT_THROW(triangulate(grid, frame, {-10, -10}, {10, 10}, nan), Error);
  EXPECT_THROW(triangulate(grid, frame, {-100, -10}, {10, 10}, 1), Error);  // beyond the posts
  try {
    triangulate(grid, frame, {-10, -10}, {10, 10}, 1, [](std::string_view, double) { return false; });
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Triangulate, MonacoOnTheShuttlesHeights) {
  VANTAGE_REQUIRE_SHARED("osm-terrain/N43E007.hgt.zip");
  const geo::LonLat monaco{7.42, 43.735};
  const Vec2 half(1000, 1000);
  auto start = std::chrono::steady_clock::now();
  const HeightGrid grid =
      read_height_grid(testing::shared_data("osm-terrain/N43E007.hgt.zip"), Window{monaco, -half, half});
  const double read_s = seconds_since(start);
  start = std::chrono::steady_clock::now();
  const Triangulation result = triangulate(grid, geo::LocalFrame(monaco), -half, half, 0.5);
  std::cout << "2 x 2 km: " << result.posts << " posts, " << grid.voids << " voids, "
            << result.surface.mesh().triangles.size() << " triangles, largest error " << result.largest_error_m
            << " m; read in " << read_s << " s, triangulated in " << seconds_since(start) << " s\n";
  expect_tiling(result.surface.mesh(), -half, half);
  EXPECT_LE(result.largest_error_m, 0.5 + 1e-3);
  EXPECT_LT(result.surface.mesh().triangles.size(), 2 * result.posts);
  const auto range = result.surface.range({{-1000, -1000}, {1000, -1000}, {1000, 1000}, {-1000, 1000}});
  double lowest = 1e9, highest = -1e9;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 at = geo::LocalFrame(monaco).to_local(grid.position(Vec2(column, row)));
      if (at.cwiseAbs().maxCoeff() > 1000) continue;
      lowest = std::min(lowest, double(grid.at(column, row)));
      highest = std::max(highest, double(grid.at(column, row)));
    }
  }
  EXPECT_NEAR(range->lowest, lowest, 0.5);
  EXPECT_GE(range->highest, highest - 0.5);
  EXPECT_LT(range->highest, highest + 50);  // on the border, between posts inside and outside
  EXPECT_GT(highest, 300);                  // above the town
}

TEST(HeavyTriangulate, AMillionPostsInSeconds) {
  VANTAGE_REQUIRE_SHARED("osm-terrain/N43E007.hgt.zip");
  const HeightGrid grid = read_height_grid(testing::shared_data("osm-terrain/N43E007.hgt.zip"));
  const geo::LonLat origin{7.5, 43.5};
  const Vec2 half(39000, 50000);
  for (const double error_m : {20.0, 5.0, 1.0}) {
    const auto start = std::chrono::steady_clock::now();
    const Triangulation result = triangulate(grid, geo::LocalFrame(origin), -half, half, error_m);
    std::cout << result.posts << " posts, " << error_m << " m: " << result.surface.mesh().triangles.size()
              << " triangles, largest error " << result.largest_error_m << " m, " << seconds_since(start) << " s\n";
    EXPECT_LE(result.largest_error_m, error_m * 1.01);
  }
}

}  // namespace
}  // namespace vantage::terrain
