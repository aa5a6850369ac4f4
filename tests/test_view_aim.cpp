// Where a camera is turned: against orientations that are tried one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <vector>

#include "support/flight_cases.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/mission.h"
#include "vantage/sensor.h"
#include "vantage/standpoints.h"

namespace vantage::testing {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

/// By how much all corners are in the picture, as a tangent; negative where one is not. Shares nothing with the
/// library.
double room(const std::vector<Vec3>& corners, const Vec3& from, double yaw_deg, double pitch_deg,
            const Pinhole& camera) {
  const double yaw = yaw_deg * kRadian, pitch = pitch_deg * kRadian;
  double least = 10;
  for (const Vec3& corner : corners) {
    const Vec3 d = corner - from;
    const double along = d.x() * std::sin(yaw) + d.y() * std::cos(yaw);
    const double right = d.x() * std::cos(yaw) - d.y() * std::sin(yaw);
    const double ahead = along * std::cos(pitch) + d.z() * std::sin(pitch);
    const double up = -along * std::sin(pitch) + d.z() * std::cos(pitch);
    if (!(ahead > 0)) return -1;
    least = std::min({least, camera.half_width - std::abs(right) / ahead, camera.half_height - std::abs(up) / ahead});
  }
  return least;
}

Mission seen_by(const std::vector<Vec3>& corners, const Pinhole& camera, const Mount& mount) {
  SceneBuilder builder;
  builder.ground("ground", 1000, -50);
  Mission mission = mission_in(builder, target_of(corners), 500);
  mission.sensor.camera = camera;
  mission.sensor.mount = mount;
  return mission;
}

TEST(ViewAim, HasTheWholeTargetInThePictureWhereSomeOrientationHas) {
  const std::uint64_t seed = 7;
  std::cout << "seed " << seed << "\n";
  Random random(seed);
  int whole = 0, off_centre = 0;
  for (int round = 0; round < 120; ++round) {
    SCOPED_TRACE(round);
    // A flat polygon with most of its corners at one side: its middle is not where the picture's has to be.
    const double length = random.uniform(5, 40), width = random.uniform(2, 20);
    const std::vector<Vec3> corners = {{0, 0, 0},
                                       {length, 0, 0},
                                       {1.02 * length, 0.3 * width, 0},
                                       {1.03 * length, 0.5 * width, 0},
                                       {1.02 * length, 0.7 * width, 0},
                                       {length, width, 0},
                                       {0, width, 0}};
    Pinhole camera;
    camera.half_width = std::tan(random.uniform(15, 40) * kRadian);
    camera.half_height = std::tan(random.uniform(10, 30) * kRadian);
    const double lowest = random.uniform(-90, -30);
    Mount mount;
    if (random.integer(0, 1) == 1) {
      mount.min_pitch_deg = lowest;
      mount.max_pitch_deg = random.uniform(lowest, 20);
    }
    const Vec3 from(random.uniform(-40, 60), random.uniform(-40, 60), random.uniform(3, 60));
    const ViewDescription view = ViewDescriber(seen_by(corners, camera, mount)).describe(from);
    EXPECT_GE(view.pitch_deg, mount.min_pitch_deg);
    EXPECT_LE(view.pitch_deg, mount.max_pitch_deg);
    double best = -1;
    for (double pitch = mount.min_pitch_deg; pitch <= mount.max_pitch_deg; pitch += 1) {
      for (double yaw = 0; yaw < 360; yaw += 1) best = std::max(best, room(corners, from, yaw, pitch, camera));
    }
    const double given = room(corners, from, view.yaw_deg, view.pitch_deg, camera);
    if (best <= 0) continue;
    ++whole;
    off_centre += view.is_centred ? 0 : 1;
    EXPECT_GE(given, 0) << "some orientation has room for " << best;
    if (!view.is_centred) {
      EXPECT_GE(given, 0.9 * best - 0.03);
    }
  }
  EXPECT_GT(whole, 40);
  EXPECT_GT(off_centre, 10);
}

/// Where points lie that the camera has at these tangents from the middle of its picture.
std::vector<Vec3> seen_at(const CameraAim& aim, double roll_deg, double across, double up) {
  const double yaw = aim.yaw_deg * kRadian, pitch = aim.pitch_deg * kRadian, roll = roll_deg * kRadian;
  const Vec3 ahead(std::cos(pitch) * std::sin(yaw), std::cos(pitch) * std::cos(yaw), std::sin(pitch));
  const Vec3 level(std::cos(yaw), -std::sin(yaw), 0), above = level.cross(ahead);
  const Vec3 right = std::cos(roll) * level - std::sin(roll) * above, top = right.cross(ahead);
  std::vector<Vec3> points;
  for (const double x : {-across, across}) {
    for (const double y : {-up, up}) points.push_back(50 * (ahead + x * right + y * top));
  }
  return points;
}

TEST(FitInPicture, FindsOrientationsWithLittleRoom) {
  const std::uint64_t seed = 11;
  std::cout << "seed " << seed << "\n";
  Random random(seed);
  Pinhole camera;
  camera.half_width = std::tan(10 * kRadian);
  camera.half_height = std::tan(7.5 * kRadian);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    Mount mount = {.min_pitch_deg = random.uniform(-80, -10), .roll_deg = 90.0 * random.integer(-1, 2)};
    mount.max_pitch_deg = mount.min_pitch_deg + random.uniform(0, 30);
    // At an end of the pitches that the mount allows, or between them.
    const double share = 0.5 * random.integer(0, 2);
    const CameraAim aim = {random.uniform(0, 360),
                           mount.min_pitch_deg + share * (mount.max_pitch_deg - mount.min_pitch_deg)};
    if (random.chance(0.3)) mount.yaw_deg = aim.yaw_deg;
    const double room = std::tan(random.uniform(2e-4, 1e-3) * kRadian);
    const std::vector<Vec3> points =
        seen_at(aim, mount.roll_deg, camera.half_width * (1 - 4 * room), camera.half_height * (1 - 6 * room));
    ASSERT_TRUE(is_in_picture(camera, mount.roll_deg, aim, points));
    const auto found = fit_in_picture(camera, mount, points);
    ASSERT_TRUE(found) << room;
    EXPECT_GE(found->aim.pitch_deg, mount.min_pitch_deg - 1e-9);
    EXPECT_LE(found->aim.pitch_deg, mount.max_pitch_deg + 1e-9);
  }
}

TEST(FitInPicture, TakesNoPointThatIsNotFinite) {
  Pinhole camera;
  camera.half_width = 0.5;
  camera.half_height = 0.5;
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(fit_in_picture(camera, {}, {Vec3(0, 10, 0)}));
  EXPECT_FALSE(fit_in_picture(camera, {}, {Vec3(0, 10, 0), Vec3(nan, nan, nan)}));
  EXPECT_FALSE(fit_in_picture(camera, {}, {Vec3(0, 10, 0), Vec3(0, infinite, 0)}));
}

TEST(FitInPicture, LeavesAsLittleOutsideAsCanBe) {
  Pinhole camera;
  camera.half_width = std::tan(10 * kRadian);
  camera.half_height = std::tan(10 * kRadian);
  const std::vector<Vec3> points = seen_at({30, -40}, 0, std::tan(14 * kRadian), 0.01);
  EXPECT_FALSE(fit_in_picture(camera, {}, points));
  EXPECT_FALSE(fit_in_picture(camera, {}, points, 3));
  const auto found = fit_in_picture(camera, {}, points, 10);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->aim.yaw_deg, 30, 1);
  EXPECT_NEAR(found->room_deg, -4, 0.1);
}

}  // namespace
}  // namespace vantage::testing
