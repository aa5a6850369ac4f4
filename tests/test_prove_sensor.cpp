// The proofs of the sensor's limits: volumes that were computed with a limit are proved, those that were computed with
// a looser one are refuted at a place that is looked at here with plain arithmetic.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/prove.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::code_of;
using testing::SceneBuilder;

constexpr double kDegree = std::numbers::pi / 180;

/// A target that leans, over ground, at a place and of a size.
struct Place {
  double scale = 1;
  Vec3 shift = Vec3::Zero();

  Vec3 at(double x, double y, double z) const { return shift + scale * Vec3(x, y, z); }
  Scene scene() const {
    return SceneBuilder().polygon("ground", {at(-90, -90, -9), at(90, -90, -9), at(90, 90, -9), at(-90, 90, -9)});
  }
  std::vector<Vec3> corners() const { return {at(-2, 0, -1), at(2, 0.3, -1), at(2.5, 1, 1.5), at(-2, 0.7, 1.5)}; }
  Target target() const {
    Target target = Target::polygon(planar());
    target.front = Vec3(0, -1, 0.3);
    return target;
  }
  /// The corners in the plane of the first three.
  std::vector<Vec3> planar() const {
    std::vector<Vec3> all = corners();
    all[3] += normal().dot(all[0] - all[3]) * normal();
    return all;
  }
  Vec3 normal() const {
    const std::vector<Vec3> all = corners();
    const Vec3 n = (all[1] - all[0]).cross(all[2] - all[0]).normalized();
    return n.y() < 0 ? n : Vec3(-n);
  }
};

std::vector<Place> places() {
  std::vector<Place> all;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(5e5, 5e6, 100)}) all.push_back({scale, shift});
  }
  return all;
}

