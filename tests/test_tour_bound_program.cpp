// The shortest polyline through hulls in a given order, and the bound of its length.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <vector>

#include "flight/tour/hull.h"
#include "flight/tour/touring_program.h"
#include "support/random.h"

namespace vantage::internal::flight::tour {
namespace {

using testing::Random;

std::vector<Vec3> box_points(const Vec3& min, const Vec3& max) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back((i & 1) != 0 ? max.x() : min.x(), (i & 2) != 0 ? max.y() : min.y(),
                        (i & 4) != 0 ? max.z() : min.z());
  }
  return points;
}

std::vector<const Hull*> pointers(const std::vector<Hull>& hulls) {
  std::vector<const Hull*> list;
  for (const Hull& hull : hulls) list.push_back(&hull);
  return list;
}

TEST(TourBoundHull, FindsTheNearestPoint) {
  const Hull box(box_points({0, 0, 0}, {2, 2, 2}));
  EXPECT_NEAR(box.nearest({5, 1, 1}, 1e-9).distance_m, 3, 1e-9);
  EXPECT_NEAR(box.nearest({5, 6, 1}, 1e-9).distance_m, 5, 1e-9);
  EXPECT_NEAR(box.nearest({3, 3, 3}, 1e-9).distance_m, std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(box.nearest({1, 1, 1}, 1e-9).distance_m, 0, 1e-9);
  EXPECT_NEAR(box.nearest_to_segment({-5, 3, 1}, {9, 3, 1}, 1e-9).distance_m, 1, 1e-9);
}

/// Against all points, and against projected descent.
TEST(TourBoundHull, AgreesWithEveryPoint) {
  Random random(11);
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3> points;
    const int count = random.integer(1, 200);
    for (int i = 0; i < count; ++i) points.push_back(random.point(-1, 1));
    if (random.chance(0.3)) {
      for (Vec3& p : points) p.z() = 0.25;
    }
    if (random.chance(0.3)) {
      for (Vec3& p : points) p = (4 * p).array().round() / 4;
    }
    const Hull hull(points);
    for (int i = 0; i < 20; ++i) {
      const Vec3 direction = i == 0 ? Vec3(0, 0, 1) : random.direction();
      double least = direction.dot(points[0]);
      for (const Vec3& p : points) least = std::min(least, direction.dot(p));
      EXPECT_NEAR(direction.dot(hull.lowest(direction)), least, 1e-14);
    }
    const Vec3 outside = random.point(-3, 3);
    const NearestInHull near = hull.nearest(outside, 1e-7);
    // The plane through the nearest point proves that nothing is nearer.
    if (near.distance_m > 1e-5) {
      const Vec3 normal = (near.point - outside) / near.distance_m;
      EXPECT_GE(normal.dot(hull.lowest(normal) - outside), near.distance_m - 1e-6);
    }
  }
}

TEST(TourBoundProgram, OfPointsIsTheLength) {
  const std::vector<Hull> hulls = {Hull({{0, 0, 0}}), Hull({{3, 0, 0}}), Hull({{3, 4, 0}})};
  TouringProgram program{pointers(hulls), {}, true};
  EXPECT_NEAR(solve_touring(program).bound_m, 12, 1e-7);
  EXPECT_LE(solve_touring(program).bound_m, 12);
  program.closed = false;
  EXPECT_NEAR(solve_touring(program).bound_m, 7, 1e-7);
  program.at_least_m = {10, 0};
  EXPECT_NEAR(solve_touring(program).bound_m, 14, 1e-7);
}

TEST(TourBoundProgram, OfBoxesThatAreKnown) {
  // Two boxes 6 m apart, there and back.
  const std::vector<Hull> two = {Hull(box_points({0, 0, 0}, {2, 2, 2})), Hull(box_points({8, 0, 0}, {9, 5, 5}))};
  EXPECT_NEAR(solve_touring({pointers(two), {}, true}).bound_m, 12, 1e-4);
  EXPECT_LE(solve_touring({pointers(two), {}, true}).bound_m, 12);
  // Boxes that share a point: nothing need be flown.
  const std::vector<Hull> one = {Hull(box_points({0, 0, 0}, {2, 2, 2})), Hull(box_points({1, 1, 1}, {9, 5, 5})),
                                 Hull(box_points({-3, -3, -3}, {1.5, 1.5, 1.5}))};
  EXPECT_NEAR(solve_touring({pointers(one), {}, true}).bound_m, 0, 1e-3);
  // From a point over a mirror to a point: as light goes.
  const std::vector<Hull> mirror = {Hull({{0, 0, 3}}), Hull(box_points({-50, -50, 0}, {50, 50, 0})), Hull({{8, 0, 3}})};
  EXPECT_NEAR(solve_touring({pointers(mirror), {}, false}).bound_m, 10, 1e-4);
  EXPECT_LE(solve_touring({pointers(mirror), {}, false}).bound_m, 10);
}

