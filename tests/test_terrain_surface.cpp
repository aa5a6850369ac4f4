// Terrain over rasters: positions, heights, within the error, and what stands on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "maps/terrain/post_positions.h"
#include "maps/terrain/triangulate.h"
#include "support/random.h"
#include "support/raster_writer.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/tiling.h"
#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

using testing::make_raster;
using testing::TestRaster;
using testing::write_raster;

// ---- positions ----

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
        const auto post = static_cast<std::size_t>(row) * 70 + static_cast<std::size_t>(column);
        worst_m = std::max(worst_m, (positions[post] - exact).norm());
      }
    }
    std::cout << srs << ": " << worst_m * 1000 << " mm\n";
    EXPECT_LT(worst_m, 1e-4) << srs;
    EXPECT_GT(worst_m, 0) << srs;  // interpolated, not transformed one by one
  }
}

// ---- the surface ----

/// Hills and single spikes over a square of `side` metres, in few triangles.
TriangulatedTerrain random_surface(testing::Random& random, double side) {
  Tin tin = unit_square(side);
  for (int i = 0; i < 60; ++i) {
    tin.insert({random.uniform(0, side), random.uniform(0, side), random.uniform(-20, 20)});
  }
  for (int i = 0; i < 8; ++i) tin.insert({random.uniform(0, side), 0, random.uniform(-20, 20)});
  for (int i = 0; i <= 10; ++i) tin.insert({side / 2, side * i / 10, random.uniform(-20, 20)});  // vertices in line
  return TriangulatedTerrain(mesh_of_all(tin));
}

