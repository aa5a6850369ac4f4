// Dubins paths: their ends, their lengths, and what they do where input is degenerate.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "support/random.h"
#include "support/wording.h"
#include "vantage/dubins.h"

namespace vantage {
namespace {

constexpr double kPi = std::numbers::pi;

double angle_between(double a, double b) { return std::abs(std::remainder(a - b, 2 * kPi)); }

/// How far the path's end is from where it should be, and how much it points elsewhere, times the radius.
double end_error(const DubinsPath& path, const PlanePose& to) {
  const PlanePose end = path.at(path.length_m());
  return std::hypot(end.x_m - to.x_m, end.y_m - to.y_m) +
         path.radius_m * angle_between(end.heading_rad, to.heading_rad);
}

PlanePose random_pose(testing::Random& random, double spread, double offset) {
  const double x = offset + random.uniform(-spread, spread), y = offset + random.uniform(-spread, spread);
  return {x, y, random.uniform(-10, 10)};
}

TEST(Dubins, EveryWordEndsWhereItShould) {
  testing::Random random(11);
  std::array<int, 6> chosen = {};
  for (int i = 0; i < 20'000; ++i) {
    const double radius = std::pow(10, random.uniform(-3, 4)), spread = radius * std::pow(10, random.uniform(-2, 2));
    const double offset = random.chance(0.3) ? 5e6 : 0;
    const PlanePose from = random_pose(random, spread, offset), to = random_pose(random, spread, offset);
    const double allowed = 1e-9 * (radius + spread) + 1e-15 * offset;
    double shortest = std::numeric_limits<double>::infinity();
    for (int w = 0; w < 6; ++w) {
      const std::optional<DubinsPath> path = dubins_of_word(static_cast<DubinsWord>(w), from, to, radius);
      if (!path) continue;
      // Adding to coordinates of a map rounds, too.
      EXPECT_LE(end_error(*path, to), allowed + 8 * offset * 2.3e-16) << name_of(path->word);
      shortest = std::min(shortest, path->length_m());
    }
    const DubinsPath best = shortest_dubins(from, to, radius);
    EXPECT_EQ(best.length_m(), shortest);
    EXPECT_GE(best.length_m(), std::hypot(from.x_m - to.x_m, from.y_m - to.y_m) - allowed);
    ++chosen[static_cast<std::size_t>(best.word)];
  }
  for (const int count : chosen) EXPECT_GT(count, 50);
}

TEST(Dubins, LengthsOfPathsThatAreKnown) {
  EXPECT_NEAR(shortest_dubins({0, 0, 0}, {10, 0, 0}, 1).length_m(), 10, 1e-12);
  EXPECT_NEAR(shortest_dubins({0, 0, 0}, {0, 2, kPi}, 1).length_m(), kPi, 1e-12);
  EXPECT_NEAR(shortest_dubins({0, 0, 0}, {0, 0, kPi}, 1).length_m(), 7 * kPi / 3, 1e-12);  // three arcs
  EXPECT_EQ(shortest_dubins({0, 0, 0}, {0, 0, kPi}, 1).word, DubinsWord::rlr);
  EXPECT_NEAR(shortest_dubins({0, 0, 0}, {-10, 0, 0}, 1).length_m(), 10 + 2 * kPi, 1e-12);
}

TEST(Dubins, SamePoseTakesNoLoop) {
  testing::Random random(12);
  for (int i = 0; i < 5'000; ++i) {
    const PlanePose pose = random_pose(random, 1000, random.chance(0.5) ? 5e6 : 0);
    const double radius = std::pow(10, random.uniform(-6, 6));
    EXPECT_LE(shortest_dubins(pose, pose, radius).length_m(), 1e-9 * radius);
    // A little ahead, on the same line, and a full turn of the heading more.
    const double ahead = random.uniform(0.1, 100);
    const PlanePose to = {pose.x_m + ahead * std::cos(pose.heading_rad), pose.y_m + ahead * std::sin(pose.heading_rad),
                          pose.heading_rad + 2 * kPi * random.integer(-3, 3)};
    if (pose.x_m > 1e6 || radius < 1e-2 || radius > 1e3) continue;
    EXPECT_NEAR(shortest_dubins(pose, to, radius).length_m(), ahead, 1e-6 * (ahead + radius));
  }
}

TEST(Dubins, TinyRadiusIsTheStraightLine) {
  const DubinsPath path = shortest_dubins({5e6, 5e6, 1}, {5e6 + 300, 5e6 + 400, -2}, 1e-6);
  EXPECT_NEAR(path.length_m(), 500, 1e-4);
}

TEST(Dubins, AWayIsContinuous) {
  testing::Random random(13);
  for (int i = 0; i < 500; ++i) {
    const PlanePose from = random_pose(random, 50, 0), to = random_pose(random, 50, 0);
    const DubinsPath path = shortest_dubins(from, to, 7);
    const double step = path.length_m() / 97;
    for (int k = 0; k < 97; ++k) {
      const PlanePose a = path.at(k * step), b = path.at((k + 1) * step);
      EXPECT_LE(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), step * (1 + 1e-9));
      EXPECT_LE(angle_between(a.heading_rad, b.heading_rad), step / 7 + 1e-9);
    }
  }
}

TEST(Dubins, RefusesWhatIsNoPathOrRadius) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  testing::expect_error([&] { shortest_dubins({nan, 0, 0}, {}, 1); }, ErrorCode::coordinate_not_finite, "dubins");
  testing::expect_error([&] { shortest_dubins({}, {}, 0); }, ErrorCode::value_out_of_range, "dubins");
  testing::expect_code([&] { shortest_dubins({}, {}, nan); }, ErrorCode::value_out_of_range, "dubins");
  testing::expect_error([&] { dubins_airplane({}, {}, {40, 0.1, 0.3}); }, ErrorCode::value_out_of_range, "dubins");
  const DubinsAirplanePath path = *dubins_airplane({}, {Vec3(100, 0, 0)}, {40, -0.2, 0.3});
  testing::expect_error([&] { path.stations(0); }, ErrorCode::value_out_of_range, "dubins");
}

