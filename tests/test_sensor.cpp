// The limits of the sensor: each against its closed form, all of them against answers for points.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "sensor/find_aim.h"
#include "support/mesh_probe.h"
#include "support/objects.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

/// Far below all viewpoints, so that only limits bound the volume.
Scene empty_scene() {
  Scene scene;
  scene.objects = named({"far away"});
  scene.mesh.vertices = {{0, 0, -5000}, {1, 0, -5000}, {0, 1, -5000}};
  scene.mesh.triangles = {{0, 1, 2}};
  scene.object_of = {0};
  return scene;
}

Target floor_square(double half) {
  return Target::polygon({{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}});
}

Target point_looking_up() {
  Target target = Target::point(Vec3::Zero());
  target.front = Vec3::UnitZ();
  return target;
}

double volume_of(const Target& target, const Sensor& sensor) {
  const Volume volume = compute_volume(PreparedTarget(PreparedScene(empty_scene()), target, sensor));
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  const MeshMeasures measures = measure(volume.mesh);
  EXPECT_TRUE(measures.closed && measures.oriented);
  return measures.volume_m3;
}

double ball(double radius) { return 4 * kPi / 3 * radius * radius * radius; }

Pinhole camera_of(double horizontal_deg, double vertical_deg) {
  return pinhole_of_fov(horizontal_deg, vertical_deg, 4000, 3000);
}

TEST(Sensor, TheLeastRangeTakesABallAway) {
  const double volume = volume_of(point_looking_up(), {.max_range_m = 100, .min_range_m = 60});
  const double wanted = (ball(100) - ball(60)) / 2;
  EXPECT_LE(volume, wanted);
  EXPECT_NEAR(volume, wanted, 1e-3 * wanted);
}

TEST(Sensor, RangesWhoseSquaresVanishAreRefused) {
  for (const double range : {5e-324, 1e-320, 1e-200, 1e-61}) {
    testing::expect_code([&] { check_sensor({.max_range_m = range}); }, ErrorCode::value_out_of_range, "sensor");
  }
  const Scene scene = testing::SceneBuilder().ground("ground", 60, -20);
  const PreparedTarget target(PreparedScene(scene), Target::point({0, 0, 0}), {.max_range_m = 1e-60});
  EXPECT_EQ(compute_visibility(target).outcome, Outcome::computed);
}

TEST(Sensor, IncidenceLeavesACone) {
  for (const double angle : {10.0, 45.0, 80.0}) {
    const double volume = volume_of(point_looking_up(), {.max_range_m = 100, .incidence_deg = angle});
    const double wanted = ball(100) / 2 * (1 - std::cos(angle * kDegree));
    EXPECT_LE(volume, wanted) << angle;
    EXPECT_NEAR(volume, wanted, 1e-3 * wanted) << angle;
  }
}

TEST(Sensor, APixelFaceOnIsARange) {
  Sensor sensor{.camera = camera_of(120, 120), .pixel = PixelLimit{0.05, PixelLimit::Kind::perpendicular}};
  const double range = 0.05 * *sensor.camera->focal_px;
  EXPECT_EQ(range_limit_m(sensor), range);
  const double volume = volume_of(point_looking_up(), sensor);
  EXPECT_NEAR(volume, ball(range) / 2, 1e-3 * ball(range) / 2);
}

TEST(Sensor, ASlantedPixelIsABallOnThePlane) {
  const Sensor sensor{.camera = camera_of(120, 120), .pixel = PixelLimit{0.05, PixelLimit::Kind::worst}};
  const double wanted = ball(0.05 * *sensor.camera->focal_px / 2);
  const double volume = volume_of(point_looking_up(), sensor);
  EXPECT_LE(volume, wanted);
  EXPECT_NEAR(volume, wanted, 1e-3 * wanted);
}

