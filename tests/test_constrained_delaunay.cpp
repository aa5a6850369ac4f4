// The constrained Delaunay triangulation: what it must be, by the exact predicates, and against the library CDT.
#include <CDT.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/orientation.h"
#include "exact/constrained_delaunay.h"
#include "support/internals.h"
#include "support/random.h"

namespace vantage {
namespace {

using exact::ConstrainedDelaunay;
using testing::Random;
using Point = ConstrainedDelaunay::Point;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr double kSnap = 1e-9;
constexpr std::uint32_t kOwn = ConstrainedDelaunay::kOwn;

Edge sorted(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

/// All facets run counter-clockwise and name each other, and no circle round one holds the corner across a side that is
/// no constraint.
void expect_right(const ConstrainedDelaunay& made) {
  ASSERT_TRUE(made.failure().empty()) << made.failure();
  const auto& facets = made.facets();
  const auto at = [&](std::uint32_t v) { return made.vertices()[v]; };
  EXPECT_EQ(facets.size(), 2 * (made.vertices().size() - 1) - 3) << "by Euler, of a triangulated triangle";
  for (std::uint32_t t = 0; t < facets.size(); ++t) {
    const auto& [a, b, c] = facets[t].vertices;
    ASSERT_GT(core::turn(at(a), at(b), at(c)), 0) << t;
    for (unsigned i = 0; i < 3; ++i) {
      const std::uint32_t across = facets[t].neighbours[i];
      if (across == ConstrainedDelaunay::kNone) {
        EXPECT_TRUE(facets[t].vertices[i] < kOwn && facets[t].vertices[(i + 1) % 3] < kOwn);
        continue;
      }
      const auto& other = facets[across];
      unsigned k = 0;
      while (k < 3 && other.vertices[k] != facets[t].vertices[(i + 1) % 3]) ++k;
      ASSERT_LT(k, 3u);
      ASSERT_EQ(other.vertices[(k + 1) % 3], facets[t].vertices[i]);
      ASSERT_EQ(other.neighbours[k], t);
      ASSERT_EQ(other.constraints >> k & 1, facets[t].constraints >> i & 1);
      if (facets[t].constraints >> i & 1) continue;
      const Point d = at(other.vertices[(k + 2) % 3]);
      EXPECT_LE(predicates::incircle(at(a).x(), at(a).y(), at(b).x(), at(b).y(), at(c).x(), at(c).y(), d.x(), d.y()), 0)
          << t << " " << across;
    }
  }
}

std::set<Edge> constraints_of(const ConstrainedDelaunay& made) {
  std::set<Edge> edges;
  for (const auto& facet : made.facets()) {
    for (unsigned i = 0; i < 3; ++i) {
      if (facet.constraints >> i & 1) edges.insert(sorted(facet.vertices[i], facet.vertices[(i + 1) % 3]));
    }
  }
  return edges;
}

/// Whether constraints lead from one point to another along the straight line, give or take `off`.
bool leads(const ConstrainedDelaunay& made, const std::set<Edge>& edges, std::uint32_t from, std::uint32_t to,
           double off) {
  const Point begin = made.vertices()[from], way = made.vertices()[to] - begin;
  while (from != to) {
    std::uint32_t next = from;
    double farthest = way.dot(made.vertices()[from] - begin);
    for (const auto& [a, b] : edges) {
      if (a != from && b != from) continue;
      const std::uint32_t end = a == from ? b : a;
      const Point there = made.vertices()[end] - begin;
      const double beside = std::abs(way.x() * there.y() - way.y() * there.x()) / way.norm();
      if (beside > off || way.dot(there) <= farthest || way.dot(there) > way.squaredNorm() * (1 + 1e-12)) continue;
      farthest = way.dot(there);
      next = end;
    }
    if (next == from) return false;
    from = next;
  }
  return true;
}

/// By the library: the triangles that have none of its own vertices, each from its least corner on.
std::set<Triangle> triangles_of_library(const std::vector<Point>& points, const std::vector<Edge>& edges) {
  CDT::Triangulation<double> library(CDT::VertexInsertionOrder::Auto, CDT::IntersectingConstraintEdges::TryResolve,
                                     kSnap);
  std::vector<CDT::V2d<double>> given;
  for (const Point& p : points) given.emplace_back(p.x(), p.y());
  library.insertVertices(given);
  std::vector<CDT::Edge> constraints;
  for (const auto& [a, b] : edges) constraints.emplace_back(a, b);
  library.insertEdges(constraints);
  std::set<Triangle> found;
  for (const auto& t : library.triangles) {
    Triangle triangle{t.vertices[0], t.vertices[1], t.vertices[2]};
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    if (triangle[0] >= kOwn) found.insert(triangle);
  }
  return found;
}

std::set<Triangle> triangles_of(const ConstrainedDelaunay& made) {
  std::set<Triangle> found;
  for (const auto& facet : made.facets()) {
    Triangle triangle = facet.vertices;
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    if (triangle[0] >= kOwn) found.insert(triangle);
  }
  return found;
}

std::vector<Point> scattered(Random& random, int count, double size = 1) {
  std::vector<Point> points{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-size, size);
    points.emplace_back(x, random.uniform(-size, size));
  }
  return points;
}

/// Segments that meet at their ends alone. The first four are round all points: beyond them there are the
/// triangulation's own vertices, which each chooses for itself.
std::vector<Edge> apart(Random& random, const std::vector<Point>& points, int tries) {
  std::vector<Edge> edges{{0, 1}, {1, 2}, {2, 3}, {0, 3}};
  const auto last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < tries; ++i) {
    const auto a = static_cast<std::uint32_t>(random.integer(0, last)),
               b = static_cast<std::uint32_t>(random.integer(0, last));
    if (a == b) continue;
    const auto crosses = [&](const Edge& other) {
      const auto& [c, d] = other;
      if (a == c || a == d || b == c || b == d) return false;
      return core::turn(points[a], points[b], points[c]) != core::turn(points[a], points[b], points[d]) &&
             core::turn(points[c], points[d], points[a]) != core::turn(points[c], points[d], points[b]);
    };
    if (std::none_of(edges.begin(), edges.end(), crosses)) edges.push_back(sorted(a, b));
  }
  return edges;
}

ConstrainedDelaunay made_of(const std::vector<Point>& points, const std::vector<Edge>& edges) {
  ConstrainedDelaunay made(kSnap);
  made.add_vertices(points);
  for (const auto& [a, b] : edges) made.add_constraint(a + kOwn, b + kOwn);
  return made;
}

/// Segments that may cross.
std::vector<Edge> any_segments(Random& random, const std::vector<Point>& points, int count) {
  std::vector<Edge> edges;
  const auto last = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < count; ++i) {
    const auto a = static_cast<std::uint32_t>(random.integer(0, last)),
               b = static_cast<std::uint32_t>(random.integer(0, last));
    if (a != b) edges.emplace_back(a, b);
  }
  return edges;
}

