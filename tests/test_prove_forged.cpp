// Forged volumes: each is wrong at a place that is named here, and no claim about it may be proved.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "support/scenes.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/zones.h"
#include "vantage/prove.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::make_box_mesh;
using testing::SceneBuilder;

/// The square of all these tests, over flat ground.
Target low_square() { return testing::target_of({{-2, -2, 0.1}, {2, -2, 0.1}, {2, 2, 0.1}, {-2, 2, 0.1}}); }

ProofVerdict verdict_of(const ProofReport& report, const std::string& claim) {
  for (const ClaimProof& one : report.claims) {
    if (one.name == claim) return one.verdict;
  }
  ADD_FAILURE() << "there is no claim " << claim;
  return ProofVerdict::proved;
}

/// Triangles of a binary STL, as they are.
void write_raw_stl(const std::filesystem::path& file, const std::vector<std::array<Vec3, 3>>& triangles) {
  std::ofstream out(file, std::ios::binary);
  const std::string header(80, '\0');
  const auto count = static_cast<std::uint32_t>(triangles.size());
  out.write(header.data(), 80);
  out.write(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& corners : triangles) {
    const Eigen::Vector3f none = Eigen::Vector3f::Zero();
    out.write(reinterpret_cast<const char*>(none.data()), 12);
    for (const Vec3& corner : corners) {
      const Eigen::Vector3f number = corner.cast<float>();
      out.write(reinterpret_cast<const char*>(number.data()), 12);
    }
    out.write("\0\0", 2);
  }
}

/// A file that states a rounding of 230 m, beside triangles without area at 9e8 m, of which single-precision numbers
/// would be rounded by so much: three corners in one place, and on one line.
TEST(ProveForged, NoRoundingIsBelievedForTrianglesWithoutArea) {
  const Scene scene = SceneBuilder().ground("ground", 60).box("wall", {8, -10, 0}, {10, 10, 20});
  const Sensor sensor{.max_range_m = 50};
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{0.2, 30};
  const testing::TemporaryDirectory folder;
  const std::filesystem::path file = folder / "volume.stl";
  const Mesh box = make_box_mesh({-180, -25, 0.25}, {-5, 25, 170});  // 200 m out of range, 140 m too high
  const double far = 9e8;
  const Vec3 step(7 * 64, 3 * 64, 11 * 64), start(far, 0, far / 2);
  const std::vector<std::array<Vec3, 3>> flat = {{Vec3(far, 0, 0), Vec3(far, 0, 0), Vec3(far, 0, 0)},
                                                 {start, start + step, start + 3 * step}};
  for (const auto& extra : flat) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (const auto& [a, b, c] : box.triangles)
      triangles.push_back({box.vertices[a], box.vertices[b], box.vertices[c]});
    triangles.push_back(extra);
    if (extra[0] != extra[1]) triangles.push_back({extra[1], extra[0], extra[2]});  // closed, as a flap is
    write_raw_stl(file, triangles);
    std::ofstream(file.string() + ".place.json") << R"({"vantage": {"georeference": null, "rounding_m": 230.0}})";
    const VolumeFile read = read_volume(file);
    EXPECT_LT(read.rounding_m, 1e-3);
    // Nor does the proof itself believe what it is told.
    for (const double rounding : {read.rounding_m, 230.0}) {
      const ProofReport report =
          prove_volume(scene, low_square(), sensor, navigation, read.volume.mesh, {.rounding_m = rounding});
      EXPECT_LT(report.rounding_m, 1e-3);
      EXPECT_NE(verdict_of(report, "altitude"), ProofVerdict::proved);
      EXPECT_NE(verdict_of(report, "range"), ProofVerdict::proved);
    }
  }
}

/// Beyond facets that are moved out by 230 m nothing is in range: a small volume would hold all that there is.
TEST(ProveForged, NoRoundingIsBelievedOfWhatIsMissing) {
  const Scene scene = SceneBuilder().ground("ground", 60).box("wall", {8, -10, 0}, {10, 10, 20});
  const Sensor sensor{.max_range_m = 50};
  Mesh small = make_box_mesh({-3, -3, 5}, {3, 3, 9});
  testing::append(small, Mesh{{{9e8, 0, 4e8}, {9e8 + 64, 0, 4e8}, {9e8 + 128, 0, 4e8}}, {{0, 1, 2}, {1, 0, 2}}});
  const MaximalProof told = prove_maximal(scene, low_square(), sensor, {}, small, {.rounding_m = 230});
  const MaximalProof plain = prove_maximal(scene, low_square(), sensor, {}, small, {});
  EXPECT_GE(told.open.size(), 10u);
  EXPECT_EQ(told.open, plain.open);
}

