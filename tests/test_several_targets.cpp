// Missions of several targets: all, any, each; and targets that are seen from either side.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/result.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::Random;
using testing::SceneBuilder;
using testing::TemporaryDirectory;
using testing::write_bytes;

constexpr const char* kWest = "{name: west, vertices: [[-12, -4, 0], [-6, -4, 0], [-6, 4, 0], [-12, 4, 0]]}";
constexpr const char* kNorth = "{name: north, vertices: [[10, 8, 0], [16, 8, 0], [16, 14, 0]]}";
constexpr const char* kSheet =
    "{name: sheet, vertices: [[-8, 30, 2], [8, 30, 2], [8, 30, 9], [-8, 30, 9]], sides: both}";

class SeveralTargets : public ::testing::Test {
 protected:
  void SetUp() override {
    // A block stands between the two squares.
    write_bytes(folder_ / "city.obj",
                "o ground\nv -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n"
                "o block\nv -2 -5 0\nv 4 -5 0\nv 4 5 0\nv -2 5 0\nv -2 -5 12\nv 4 -5 12\nv 4 5 12\nv -2 5 12\n"
                "f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n");
  }

  MissionFile file(const std::string& text) {
    write_bytes(folder_ / "mission.yaml", "scene: {mesh: city.obj}\nsensor: {max_range: 60}\n" + text + "\n");
    return read_mission(folder_ / "mission.yaml");
  }
  Mission mission(const std::string& text) { return resolve_mission(file(text)); }
  Mission of(const std::string& combine, const std::vector<std::string>& targets) {
    std::string list;
    for (const std::string& target : targets) list += "\n  - " + target;
    return mission("combine: " + combine + "\ntargets:" + list);
  }
  void expect_refused(const std::string& text, ErrorCode code) {
    SCOPED_TRACE(text);
    testing::expect_error([&] { mission(text); }, code, "mission.yaml:");
  }

  TemporaryDirectory folder_;
};

double size_of(const Volume& volume) {
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  return enclosed_volume(volume.mesh);
}

/// What verify says of a mission's volume.
VerifyReport judged(const Mission& mission, const Volume& volume) {
  VerifyOptions options;
  options.points = 4000;
  std::size_t parts = 0;
  for (const auto& view : mission.views.empty() ? std::vector<std::vector<Target>>{{mission.target}} : mission.views) {
    for (const Target& target : view) parts += target.parts.size();
  }
  if (parts == volume.lift_m.size()) options.lift_m = volume.lift_m;
  const Scene& scene = mission.scene();
  return mission.views.empty()
             ? verify_volume(scene, mission.target, mission.sensor, mission.navigation, volume.mesh, options)
             : verify_volume(scene, mission.views, mission.sensor, mission.navigation, volume.mesh, options);
}

void expect_right(const Mission& mission, const Volume& volume) {
  const VerifyReport report = judged(mission, volume);
  EXPECT_TRUE(report.is_right()) << report.worst_over_depth_m << " m at " << report.worst_over_point.transpose() << ": "
                                 << report.worst_over_cause;
  EXPECT_EQ(report.under_claimed, 0U) << report.worst_under_point.transpose();
  EXPECT_GT(report.inside, 100U);
}

TEST_F(SeveralTargets, AllAreTheParts) {
  const Mission all = of("all", {kWest, kNorth});
  EXPECT_TRUE(all.views.empty());
  EXPECT_EQ(all.target.name, "west; north");
  const Mission parts = mission(
      "target: {parts: [[[-12, -4, 0], [-6, -4, 0], [-6, 4, 0], [-12, 4, 0]], [[10, 8, 0], [16, 8, 0], [16, 14, 0]]]}");
  EXPECT_EQ(all.target.parts, parts.target.parts);
  EXPECT_EQ(mission_hash(all), mission_hash(parts));
  EXPECT_EQ(run_mission(all).volume.mesh.vertices, run_mission(parts).volume.mesh.vertices);
}