/// `off`: how far constraints may lie beside the segments.
void expect_held(const std::vector<Point>& points, const std::vector<Edge>& edges, double off) {
  const ConstrainedDelaunay made = made_of(points, edges);
  expect_right(made);
  const std::set<Edge> held = constraints_of(made);
  for (const auto& [a, b] : edges) EXPECT_TRUE(leads(made, held, a + kOwn, b + kOwn, off)) << a << " " << b;
}

TEST(ConstrainedDelaunay, IsThatOfTheLibraryWhereThereIsOne) {
  Random random(31);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const std::vector<Point> points = scattered(random, random.integer(1, 700));
    const std::vector<Edge> edges = apart(random, points, random.integer(0, 60));
    const ConstrainedDelaunay made = made_of(points, edges);
    expect_right(made);
    EXPECT_EQ(made.vertices().size(), points.size() + kOwn) << "no two of the segments cross";
    EXPECT_EQ(triangles_of(made), triangles_of_library(points, edges));
  }
}

TEST(ConstrainedDelaunay, HoldsSegmentsThatCross) {
  Random random(32);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const std::vector<Point> points = scattered(random, random.integer(4, 200));
    expect_held(points, any_segments(random, points, random.integer(1, 30)), 2e-9);
  }
}

// On lattices points lie on one line and on one circle in great numbers.
TEST(ConstrainedDelaunay, HoldsSegmentsAmongPointsOfALattice) {
  Random random(33);
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const int side = random.integer(2, 14);
    std::vector<Point> points;
    for (int i = 0; i <= side; ++i) {
      for (int j = 0; j <= side; ++j) points.emplace_back(2.0 * i / side - 1, 2.0 * j / side - 1);
    }
    expect_held(points, any_segments(random, points, random.integer(1, 40)), 4e-9);
  }
}