TEST(Sensor, TheSunTakesAConeAway) {
  // Overhead, it shines into a camera that looks up; seen from above nothing lies towards it. A low one takes away a
  // cone on the side across from it.
  EXPECT_NEAR(volume_of(point_looking_up(), {.max_range_m = 100, .sun = SunLimit{Vec3::UnitZ(), 40}}), ball(100) / 2,
              1e-3 * ball(100) / 2);
  const Vec3 low(std::cos(10 * kDegree), 0, -std::sin(10 * kDegree));  // below the plane: all of the cone is above it
  const double volume = volume_of(point_looking_up(), {.max_range_m = 100, .sun = SunLimit{low, 8}});
  const double wanted = ball(100) / 2 * std::cos(8 * kDegree);
  EXPECT_LE(volume, wanted);
  EXPECT_NEAR(volume, wanted, 1e-3 * wanted);
}

TEST(Sensor, AFixedFrameIsAPyramid) {
  // Straight down with the picture's upper edge to the north: all of the square is in it from a pyramid whose apex is
  // where the square fits.
  const Sensor sensor{.max_range_m = 100, .camera = camera_of(80, 60), .mount = {0, -90, -90, 0}};
  Navigation navigation;
  navigation.altitude = {0, 60};
  const Volume volume =
      compute_volume(PreparedTarget(PreparedScene(empty_scene()), floor_square(10), sensor), navigation);
  const double w = std::tan(40 * kDegree), h = std::tan(30 * kDegree);
  const auto above = [&](double z) {  // integral of 4 (w z - 10) (h z - 10)
    return 4 * (w * h * z * z * z / 3 - 5 * (w + h) * z * z + 100 * z);
  };
  const double first = 10 / h;
  const double wanted = above(60) - above(first);
  EXPECT_NEAR(measure(volume.mesh).volume_m3, wanted, 1e-6 * wanted);
}

TEST(Sensor, WhatAGimbalCannotReach) {
  // A point, a picture of 60 degrees: seen from straight above it takes a pitch of -90; the gimbal ends at -40, so the
  // point is in the picture where it is seen at most 70 degrees down.
  const Sensor sensor{.max_range_m = 100, .camera = camera_of(60, 60), .mount = {{}, -40, 30, 0}};
  const double volume = volume_of(point_looking_up(), sensor);
  const double wanted = ball(100) / 2 * std::sin(70 * kDegree);
  EXPECT_LE(volume, wanted);
  EXPECT_NEAR(volume, wanted, 1e-2 * wanted);
}

TEST(Sensor, FindsAnAimWhereThereIsOne) {
  // One corner ahead, at the edge of what the picture holds: level, 20 degrees up, a picture of 40 by 30 degrees.
  const Pinhole camera = camera_of(40, 30);
  const auto up = [](double degrees) { return Vec3(0, std::cos(degrees * kDegree), std::sin(degrees * kDegree)); };
  const auto fits = [&](const Mount& mount, const Vec3& corner) {
    return internal::sensor::find_aim(camera, mount, std::vector<Vec3>{corner}).aim.has_value();
  };
  EXPECT_TRUE(fits({0, 0, 0, 0}, up(14.99)));
  EXPECT_FALSE(fits({0, 0, 0, 0}, up(15.01)));
  EXPECT_TRUE(fits({{}, 0, 0, 0}, up(14.99)));
  EXPECT_TRUE(fits({{}, -20, 10, 0}, up(24.99)));
  EXPECT_FALSE(fits({{}, -20, 10, 0}, up(25.1)));
  EXPECT_TRUE(fits({0, 0, 0, 90}, up(19.99)));  // on its side the picture is 40 degrees high
  EXPECT_FALSE(fits({0, 0, 0, 90}, up(20.01)));
  EXPECT_TRUE(fits({180, -90, -90, 0}, -Vec3::UnitZ()));
  // A positive roll lowers the right edge: what is right and low comes into the picture.
  const Vec3 right_and_low = Vec3(std::tan(15 * kDegree), 1, -std::tan(14 * kDegree)).normalized();
  const Vec3 right_and_high = Vec3(std::tan(15 * kDegree), 1, std::tan(14 * kDegree)).normalized();
  EXPECT_TRUE(fits({0, 0, 0, 30}, right_and_low));
  EXPECT_FALSE(fits({0, 0, 0, 30}, right_and_high));
}

