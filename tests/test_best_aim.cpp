// The search for the orientation that takes a target in from nearest by, and the ascent that it stands on.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sensor/best_aim.h"
#include "sensor/rise.h"
#include "support/random.h"
#include "vantage/camera.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using internal::sensor::Aim;
using internal::sensor::AimFinder;
using internal::sensor::Plane2;
using internal::sensor::rise;
using internal::sensor::Room;
using testing::Random;

double least(const std::vector<Plane2>& planes, const Vector2d& place) {
  double result = std::numeric_limits<double>::infinity();
  for (const Plane2& plane : planes) result = std::min(result, plane.at(place));
  return result;
}

/// The highest place is a corner of the room, or where planes cross its sides or each other three by three.
double highest(const std::vector<Plane2>& planes, const Vector2d& min, const Vector2d& max) {
  // As planes a . (x, y, height) = b: those given, then the sides of the room.
  std::vector<Vec3> normals;
  std::vector<double> at;
  for (const Plane2& plane : planes) {
    normals.emplace_back(-plane.slope.x(), -plane.slope.y(), 1);
    at.push_back(plane.value);
  }
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    for (const double side : {min[axis], max[axis]}) {
      normals.push_back(Vec3::Unit(axis));
      at.push_back(side);
    }
  }
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      for (std::size_t k = j + 1; k < normals.size(); ++k) {
        Eigen::Matrix3d rows;
        rows << normals[i].transpose(), normals[j].transpose(), normals[k].transpose();
        if (std::abs(rows.determinant()) < 1e-9) continue;
        const Vec3 place = rows.inverse() * Vec3(at[i], at[j], at[k]);
        const Vector2d flat = place.head<2>();
        if (((flat - min).array() < -1e-9).any() || ((max - flat).array() < -1e-9).any()) continue;
        best = std::max(best, least(planes, flat));
      }
    }
  }
  return best;
}

TEST(BestAim, RisesToTheTopOfTheLeastOfPlanes) {
  Random random(61);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Plane2> planes;
    for (int i = random.integer(1, 8); i > 0; --i) {
      planes.push_back({random.uniform(1, 2), {random.uniform(-5, 5), random.uniform(-5, 5)}});
      if (random.chance(0.2)) planes.back().slope.x() = 0;
    }
    const double reach = random.uniform(0.01, 1);
    const Room room{.reach = reach,
                    .min = {-random.uniform(0, 1), random.chance(0.2) ? 0 : -random.uniform(0, 1)},
                    .max = {random.uniform(0, 1), random.chance(0.2) ? 0 : random.uniform(0, 1)}};
    const Vector2d min = room.min.cwiseMax(-reach), max = room.max.cwiseMin(reach);
    const Vector2d place = rise(planes, room);
    EXPECT_TRUE((place.array() >= min.array()).all() && (place.array() <= max.array()).all()) << "trial " << trial;
    EXPECT_NEAR(least(planes, place), highest(planes, min, max), 1e-8) << "trial " << trial;
  }
}

TEST(BestAim, StaysWhereAllIsFlat) {
  const std::vector<Plane2> flat = {{1, {0, 0}}, {2, {3, 1}}};
  EXPECT_EQ(rise(flat, {.reach = 1, .min = {-1, -1}, .max = {1, 1}}), Vector2d(0, 0));
}

/// What no orientation of a grid does better than by a thousandth.
TEST(BestAim, NoOrientationOfAGridIsBetter) {
  Random random(62);
  constexpr double kDegree = std::numbers::pi / 180;
  for (int trial = 0; trial < 60; ++trial) {
    const Pinhole camera = pinhole_of_fov(random.uniform(20, 110), random.uniform(20, 90), 4000, 3000);
    Mount mount{.min_pitch_deg = random.uniform(-90, -20), .max_pitch_deg = random.uniform(0, 60)};
    if (random.chance(0.3)) mount.yaw_deg = random.uniform(-180, 180);
    if (random.chance(0.3)) mount.roll_deg = random.uniform(-30, 30);
    std::vector<Vec3> corners;
    for (int i = random.integer(3, 7); i > 0; --i) corners.push_back(random.point(-8, 8));
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
    for (Vec3& corner : corners) corner -= middle;
    const AimFinder finder(corners, camera, mount, 1e-3);
    // Not next to the vertical, where several orientations are good and no small turn leads from one to another.
    const double elevation = random.uniform(-30, 45) * kDegree, azimuth = random.uniform(-180, 180) * kDegree;
    const Vec3 direction(std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                         std::sin(elevation));
    const double found = finder.best(direction).distance(direction);
    double best = std::numeric_limits<double>::infinity();
    const Vec3 towards = -direction;
    const Aim at{std::atan2(towards.x(), towards.y()), -elevation};
    constexpr int kSteps = 60;
    for (int i = -kSteps; i <= kSteps; ++i) {
      for (int k = -kSteps; k <= kSteps; ++k) {
        const Aim turned{at.yaw + i * 0.01, at.pitch + k * 0.01};
        best = std::min(best, finder.next_to(turned).distance(direction));
      }
    }
    EXPECT_LE(found, 1.001 * best) << "trial " << trial;
  }
}

}  // namespace
}  // namespace vantage