TEST(TourBoundProgram, CountsADwellingLegInFull) {
  // In, 5 m within a cube of 1 m, out.
  const Hull from({{0, 0, 0}}), to({{10, 0, 0}}), cube(box_points({5, -1, 0}, {6, 1, 1}));
  const TouringProgram program{{&from, &cube, &cube, &to}, {0, 5, 0}, false};
  EXPECT_NEAR(solve_touring(program).bound_m, 5 + 5 + 4, 1e-4);
  EXPECT_LE(solve_touring(program).bound_m, 14);
}

/// Hulls of all sizes and places, some flat, some a point; open or closed; some legs that count as longer than they
/// are. One draw a statement: compilers choose the order of those in one expression, and would test other hulls.
struct RandomProgram {
  explicit RandomProgram(Random& random) {
    const int count = random.integer(2, 12);
    size = std::pow(10.0, random.integer(-3, 4));
    const double spread = random.uniform(0.1, 6);
    for (int k = 0; k < count; ++k) {
      const Vec3 centre = size * random.point(-spread, spread);
      std::vector<Vec3> points;
      const int corners = random.chance(0.2) ? 1 : random.integer(2, 60);
      for (int i = 0; i < corners; ++i) {
        const double away = size * random.uniform(0, 1);
        points.push_back(centre + away * random.direction());
      }
      if (random.chance(0.2)) {
        for (Vec3& p : points) p.z() = centre.z();
      }
      hulls.emplace_back(points);
      all.extend(hulls.back().box());
    }
    program = {pointers(hulls), {}, random.chance(0.5)};
    if (!random.chance(0.3)) return;
    for (std::size_t leg = 0; leg < program.leg_count(); ++leg) {
      program.at_least_m.push_back(random.chance(0.5) ? 0 : size * random.uniform(0, 4));
    }
  }

  double extent_m() const { return (all.max - all.min).norm(); }

  double size = 0;
  std::vector<Hull> hulls;
  Box all;
  TouringProgram program;
};

std::vector<Vec3> any_points(const std::vector<Hull>& hulls, Random& random) {
  std::vector<Vec3> any;
  for (const Hull& hull : hulls) {
    const auto last = static_cast<int>(hull.points().size()) - 1;
    const double share = random.uniform(0, 1);
    const Vec3 one = hull.points()[random.integer(0, last)];
    any.push_back(share * one + (1 - share) * hull.points()[random.integer(0, last)]);
  }
  return any;
}

/// No polyline through points of the hulls is shorter than the bound, whatever the vectors, and that of the solver is
/// tight. Its points lie in the hulls as well as it says.
TEST(TourBoundProgram, IsBelowEveryPolylineAndTight) {
  Random random(12);
  double worst = 0, farthest = 0;
  for (int round = 0; round < 30; ++round) {
    const RandomProgram of(random);
    const TouringProgram& program = of.program;
    SCOPED_TRACE(round);
    const TouringSolution solution = solve_touring(program, {1e-9, 1e-9, 40});
    std::vector<Vec3> inside;
    for (std::size_t k = 0; k < of.hulls.size(); ++k) {
      inside.push_back(of.hulls[k].nearest(solution.points[k], 1e-12 * of.size).point);
      farthest = std::max(farthest, (inside[k] - solution.points[k]).norm() / of.extent_m());
    }
    EXPECT_LE(farthest, kOutsideOfSize);
    const double length = touring_length(program, inside), rounding = 1e-12 * of.size;
    EXPECT_LE(solution.bound_m, length + rounding);
    worst = std::max(worst, (length - solution.bound_m) / std::max(length, of.size));
    EXPECT_LE(length - solution.bound_m, 1e-5 * std::max(length, of.size));
    for (int i = 0; i < 20; ++i) {
      std::vector<Direction> directions;
      for (std::size_t leg = 0; leg < program.leg_count(); ++leg) {
        const double norm = random.uniform(0, 2);
        directions.push_back(direction_of(norm * random.direction()));
      }
      EXPECT_LE(touring_bound(program, directions), length + rounding);
      EXPECT_LE(solution.bound_m, touring_length(program, any_points(of.hulls, random)) + rounding);
    }
  }
  std::cout << "largest gap " << worst << " of the length, points outside of their hulls by " << farthest
            << " of the size of all\n";
}

TEST(TourBoundProgram, DirectionsAreNeverLongerThanOne) {
  Random random(13);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 vector = (i % 3 == 0 ? 1.0 : random.uniform(0, 3)) * random.direction();
    const Direction d = direction_of(vector);
    std::int64_t squared = 0;
    for (const std::int64_t x : d) squared += x * x;
    EXPECT_LE(squared, std::int64_t{1} << (2 * kDirectionBits));
    EXPECT_LE((vector_of(d) - vector / std::max(1.0, vector.norm())).norm(), 2e-9);
  }
}

}  // namespace
}  // namespace vantage::internal::flight::tour