TEST(Sensor, TheSunStandsWhereTheAlmanacSays) {
  // The example of Reda and Andreas, "Solar position algorithm for solar radiation applications" (NREL, 2008), table
  // A5.1: 2003-10-17 12:30:30 at seven hours before UTC, zenith angle 50.11162, azimuth 194.34024 degrees.
  const Vec3 sun = sun_direction(39.742476, -105.1786, 1066419030);
  EXPECT_NEAR(std::acos(sun.z()) / kDegree, 50.11162, 0.02);
  EXPECT_NEAR(std::atan2(sun.x(), sun.y()) / kDegree + 360, 194.34024, 0.02);
}

struct RandomCase {
  Scene scene;
  Target target;
  Sensor sensor;
};

RandomCase random_case(testing::Random& random) {
  const auto uniform = [&](double a, double b) { return random.uniform(a, b); };
  RandomCase result;
  result.scene = empty_scene();
  const Vec3 normal = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(0, 1.2)).normalized();
  const Vec3 u = normal.cross(Vec3(0.3, 0.5, -0.2)).normalized(), v = normal.cross(u);
  const double size = uniform(1, 8);
  std::vector<Vec3> corners;
  const int count = random.integer(3, 7);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * kPi * (i + uniform(-0.2, 0.2)) / count;
    corners.push_back(size * (std::cos(angle) * u + std::sin(angle) * v));
  }
  result.target = Target::polygon(corners);
  result.target.front = normal;
  Sensor& sensor = result.sensor;
  sensor.max_range_m = uniform(60, 250);
  const auto sometimes = [&] { return random.chance(0.5); };
  if (sometimes()) sensor.min_range_m = uniform(5, 50);
  if (sometimes()) sensor.incidence_deg = uniform(20, 85);
  if (sometimes()) sensor.sun = SunLimit{Vec3(uniform(-1, 1), uniform(-1, 1), uniform(0, 1)), uniform(3, 60)};
  if (sometimes()) {
    sensor.camera = camera_of(uniform(20, 80), uniform(20, 80));
    if (sometimes()) {
      sensor.mount.min_pitch_deg = uniform(-90, -20);
      sensor.mount.max_pitch_deg = uniform(-15, 60);
    }
    if (sometimes()) sensor.mount.roll_deg = uniform(-40, 40);
    if (sometimes()) sensor.pixel = PixelLimit{uniform(0.01, 0.05), PixelLimit::Kind::worst};
  }
  return result;
}

/// In the way of some viewpoints, and not on the target.
Scene walls_about_the_origin(testing::Random& random) {
  testing::SceneBuilder builder;
  for (int i = 0; i < 8; ++i) {
    const double angle = random.uniform(0, 2 * kPi), away = random.uniform(12, 50), half = random.uniform(2, 8);
    const Vec3 middle(away * std::cos(angle), away * std::sin(angle), random.uniform(-5, 20));
    const Vec3 aside(-half * std::sin(angle), half * std::cos(angle), 0), up(0, 0, random.uniform(2, 15));
    builder.polygon("wall", {middle - aside, middle + aside, middle + aside + up, middle - aside + up});
  }
  return builder;
}