/// The line of sight to a facade passes 0.8 degrees beside the sun: its direction is inside the cone.
TEST(ProveForged, ASunInsideTheViewIsNotProved) {
  const Scene scene = SceneBuilder().ground("ground", 60).box("house", {-10, 0, 0}, {10, 5, 12});
  Target facade = testing::target_of({{-0.5, -0.01, 8}, {0.5, -0.01, 8}, {0.5, -0.01, 9}, {-0.5, -0.01, 9}});
  facade.front = Vec3(0, -1, 0);
  const double up = 10 * std::acos(-1.0) / 180;
  const Sensor sensor{.max_range_m = 50, .sun = SunLimit{Vec3(0, std::cos(up), std::sin(up)), 30}};
  const Mesh cube = make_box_mesh({-1, -41, 1}, {1, -39, 3});
  const Vec3 place(0.1, -40, 2), way = Vec3(0, -0.01, 8.5) - place;
  ASSERT_LT(std::acos(way.normalized().dot(sensor.sun->direction)), 0.02);
  EXPECT_NE(verdict_of(prove_volume(scene, facade, sensor, {}, cube), "sun"), ProofVerdict::proved);
  Mesh both = make_box_mesh({20, -9, 8}, {22, -6, 9});  // a right one beside it
  EXPECT_EQ(verdict_of(prove_volume(scene, facade, sensor, {}, both), "sun"), ProofVerdict::proved);
  testing::append(both, cube);
  EXPECT_NE(verdict_of(prove_volume(scene, facade, sensor, {}, both), "sun"), ProofVerdict::proved);
}

/// A box that keeps a limit, and a lobe at one of its vertices, turned inside out, that reaches to where the limit is
/// broken: the mesh winds round it -1 times, and its sides face the other way.
struct Lobed {
  Scene scene = SceneBuilder().ground("ground", 60);
  Mesh box = make_box_mesh({-3, -3, 12}, {3, 3, 16}), lobed = box;

  explicit Lobed(bool is_inside_out = true, const Vec3& far_end = {0, 0, 3}) {
    const auto first = static_cast<std::uint32_t>(lobed.vertices.size());
    lobed.vertices.insert(lobed.vertices.end(), {far_end, Vec3(-1, 2, 13), Vec3(1, -2, 13)});
    const std::uint32_t shared = 3;  // of the box, at (3, 3, 12)
    const std::uint32_t tip = first, left = first + 1, right = first + 2;
    std::vector<Triangle> lobe = {{tip, left, right}, {tip, right, shared}, {tip, shared, left}, {shared, right, left}};
    const double outward = enclosed_volume(Mesh{lobed.vertices, lobe});
    for (Triangle& t : lobe) {
      if ((outward < 0) != is_inside_out) std::swap(t[1], t[2]);
      lobed.triangles.push_back(t);
    }
  }
  ProofVerdict of(const std::string& claim, const Mesh& mesh, const Sensor& sensor,
                  const Navigation& navigation) const {
    Target target = low_square();
    target.front = Vec3(0, 0, 1);
    return verdict_of(prove_volume(scene, target, sensor, navigation, mesh), claim);
  }
};