TEST(TriangulatedTerrain, HeightIsThatOfTheTriangleThere) {
  testing::Random random(21);
  for (int run = 0; run < 20; ++run) {
    const TriangulatedTerrain surface = random_surface(random, 100);
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

TEST(TriangulatedTerrain, StopsWhereItIsToldTo) {
  testing::Random random(5);
  const Mesh mesh = random_surface(random, 100).mesh();
  const core::ProgressReporter::AskAlways always;
  int asked = 0;
  const Progress progress = [&](std::string_view, double) { return ++asked < 50; };
  const core::ProgressReporter reporter(progress);
  EXPECT_THROW(TriangulatedTerrain(mesh, reporter), Error);
  EXPECT_EQ(asked, 50);
}

TEST(TriangulatedTerrain, RangeOverAPolygonIsExact) {
  testing::Random random(22);
  for (int run = 0; run < 60; ++run) {
    const TriangulatedTerrain surface = random_surface(random, 100);
    const double size = random.chance(0.5) ? random.uniform(1, 10) : random.uniform(10, 45);
    const Vec2 middle(random.uniform(size, 100 - size), random.uniform(size, 100 - size));
    std::vector<Vec2> ring;  // a star, convex or not
    const int corners = random.integer(3, 9);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, radius = size * random.uniform(0.2, 1);
      ring.push_back(middle + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    if (random.chance(0.3)) std::reverse(ring.begin(), ring.end());
    const std::optional<TriangulatedTerrain::Range> range = surface.range(ring);
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

TEST(TriangulatedTerrain, RangeMeetsEdgesBetweenCornersOfThePolygon) {
  // A ridge along x = 50, 10 high: a polygon across it has its corners lower, and no vertex of the terrain inside.
  const TriangulatedTerrain roof(Mesh{{{0, 0, 0}, {50, 0, 10}, {100, 0, 0}, {100, 100, 0}, {50, 100, 10}, {0, 100, 0}},
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

// ---- from rasters ----

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
    EXPECT_NEAR(static_cast<double>(result.posts), 85 * 63, 200);
    EXPECT_GT(mesh.triangles.size(), before);
    before = mesh.triangles.size();
    // At every post, by other means.
    double worst_m = 0;
    for (int row = 0; row < all.rows; ++row) {
      for (int column = 0; column < all.columns; ++column) {
        const Vec2 at = frame.to_local(all.position(Vec2(column, row)));
        if ((at - min).minCoeff() < 0 || (max - at).minCoeff() < 0) continue;
        worst_m = std::max(worst_m, std::abs(*result.surface.height(at) - hills(10 * column, 10 * row)));
        ASSERT_GE(*result.surface.height(at), hills(10 * column, 10 * row) - 1e-3);  // posts are floats
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

/// How far the ground is from where it should be in the cells whose posts all lie in its rectangle: at the posts, on
/// the middles of the cells' sides, and on those of their higher diagonals.
double worst_over_cells(const HeightGrid& grid, const geo::LocalFrame& frame, const TriangulatedTerrain& surface,
                        const Vec2& min, const Vec2& max) {
  std::vector<std::optional<Vec3>> posts;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 at = frame.to_local(grid.position(Vec2(column, row)));
      posts.emplace_back(Vec3(at.x(), at.y(), static_cast<double>(grid.at(column, row))));
      if ((at - min).minCoeff() < 0.02 || (max - at).minCoeff() < 0.02) posts.back().reset();
    }
  }
  double worst = 0;
  std::size_t cells = 0;
  const auto look = [&](const Vec3& a, const Vec3& b) {
    const Vec3 middle = (a + b) / 2;
    worst = std::max(worst, std::abs(surface.height(middle.head<2>()).value() - middle.z()));
  };
  for (std::size_t a = 0; a + static_cast<std::size_t>(grid.columns) + 1 < posts.size(); ++a) {
    const std::size_t b = a + 1, c = b + static_cast<std::size_t>(grid.columns), d = c - 1;
    if (b % static_cast<std::size_t>(grid.columns) == 0 || !posts[a] || !posts[b] || !posts[c] || !posts[d]) continue;
    ++cells;
    look(*posts[a], *posts[a]);
    look(*posts[a], *posts[b]);
    look(*posts[a], *posts[d]);
    const bool falling = posts[a]->z() + posts[c]->z() >= posts[b]->z() + posts[d]->z();
    falling ? look(*posts[a], *posts[c]) : look(*posts[b], *posts[d]);
  }
  EXPECT_GT(cells, 100u);
  return worst;
}

TEST(Triangulate, TheGroundBetweenPostsDoesNotDependOnTheFrame) {
  const testing::TemporaryDirectory folder;
  testing::Random random(31);
  for (const char* srs : {"EPSG:4326", "EPSG:32632", "EPSG:28992"}) {
    for (const bool in_steps : {false, true}) {  // whole metres, many posts in the plane of their neighbours
      TestRaster raster = make_raster(40, 36, [&](int column, int row) {
        if (in_steps) return static_cast<double>(random.integer(0, 2) + (column > 20 ? column / 3 : 0));
        return 5 * ((column + row) % 2) + random.uniform(-4, 4);  // saddles
      });
      raster.srs = srs;
      if (raster.srs == "EPSG:4326") raster.transform = {7.4, 1.0 / 1200, 0, 43.75, 0, -1.0 / 1200};  // SRTM's
      if (raster.srs == "EPSG:28992") raster.transform = {85000, 25, 0, 447000, 0, -25};
      const HeightGrid grid = read_height_grid(write_raster(folder.path(), "dem", raster));
      for (const double error : {0.0, 0.01, 0.5}) {
        for (const Vec2& origin : {Vec2(20, 18), Vec2(17.3, 19.1), Vec2(-140, 300)}) {
          const geo::LocalFrame frame(grid.position(origin));
          // Not along the posts: within 1 cm of the border they would count as on it.
          const Vec2 from = frame.to_local(grid.position(Vec2(2.6, 32.3))),
                     to = frame.to_local(grid.position(Vec2(36.4, 2.7)));
          const Triangulation ground = triangulate(grid, frame, from, to, error);
          expect_tiling(ground.surface.mesh(), from, to);
          EXPECT_LE(ground.largest_error_m, error + 1e-3);
          const Vec2 cell = (to - from).cwiseAbs() / 32;  // those at the border are cut by it
          EXPECT_LE(worst_over_cells(grid, frame, ground.surface, from + cell, to - cell), error + 1e-3)
              << srs << ", " << error << " m, origin " << origin.transpose() << (in_steps ? ", in steps" : "");
        }
      }
    }
  }
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

TEST(Triangulate, MonacoOnTheShuttlesHeights) {
  VANTAGE_REQUIRE_SHARED("osm-terrain/N43E007.hgt.zip");
  const geo::LonLat monaco{7.42, 43.735};
  const Vec2 half(1000, 1000);
  core::Stopwatch stopwatch;
  const HeightGrid grid =
      read_height_grid(testing::shared_data("osm-terrain/N43E007.hgt.zip"), Window{monaco, -half, half});
  const double read_s = stopwatch.lap();
  const Triangulation result = triangulate(grid, geo::LocalFrame(monaco), -half, half, 0.5);
  std::cout << "2 x 2 km: " << result.posts << " posts, " << grid.voids << " voids, "
            << result.surface.mesh().triangles.size() << " triangles, largest error " << result.largest_error_m
            << " m; read in " << read_s << " s, triangulated in " << stopwatch.lap() << " s\n";
  expect_tiling(result.surface.mesh(), -half, half);
  EXPECT_LE(result.largest_error_m, 0.5 + 1e-3);
  EXPECT_LT(result.surface.mesh().triangles.size(), 2 * result.posts);
  const auto range = result.surface.range({{-1000, -1000}, {1000, -1000}, {1000, 1000}, {-1000, 1000}});
  double lowest = 1e9, highest = -1e9;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 at = geo::LocalFrame(monaco).to_local(grid.position(Vec2(column, row)));
      if (at.cwiseAbs().maxCoeff() > 1000) continue;
      lowest = std::min(lowest, static_cast<double>(grid.at(column, row)));
      highest = std::max(highest, static_cast<double>(grid.at(column, row)));
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
    const core::Stopwatch stopwatch;
    const Triangulation result = triangulate(grid, geo::LocalFrame(origin), -half, half, error_m);
    std::cout << result.posts << " posts, " << error_m << " m: " << result.surface.mesh().triangles.size()
              << " triangles, largest error " << result.largest_error_m << " m, " << stopwatch.seconds() << " s\n";
    EXPECT_LE(result.largest_error_m, error_m * 1.01);
  }
}

}  // namespace
}  // namespace vantage::internal::terrain