ClaimProof sensor_claim(const Place& place, const Sensor& sensor, const Volume& volume) {
  const ProveOptions options{.lift_m = volume.lift_m};
  const ProofReport report = prove_volume(place.scene(), place.target(), sensor, {}, volume.mesh, options);
  EXPECT_EQ(report.claims.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(report.claims[i].verdict, ProofVerdict::proved) << report.claims[i].text;
  EXPECT_EQ(report.claims.back().place.has_value(), report.claims.back().verdict == ProofVerdict::wrong);
  return report.claims.back();
}

Volume volume_with(const Place& place, const Sensor& sensor) {
  const ExactOptions options{.tolerance_m = 0.2 * place.scale};
  Volume volume = compute_volume(PreparedTarget(PreparedScene(place.scene()), place.target(), sensor), {}, options);
  EXPECT_FALSE(volume.empty()) << volume.reason;
  return volume;
}

/// `breaks`: by how much a position breaks the limit of `sensor`, in any unit; 0 on its border.
void expect_sensor(const Place& place, const Sensor& sensor, const Sensor& looser,
                   const std::function<double(const Vec3&)>& breaks) {
  const ClaimProof right = sensor_claim(place, sensor, volume_with(place, sensor));
  EXPECT_EQ(right.verdict, ProofVerdict::proved) << right.text << " scale " << place.scale;
  const ClaimProof wrong = sensor_claim(place, sensor, volume_with(place, looser));
  ASSERT_EQ(wrong.verdict, ProofVerdict::wrong) << wrong.text << " scale " << place.scale;
  EXPECT_GT(breaks(*wrong.place), 0) << wrong.text;
}

TEST(ProveSensor, MinRange) {
  for (const Place& place : places()) {
    Sensor sensor{.max_range_m = 30 * place.scale, .min_range_m = 6 * place.scale}, looser = sensor;
    looser.min_range_m *= 0.98;
    expect_sensor(place, sensor, looser, [&](const Vec3& p) {
      double least = std::numeric_limits<double>::infinity();  // to points of the target
      const std::vector<Vec3> t = place.planar();
      for (int i = 0; i <= 200; ++i) {
        for (int j = 0; j <= 200; ++j) {
          const Vec3 low = t[0] + i / 200.0 * (t[1] - t[0]), high = t[3] + i / 200.0 * (t[2] - t[3]);
          least = std::min(least, (low + j / 200.0 * (high - low) - p).norm());
        }
      }
      return sensor.min_range_m - least;
    });
  }
}

TEST(ProveSensor, Incidence) {
  for (const Place& place : places()) {
    const Sensor sensor{.max_range_m = 30 * place.scale, .incidence_deg = 40};
    Sensor looser = sensor;
    looser.incidence_deg = 40.04;
    expect_sensor(place, sensor, looser, [&](const Vec3& p) {
      double most = 0;
      for (const Vec3& t : place.planar()) {
        most = std::max(most, std::acos((p - t).normalized().dot(place.normal())) / kDegree);
      }
      return most - 40;
    });
  }
}

TEST(ProveSensor, WorstPixel) {
  for (const Place& place : places()) {
    Sensor sensor{.max_range_m = 60 * place.scale};
    sensor.camera = pinhole_of_fov(160, 160, 4000, 4000);
    sensor.mount = {.yaw_deg = 0, .min_pitch_deg = 0, .max_pitch_deg = 0};
    sensor.pixel = PixelLimit{0.1 * place.scale};
    Sensor looser = sensor;
    looser.pixel->size_m *= 1.001;
    const double focal_px = *sensor.camera->focal_px;
    const auto breaks = [&](const Vec3& p) {
      double most = 0;
      for (const Vec3& t : place.planar()) {
        most = std::max(most, (p - t).squaredNorm() / (focal_px * place.normal().dot(p - t)));
      }
      return most - sensor.pixel->size_m;
    };
    const auto claim = [&](const Sensor& of) {
      const Volume volume = volume_with(place, of);
      const ProofReport report =
          prove_volume(place.scene(), place.target(), sensor, {}, volume.mesh, {.lift_m = volume.lift_m});
      for (const ClaimProof& one : report.claims) {
        if (one.name == "pixel") return one;
      }
      return ClaimProof{};
    };
    EXPECT_EQ(claim(sensor).verdict, ProofVerdict::proved) << claim(sensor).text;
    const ClaimProof wrong = claim(looser);
    ASSERT_EQ(wrong.verdict, ProofVerdict::wrong) << wrong.text;
    EXPECT_GT(breaks(*wrong.place), 0);
  }
}

/// Tangents in the picture of a camera with that mount, by its definition: yaw from north to east, pitch up, roll
/// lowers the right edge.
Vec3 in_picture(const Vec3& towards, double yaw_deg, double pitch_deg, double roll_deg) {
  using Eigen::AngleAxisd;
  // Of a level camera that looks north: to the right is east, down is down.
  const Eigen::Quaterniond turn = AngleAxisd(-yaw_deg * kDegree, Vec3::UnitZ()) *
                                  AngleAxisd(pitch_deg * kDegree, Vec3::UnitX()) *
                                  AngleAxisd(roll_deg * kDegree, Vec3::UnitY());
  const Vec3 own = turn.conjugate() * towards;
  return {own.x() / own.y(), -own.z() / own.y(), own.y()};
}

TEST(ProveSensor, AFixedCamera) {
  for (const Place& place : places()) {
    Sensor sensor{.max_range_m = 60 * place.scale};
    sensor.camera = pinhole_of_fov(50, 40);
    sensor.mount = {.yaw_deg = 25, .min_pitch_deg = -20, .max_pitch_deg = -20, .roll_deg = 15};
    Sensor looser = sensor;
    looser.camera = pinhole_of_fov(50.5, 40.4);
    expect_sensor(place, sensor, looser, [&](const Vec3& p) {
      double most = 0;
      for (const Vec3& t : place.planar()) {
        const Vec3 seen = in_picture(t - p, 25, -20, 15);
        if (!(seen.z() > 0)) return 1.0;
        most =
            std::max({most, std::abs(seen.x()) - std::tan(25 * kDegree), std::abs(seen.y()) - std::tan(20 * kDegree)});
      }
      return most;
    });
  }
}

/// One orientation is found for each facet, or one that turns from corner to corner.
TEST(ProveSensor, ACameraThatTurns) {
  const Place place{1e-3, {5e5, 5e6, 100}};
  for (const double range : {20, 46}) {
    Sensor sensor{.max_range_m = range * place.scale};
    sensor.camera = pinhole_of_fov(30, 20);
    sensor.mount = {.min_pitch_deg = -30, .max_pitch_deg = 30};
    EXPECT_EQ(sensor_claim(place, sensor, volume_with(place, sensor)).verdict, ProofVerdict::proved) << range;
  }
}

/// Where what serves is a narrow strip of yaws and pitches, or there are several.
TEST(ProveSensor, ACameraThatTurnsAndRolls) {
  struct Camera {
    double width_deg, height_deg;
    Mount mount;
  };
  const Place place{1e-3, {5e5, 5e6, 100}};
  for (const Camera& camera :
       std::vector<Camera>{{38, 46, {.min_pitch_deg = -75.6, .max_pitch_deg = -50.5, .roll_deg = -140}},
                           {60, 2, {.min_pitch_deg = -90, .max_pitch_deg = 90, .roll_deg = -50}},
                           {8, 150, {.min_pitch_deg = -90, .max_pitch_deg = 90, .roll_deg = 3}},
                           {150, 103, {.min_pitch_deg = 40, .max_pitch_deg = 90, .roll_deg = 90}}}) {
    Sensor sensor{.max_range_m = 50 * place.scale};
    sensor.camera = pinhole_of_fov(camera.width_deg, camera.height_deg);
    sensor.mount = camera.mount;
    EXPECT_EQ(sensor_claim(place, sensor, volume_with(place, sensor)).verdict, ProofVerdict::proved)
        << camera.width_deg;
  }
}

/// Each camera sees the target from so near that neighbouring facets of the volume need other orientations.
TEST(ProveSensor, CamerasThatTurnOfManyKinds) {
  const Scene scene = SceneBuilder().ground("ground", 500, -1);
  testing::Random random(73);
  int made = 0;
  for (int draw = 0; draw < 12; ++draw) {
    SCOPED_TRACE(::testing::Message() << "draw " << draw << " of seed 73");
    const double radius = std::pow(10, random.uniform(-0.3, 1)), tilt = draw % 2 == 0 ? 0 : random.uniform(0, 1.5);
    const Eigen::AngleAxisd turn(tilt, Vec3(std::cos(draw), std::sin(draw), 0));
    std::vector<Vec3> corners;
    for (int k = 0; k < 3 + draw % 5; ++k) {
      const double angle = 2 * std::numbers::pi * (k + random.uniform(0, 0.8)) / (3 + draw % 5);
      corners.push_back(Vec3(0, 0, 2 * radius) + turn * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0));
    }
    Target target = Target::polygon(corners);
    target.front = turn * Vec3::UnitZ();
    const double width = random.uniform(25, 120), height = random.uniform(25, 90);
    Sensor sensor{.max_range_m = radius + 3 * radius / std::tan(std::min(width, height) / 2 * kDegree)};
    sensor.camera = pinhole_of_fov(width, height);
    sensor.mount = {.min_pitch_deg = -90, .max_pitch_deg = draw % 3 * 30.0, .roll_deg = draw % 4 == 0 ? 20.0 : 0.0};
    const Volume volume =
        compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), {}, {.tolerance_m = 0.1});
    if (volume.empty()) continue;
    const auto verdict = [&](double scale) {
      Mesh mesh = volume.mesh;
      for (Vec3& vertex : mesh.vertices) vertex = volume.frame.origin + scale * (vertex - volume.frame.origin);
      return prove_volume(scene, target, sensor, {}, mesh, {.lift_m = volume.lift_m}).claims.back().verdict;
    };
    EXPECT_EQ(verdict(1), ProofVerdict::proved);
    EXPECT_EQ(verdict(0.97), ProofVerdict::not_proved);  // nearer than the picture allows
    ++made;
  }
  EXPECT_GT(made, 8);
}

