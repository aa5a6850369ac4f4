// What travels in a volume's file: what it was computed for, and its hash.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/output.h"
#include "support/formats.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::read_bytes;
using testing::SceneBuilder;
using testing::TemporaryDirectory;
using testing::write_bytes;

Scene yard() {
  return SceneBuilder()
      .ground("ground", 60)
      .box("shed", {4, 4, 0}, {8, 9, 5})
      .box("tower", {-20, -9, 0}, {-12, -4, 30});
}

/// The first lies under the ground, by less than surfaces are planar, and so is raised.
Target two_squares() {
  Target target;
  target.name = "two \"squares\"";
  constexpr double kUnder = -0.0015;
  target.parts = {{{-2, -2, kUnder}, {0, -2, kUnder}, {0, 0, kUnder}, {-2, 0, kUnder}},
                  {{0.5, 0.25, 0}, {2, 0.25, 0}, {2, 2, 0}}};
  target.front = Vec3(0, 0, 1);
  return target;
}

/// What holds the statement of a volume's file: the one beside it, where there is one.
std::filesystem::path holder_of(const std::filesystem::path& file) {
  const std::filesystem::path beside = file.string() + ".place.json";
  return std::filesystem::exists(beside) ? beside : file;
}

bool is_single(const std::filesystem::path& file) {
  const std::vector<FormatFacts> formats = known_formats();
  const auto format = std::find_if(formats.begin(), formats.end(),
                                   [&](const FormatFacts& one) { return one.extension == file.extension(); });
  return format->is_single;
}

class Provenance : public ::testing::TestWithParam<std::string> {
 protected:
  Provenance() {
    volume_ = compute_volume(PreparedTarget(PreparedScene(scene_), two_squares(), {40}));
    volume_.provenance->scene_hash = scene_hash(scene_);
    volume_.provenance->mission_hash = std::string(64, 'a');
  }

  TemporaryDirectory folder_;
  Scene scene_ = yard();
  Volume volume_;
};

TEST_P(Provenance, TravelsInTheFile) {
  ASSERT_EQ(volume_.outcome, Outcome::computed) << volume_.reason;
  const std::filesystem::path file = folder_ / GetParam();
  write_volume(volume_, file, UpAxis::y, 0.3048);
  const VolumeFile read = read_volume(file);
  ASSERT_TRUE(read.volume.provenance.has_value());
  const VolumeProvenance& made = *read.volume.provenance;
  EXPECT_EQ(made.version, VANTAGE_VERSION);
  EXPECT_EQ(made.method, "exact");
  EXPECT_EQ(made.target.name, two_squares().name);
  EXPECT_EQ(made.target.parts, two_squares().parts);
  EXPECT_EQ(made.target.front, two_squares().front);
  EXPECT_EQ(made.sensor.max_range_m, 40);
  EXPECT_EQ(made.scene_hash, scene_hash(scene_));
  EXPECT_EQ(made.mission_hash, std::string(64, 'a'));
  EXPECT_EQ(read.volume.tolerance_m, volume_.tolerance_m);
  ASSERT_EQ(read.volume.lift_m.size(), 2U);
  EXPECT_EQ(read.volume.lift_m, volume_.lift_m);
  EXPECT_GT(read.volume.lift_m[0], 0);
}

TEST_P(Provenance, TheHashIsThatOfWhatIsRead) {
  const std::filesystem::path file = folder_ / GetParam();
  write_volume(volume_, file, UpAxis::y, 0.3048);
  const VolumeFile read = read_volume(file);
  EXPECT_EQ(read.volume_hash.size(), 64U);
  EXPECT_EQ(volume_hash(read.volume.mesh), read.volume_hash);
}

TEST_P(Provenance, AMovedFileIsJudgedAlike) {
  const std::string name = GetParam();
  write_volume(volume_, folder_ / name);
  std::filesystem::create_directory(folder_ / "elsewhere");
  const std::filesystem::path moved = folder_ / "elsewhere" / ("renamed" + name.substr(name.find('.')));
  std::filesystem::rename(folder_ / name, moved);
  const std::filesystem::path beside = (folder_ / name).string() + ".place.json";
  if (std::filesystem::exists(beside)) std::filesystem::rename(beside, moved.string() + ".place.json");
  const VolumeFile read = read_volume(moved);
  VerifyOptions options;
  options.points = 4000;
  options.lift_m = read.volume.lift_m;
  options.rounding_m = read.rounding_m;
  const VerifyReport report = verify_volume(scene_, two_squares(), {40}, {}, read.volume.mesh, options);
  EXPECT_TRUE(report.is_right()) << report.over_claimed << " over-claimed, because of " << report.worst_over_cause;
  options.lift_m.clear();
  EXPECT_GT(verify_volume(scene_, two_squares(), {40}, {}, read.volume.mesh, options).over_claimed, 0U)
      << "what the file says is needed";
}

