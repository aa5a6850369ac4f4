// What holds for every limit: given alone it is visited as itself, it is asked of points and legs, cut, verified,
// proved, written and hashed. Limits are those of the table, support/limit_samples.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "app/mission_parser.h"
#include "support/legs.h"
#include "support/limit_samples.h"
#include "support/places.h"
#include "support/random.h"
#include "support/temporary_directory.h"
#include "vantage/each_limit.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/result.h"
#include "vantage/solid.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::limit_samples;
using testing::LimitSample;
using testing::LimitWorld;
using testing::TemporaryDirectory;

std::vector<Limit> visited(const LimitWorld& world) {
  std::vector<Limit> found;
  const auto visit = [&](Limit limit, const auto& /*value*/) { found.push_back(limit); };
  each_limit(world.navigation, visit);
  each_limit(world.sensor, visit);
  return found;
}

TEST(EachLimit, IsVisitedAlone) {
  EXPECT_TRUE(Navigation().empty());
  EXPECT_TRUE(visited({}).empty());
  LimitWorld all = testing::world_of_samples();
  std::vector<Limit> names;
  for (const LimitSample& sample : limit_samples()) {
    SCOPED_TRACE(name_of(sample.limit));
    LimitWorld alone = testing::world_of_samples();
    EXPECT_TRUE(visited(alone).empty());
    sample.add(alone);
    EXPECT_EQ(visited(alone), std::vector<Limit>{sample.limit});
    EXPECT_EQ(alone.navigation.empty(), !testing::is_of_navigation(sample.limit));
    EXPECT_EQ(alone.sensor.limits_view(), !testing::is_of_navigation(sample.limit));
    sample.add(all);
    names.push_back(sample.limit);
  }
  EXPECT_EQ(visited(all), names) << "in the order of Limit";
  EXPECT_EQ(std::set<Limit>(names.begin(), names.end()).size(), names.size());
}

TEST(EachLimit, IsNoneOfWhatTheVolumeIsComputedWith) {
  LimitWorld none;
  none.sensor.max_range_m = 10;
  none.sensor.pixel = PixelLimit{0.1, PixelLimit::Kind::perpendicular};
  none.sensor.link = RadioLink{2.4, 0.6};
  none.sensor.visible = VisibleShare{0.5, 16};
  EXPECT_FALSE(none.sensor.limits_view());
  EXPECT_TRUE(visited(none).empty());
}

// A fuzzer finds the keys of a limit, and what is wrong with their reader, by the seeds.
TEST(EachLimit, IsInASeedOfTheFuzzer) {
  std::set<Limit> found;
  for (const auto& seed :
       std::filesystem::directory_iterator(testing::source_folder() / "tests" / "fuzz" / "seeds" / "mission")) {
    const MissionFile mission = internal::app::parse_mission(testing::read_bytes(seed.path()), seed.path());
    const std::vector<Limit> limits = visited({{}, {}, mission.sensor, mission.navigation});
    found.insert(limits.begin(), limits.end());
    if (!mission.navigation_meshes.empty()) found.insert(Limit::meshes);  // they are files
    if (mission.camera) found.insert(Limit::frame);                       // it is told when the camera is known
  }
  for (const LimitSample& sample : limit_samples()) EXPECT_EQ(found.count(sample.limit), 1u) << name_of(sample.limit);
}

class EveryLimit : public ::testing::TestWithParam<std::size_t> {
 protected:
  /// The volume with the limit, and without.
  static Volume volume_of(const LimitWorld& world) {
    return compute_volume(PreparedTarget(PreparedScene(world.scene), world.target, world.sensor), world.navigation);
  }
  /// Of `kept` and `broken`, above 0 inside.
  std::vector<double> depths_in(const Mesh& mesh) const {
    return SolidIndex(mesh).depths_m(std::vector<Vec3>{sample_.kept, sample_.broken});
  }
  static Mission mission_of(const LimitWorld& world) {
    Mission mission;
    auto loaded = std::make_shared<LoadedScene>();
    loaded->scene = world.scene;
    mission.loaded = loaded;
    mission.target = world.target;
    mission.sensor = world.sensor;
    mission.navigation = world.navigation;
    return mission;
  }

  const LimitSample& sample_ = limit_samples()[GetParam()];
  const LimitWorld world_ = testing::world_of(sample_), free_ = testing::world_of_samples();
};

TEST_P(EveryLimit, IsAskedOfPoints) {
  const auto ask = [&](const LimitWorld& world) {
    return query_points(PreparedTarget(PreparedScene(world.scene), world.target, world.sensor), world.navigation,
                        {sample_.kept, sample_.broken});
  };
  const std::vector<PointAnswer> free = ask(free_), answers = ask(world_);
  for (const PointAnswer& answer : free) EXPECT_TRUE(answer.inside) << "without the limit";
  EXPECT_TRUE(answers[0].inside);
  EXPECT_TRUE(answers[0].outside_of.empty());
  EXPECT_GT(answers[0].margin_m, 0);
  EXPECT_LE(answers[0].margin_m, free[0].margin_m);
  EXPECT_FALSE(answers[1].inside);
  EXPECT_EQ(answers[1].outside_of, sample_.outside_of);
  EXPECT_LT(answers[1].margin_m, 0);
  EXPECT_TRUE(answers[1].blocked_by.empty());
}

