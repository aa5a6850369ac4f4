// The network of triangles under a terrain: Delaunay, within the error, folded upwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/tiling.h"

namespace vantage::internal::terrain {
namespace {

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
      const auto back = static_cast<std::size_t>(std::find(beyond.neighbour.begin(), beyond.neighbour.end(), f) -
                                                 beyond.neighbour.begin());
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

TEST(Tin, AsksAtEachOfTheFirstInsertions) {  // each of them may move a million candidates
  testing::Random random(12);
  Tin tin = unit_square(100);
  std::vector<Vec3> posts;
  for (int i = 0; i < 500; ++i) posts.push_back(random.point(1, 99));
  tin.add_candidates(posts);
  std::size_t asked = 0;
  tin.refine(0, [&](double) { ++asked; });
  EXPECT_GE(asked, posts.size());
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
      const double angle = 2 * std::numbers::pi * (i + random.uniform(-0.2, 0.2)) / count;
      ring.emplace_back(500 + std::cos(angle), 500 + std::sin(angle), random.uniform(-3, 3));
    }
    std::vector<Vec3> shuffled = ring;
    for (std::size_t i = shuffled.size(); i > 1; --i) {
      std::swap(shuffled[i - 1], shuffled[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
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

}  // namespace
}  // namespace vantage::internal::terrain