TEST_P(Provenance, AGarbledStatementIsRefused) {
  const std::filesystem::path file = folder_ / GetParam();
  write_volume(volume_, file);
  const std::filesystem::path holder = holder_of(file);
  std::string bytes = read_bytes(holder);
  const std::size_t at = bytes.find("max_range_m");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 11, "max_range_x");
  write_bytes(holder, bytes);
  try {
    read_volume(file);
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(error.where().find(file.filename().string()), std::string::npos) << error.what();
  }
}

TEST_P(Provenance, ARoundingThatCannotBeIsNotAllowed) {
  const std::filesystem::path file = folder_ / GetParam();
  write_volume(volume_, file);
  const double stated = read_volume(file).rounding_m;
  const std::filesystem::path holder = holder_of(file);
  std::string bytes = read_bytes(holder);
  std::size_t at = bytes.find("rounding_m");
  ASSERT_NE(at, std::string::npos);
  at = bytes.find_first_of("0123456789", at);
  ASSERT_NE(at, std::string::npos);
  bytes[at] = '9';  // metres, whatever the rest of the number was
  const std::size_t end = bytes.find_first_not_of("0123456789", at);
  for (std::size_t i = end; i < bytes.size() && std::string("0123456789.e-+").find(bytes[i]) != std::string::npos;
       ++i) {
    bytes[i] = ' ';
  }
  write_bytes(holder, bytes);
  const VolumeFile read = read_volume(file);
  EXPECT_LT(read.rounding_m, is_single(file) ? 1e-4 : 1e-12);
  EXPECT_GE(read.rounding_m, stated);
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_EQ(read.notes[0].code, WarningCode::rounding_overstated);
}

/// However much has to be mended: of small volumes far away facets lose their area.
TEST_P(Provenance, TheRoundingThatIsWrittenIsAllowed) {
  const std::filesystem::path file = folder_ / GetParam();
  const bool rounds = is_single(file);
  double most = 0;
  for (const double size : {1.0, 1e-3, 1e-6, 1e-8}) {
    for (const double away : {0.0, 1.7e3, 5.4e6}) {
      for (const double unit : {0.3048, 0.01, 1 / 3.0, 25.4}) {
        SCOPED_TRACE(::testing::Message() << size << " " << away << " " << unit);
        if (rounds && size < 1 && away > 0) continue;  // nothing would be left
        Volume moved = volume_;
        for (Vec3& v : moved.mesh.vertices) v = size * v + Vec3(away, -away / 3, away / 7);
        const WrittenVolume written = write_volume(moved, file, UpAxis::y, unit);
        const VolumeFile read = read_volume(file);
        EXPECT_EQ(read.rounding_m, written.rounding_m);
        EXPECT_TRUE(read.notes.empty());
        Box box;
        for (const Vec3& v : read.volume.mesh.vertices) box.extend(v);
        const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
        most = std::max(most, written.rounding_m / std::ldexp(largest, rounds ? -24 : -53));
      }
    }
  }
  EXPECT_GT(most, 1) << "there was nothing to mend";
}

/// Where the first coordinate of a volume's file stands; 0 where it is not said.
std::size_t first_coordinate(const std::string& name, const std::string& bytes) {
  if (name == "v.ply") return bytes.find("end_header\n") + 11;
  if (name == "v.obj") return bytes.find_first_of("0123456789", bytes.find("\nv "));
  if (name == "v.stl") return 84 + 3 * sizeof(float);  // behind the header and the facet's normal
  if (name != "v.glb") return 0;
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, bytes.data() + 12, sizeof json_bytes);
  return 20 + json_bytes + 8;
}

TEST_P(Provenance, AChangedMeshIsNoticed) {
  const std::filesystem::path file = folder_ / GetParam();
  write_volume(volume_, file);
  EXPECT_TRUE(read_volume(file).notes.empty());
  std::string bytes = read_bytes(file);
  const std::size_t at = first_coordinate(GetParam(), bytes);
  if (at == 0) GTEST_SKIP() << "first_coordinate() does not know the format";
  bytes[at] ^= 1;  // of an OBJ 2 becomes 3
  write_bytes(file, bytes);
  const VolumeFile changed = read_volume(file);
  ASSERT_EQ(changed.notes.size(), 1U);
  EXPECT_EQ(changed.notes[0].code, WarningCode::volume_changed);
}