// The volumes of both sides meet in the target's plane: in facets, along edges and in points.
TEST(BothSides, VolumesThatTouchAreClosed) {
  Random random(2239);
  int computed = 0;
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    SceneBuilder builder;
    for (int i = random.integer(1, 5); i > 0; --i) {
      const Vec3 at = random.point(-16, 16);
      builder.polygon("sheet", {at, at + random.point(-6, 6), at + random.point(-6, 6)});
    }
    const Vec3 normal = random.direction();
    Target front =
        testing::random_target(random, random.integer(3, 7), random.uniform(1, 5), random.point(-4, 4), normal);
    front.front = normal;
    Target back = front;
    back.front = -normal;
    std::vector<Volume> sides;
    try {
      const PreparedScene scene(builder.scene());
      Sensor sensor{random.uniform(20, 45)};
      if (random.chance(0.5)) sensor.min_range_m = random.uniform(2, 12);
      for (const Target& side : {front, back}) {
        sides.push_back(compute_volume(PreparedTarget(scene, side, sensor), {}, {.tolerance_m = 0.02}));
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();  // a sheet stands in the target
      continue;
    }
    const Volume both = unite_volumes(sides);
    ASSERT_EQ(both.outcome, Outcome::computed);
    ++computed;
    EXPECT_EQ(testing::first_open_edge(both.mesh), "");
    double apart = 0;
    for (const Volume& side : sides) apart += enclosed_volume(side.mesh);
    EXPECT_NEAR(enclosed_volume(both.mesh), apart, 1e-6 * apart) << "they only touch";
  }
  EXPECT_GT(computed, 20);
}

TEST_F(SeveralTargets, TheReportOfSpheresIsOfAllPartsAndTargets) {
  const std::string spheres = "\nmethod: spheres\nspheres: {cubemap: 12, max_splits: 0, device: cpu}";
  const auto report_of = [&](const std::string& text) {
    const Result result = run_mission(mission(text + spheres));
    EXPECT_TRUE(result.spheres);
    return result.spheres.value_or(SpheresReport());
  };
  const std::string list = std::string("combine: any\ntargets:\n  - ") + kWest + "\n  - " + kNorth;
  const SpheresReport west = report_of(std::string("target: ") + kWest),
                      north = report_of(std::string("target: ") + kNorth);
  ASSERT_GE(west.spheres, 4U);
  ASSERT_GE(north.spheres, 3U);
  for (const SpheresReport& all :
       {report_of(list), report_of("target: {parts: [[[-12, -4, 0], [-6, -4, 0], [-6, 4, 0], "
                                   "[-12, 4, 0]], [[10, 8, 0], [16, 8, 0], [16, 14, 0]]]}")}) {
    EXPECT_EQ(all.spheres, west.spheres + north.spheres);
    EXPECT_EQ(all.pairs, west.pairs + north.pairs);
    EXPECT_EQ(all.splits, west.splits + north.splits);
    EXPECT_EQ(all.device.name, west.device.name);
    EXPECT_GT(all.render_seconds, 0);
  }
}

TEST_F(SeveralTargets, AllWithSidesAndOffsetsOfTheirOwn) {
  // A wall that faces south, raised by its offset, beside a square that faces up.
  const std::string wall =
      "{name: wall, vertices: [[6, 20, 2], [6, 20, 5], [12, 20, 5], [12, 20, 2]], front: [0, -1, 0], offset: 0.5}";
  const Mission all = of("all", {kNorth, wall});
  ASSERT_TRUE(all.views.empty());
  ASSERT_EQ(all.target.parts.size(), 2U);
  EXPECT_TRUE(all.target.front_by_order);
  EXPECT_EQ(make_target_frame(all.target, 0).normal, Vec3::UnitZ());
  EXPECT_TRUE(make_target_frame(all.target, 1).normal.isApprox(-Vec3::UnitY()));
  EXPECT_EQ(make_target_frame(all.target, 1).origin.y(), 19.5);
  const Volume volume = run_mission(all).volume;
  expect_right(all, volume);
  const double both =
      size_of(intersect_volumes({run_mission(of("all", {kNorth})).volume, run_mission(of("all", {wall})).volume}));
  EXPECT_NEAR(size_of(volume), both, volume.tolerance_m * surface_area(volume.mesh)) << "facets of the range differ";
}