/// What does not keep the frame is not proved, as no search shows that there is no orientation.
TEST(ProveSensor, ACameraThatTurnsTooLittle) {
  const Scene scene = SceneBuilder().ground("ground", 90, -9);
  const Target target = Target::polygon({{-3, 0, -1}, {3, 0, -1}, {3, 0, 1}, {-3, 0, 1}});  // looks south
  const auto verdict = [&](const Mount& mount, double width_deg, const Mesh& volume) {
    Sensor sensor{.max_range_m = 60};
    sensor.camera = pinhole_of_fov(width_deg, 60);
    sensor.mount = mount;
    return prove_volume(scene, target, sensor, {}, volume).claims.back().verdict;
  };
  // From 10 m in front of the middle it is 33.4 degrees wide, and less from the side and from farther away.
  const double width = 2 * std::atan2(3, 10) / kDegree;
  const Mesh volume = testing::make_box_mesh({-4, -20, -2}, {4, -10, 2});
  EXPECT_EQ(verdict({}, 1.02 * width, volume), ProofVerdict::proved);
  EXPECT_EQ(verdict({}, 0.98 * width, volume), ProofVerdict::not_proved);
  EXPECT_EQ(verdict({.min_pitch_deg = 0, .max_pitch_deg = 0}, 1.02 * width, volume), ProofVerdict::proved);
  EXPECT_EQ(verdict({.yaw_deg = 0}, 1.02 * width, volume), ProofVerdict::not_proved);
  EXPECT_EQ(verdict({.min_pitch_deg = 10, .max_pitch_deg = 90}, 1.2 * width, volume), ProofVerdict::proved);
  EXPECT_EQ(verdict({.min_pitch_deg = 20, .max_pitch_deg = 90}, 1.2 * width, volume), ProofVerdict::not_proved);
  // Round the middle no facet is too near, but what is inside is.
  const Mesh around = testing::make_box_mesh({-40, -40, -40}, {40, 40, 40});
  EXPECT_EQ(verdict({}, 90, around), ProofVerdict::not_proved);
}