INSTANTIATE_TEST_SUITE_P(Formats, Provenance, ::testing::ValuesIn(testing::in_each_format("v")),
                         [](const auto& parameter) { return parameter.param.substr(2); });

TEST(ProvenanceOfPly, LinesAreShort) {
  const TemporaryDirectory folder;
  Target many;
  for (int i = 0; i < 60; ++i) many.parts[0].emplace_back(3 * std::cos(0.1 * i), 3 * std::sin(0.1 * i), 0.1);
  write_volume(compute_visibility(PreparedTarget(PreparedScene(yard()), many, {20})), folder / "v.ply");
  std::istringstream header(read_bytes(folder / "v.ply"));
  int lines = 0;
  for (std::string line; std::getline(header, line) && line != "end_header"; ++lines) EXPECT_LT(line.size(), 256U);
  EXPECT_GT(lines, 20);
  EXPECT_EQ(read_volume(folder / "v.ply").volume.provenance->target.parts, many.parts);
}

// A sensor that no volume is computed for, or that is none.
TEST(ProvenanceOfStl, AnImpossibleSensorIsRefused) {
  const TemporaryDirectory folder;
  Target target;
  target.parts = {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  Volume volume = compute_volume(PreparedTarget(PreparedScene(yard()), target, {20}));
  const auto is_refused = [&](const Sensor& sensor, const std::string& from = "", const std::string& to = "") {
    volume.provenance->sensor = sensor;
    write_volume(volume, folder / "v.stl");
    std::string beside = read_bytes(folder / "v.stl.place.json");
    const std::size_t at = beside.find(from);
    EXPECT_NE(at, std::string::npos) << beside;
    write_bytes(folder / "v.stl.place.json", beside.replace(at, from.size(), to));
    try {
      read_volume(folder / "v.stl");
      return false;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::record_garbled);
      EXPECT_LT(error.problem().size(), 200U) << "it quotes little of the file";
      return true;
    }
  };
  const Sensor right{.max_range_m = 20, .sun = SunLimit{Vec3(0, 1, 1), 5}, .visible = VisibleShare{0.5, 77}};
  EXPECT_FALSE(is_refused(right));
  EXPECT_TRUE(is_refused(right, "77", "1e30"));
  EXPECT_TRUE(is_refused(right, "77", "-1"));
  EXPECT_TRUE(is_refused(right, "77", "1025"));
  EXPECT_TRUE(is_refused(right, "\"sensor\":", "\"sensor\":true,\"was\":"));
  EXPECT_TRUE(is_refused(right, "77", "\"" + std::string(100'000, 'x') + "\""));
  Sensor wrong = right;
  wrong.sun->exclude_deg = 400;
  EXPECT_TRUE(is_refused(wrong));
  wrong = right;
  wrong.camera.emplace().half_width = 0.5;
  wrong.camera->half_height = 0.4;
  EXPECT_FALSE(is_refused(wrong));
  wrong.mount.max_pitch_deg = 120;
  EXPECT_TRUE(is_refused(wrong));
}

TEST(MissionHash, DependsOnWhatIsAskedAlone) {
  const TemporaryDirectory folder;
  write_scene(yard(), folder / "yard.obj");
  const auto hash = [&](const std::string& name, const std::string& more) {
    write_bytes(folder / name, "# a comment\nscene: {mesh: yard.obj}\n" + more);
    return mission_hash(resolve_mission(read_mission(folder / name)));
  };
  const std::string target = "target: {name: a, vertices: [[0, 0, 1], [1, 0, 1], [0, 1, 1]]}\n";
  const std::string range = "sensor: {max_range: 30}\n";
  const std::string plain = hash("one.yaml", target + range);
  EXPECT_EQ(plain.size(), 64U);
  const std::string same = "target: {name: b, vertices: [[0, 0, 1.0], [1, 0, 1], [-0, 1, 1]]}\n";
  EXPECT_EQ(hash("two.yaml", range + same), plain);
  const std::string farther = "sensor: {max_range: 31}\n";
  EXPECT_NE(hash("one.yaml", target + farther), plain);
  EXPECT_NE(hash("one.yaml", target + range + "navigation: {altitude: [1, 20]}\n"), plain);
  EXPECT_NE(hash("one.yaml", target + range + "exact: {tolerance: 0.02}\n"), plain);
  EXPECT_NE(hash("one.yaml", target + range + "method: spheres\n"), plain);
}

}  // namespace
}  // namespace vantage