TEST_F(SeveralTargets, AnyIsTheUnion) {
  const Mission any = of("any", {kWest, kNorth});
  ASSERT_EQ(any.views.size(), 1U);
  EXPECT_EQ(any.views[0].size(), 2U);
  EXPECT_EQ(volume_count(any), 1U);
  const Volume volume = run_mission(any).volume;
  expect_right(any, volume);
  const double west = size_of(run_mission(of("all", {kWest})).volume);
  const double north = size_of(run_mission(of("all", {kNorth})).volume);
  const double both = size_of(run_mission(of("all", {kWest, kNorth})).volume);
  EXPECT_NEAR(size_of(volume), west + north - both, volume.tolerance_m * surface_area(volume.mesh));
  EXPECT_GT(size_of(volume), 1.05 * std::max(west, north)) << "or nothing is tested";
  // One of the two alone is claimed too little, and all of the union is too much for both.
  EXPECT_FALSE(judged(of("all", {kWest, kNorth}), volume).is_right());
  EXPECT_GT(judged(any, run_mission(of("all", {kWest})).volume).under_claimed, 0U);
}

TEST_F(SeveralTargets, AnyOfFacesOfAnObject) {
  const Mission any = mission("combine: any\ntarget: {object: block, part: facade}");
  ASSERT_EQ(any.views.size(), 1U);
  EXPECT_EQ(any.views[0].size(), 4U);
  expect_right(any, run_mission(any).volume);
  const Mission each = mission("combine: each\ntarget: {object: block, part: facade}");
  EXPECT_EQ(volume_count(each), 4U);
  EXPECT_EQ(each.views[1][0].name, "block, facade 2");
}

TEST_F(SeveralTargets, EachIsAsIfItWereAlone) {
  const Mission each = of("each", {kWest, kNorth, "{point: [20, 0, 3]}", kSheet});
  ASSERT_EQ(volume_count(each), 4U);
  const std::vector<Result> results = run_missions(each, {2, {}});
  ASSERT_EQ(results.size(), 4U);
  EXPECT_EQ(run_missions(each, {1, {}})[3].volume.mesh.vertices, results[3].volume.mesh.vertices);
  const std::vector<std::string> alone = {kWest, kNorth, "{name: target 3, point: [20, 0, 3]}", kSheet};
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const Mission one = mission("target: " + alone[i]);
    const Result result = run_mission(one);
    EXPECT_EQ(result.volume.mesh.vertices, results[i].volume.mesh.vertices);
    EXPECT_EQ(mission_hash(one), mission_hash(one_volume(each, i)));
    EXPECT_EQ(result.volume.provenance->mission_hash, results[i].volume.provenance->mission_hash);
  }
  testing::expect_error([&] { run_mission(each); }, ErrorCode::not_applicable, "mission.yaml:");
  testing::expect_error([&] { one_volume(each, 4); }, ErrorCode::index_out_of_range);
}