/// A corner almost beside the camera is so far from the middle of the picture that numbers overflow. That is no proof.
TEST(ProveSensor, ACameraBesideTheTarget) {
  const Scene scene = SceneBuilder().ground("ground", 90, -9);
  const Target target = Target::polygon({{-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}});  // looks south
  Sensor sensor{.max_range_m = 60};
  sensor.camera = pinhole_of_fov(40, 40);
  sensor.mount = {.yaw_deg = 0, .min_pitch_deg = 0, .max_pitch_deg = 10};
  for (const double beside : {-1e-320, -1e-308, -1e-300, 0.0}) {
    const Mesh volume = {{{3, beside, 0.3}, {4, beside, 0.2}, {3.5, beside, 1}, {3.5, -1, 0.5}},
                         {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    const ProofReport report = prove_volume(scene, target, sensor, {}, volume);
    EXPECT_EQ(report.claims.back().verdict, ProofVerdict::not_proved) << beside;
  }
}

TEST(ProveSensor, Sun) {
  for (const Place& place : places()) {
    for (const double exclude_deg : {25.0, 60.0, 90.0}) {
      Sensor sensor{.max_range_m = 30 * place.scale};
      sensor.sun = SunLimit{Vec3(1, 1.5, 0.2), exclude_deg};
      Sensor looser = sensor;
      looser.sun->exclude_deg *= 0.99;
      expect_sensor(place, sensor, looser, [&](const Vec3& p) {
        double least = 180;
        const std::vector<Vec3> t = place.planar();
        for (int i = 0; i <= 100; ++i) {
          for (int j = 0; j <= 100; ++j) {
            const Vec3 low = t[0] + i / 100.0 * (t[1] - t[0]), high = t[3] + i / 100.0 * (t[2] - t[3]);
            const Vec3 sight = (low + j / 100.0 * (high - low) - p).normalized();
            least = std::min(least, std::acos(sight.dot(sensor.sun->direction.normalized())) / kDegree);
          }
        }
        return exclude_deg - least;
      });
    }
  }
}

TEST(ProveSensor, APointWithoutAFrontHasNoPlane) {
  const Scene scene = Place{}.scene();
  const Target point = Target::point({0, 0, 5});
  const Sensor sensor{.max_range_m = 30};
  const Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), point, sensor));
  Sensor inclined = sensor;
  inclined.incidence_deg = 40;
  EXPECT_EQ(code_of([&] { prove_volume(scene, point, inclined, {}, volume.mesh); }), ErrorCode::direction_invalid);
}

}  // namespace
}  // namespace vantage
