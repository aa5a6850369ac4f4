// Computations that would take too much: refused before they begin, or ended at the same place every time.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "support/cli_fixture.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
using testing::expect_code;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;

TEST(WorkLimit, CountsTheWorkOfAllCopiesAndParts) {
  const ProgressReporter limited = ProgressReporter().limited(100, "do less");
  const ProgressReporter part = limited.part(0, 0.5);
  limited.spend(40);
  part.spend(60);
  EXPECT_EQ(part.spent(), 100);
  EXPECT_EQ(limited.spent(), 100);
  limited.expect(0);
  expect_code([&] { part.spend(1); }, ErrorCode::work_too_large);
  expect_code([&] { limited.expect(1); }, ErrorCode::work_too_large);
  EXPECT_EQ(limited.spent(), 100) << "what is refused is not counted";
  limited.limited(7, "do less").spend(7);
  EXPECT_EQ(limited.spent(), 100) << "a limit counts from now on";
}

TEST(WorkLimit, WithoutOneNothingIsCounted) {
  const ProgressReporter free;
  free.spend(1e300);
  free.expect(std::numeric_limits<double>::infinity());
  EXPECT_EQ(free.spent(), 0);
}

TEST(WorkLimit, SaysWhatToDo) {
  const ProgressReporter limited = ProgressReporter().limited(2e6, "ask for fewer cells");
  testing::expect_error([&] { limited.spend(3e6); }, ErrorCode::work_too_large);
}

PreparedScene soup(int triangles) {
  Random random(2203);
  SceneBuilder builder;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 at = random.point(-20, 20) + Vec3(0, 0, 24);
    builder.polygon("soup", {at, at + random.point(-6, 6), at + random.point(-6, 6)});
  }
  return PreparedScene(builder.scene());
}

Target square(double size) {
  return target_of({{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}});
}