TEST(ConstrainedDelaunay, RunsThroughWhatItPassesWithinTheSnappingDistance) {
  const std::vector<Point> points{{-1, 0},           {1, 0}, {0, 0.5 * kSnap}, {0.5, -0.5 * kSnap},
                                  {-0.5, 3 * kSnap}, {0, 1}, {0, -1}};
  const ConstrainedDelaunay made = made_of(points, {{0, 1}});
  expect_right(made);
  EXPECT_EQ(constraints_of(made), (std::set<Edge>{{kOwn + 0, kOwn + 2}, {kOwn + 2, kOwn + 3}, {kOwn + 1, kOwn + 3}}));
}

TEST(ConstrainedDelaunay, TakesTheSideThatThereIs) {
  ConstrainedDelaunay made = made_of({{-1, 0}, {1, 0}, {0, 1}, {0, -1}}, {{0, 1}});
  made.add_vertices(std::vector<Point>{{0, 0.5 * kSnap}, {0.5, -0.5 * kSnap}});
  made.add_constraint(kOwn + 0, kOwn + 1);
  made.add_constraint(kOwn + 1, kOwn + 0);
  expect_right(made);
  EXPECT_EQ(constraints_of(made), (std::set<Edge>{{kOwn + 0, kOwn + 1}}));
}

TEST(ConstrainedDelaunay, GrowsPointByPoint) {
  Random random(34);
  const std::vector<Point> points = scattered(random, 300);
  ConstrainedDelaunay made = made_of(points, apart(random, points, 30));
  const std::set<Edge> before = constraints_of(made);
  std::vector<Point> centres;
  for (const auto& facet : made.facets()) {
    const auto& [a, b, c] = facet.vertices;
    if (a < kOwn || b < kOwn || c < kOwn) continue;
    centres.emplace_back((made.vertices()[a] + made.vertices()[b] + made.vertices()[c]) / 3);
  }
  made.add_vertices(centres);
  expect_right(made);
  EXPECT_EQ(constraints_of(made), before);
}

// Long constraints that cross, and points that come later all over.
TEST(ConstrainedDelaunay, FindsPointsAmongLongConstraints) {
  Random random(35);
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const std::vector<Point> points = scattered(random, 1500);
    std::vector<Edge> edges = apart(random, points, 0);
    for (const Edge& edge : any_segments(random, points, 100)) edges.push_back(edge);
    ConstrainedDelaunay made = made_of(points, edges);
    for (int i = 0; i < 200; ++i) made.add_vertices(std::vector<Point>{{random.uniform(-1, 1), random.uniform(-1, 1)}});
    expect_right(made);
  }
}

TEST(ConstrainedDelaunay, FailsWherePointsAreInOnePlace) {
  ConstrainedDelaunay made(kSnap);
  made.add_vertices(std::vector<Point>{{0, 0}, {0.5, 0}, {0, 0}});
  EXPECT_FALSE(made.failure().empty());
}

}  // namespace
}  // namespace vantage