TEST_F(SeveralTargets, BothSidesAreSeenFromEither) {
  const Mission both = mission("target: " + std::string(kSheet));
  ASSERT_EQ(both.views.size(), 1U);
  ASSERT_EQ(both.views[0].size(), 2U);
  EXPECT_TRUE(make_target_frame(both.views[0][0]).normal.isApprox(-Vec3::UnitY()));
  EXPECT_TRUE(make_target_frame(both.views[0][1]).normal.isApprox(Vec3::UnitY()));
  const Result result = run_mission(both);
  expect_right(both, result.volume);
  const double front =
      size_of(run_mission(mission("target: {vertices: [[-8, 30, 2], [8, 30, 2], [8, 30, 9], [-8, 30, 9]]}")).volume);
  const double back = size_of(
      run_mission(mission("target: {vertices: [[-8, 30, 2], [8, 30, 2], [8, 30, 9], [-8, 30, 9]], front: [0, 1, 0]}"))
          .volume);
  EXPECT_NEAR(size_of(result.volume), front + back, 1e-6 * front);
  // Beside a target that is seen from above: both of them, the sheet from either side.
  const Mission more = of("all", {kNorth, kSheet});
  ASSERT_EQ(more.views.size(), 2U);
  expect_right(more, run_mission(more).volume);
}

TEST_F(SeveralTargets, LimitsHoldForEachTarget) {
  const std::string limits = "\nnavigation: {altitude: [5, 25], keep_out: [{min: [-20, -9, 0], max: [-9, 9, 40]}]}";
  const Mission any = mission("combine: any\ntargets: [" + std::string(kWest) + ", " + kNorth + "]" + limits);
  const Volume volume = run_mission(any).volume;
  expect_right(any, volume);
  EXPECT_GE(bounding_box(volume.mesh).min.z(), 5);
  EXPECT_LE(bounding_box(volume.mesh).max.z(), 25);
}

TEST_F(SeveralTargets, AreWrittenAsTheyAreRead) {
  const MissionFile first = file("combine: any\ntargets:\n  - " + std::string(kWest) + "\n  - " + kSheet +
                                 "\n  - {object: block, part: roof}\n  - {point: [1, 2, 30]}");
  const std::string text = mission_text(first, folder_.path());
  const MissionFile again = read_mission_text(text, folder_ / "again.yaml");
  ASSERT_EQ(again.targets.size(), 4U) << text;
  EXPECT_EQ(again.combine, Combine::any);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(again.targets[i].target.name, first.targets[i].target.name);
    EXPECT_EQ(again.targets[i].target.parts, first.targets[i].target.parts);
    EXPECT_EQ(again.targets[i].both_sides, first.targets[i].both_sides);
    EXPECT_EQ(again.targets[i].source.index(), first.targets[i].source.index());
  }
  EXPECT_EQ(mission_hash(resolve_mission(again)), mission_hash(resolve_mission(first)));
  const MissionFile sides = file("target: " + std::string(kSheet));
  EXPECT_TRUE(read_mission_text(mission_text(sides, folder_.path()), folder_ / "again.yaml").targets[0].both_sides);
}

TEST_F(SeveralTargets, AreAtLeastOne) {
  MissionFile none = file("target: " + std::string(kSheet));
  none.targets.clear();
  EXPECT_EQ(testing::code_of([&] { resolve_mission(none); }), ErrorCode::nothing_given);
}

TEST_F(SeveralTargets, HaveHashesOfTheirOwn) {
  const std::string all = mission_hash(of("all", {kWest, kNorth})), any = mission_hash(of("any", {kWest, kNorth})),
                    each = mission_hash(of("each", {kWest, kNorth}));
  EXPECT_NE(all, any);
  EXPECT_NE(all, each);
  EXPECT_NE(any, each);
  EXPECT_NE(mission_hash(mission("target: " + std::string(kSheet))),
            mission_hash(mission("target: {vertices: [[-8, 30, 2], [8, 30, 2], [8, 30, 9], [-8, 30, 9]]}")));
}