TEST(ProveForged, NoLimitIsProvedOfALobeThatIsInsideOut) {
  for (const bool is_inside_out : {true, false}) {
    const Lobed world(is_inside_out);
    const auto check = [&](const std::string& claim, const Sensor& sensor, const Navigation& navigation) {
      EXPECT_EQ(world.of(claim, world.box, sensor, navigation), ProofVerdict::proved) << claim;
      EXPECT_NE(world.of(claim, world.lobed, sensor, navigation), ProofVerdict::proved) << claim << is_inside_out;
    };
    const Sensor plain{.max_range_m = 50};
    Sensor sensor = plain;
    sensor.camera = pinhole_of_fov(40, 30);
    sensor.mount.min_pitch_deg = -90;
    sensor.mount.max_pitch_deg = -30;
    check("frame", sensor, {});
    sensor = plain;
    sensor.min_range_m = 8;
    check("min_range", sensor, {});
    sensor = plain;
    sensor.incidence_deg = 40;
    check("incidence", sensor, {});
    Navigation navigation;
    navigation.altitude = Navigation::Altitude{10, 30};
    check("altitude", plain, navigation);
    navigation = {};
    navigation.keep_in = {Box{{-9, -9, 10}, {9, 9, 30}}};
    check("keep_in", plain, navigation);
    navigation.keep_in.push_back(Box{{-9, -9, 9}, {9, 9, 29}});
    check("keep_in", plain, navigation);
    navigation = {};
    navigation.keep_in = {testing::zone_of({{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, 10, 30)};
    check("keep_in", plain, navigation);
    navigation = {};
    navigation.keep_out = {Box{{-1, -1, 2}, {1, 1, 5}}};
    check("keep_out", plain, navigation);
    navigation = {};
    navigation.keep_out = {testing::zone_of({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 2, 5)};
    check("keep_out", plain, navigation);
    navigation = {};
    navigation.meshes = {{make_box_mesh({-9, -9, 10}, {9, 9, 30}), "hall"}};
    check("meshes", plain, navigation);
    navigation = {};
    navigation.above_ground = AboveGround{10, 30, {0.0, nullptr}};
    check("agl", plain, navigation);
    navigation.above_ground->ground = {0.0, std::make_shared<const Mesh>(world.scene.mesh)};
    check("agl", plain, navigation);
    navigation = {};
    navigation.clearance = Clearance{8, std::make_shared<const Mesh>(world.scene.mesh)};
    check("clearance", plain, navigation);
  }
}

TEST(ProveForged, NorWhereTheLobeReachesUpOrThroughTheGround) {
  for (const bool is_inside_out : {true, false}) {
    const auto check = [&](const std::string& claim, const Sensor& sensor, const Vec3& far_end) {
      const Lobed world(is_inside_out, far_end);
      EXPECT_EQ(world.of(claim, world.box, sensor, {}), ProofVerdict::proved) << claim;
      EXPECT_NE(world.of(claim, world.lobed, sensor, {}), ProofVerdict::proved) << claim << is_inside_out;
    };
    const Vec3 above(0, 0, 40), below(0, 0, -20);
    const Sensor plain{.max_range_m = 50};
    Sensor sensor{.max_range_m = 20};
    check("range", sensor, above);
    sensor = plain;
    sensor.camera = pinhole_of_fov(170, 170, 4000, 4000);
    sensor.mount = {.yaw_deg = 0, .min_pitch_deg = -90, .max_pitch_deg = -90};
    sensor.pixel = PixelLimit{40 / *sensor.camera->focal_px};
    check("pixel", sensor, above);
    sensor = plain;
    sensor.sun = SunLimit{Vec3(0, 0, 1), 30};
    check("sun", sensor, below);
    check("front", plain, below);
  }
}

/// A cover that hides all of a target, below the lift that a file states: neither the proof nor the rays believe it.
TEST(ProveForged, NoLiftIsBelievedOverACover) {
  const Sensor sensor{.max_range_m = 50};
  const Mesh volume = make_box_mesh({-20, -20, 0.25}, {20, 20, 30});
  for (const double height : {0.003, 0.009}) {
    const double z = 0.1 + height;
    const Scene scene =
        SceneBuilder().ground("ground", 60).polygon("cover", {{-3, -3, z}, {3, -3, z}, {3, 3, z}, {-3, 3, z}});
    const ProofReport report = prove_volume(scene, low_square(), sensor, {}, volume, {.lift_m = {0.01}});
    EXPECT_EQ(verdict_of(report, "sight"), ProofVerdict::wrong) << height;
    EXPECT_LT(report.lift_m, 1e-5);
    EXPECT_EQ(report.lift_of_part_m, std::vector<double>{report.lift_m});
    VerifyOptions options;
    options.points = 500;
    options.lift_m = {0.01};
    EXPECT_GT(verify_volume(scene, low_square(), sensor, {}, volume, options).over_claimed, 100U) << height;
  }
}

}  // namespace
}  // namespace vantage