TEST(Sensor, WhatIsClaimedKeepsEveryLimit) {
  testing::Random random(20261122);
  std::size_t claimed = 0, over = 0, kept = 0, under = 0;
  for (int round = 0; round < 12; ++round) {
    const RandomCase made = random_case(random);
    const PreparedScene scene(made.scene);
    const PreparedTarget target(scene, made.target, made.sensor);
    const Volume volume = compute_volume(target, {}, {.tolerance_m = 0.1});
    if (volume.empty()) continue;
    const MeshMeasures measures = measure(volume.mesh);
    ASSERT_TRUE(measures.closed && measures.oriented) << "round " << round;
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i) {  // just inside of facets
      const auto last = static_cast<int>(volume.mesh.triangles.size()) - 1;
      const Triangle& t = volume.mesh.triangles[static_cast<std::size_t>(random.integer(0, last))];
      const Vec3 &a = volume.mesh.vertices[t[0]], &b = volume.mesh.vertices[t[1]], &c = volume.mesh.vertices[t[2]];
      const double s = random.uniform(0, 1), r = random.uniform(0, 1 - s);
      const Vec3 on = a + s * (b - a) + r * (c - a);
      points.push_back(on - (b - a).cross(c - a).normalized() * 1e-5 * on.norm());
    }
    for (int i = 0; i < 200; ++i) {
      points.push_back(random.in_box(measures.bounds));
    }
    const std::vector<PointAnswer> answers = query_points(target, {}, points);
    const testing::MeshProbe probe(volume);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite()) continue;
      const double depth = probe.depth(points[i]);
      const bool is_claimed = depth > 1e-6 * points[i].norm();
      claimed += is_claimed;
      if (is_claimed && !answers[i].inside) {
        ++over;
        ADD_FAILURE() << "round " << round << " (" << points[i].transpose() << "), " << depth << " m deep, breaks "
                      << (answers[i].outside_of.empty() ? "sight" : answers[i].outside_of[0]);
      }
      if (i < 200) continue;
      kept += answers[i].inside;
      under += answers[i].inside && depth < 0;
    }
  }
  std::cout << claimed << " claimed, " << over << " wrongly; of " << kept << " that keep all limits " << under
            << " are not claimed\n";
  EXPECT_EQ(over, 0u);
  EXPECT_LE(static_cast<double>(under), 0.02 * static_cast<double>(kept) + 3);
}

TEST(Sensor, TighterLimitsNeverGrowAVolume) {
  const auto volume = [&](double incidence, double min_range, double fov, double sun) {
    return volume_of(floor_square(3), {.max_range_m = 80,
                                       .min_range_m = min_range,
                                       .incidence_deg = incidence,
                                       .camera = camera_of(fov, fov),
                                       .sun = SunLimit{Vec3(1, 0, 0.3), sun}});
  };
  const double loose = volume(60, 10, 60, 20);
  EXPECT_LT(volume(55, 10, 60, 20), loose);
  EXPECT_LT(volume(60, 15, 60, 20), loose);
  EXPECT_LE(volume(60, 10, 20, 20), loose);
  EXPECT_LE(volume(60, 10, 60, 30), loose);
}

/// Angles stay, and so do pixels of the camera; all lengths grow.
RandomCase scaled(RandomCase made, double by) {
  for (Vec3& vertex : made.scene.mesh.vertices) vertex *= by;
  for (std::vector<Vec3>& part : made.target.parts) {
    for (Vec3& vertex : part) vertex *= by;
  }
  made.sensor.max_range_m *= by;
  made.sensor.min_range_m *= by;
  if (made.sensor.pixel) made.sensor.pixel->size_m *= by;
  return made;
}

TEST(Sensor, ScalesWithSceneRangeAndPixel) {
  testing::Random random(20261123);
  int compared = 0;
  for (int round = 0; round < 7; ++round) {
    RandomCase made = random_case(random);
    made.scene = walls_about_the_origin(random);
    const auto volume_of_scaled = [&](double by) {
      const RandomCase other = scaled(made, by);
      const PreparedTarget target(PreparedScene(other.scene), other.target, other.sensor);
      const Volume volume = compute_volume(target, {}, {.tolerance_m = 0.02 * by});
      return volume.empty() ? 0 : measure(volume.mesh).volume_m3 / (by * by * by);
    };
    const double volume = volume_of_scaled(1);
    compared += volume > 0;
    for (const double by : {0.01, 300.0}) {
      EXPECT_NEAR(volume_of_scaled(by), volume, 1e-4 * volume) << "round " << round << ", " << by << " times as large";
    }
  }
  EXPECT_GE(compared, 4);
}