TEST_F(SeveralTargets, FilesStateThem) {
  const Mission any = of("any", {kWest, kSheet});
  Result result = run_mission(any);
  ASSERT_EQ(result.volume.provenance->views.size(), 1U);
  ASSERT_EQ(result.volume.provenance->views[0].size(), 3U);
  write_results(result.volume, result_request(any, result, {folder_ / "volume.ply"}));
  const VolumeFile read = read_volume(folder_ / "volume.ply", any.scene());
  ASSERT_TRUE(read.volume.provenance);
  ASSERT_EQ(read.volume.provenance->views.size(), 1U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.volume.provenance->views[0][i].parts, any.views[0][i].parts);
    EXPECT_EQ(read.volume.provenance->views[0][i].front_by_order, any.views[0][i].front_by_order);
  }
  EXPECT_EQ(read.volume.lift_m, result.volume.lift_m);
  EXPECT_TRUE(volume_warnings(read, any).empty());
  EXPECT_EQ(verify_options(read, any).lift_m, result.volume.lift_m);
}

TEST_F(SeveralTargets, ThatAreWrong) {
  const std::string west = kWest;
  expect_refused("target: " + west + "\ntargets: [" + west + "]", ErrorCode::conflicting_keys);
  expect_refused("targets: []", ErrorCode::nothing_given);
  expect_refused("targets: " + west, ErrorCode::wrong_type);
  expect_refused("targets: [" + west + "]\ncombine: some", ErrorCode::unknown_choice);
  expect_refused("targets: [" + west + ", {object: blok, part: roof}]", ErrorCode::object_missing);
  expect_refused("targets: [" + west + ", {vertices: [[0, 0, 0], [1, 0, 0]]}]", ErrorCode::target_vertex_count);
  expect_refused("target: {point: [1, 2, 3], sides: both}", ErrorCode::not_applicable);
  expect_refused("target: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], sides: left}", ErrorCode::unknown_choice);
  const Mission pierced = of("each", {kWest, "{vertices: [[0, 0, 1], [9, 0, 1], [9, 3, 1]]}"});
  testing::expect_error([&] { run_missions(pierced); }, ErrorCode::target_pierced, "mission.yaml:");
}

TEST_F(SeveralTargets, NamesGivenTwiceGetNumbersThatAreFree) {
  const Mission each = of("each", {"{name: a, point: [20, 20, 5]}", "{name: a, point: [-20, -30, 5]}",
                                   "{name: a (2), point: [30, -30, 5]}"});
  std::set<std::string> names;
  for (const auto& view : each.views) names.insert(view.front().name);
  EXPECT_EQ(names, (std::set<std::string>{"a", "a (2)", "a (3)"}));
}

TEST_F(SeveralTargets, AreNotOnePreparedTarget) {
  const Mission any = of("any", {kWest, kNorth});
  const PreparedScene scene(any.scene());
  testing::expect_error([&] { prepare_target(any, scene); }, ErrorCode::not_applicable);
  const PreparedTarget alone(scene, any.views[0][0], any.sensor);
  testing::expect_code([&] { run_mission(any, alone); }, ErrorCode::not_applicable);
}

TEST_F(SeveralTargets, PointsAreStatedWithTheirSides) {
  const Mission all = of("all", {"{name: a, point: [20, 20, 5], front: [1, 0, 0]}", kNorth});
  const Volume volume = run_mission(all).volume;
  ASSERT_TRUE(volume.provenance);
  ASSERT_EQ(volume.provenance->views.size(), 2u);
  const auto& views = volume.provenance->views;
  EXPECT_TRUE(std::any_of(views.begin(), views.end(), [](const std::vector<Target>& list) {
    return list[0].is_point() && list[0].front == Vec3(1, 0, 0);
  }));
}

TEST_F(SeveralTargets, CanBeStopped) {
  const Mission each = of("each", {kWest, kNorth, kSheet});
  int calls = 0;
  const auto stop = [&](std::string_view, double) { return ++calls < 5; };
  testing::expect_code([&] { run_missions(each, {2, {}}, stop); }, ErrorCode::cancelled);
}