struct Curve {
  double least_radius = std::numeric_limits<double>::infinity(), lowest = 0, highest = 0;
  double climb_error = 0;  ///< of what it says, against chords of half a metre
};

/// Curvature from dense points: the circle through three of them. Breaks between pieces hold chords of both.
Curve measure(const DubinsAirplanePath& path) {
  Curve curve;
  const double length = path.length_m();
  const int count = std::max(8, static_cast<int>(length / 0.5));
  std::vector<SpacePose> poses;
  for (int i = 0; i <= count; ++i) poses.push_back(path.at(length * i / count));
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const Vec3 a = poses[i + 1].position - poses[i].position;
    const double climb = poses[i].climb_rad;
    curve.lowest = std::min(curve.lowest, climb);
    curve.highest = std::max(curve.highest, climb);
    curve.climb_error = std::max(curve.climb_error, std::abs(std::atan2(a.z(), a.head<2>().norm()) - climb));
    if (i == 0) continue;
    const Vec3 b = poses[i].position - poses[i - 1].position;
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    curve.least_radius = std::min(curve.least_radius, turn > 0 ? length / count / turn : 1e300);
  }
  return curve;
}

TEST(DubinsAirplane, KeepsItsLimitsAndEndsWhereItShould) {
  testing::Random random(14);
  for (int i = 0; i < 400; ++i) {
    const WingLimits limits = {random.uniform(10, 60), -random.uniform(0.1, 0.5), random.uniform(0.1, 0.5)};
    const auto pose = [&] {
      SpacePose p;
      p.position = random.point(-200, 200);
      if (random.chance(0.3)) p.position.z() = 50;
      p.heading_rad = random.uniform(-4, 4);
      p.climb_rad = random.chance(0.5) ? 0 : random.uniform(limits.lowest_climb_rad, limits.highest_climb_rad);
      return p;
    };
    const SpacePose from = pose(), to = pose();
    const std::optional<DubinsAirplanePath> path = dubins_airplane(from, to, limits);
    ASSERT_TRUE(path);
    const SpacePose end = path->at(path->length_m());
    EXPECT_LE((end.position - to.position).norm(), 1e-6);
    EXPECT_LE(angle_between(end.heading_rad, to.heading_rad), 1e-7);
    EXPECT_LE(angle_between(end.climb_rad, to.climb_rad), 1e-7);
    const Curve curve = measure(*path);
    EXPECT_GE(curve.least_radius, limits.turn_radius_m * 0.999);
    EXPECT_GE(curve.lowest, limits.lowest_climb_rad - 1e-9);
    EXPECT_LE(curve.highest, limits.highest_climb_rad + 1e-9);
    EXPECT_LE(curve.climb_error, 0.06);  // half a metre on a circle of 10 m
    const double climb = to.position.z() - from.position.z();
    const double steepest = std::sin(climb > 0 ? limits.highest_climb_rad : -limits.lowest_climb_rad);
    EXPECT_GE(path->length_m(), std::abs(climb) / steepest - 1e-6);
    EXPECT_GE(path->length_m(), (to.position - from.position).norm() - 1e-6);
  }
}

TEST(DubinsAirplane, ChordsKeepTheirDistanceFromThePath) {
  testing::Random random(15);
  for (int i = 0; i < 100; ++i) {
    const WingLimits limits = {40, -0.26, 0.35};
    const SpacePose from = {random.point(-200, 200), random.uniform(-4, 4), 0};
    const SpacePose to = {random.point(-200, 200), random.uniform(-4, 4), 0};
    const std::optional<DubinsAirplanePath> path = dubins_airplane(from, to, limits);
    ASSERT_TRUE(path);
    const double allowed = std::pow(10, random.uniform(-2, 0));
    const std::vector<double> stations = path->stations(allowed);
    EXPECT_EQ(stations.front(), 0);
    EXPECT_NEAR(stations.back(), path->length_m(), 1e-9);
    for (std::size_t s = 0; s + 1 < stations.size(); ++s) {
      EXPECT_LE(stations[s], stations[s + 1]);
      const Vec3 a = path->at(stations[s]).position, b = path->at(stations[s + 1]).position;
      for (const double share : {0.25, 0.5, 0.75}) {
        const Vec3 p = path->at(stations[s] + share * (stations[s + 1] - stations[s])).position - a;
        const Vec3 along = b - a;
        const double t = along.squaredNorm() > 0 ? std::clamp(p.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
        EXPECT_LE((p - t * along).norm(), allowed * (1 + 1e-9));
      }
    }
  }
}

TEST(DubinsAirplane, ClimbsAboveItself) {
  // 100 m straight up, at 20 degrees at most: the way must be 292 m or more.
  const std::optional<DubinsAirplanePath> path =
      dubins_airplane({}, {Vec3(0, 0, 100), 0, 0}, {10, -0.26, 20 * kPi / 180});
  ASSERT_TRUE(path);
  EXPECT_GE(path->length_m(), 100 / std::sin(20 * kPi / 180));
  EXPECT_FALSE(dubins_airplane({}, {Vec3(0, 0, 100), 0, 0.5}, {10, -0.26, 0.3}));  // steeper than it can
}

}  // namespace
}  // namespace vantage