TEST(Sensor, FacetsSayWhichLimitMakesThem) {
  const Volume volume = compute_volume(
      PreparedTarget(PreparedScene(empty_scene()), floor_square(5),
                     {.max_range_m = 100, .min_range_m = 20, .incidence_deg = 50, .camera = camera_of(30, 30)}));
  std::vector<std::string> names;
  for (const Cause& cause : volume.causes) {
    if (cause.kind == CauseKind::sensor) names.push_back(cause.name);
  }
  EXPECT_NE(std::find(names.begin(), names.end(), "incidence"), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "frame"), names.end());
}

ErrorCode code_of(const Sensor& sensor, const Target& target = floor_square(5)) {
  try {
    const PreparedTarget prepared(PreparedScene(empty_scene()), target, sensor);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::internal_defect;
}

TEST(Sensor, RefusesWhatIsNoLimit) {
  const Pinhole camera = camera_of(60, 40);
  EXPECT_EQ(code_of({}), ErrorCode::value_out_of_range);  // nothing bounds the range
  EXPECT_EQ(code_of({.max_range_m = 50, .min_range_m = 50}), ErrorCode::limits_empty);
  EXPECT_EQ(code_of({.max_range_m = 50, .min_range_m = -1}), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of({.max_range_m = 50, .incidence_deg = 90}), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of({.max_range_m = 50, .camera = camera, .mount = {{}, 10, -10, 0}}), ErrorCode::limits_reversed);
  EXPECT_EQ(code_of({.max_range_m = 50, .camera = camera, .mount = {{}, -91, 0, 0}}), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of({.max_range_m = 50, .pixel = PixelLimit{0.1}}), ErrorCode::missing_key);
  EXPECT_EQ(code_of({.max_range_m = 50, .camera = camera, .pixel = PixelLimit{0}}), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of({.max_range_m = 50, .sun = SunLimit{Vec3::Zero(), 10}}), ErrorCode::direction_invalid);
  EXPECT_EQ(code_of({.max_range_m = 50, .sun = SunLimit{Vec3::UnitX(), 91}}), ErrorCode::value_out_of_range);
  EXPECT_EQ(code_of({.max_range_m = 50, .incidence_deg = 40}, Target::point(Vec3(0, 0, 5))), ErrorCode::not_applicable);
  EXPECT_EQ(code_of({.max_range_m = 100, .min_range_m = 20, .camera = camera, .pixel = PixelLimit{0.001}}),
            ErrorCode::limits_empty);
}

TEST(Sensor, SaysWhichLimitLeavesNothing) {
  const auto reason = [](const Sensor& sensor) {
    const Volume volume = compute_volume(PreparedTarget(PreparedScene(empty_scene()), floor_square(5), sensor));
    EXPECT_EQ(volume.outcome, Outcome::outside_limits);
    return volume.reason;
  };
  EXPECT_NE(reason({.max_range_m = 50, .camera = camera_of(2, 2)}).find("'frame'"), std::string::npos);
  EXPECT_NE(reason({.max_range_m = 50, .camera = camera_of(2, 2), .mount = {0, -90, -90, 0}}).find("'frame'"),
            std::string::npos);
  EXPECT_NE(reason({.max_range_m = 50, .incidence_deg = 1}).find("'incidence'"), std::string::npos);
}

TEST(Sensor, QueriesNameTheLimitsThatArePassed) {
  Sensor sensor{.max_range_m = 100, .min_range_m = 20, .incidence_deg = 30, .camera = camera_of(20, 20)};
  const auto answers = query_points(PreparedTarget(PreparedScene(empty_scene()), floor_square(5), sensor), {},
                                    {{0, 0, 60}, {0, 0, 30}, {0, 0, 15}, {60, 0, 20}});
  EXPECT_TRUE(answers[0].inside);
  // The half diagonal of 5 sqrt(2) m is turned into the picture's width: 5 m at tan 10 degrees.
  EXPECT_NEAR(answers[0].margin_m, 60 - 5 / std::tan(10 * kDegree), 0.05);
  EXPECT_TRUE(answers[1].inside);
  EXPECT_EQ(answers[2].outside_of, (std::vector<std::string>{"min_range", "frame"}));
  EXPECT_EQ(answers[3].outside_of, (std::vector<std::string>{"incidence"}));
}

}  // namespace
}  // namespace vantage