TEST(WorkLimit, OfCellsEndsAtTheSamePlaceEachTime) {
  Sensor sensor{55};
  sensor.visible = VisibleShare{0.5, 8};
  const PreparedTarget target(soup(12), square(3), sensor);
  const auto stages_until_refused = [&](double limit) {
    std::vector<double> fractions;
    const Progress note = [&](std::string_view, double fraction) {
      if (fractions.empty() || fraction != fractions.back()) fractions.push_back(fraction);
      return true;
    };
    const ProgressReporter::AskAlways always;
    expect_code([&] { compute_parts(target, {.tolerance_m = 0.1, .work_limit = limit}, note); },
                ErrorCode::work_too_large);
    return fractions.empty() ? 0 : fractions.back();
  };
  const double reached = stages_until_refused(30'000);
  EXPECT_GT(reached, 0) << "it may begin";
  EXPECT_LT(reached, 1);
  EXPECT_EQ(stages_until_refused(30'000), reached);
  const Volume whole = compute_parts(target, {.tolerance_m = 0.1});
  EXPECT_EQ(whole.outcome, Outcome::computed);
  const Volume as_whole = compute_parts(target, {.tolerance_m = 0.1, .work_limit = 1e12});
  EXPECT_EQ(as_whole.mesh.vertices, whole.mesh.vertices) << "the limit changes no result";
}

TEST(WorkLimit, OfPartsAndSeveralTargets) {
  const PreparedScene scene = soup(8);
  std::vector<Volume> volumes;
  for (const double x : {-3.0, 0.0, 3.0}) {
    volumes.push_back(compute_visibility(
        PreparedTarget(scene, target_of({{x, 0, 0}, {x + 2, 0, 0}, {x + 1, 2, 0}}), {55}), {0.1, 0}));
  }
  const double few = 10;
  expect_code([&] { intersect_volumes(volumes, {}, few); }, ErrorCode::work_too_large);
  expect_code([&] { unite_volumes(volumes, {}, few); }, ErrorCode::work_too_large);
  EXPECT_EQ(intersect_volumes(volumes).outcome, Outcome::computed);
  EXPECT_EQ(unite_volumes(volumes).outcome, Outcome::computed);
}

/// A rough surface of so many posts along each side.
std::shared_ptr<const Mesh> rough_surface(std::uint32_t posts) {
  Random random(2207);
  Mesh mesh;
  for (std::uint32_t i = 0; i < posts; ++i) {
    for (std::uint32_t k = 0; k < posts; ++k) {
      const double part = 120.0 / (posts - 1);
      mesh.vertices.emplace_back(part * i - 60, part * k - 60, random.uniform(-9, -5));
    }
  }
  for (std::uint32_t i = 0; i + 1 < posts; ++i) {
    for (std::uint32_t k = 0; k + 1 < posts; ++k) {
      const std::uint32_t a = posts * i + k, b = a + posts;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return std::make_shared<const Mesh>(std::move(mesh));
}

TEST(WorkLimit, OfTheClearanceIsToldBeforeTheFirstBoolean) {
  Navigation navigation;
  navigation.clearance = {10, rough_surface(250)};  // 124,002 triangles
  const Volume dome = testing::make_hemisphere(Vec3::Zero(), 55);
  double farthest = 0;
  const Progress note = [&](std::string_view, double fraction) {
    farthest = std::max(farthest, fraction);
    return true;
  };
  {
    const ProgressReporter::AskAlways always;
    expect_code([&] { cut_to_navigation(dome, navigation, note, 0.02 * kWorkLimit); }, ErrorCode::work_too_large);
  }
  EXPECT_LT(farthest, 0.55) << "solids were made already";
  // What the other limits cut off needs no clearance from what lies there.
  navigation.altitude = {8, 60};
  const Volume high = cut_to_navigation(dome, navigation);
  EXPECT_EQ(high.outcome, Outcome::computed) << high.reason;
  EXPECT_EQ(testing::first_open_edge(high.mesh), "");
}

// The limit is enough to find that nothing is left, and not for the booleans that tell which limit is the reason.
TEST(WorkLimit, LeavesAnEmptyVolumeItsReason) {
  const Volume dome = testing::make_hemisphere(Vec3::Zero(), 55, 90, 40);
  Navigation navigation;
  navigation.altitude = {200, 300};
  const auto cut = [&](double limit) { return cut_to_navigation(dome, navigation, {}, limit); };
  const Volume empty = cut(1.2 * static_cast<double>(dome.mesh.triangles.size()));
  EXPECT_EQ(empty.outcome, Outcome::outside_limits);
  EXPECT_EQ(empty.reason, cut(kWorkLimit).reason);
  EXPECT_EQ(empty.hint, cut(kWorkLimit).hint);
  EXPECT_FALSE(empty.reason.empty());
}

TEST(WorkLimit, OfTheGroundInPiecesOverEachOther) {
  Random random(2213);
  Mesh pieces;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 at = random.in_box({Vec3(-40, -40, -3), Vec3(40, 40, 0)});
    testing::append(pieces,
                    {{at, at + Vec3(random.uniform(1, 9), 0, 1), at + Vec3(0, random.uniform(1, 9), 0)}, {{0, 1, 2}}});
  }
  Navigation navigation;
  navigation.above_ground = {2, 30, Ground{0, std::make_shared<const Mesh>(pieces)}};
  expect_code([&] { cut_to_navigation(testing::make_hemisphere(Vec3::Zero(), 50), navigation, {}, 40'000); },
              ErrorCode::work_too_large);
}

TEST(WorkLimit, IsAKeyOfTheMissionAndNoPartOfItsHash) {
  const std::string text = "sensor: {max_range: 60}\ntarget: {vertices: [[-5, -5, 0], [5, -5, 0], [5, 5, 0]]}\n";
  const auto read = [](const std::string& mission) { return read_mission_text(mission, "m.yaml", SceneSource{}); };
  EXPECT_EQ(read(text).exact.work_limit, kWorkLimit);
  const MissionFile raised = read(text + "work_limit: 3e7\n");
  EXPECT_EQ(raised.exact.work_limit, 3e7);
  const std::string written = mission_text(raised, ".");
  const std::size_t line = written.find("work_limit: ");
  ASSERT_NE(line, std::string::npos);
  EXPECT_EQ(read(text + written.substr(line, written.find('\n', line) - line) + "\n").exact.work_limit, 3e7);
  EXPECT_EQ(mission_text(read(text), ".").find("work_limit"), std::string::npos);
  for (const char* wrong : {"0", "-1", "many", ".inf"}) {
    EXPECT_THROW(read(text + "work_limit: " + wrong + "\n"), Error) << wrong;
  }
  const auto hash_of = [](const MissionFile& file) {
    return mission_hash(resolve_mission(file, std::make_shared<const LoadedScene>()));
  };
  EXPECT_EQ(hash_of(raised), hash_of(read(text)));
}

class CliWorkLimit : public testing::Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    Random random(2221);
    std::string text;
    for (int i = 0; i < 60; ++i) {
      const Vec3 at = random.point(-20, 20) + Vec3(0, 0, 24);
      text += "o soup\n";
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = at + random.point(-6, 6);
        text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
      }
      text += "f -3 -2 -1\n";
    }
    write("soup.obj", text);
    write("mission.yaml", std::string("scene: {mesh: soup.obj}\nsensor: {max_range: 55, visible: 0.5}\n") +
                              testing::kTarget + "work_limit: 100000\n");
  }
};

TEST_F(CliWorkLimit, RefusesAndLeavesAllFilesAsTheyWere) {
  expect_bad({"compute", "mission.yaml", "-q", "-o", "volume.ply"}, "mission.yaml");
}

// The computation would take minutes.
TEST_F(CliWorkLimit, TellsHowFarItIsInAPipeAndStopsWithNothingHalf) {
  write("mission.yaml", std::string("scene: {mesh: soup.obj}\nsensor: {max_range: 55, visible: 0.5}\n") +
                            testing::kTarget + "work_limit: 1e12\n");
  const auto before = files();
  options_.shows_progress = true;
  options_.signal = SIGINT;
  options_.signal_when = [](const std::string& err) { return err.find("vantage: cells ") != std::string::npos; };
  for (const char* word : {"", "always"}) {  // there is one word that says otherwise, "never"
    options_.progress_word = word;
    const testing::ProgramRun result = run({"compute", "mission.yaml", "-o", "volume.ply"});
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(files() == before);
  }
}

// It takes seconds until it is refused.
TEST_F(CliWorkLimit, NeverTellsHowFarItIsWhereThatIsAskedFor) {
  write("mission.yaml", std::string("scene: {mesh: soup.obj}\nsensor: {max_range: 55, visible: 0.5}\n") +
                            testing::kTarget + "work_limit: 400000\n");
  expect_refused({"compute", "mission.yaml", "-o", "volume.ply"}, "mission.yaml");  // three lines, no more
}

TEST_F(CliWorkLimit, AQuickCommandInAPipeSaysNothingOfItsProgress) {
  options_.shows_progress = true;
  EXPECT_NE(output_of({"inspect", "city.obj"}), "");
}

TEST_F(CliWorkLimit, TheClearanceTellsHowFarItIsInAPipe) {
  const Mesh rough = *rough_surface(160);  // 50,562 triangles
  std::string text = "o roofs\n";
  for (const Vec3& p : rough.vertices) {
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  }
  for (const auto& [a, b, c] : rough.triangles) {
    text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
  }
  write("rough.obj", text);
  write("mission.yaml", std::string("scene: {mesh: rough.obj}\nsensor: {max_range: 55}\n") + testing::kTarget +
                            "navigation: {clearance: 10}\nwork_limit: 1e12\n");
  const auto before = files();
  options_.shows_progress = true;
  options_.signal = SIGINT;
  options_.signal_when = [](const std::string& err) { return err.find("vantage: navigation ") != std::string::npos; };
  const testing::ProgramRun result = run({"compute", "mission.yaml", "-o", "volume.ply"});
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(files() == before);
}

TEST_F(CliWorkLimit, TheHelpNamesTheWordThatSilencesProgress) {
  EXPECT_NE(output_of({"compute", "--help"}).find("VANTAGE_PROGRESS=never"), std::string::npos);
}

}  // namespace
}  // namespace vantage