TEST_P(EveryLimit, IsAskedOfLegs) {
  const PreparedTarget target(PreparedScene(world_.scene), world_.target, world_.sensor);
  const LegLimits limits(target, world_.navigation);
  const std::vector<LegBreak> breaks = limits.broken({sample_.kept, sample_.broken});
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(std::vector<std::string>{breaks[0].limit}, sample_.outside_of);
  EXPECT_FALSE(testing::holds(breaks[0].intervals, 0));
  EXPECT_TRUE(testing::holds(breaks[0].intervals, 1));
  EXPECT_GT(breaks[0].worst, 0);
}

TEST_P(EveryLimit, IsCutVerifiedAndProved) {
  const Volume free = volume_of(free_), cut = volume_of(world_);
  ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_GT(depths_in(free.mesh)[1], 0.1);
  EXPECT_GT(depths_in(cut.mesh)[0], 0.1);
  EXPECT_LT(depths_in(cut.mesh)[1], -0.1);
  EXPECT_LT(enclosed_volume(cut.mesh), 0.999 * enclosed_volume(free.mesh));
  const auto verify = [&](const Mesh& mesh) {
    return verify_volume(world_.scene, world_.target, world_.sensor, world_.navigation, mesh, {.points = 4000});
  };
  const VerifyReport report = verify(cut.mesh);
  EXPECT_TRUE(report.is_right()) << report.worst_over_cause << " at " << report.worst_over_point.transpose();
  EXPECT_LT(report.under_claimed, sample_.is_flat ? 1u : report.points / 40) << report.worst_under_point.transpose();
  EXPECT_GT(verify(free.mesh).over_claimed, 20u) << "the limit is not checked";
  const auto prove = [&](const Mesh& mesh) {
    const ProofReport proof = prove_volume(world_.scene, world_.target, world_.sensor, world_.navigation, mesh);
    const auto claim = std::find_if(proof.claims.begin(), proof.claims.end(),
                                    [&](const ClaimProof& one) { return one.name == name_of(sample_.limit); });
    EXPECT_NE(claim, proof.claims.end()) << "it is not claimed";
    return claim == proof.claims.end() ? ProofVerdict::not_proved : claim->verdict;
  };
  const ProofVerdict of_free = prove(free.mesh), of_cut = prove(cut.mesh);
  EXPECT_EQ(of_free, sample_.is_refuted ? ProofVerdict::wrong : ProofVerdict::not_proved);
  EXPECT_EQ(of_cut, ProofVerdict::proved);
}

// Facets at the limit have a witness, or it is named as one of which there is none.
TEST_P(EveryLimit, IsKnownToTheProofOfMaximality) {
  const Mesh mesh = volume_of(world_).mesh;
  const auto prove = [&](const LimitWorld& world) {
    return prove_maximal(world.scene, world.target, world.sensor, world.navigation, mesh, {});
  };
  const MaximalProof with = prove(world_), without = prove(free_);
  const bool has_no_witness =
      std::find(with.sampled.begin(), with.sampled.end(), name_of(sample_.limit)) != with.sampled.end();
  EXPECT_EQ(with.proved_share > without.proved_share + 0.02, !has_no_witness)
      << with.proved_share << ", without it " << without.proved_share;
}

TEST_P(EveryLimit, IsRefusedByAllWhereItIsWrong) {
  LimitWorld wrong = free_;
  sample_.add_wrong(wrong);
  const auto told = [](const auto& take) {
    try {
      take();
    } catch (const Error& error) {
      return std::pair(error.code(), std::string(error.what()));
    }
    return std::pair(ErrorCode{}, std::string("it is taken"));
  };
  const auto prepare = [&] { return PreparedTarget(PreparedScene(wrong.scene), wrong.target, wrong.sensor); };
  const auto expected = told([&] {
    check_sensor(wrong.sensor);
    check_navigation(wrong.navigation);
  });
  EXPECT_EQ(expected.first, sample_.wrong_code) << expected.second;
  const Volume free = volume_of(free_);
  EXPECT_EQ(told([&] { volume_of(wrong); }), expected);
  EXPECT_EQ(told([&] { cut_to_limits(free, prepare(), wrong.navigation); }), expected);
  EXPECT_EQ(told([&] { query_points(prepare(), wrong.navigation, {{0, 0, 5}}); }), expected);
  EXPECT_EQ(told([&] { LegLimits(prepare(), wrong.navigation); }), expected);
  EXPECT_EQ(told([&] { verify_volume(wrong.scene, wrong.target, wrong.sensor, wrong.navigation, free.mesh); }),
            expected);
  EXPECT_EQ(told([&] { prove_volume(wrong.scene, wrong.target, wrong.sensor, wrong.navigation, free.mesh); }),
            expected);
  EXPECT_EQ(told([&] { prove_maximal(wrong.scene, wrong.target, wrong.sensor, wrong.navigation, free.mesh, {}); }),
            expected);
  if (sample_.wrong_text.empty()) return;
  try {
    read_mission_text(testing::wrong_mission_text_of(sample_), "mission.yaml");
    ADD_FAILURE() << "a mission may say it";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), sample_.wrong_code) << error.what();
    const std::string line = testing::is_of_navigation(sample_.limit) ? "4" : "3";
    EXPECT_EQ(error.where().rfind("mission.yaml:" + line + ":", 0), 0u) << error.where();
  }
}

