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

/// Facets across a side know each other, by the same two corners.
void expect_mutual_neighbours(const Tin& tin) {
  for (std::uint32_t f = 0; f < tin.facets().size(); ++f) {
    const Tin::Facet& facet = tin.facets()[f];
    for (std::size_t i = 0; i < 3; ++i) {
      if (facet.neighbour[i] == Tin::kNone) continue;
      const Tin::Facet& beyond = tin.facets()[facet.neighbour[i]];
      const auto back =
          std::size_t(std::find(beyond.neighbour.begin(), beyond.neighbour.end(), f) - beyond.neighbour.begin());
      ASSERT_LT(back, 3u);
      ASSERT_EQ(beyond.corner[(back + 1) % 3], facet.corner[(i + 2) % 3]);
      ASSERT_EQ(beyond.corner[(back + 2) % 3], facet.corner[(i + 1) % 3]);
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
    expect_mutual_neighbours(tin);
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

TEST(Tin, InsertsWhatMakesAMiddle) {
  // Two posts in a row on a slope that is not between them: their middle is off by 6, they themselves by 5 and 1.
  for (const double error : {6.5, 5.5}) {
    Tin tin = unit_square(10);
    const std::uint32_t first = tin.add_candidates({{4, 2, 5}, {6, 2, -1}, {5, 8, 0.5}, {5, 9, 1}});
    tin.add_middles({{{first, first + 1}}, {{first, first + 1, first + 2, first + 3}}});
    tin.refine(error, [](double) {});
    EXPECT_EQ(tin.facets().size(), 2u) << error;  // the middle is at 2
  }
  Tin tin = unit_square(10);
  const std::uint32_t first = tin.add_candidates({{4, 5, 3}, {6, 5, 3.5}, {5, 8, 0.5}, {5, 3, 1}});
  tin.add_middles({{{first, first + 1, first + 2, first + 3}}});
  tin.refine(3.25 - 1e-9, [](double) {});
  EXPECT_EQ(tin.facets().size(), 4u);  // the second, of 3.5; the middle, of 3.25, is between both then
  tin.refine(1, [](double) {});
  const Mesh mesh = mesh_of_all(tin);
  expect_tiling(mesh, {0, 0}, {10, 10});
  EXPECT_NEAR(slow_height(mesh, {5, 5}).value(), 3.25, 1);
}

/// The upper side of the convex hull of points over a place among them: the highest of all triangles there.
double upper_hull(const std::vector<Vec3>& points, const Vec2& at) {
  double highest = -1e9;
  for (std::uint32_t a = 0; a < points.size(); ++a) {
    for (std::uint32_t b = a + 1; b < points.size(); ++b) {
      for (std::uint32_t c = b + 1; c < points.size(); ++c) {
        highest = std::max(highest, slow_height(Mesh{points, {{a, b, c}}}, at).value_or(-1e9));
      }
    }
  }
  return highest;
}

TEST(Tin, FoldsPointsOnACircleIntoTheirUpperHull) {
  testing::Random random(13);
  for (int run = 0; run < 60; ++run) {
    const int count = random.integer(4, 9);
    std::vector<Vec3> ring;  // counter-clockwise
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * M_PI * (i + random.uniform(-0.2, 0.2)) / count;
      ring.emplace_back(500 + std::cos(angle), 500 + std::sin(angle), random.uniform(-3, 3));
    }
    std::vector<Vec3> shuffled = ring;
    for (std::size_t i = shuffled.size(); i > 1; --i) {
      std::swap(shuffled[i - 1], shuffled[std::size_t(random.integer(0, int(i) - 1))]);
    }
    Tin tin = unit_square(1000);
    for (const Vec3& point : shuffled) tin.insert(point);
    tin.fold_up(0);
    const Mesh mesh = mesh_of_all(tin);
    expect_tiling(mesh, {0, 0}, {1000, 1000});
    expect_mutual_neighbours(tin);
    for (int i = 0; i < 30; ++i) {
      Vec2 at = Vec2::Zero();  // inside
      double sum = 0;
      for (const Vec3& point : ring) {
        const double weight = random.uniform(0, 1);
        at += weight * point.head<2>();
        sum += weight;
      }
      at /= sum;
      ASSERT_NEAR(slow_height(mesh, at).value(), upper_hull(ring, at), 1e-5);
    }
  }
}

TEST(Tin, FoldsOnlyWhereNoCandidateGoesAstray) {
  // A valley from corner to corner, folded as a ridge between the other two; a post says that it is a valley.
  for (const bool has_post : {false, true}) {
    for (const bool turned : {false, true}) {
      Tin tin({Vec3(0, 0, turned ? 4.0 : 0.0), Vec3(10, 0, turned ? 0.0 : 4.0), Vec3(10, 10, turned ? 4.0 : 0.0),
               Vec3(0, 10, turned ? 0.0 : 4.0)});
      if (has_post) tin.add_candidates({{4, 4, turned ? 4.0 : 0.0}});
      tin.refine(1, [](double) {});
      tin.fold_up(1);
      ASSERT_EQ(tin.facets().size(), 2u);
      expect_tiling(mesh_of_all(tin), {0, 0}, {10, 10});
      EXPECT_EQ(slow_height(mesh_of_all(tin), {5, 5}), has_post && !turned ? 0.0 : 4.0);
    }
  }
}

TEST(Tin, LeavesWhatIsOnNoCircle) {
  // A kite: its short diagonal is Delaunay's, beyond doubt, and lower than its long one.
  Tin tin = unit_square(1000);
  for (const Vec3& point : {Vec3(500, 480, 9), Vec3(510, 500, 0), Vec3(500, 520, 9), Vec3(490, 500, 0)}) {
    tin.insert(point);
  }
  tin.fold_up(0);
  expect_delaunay(mesh_of_all(tin));
  EXPECT_EQ(slow_height(mesh_of_all(tin), {500, 500}), 0.0);
}

TEST(Tin, FoldingKeepsTheErrorAndTheNetwork) {
  testing::Random random(14);
  int folded = 0;
  for (int run = 0; run < 30; ++run) {
    Tin tin = unit_square(24);
    std::vector<Vec3> candidates;
    for (int y = 0; y <= 24; ++y) {
      for (int x = 0; x <= 24; ++x) {
        const bool corner = (x == 0 || x == 24) && (y == 0 || y == 24);
        candidates.emplace_back(x, y, corner ? 0 : random.chance(0.4) ? random.uniform(0, 9) : 1.0);
      }
    }
    const double error = random.chance(0.3) ? 0 : random.uniform(0, 4);
    tin.add_candidates(candidates);
    tin.refine(error, [](double) {});
    const Mesh before = mesh_of_all(tin);
    tin.fold_up(error);
    const Mesh mesh = mesh_of_all(tin);
    expect_tiling(mesh, {0, 0}, {24, 24});
    expect_mutual_neighbours(tin);
    for (const Vec3& candidate : candidates) {
      ASSERT_LE(std::abs(slow_height(mesh, candidate.head<2>()).value() - candidate.z()), error + 1e-9);
    }
    for (int i = 0; i < 100; ++i) {  // nowhere lower
      const Vec2 at(random.uniform(0, 24), random.uniform(0, 24));
      const double change = slow_height(mesh, at).value() - slow_height(before, at).value();
      ASSERT_GE(change, -1e-9);
      folded += change > 1e-3;
    }
  }
  EXPECT_GT(folded, 300);
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

/// How far the ground is from where it should be in the cells whose posts all lie in its rectangle: at the posts, on
/// the middles of the cells' sides, and on those of their higher diagonals.
double worst_over_cells(const HeightGrid& grid, const geo::LocalFrame& frame, const Surface& surface, const Vec2& min,
                        const Vec2& max) {
  std::vector<std::optional<Vec3>> posts;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 at = frame.to_local(grid.position(Vec2(column, row)));
      posts.emplace_back(Vec3(at.x(), at.y(), double(grid.at(column, row))));
      if ((at - min).minCoeff() < 0.02 || (max - at).minCoeff() < 0.02) posts.back().reset();
    }
  }
  double worst = 0;
  std::size_t cells = 0;
  const auto look = [&](const Vec3& a, const Vec3& b) {
    const Vec3 middle = (a + b) / 2;
    worst = std::max(worst, std::abs(surface.height(middle.head<2>()).value() - middle.z()));
  };
  for (std::size_t a = 0; a + std::size_t(grid.columns) + 1 < posts.size(); ++a) {
    const std::size_t b = a + 1, c = b + std::size_t(grid.columns), d = c - 1;
    if (b % std::size_t(grid.columns) == 0 || !posts[a] || !posts[b] || !posts[c] || !posts[d]) continue;
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
        if (in_steps) return double(random.integer(0, 2) + (column > 20 ? column / 3 : 0));
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