TEST(UniteVolumes, AddsNothingAndLosesNothing) {
  Random random(411);
  const PreparedScene scene(SceneBuilder()
                                .ground("ground", 200)
                                .box("west", {-40, -30, 0}, {-20, 30, 18})
                                .box("post", {12, -12, 0}, {13, -11, 6})
                                .scene());
  for (int round = 0; round < 6; ++round) {
    std::vector<Volume> volumes;
    for (int i = 0; i < 3; ++i) {
      const double x = random.uniform(-12, 8), y = random.uniform(-8, 20);
      volumes.push_back(compute_visibility(
          PreparedTarget(scene, testing::target_of({{x, y, 0}, {x + 3, y, 0}, {x + 3, y + 2, 0}}), {40}), {0.05, 0}));
    }
    const Volume all = unite_volumes(volumes);
    ASSERT_EQ(all.outcome, Outcome::computed);
    EXPECT_EQ(testing::first_open_edge(all.mesh), "");
    const testing::MeshProbe probe(all);
    std::vector<testing::MeshProbe> probes;
    for (const Volume& volume : volumes) probes.emplace_back(volume);
    Box box = bounding_box(all.mesh);
    int inside = 0;
    for (int k = 0; k < 400; ++k) {
      const Vec3 point = random.in_box(box);
      const bool is_in_one =
          std::any_of(probes.begin(), probes.end(), [&](const auto& one) { return one.depth(point) > 0; });
      EXPECT_EQ(probe.depth(point) > 0, is_in_one) << point.transpose();
      inside += is_in_one;
    }
    EXPECT_GT(inside, 50);
  }
}

TEST(UniteVolumes, LeavesOutWhatIsEmpty) {
  const PreparedScene scene(SceneBuilder().ground("ground", 100).scene());
  const auto of_size = [&](double size) {
    return compute_visibility(
        PreparedTarget(scene, testing::target_of({{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}}), {20}));
  };
  const Volume small = of_size(3), none = of_size(60);
  ASSERT_EQ(none.outcome, Outcome::out_of_range);
  const Volume both = unite_volumes({none, small});
  EXPECT_EQ(both.outcome, Outcome::computed);
  EXPECT_NEAR(enclosed_volume(both.mesh), enclosed_volume(small.mesh), 1e-6);
  const Volume nothing = unite_volumes({none, none});
  EXPECT_EQ(nothing.outcome, Outcome::out_of_range);
  testing::expect_wording(nothing.reason);
  testing::expect_error([] { unite_volumes({}); }, ErrorCode::nothing_given);
}

TEST(JoinedAnswers, OfAnyAndOfAll) {
  PointAnswer seen, hidden, far;
  seen.inside = true;
  seen.margin_m = 3;
  hidden.margin_m = -2;
  hidden.blocked_by = {"b", "tower"};
  far.margin_m = -9;
  far.out_of_range = true;
  far.blocked_by = {"a"};
  far.outside_of = {"altitude min", "incidence"};
  hidden.outside_of = {"altitude min"};
  const PointAnswer any = any_of(std::vector{hidden, seen, far});
  EXPECT_TRUE(any.inside);
  EXPECT_EQ(any.margin_m, 3);
  EXPECT_TRUE(any.blocked_by.empty());
  const PointAnswer none = any_of(std::vector{hidden, far});
  EXPECT_FALSE(none.inside);
  EXPECT_EQ(none.margin_m, -2);
  EXPECT_EQ(none.blocked_by, (std::vector<std::string>{"a", "b", "tower"}));
  EXPECT_FALSE(none.out_of_range);
  EXPECT_EQ(none.outside_of, std::vector<std::string>{"altitude min"});
  const PointAnswer all = all_of(std::vector{seen, hidden, far});
  EXPECT_FALSE(all.inside);
  EXPECT_EQ(all.margin_m, -9);
  EXPECT_TRUE(all.out_of_range);
  EXPECT_EQ(all.outside_of, (std::vector<std::string>{"altitude min", "incidence"}));
  testing::expect_error([] { any_of(std::vector<PointAnswer>{}); }, ErrorCode::nothing_given);
}