TEST_P(EveryLimit, BoundsOuterVolumesOrIsNamed) {
  const OuterVolume outer = outer_volume(mission_of(world_));
  ASSERT_FALSE(outer.volume.empty());
  EXPECT_GT(depths_in(outer.volume.mesh)[0], 0);
  EXPECT_EQ(depths_in(outer.volume.mesh)[1] < 0, sample_.bounds_outer);
  EXPECT_EQ(outer.ignored.empty(), sample_.bounds_outer);
}

// Points are answered exactly, and flat facets of a limit that is curved take away more than it forbids.
TEST_P(EveryLimit, IsWideEnoughInOuterVolumes) {
  const Mesh outer = outer_volume(mission_of(world_)).volume.mesh;
  testing::Random random(2911);
  std::vector<Vec3> points(4000);
  for (Vec3& point : points) point = random.in_box(bounding_box(outer));
  const std::vector<PointAnswer> answers = query_points(
      PreparedTarget(PreparedScene(world_.scene), world_.target, world_.sensor), world_.navigation, points);
  const std::vector<double> depths = SolidIndex(outer).depths_m(points);
  std::size_t allowed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!answers[i].inside) continue;
    ++allowed;
    EXPECT_GT(depths[i], -1e-9) << points[i].transpose();
  }
  EXPECT_GT(allowed, 100u);
}

TEST_P(EveryLimit, IsReadWrittenAndHashed) {
  const TemporaryDirectory folder;
  write_scene(world_.scene, folder / "scene.obj");
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / "mission.yaml") << text;
    return read_mission(folder / "mission.yaml");
  };
  const MissionFile file = read(testing::mission_text_of(sample_, folder.path()));
  const Mission mission = resolve_mission(file);
  testing::expect_same_limits(mission.navigation, world_.navigation);
  testing::expect_same_limits(mission.sensor, world_.sensor);
  const std::string text = mission_text(file, folder.path());
  const MissionFile again = read(text);
  EXPECT_EQ(mission_text(again, folder.path()), text);
  const Mission resolved = resolve_mission(again);
  testing::expect_same_limits(resolved.navigation, world_.navigation);
  testing::expect_same_limits(resolved.sensor, world_.sensor);
  EXPECT_EQ(mission_hash(resolved), mission_hash(mission));
  const Mission free = resolve_mission(read(testing::mission_text_without_limit()));
  EXPECT_TRUE(free.navigation.empty());
  EXPECT_NE(mission_hash(mission), mission_hash(free));
}

/// Files of volumes state the sensor, and no limit of navigation.
class EveryLimitOfSensor : public EveryLimit {};

TEST_P(EveryLimitOfSensor, TravelsInTheFileOfTheVolume) {
  const TemporaryDirectory folder;
  const Volume volume = volume_of(world_);
  for (const char* name : {"volume.ply", "volume.stl"}) {
    write_volume(volume, folder / name);
    const VolumeFile read = read_volume(folder / name);
    ASSERT_TRUE(read.volume.provenance);
    testing::expect_same_limits(read.volume.provenance->sensor, world_.sensor);
    if (world_.sensor.camera) {
      EXPECT_EQ(read.volume.provenance->sensor.mount, world_.sensor.mount);
    }
  }
}

std::size_t first_of_sensor() {
  const std::vector<LimitSample>& samples = limit_samples();
  const auto is_of_sensor = [](const LimitSample& sample) { return !testing::is_of_navigation(sample.limit); };
  return static_cast<std::size_t>(std::find_if(samples.begin(), samples.end(), is_of_sensor) - samples.begin());
}

INSTANTIATE_TEST_SUITE_P(All, EveryLimit, ::testing::Range(std::size_t{0}, limit_samples().size()));
INSTANTIATE_TEST_SUITE_P(All, EveryLimitOfSensor, ::testing::Range(first_of_sensor(), limit_samples().size()));

}  // namespace
}  // namespace vantage
