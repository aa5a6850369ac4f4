// Configuration files of the published program: what they say, what is refused, and the volumes that it computed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/mesh_reading.h"
#include "vantage/spheres.h"

namespace vantage::testing {
namespace {

// As their tools write it: blanks before colons, comments, a comma in a key, blocks again and again.
constexpr const char* kAsTheirs = R"(world_coord_sys:
  id: world
  origin: [0.0, 0.0, 0.0]
  up: [0.0, 1.0, 0.0]
  front: [1.0, 0.0, 0.0]

mesh:
  id: battcave
  position : [0.0, 0.0, 0.0]
  scale : 1.0
  orientation axis, angle: [1, 0, 0, 0]
  format : OBJ
  filename : /maps/battcave.obj

visibility_vol:
  id: 2
  width: 40
  height: 40
  fov_degrees: 90
  # x, z, -y
  origin: [-14.638578, 0.500000, -9.623141]
  front: [1.0, 0.0, 0.0]
  up: [0.0, 1.0, 0.0]
  # max height of visibility volume above ground plane [meters]
  up_max: 1000.0
  # min height of visibility volume above ground plane [meters]
  up_min: -1.0
  radius_max: 100.000000
  output_file: /out/v_002.obj

visibility_vol:
  id: Volume 3
  width: 8
  height: 8
  origin: [1, 2, 3]
  output_file: sub/v.ply
)";

const std::filesystem::path kFolder = "/folder";

TEST(WillisConfig, ReadsWhatTheirToolsWrite) {
  const WillisConfig config = parse_willis_config(kAsTheirs, kFolder / "c.yaml");
  EXPECT_TRUE(config.warnings.empty());
  EXPECT_EQ(config.up, UpAxis::y);
  ASSERT_EQ(config.meshes.size(), 1U);
  EXPECT_EQ(config.meshes[0].file, "/maps/battcave.obj");
  EXPECT_EQ(config.meshes[0].where, kFolder / "c.yaml:13:14");
  EXPECT_EQ(config.meshes[0].rotation, Eigen::Matrix3d::Identity());
  ASSERT_EQ(config.volumes.size(), 2U);
  const WillisVolume& first = config.volumes[0];
  EXPECT_EQ(first.name, "volume 2");
  EXPECT_EQ(first.texels, 40);
  EXPECT_EQ(first.origin, Vec3(-14.638578, 0.5, -9.623141));
  EXPECT_EQ(first.up_min, -1);
  EXPECT_EQ(first.up_max, 1000);
  EXPECT_EQ(first.radius_max, 100);
  EXPECT_EQ(first.output, "/out/v_002.obj");
  EXPECT_EQ(first.where, kFolder / "c.yaml:21:11");
}

TEST(WillisConfig, HasDefaults) {
  const WillisConfig config = parse_willis_config(kAsTheirs, kFolder / "c.yaml");
  const WillisVolume& second = config.volumes.at(1);
  EXPECT_EQ(second.name, "volume Volume 3");
  EXPECT_EQ(second.front, Vec3::UnitX());
  EXPECT_EQ(second.up, Vec3::UnitY());
  EXPECT_EQ(second.up_min, -INFINITY);
  EXPECT_EQ(second.up_max, INFINITY);
  EXPECT_EQ(second.radius_max, INFINITY);
  EXPECT_EQ(second.output, kFolder / "sub/v.ply");
  const WillisConfig least = parse_willis_config(
      "visibility_vol: {width: 4, height: 4, origin: [0, 0, 0], output_file: v.obj}\nmesh: {filename: a.obj}\n", "c");
  EXPECT_EQ(least.up, UpAxis::y);
  EXPECT_EQ(least.meshes[0].scale, Vec3::Ones());
  expect_wording(least.volumes[0].name);
}

TEST(WillisConfig, PlacesMeshes) {
  const WillisConfig config = parse_willis_config(
      "mesh: {filename: a.obj, scale: [1, 2, 3], position: [4, 5, 6], 'orientation axis, angle': [0, 0, 2, 450]}\n"
      "mesh: {filename: b.ply, format: ply, material: stone}\n"
      "visibility_vol: {width: 4, height: 4, origin: [0, 0, 0], front: [1, 5, 0], output_file: v.obj}\n",
      "c");
  ASSERT_EQ(config.meshes.size(), 2U);
  EXPECT_EQ(config.meshes[0].scale, Vec3(1, 2, 3));
  EXPECT_EQ(config.meshes[0].position, Vec3(4, 5, 6));
  EXPECT_LT((config.meshes[0].rotation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(config.volumes[0].front, Vec3::UnitX()) << "made level";
  EXPECT_TRUE(config.warnings.empty());
}

TEST(WillisConfig, TellsKeysThatMeanNothing) {
  const WillisConfig config = parse_willis_config(
      "light: {intensity: 3}\nmesh: {filename: a.obj, colour: red}\n"
      "visibility_vol: {width: 4, height: 4, origin: [0, 0, 0], output_file: v.obj}\n",
      "c.yaml");
  ASSERT_EQ(config.warnings.size(), 2U);
  EXPECT_EQ(config.warnings[0].rfind("c.yaml:1:1:", 0), 0U) << config.warnings[0];
  EXPECT_EQ(config.warnings[1].rfind("c.yaml:2:25:", 0), 0U) << config.warnings[1];
  expect_wording(config.warnings);
}

/// Expects an input error of kAsTheirs with `from` replaced by `to`.
void expect_refused(const std::string& from, const std::string& to, ErrorCode code, const std::string& where) {
  std::string text = kAsTheirs;
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  expect_error([&] { parse_willis_config(text, "c.yaml"); }, code, where);
}

TEST(WillisConfig, RefusesCubesThatAreNone) {
  expect_refused("fov_degrees: 90", "fov_degrees: 60", ErrorCode::value_unsupported, "c.yaml:19:16");
  expect_refused("width: 40", "width: 80", ErrorCode::value_unsupported, "c.yaml:18:11");
  expect_refused("width: 40", "width: 0", ErrorCode::value_out_of_range, "c.yaml:17:10");
  expect_refused("width: 40", "width: 100000", ErrorCode::value_out_of_range, "c.yaml:17:10");
  expect_refused("width: 40", "width: 40.5", ErrorCode::value_out_of_range, "c.yaml:17:10");
  expect_refused("width: 40", "width: -3", ErrorCode::value_out_of_range, "c.yaml:17:10");
  expect_refused("height: 40", "height:", ErrorCode::wrong_type, "c.yaml:18:3");
  expect_refused("  front: [1.0, 0.0, 0.0]\n  up: [0.0", "  front: [0, 2, 0]\n  up: [0.0", ErrorCode::direction_invalid,
                 "c.yaml:22:10");
  expect_refused("  up: [0.0, 1.0, 0.0]\n  # max", "  up: [0, 0, 0]\n  # max", ErrorCode::direction_invalid,
                 "c.yaml:23:7");
}

TEST(WillisConfig, RefusesNumbersThatAreNone) {
  expect_refused("-14.638578", ".nan", ErrorCode::value_out_of_range, "c.yaml:21:12");
  expect_refused("-14.638578", "-inf", ErrorCode::value_out_of_range, "c.yaml:21:12");
  expect_refused("-14.638578", "1e400", ErrorCode::value_out_of_range, "c.yaml:21:12");
  expect_refused("-14.638578", "1e12", ErrorCode::value_out_of_range, "c.yaml:21:12");
  expect_refused("-14.638578, ", "", ErrorCode::wrong_type, "c.yaml:21:11");
  expect_refused("radius_max: 100", "radius_max: -100", ErrorCode::value_out_of_range, "c.yaml:28:15");
  expect_refused("radius_max: 100.000000", "radius_max: .inf", ErrorCode::value_out_of_range, "c.yaml:28:15");
  expect_refused("up_min: -1.0", "up_min: 1000", ErrorCode::limits_reversed, "c.yaml:27:11");
  expect_refused("up_min: -1.0", "up_min: 0.6", ErrorCode::limits_empty, "c.yaml:21:11");
  expect_refused("scale : 1.0", "scale : 0", ErrorCode::value_out_of_range, "c.yaml:10:11");
  expect_refused("scale : 1.0", "scale : [1, -1, 1]", ErrorCode::value_out_of_range, "c.yaml:10:11");
  expect_refused("[1, 0, 0, 0]", "[0, 0, 0, 90]", ErrorCode::direction_invalid, "c.yaml:11:28");
  expect_refused("[1, 0, 0, 0]", "[1, 0, 0]", ErrorCode::wrong_type, "c.yaml:11:28");
}

TEST(WillisConfig, RefusesWhatIsMissingOrMeantOtherwise) {
  expect_refused("  filename : /maps/battcave.obj\n", "", ErrorCode::missing_key, "c.yaml:8:3");
  expect_refused("  output_file: /out/v_002.obj\n", "", ErrorCode::missing_key, "c.yaml:16:3");
  expect_refused("  origin: [1, 2, 3]\n", "", ErrorCode::missing_key, "c.yaml:32:3");
  expect_refused("format : OBJ", "format : DAE", ErrorCode::value_unsupported, "c.yaml:12:12");
  expect_refused("radius_max: 100", "radius_mx: 100", ErrorCode::unknown_key, "c.yaml:28:3");
  expect_refused("sub/v.ply", "/out/./v_002.obj", ErrorCode::output_named_twice, "c.yaml:36:16");
  expect_refused("up: [0.0, 1.0, 0.0]\n  front", "up: [1, 0, 0]\n  front", ErrorCode::value_unsupported, "c.yaml:4:7");
  expect_refused("origin: [0.0, 0.0, 0.0]", "origin: [0, 0, 1]", ErrorCode::value_unsupported, "c.yaml:3:11");
  expect_refused("width: 40", "width: 40\n  width: 40", ErrorCode::duplicate_key, "c.yaml:18:3");
  expect_refused("world_coord_sys:", "world_coord_sys: {}\nworld_coord_sys:", ErrorCode::duplicate_key, "c.yaml:2:1");
  expect_error([] { parse_willis_config("mesh: {filename: a.obj}\n", "c"); }, ErrorCode::missing_key, "c:1:1");
  expect_error(
      [] {
        parse_willis_config("visibility_vol: {width: 4, height: 4, origin: [0, 0, 0], output_file: v.obj}\n", "c");
      },
      ErrorCode::missing_key, "c:1:1");
  expect_error([] { parse_willis_config("mesh: 3\n", "c"); }, ErrorCode::wrong_type, "c:1:7");
  expect_error([] { parse_willis_config("", "c"); }, ErrorCode::file_empty, "c");
}

TEST(WillisConfig, BoundsTheNumberOfBlocks) {
  std::string text = "mesh: {filename: a.obj}\n";
  const auto add = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      text += "visibility_vol: {width: 4, height: 4, origin: [0,0,0], output_file: v" + std::to_string(i) + ".obj}\n";
    }
  };
  add(0, 500);
  EXPECT_EQ(parse_willis_config(text, "c").volumes.size(), 500U);
  add(500, 10001);
  expect_error([&] { parse_willis_config(text, "c"); }, ErrorCode::yaml_unsupported, "c");
}

}  // namespace
}  // namespace vantage::testing