TEST(VolumeFiles, HaveNamesOfTheirOwn) {
  const auto files =
      volume_files("out/volume.ply", {"Town Hall, roof", "town hall, roof", "../x", std::string(300, 'n')});
  for (std::size_t i = 0; i < 3; ++i) testing::expect_wording(files[i].string());
  EXPECT_LT(files[3].filename().string().size(), 200U);
}

// ---- targets that are wrong beside others

TEST_F(SeveralTargets, WhatIsWrongWithOneDoesNotStopTheOthers) {
  const std::string through = "{name: through, vertices: [[-5, -4, 5], [6, -4, 5], [6, 4, 5], [-5, 4, 5]]}";
  const Mission all = of("each", {kWest, through, kNorth});
  const std::vector<Attempt> attempts = try_missions(all);
  ASSERT_EQ(attempts.size(), 3u);
  ASSERT_TRUE(attempts[1].error && !attempts[1].result);
  EXPECT_EQ(attempts[1].error->code(), ErrorCode::target_pierced);
  EXPECT_NE(attempts[1].error->where().find("mission.yaml:6:"), std::string::npos) << attempts[1].error->where();
  const std::vector<Result> good = run_missions(of("each", {kWest, kNorth}));
  for (const auto& [attempt, result] : {std::pair{&attempts[0], &good[0]}, {&attempts[2], &good[1]}}) {
    ASSERT_TRUE(attempt->result && !attempt->error);
    EXPECT_EQ(volume_hash(attempt->result->volume.mesh), volume_hash(result->volume.mesh));
    EXPECT_EQ(attempt->result->volume.provenance->mission_hash, result->volume.provenance->mission_hash);
  }
  testing::expect_code([&] { run_missions(all); }, ErrorCode::target_pierced, "mission.yaml:6:");
}

TEST_F(SeveralTargets, WhatIsWrongWithAllIsNoErrorOfEach) {
  const Mission good = of("each", {kWest, kNorth});
  const auto refuse = [&](auto change, ErrorCode code) {
    Mission wrong = good;
    change(wrong);
    int volumes = 0;
    const Progress told = [&](std::string_view stage, double) {
      volumes += stage == "targets";
      return true;
    };
    testing::expect_code([&] { try_missions(wrong, {}, told); }, code);
    EXPECT_EQ(volumes, 0) << "no volume is computed before";
  };
  refuse([](Mission& mission) { mission.sensor.max_range_m = -1; }, ErrorCode::value_out_of_range);
  refuse([](Mission& mission) { mission.navigation.clearance = Clearance{1, {}}; }, ErrorCode::nothing_given);
  refuse(
      [](Mission& mission) {
        mission.as_written.method = Method::spheres;
        mission.sensor.visible.emplace();
      },
      ErrorCode::not_applicable);
}

TEST_F(SeveralTargets, TheMethodOfSpheresIsRefusedOnceForAll) {
  Mission wrong = of("each", {kWest, kNorth});
  wrong.as_written.method = Method::spheres;
  wrong.as_written.spheres.cubemap = -1;
  testing::expect_code([&] { try_missions(wrong); }, ErrorCode::value_out_of_range);
}

TEST_F(SeveralTargets, TheWorkForOneTargetIsItsOwn) {
  Mission all = of("each", {kWest, kNorth});
  all.as_written.exact.work_limit = 1;
  all.navigation.keep_out.push_back(Box{Vec3(-20, -20, 5), Vec3(20, 20, 9)});
  for (const Attempt& attempt : try_missions(all)) {
    ASSERT_TRUE(attempt.error);
    EXPECT_EQ(attempt.error->code(), ErrorCode::work_too_large);
    testing::expect_wording(attempt.error->where());
  }
}

TEST_F(SeveralTargets, AStopEndsAllAttempts) {
  const Mission all = of("each", {kWest, kNorth});
  int told = 0;
  testing::expect_code([&] { try_missions(all, {}, [&](std::string_view, double) { return ++told < 2; }); },
                       ErrorCode::cancelled);
}

}  // namespace
}  // namespace vantage
