// How a computation ends when it does not end with a volume: outcomes with a reason and a hint, errors with a way out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <string>

#include "support/progress_check.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::SceneBuilder;
using testing::target_of;

Target square(double half_side, const Vec3& centre = Vec3::Zero()) {
  const double s = half_side;
  return target_of(
      {centre + Vec3(-s, -s, 0), centre + Vec3(s, -s, 0), centre + Vec3(s, s, 0), centre + Vec3(-s, s, 0)});
}

/// Upright, in the plane y = const; counter-clockwise seen from -y.
Target facade(double half_side, const Vec3& centre) {
  const double s = half_side;
  return target_of(
      {centre + Vec3(-s, 0, -s), centre + Vec3(s, 0, -s), centre + Vec3(s, 0, s), centre + Vec3(-s, 0, s)});
}

Volume compute(const Scene& scene, const Target& target, double range = 50) {
  return compute_visibility(PreparedTarget(PreparedScene(scene), target, {range}), {0.1, 0});
}

/// The error of computing.
Error refusal(const Scene& scene, const Target& target, ErrorCode code, const Sensor& sensor = {50},
              const ExactOptions& options = {}) {
  return testing::expect_error(
      [&] { compute_visibility(PreparedTarget(PreparedScene(scene), target, sensor), options); }, code);
}

/// The error of a target that an object pierces.
Error refusal_of_pierced(const Scene& scene, const Target& target, const std::string& object) {
  Error error = refusal(scene, target, ErrorCode::target_pierced);
  EXPECT_EQ(scene.objects.at(error.object().value_or(0)).name, object) << error.what();
  EXPECT_NE(error.problem().find(object), std::string::npos) << error.what();
  return error;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The offset that the error of a pierced target, or the note of a buried one, gives as the way out.
double offset_in(const std::string& fix) {
  const auto at = fix.find("offset: ");
  EXPECT_NE(at, std::string::npos) << fix;
  return at == std::string::npos ? 0 : std::stod(fix.substr(at + 8));
}

TEST(ExactOutcomes, OutOfRangeSaysHowFar) {
  const Volume volume = compute(SceneBuilder().ground("ground", 100), square(50), 60);
  EXPECT_EQ(volume.outcome, Outcome::out_of_range);
  testing::expect_wording(volume.reason);
  EXPECT_TRUE(contains(volume.reason, "70.71 m")) << volume.reason;
  EXPECT_FALSE(volume.hint.empty());
  EXPECT_TRUE(volume.mesh.empty());
  EXPECT_TRUE(volume.cause_of.empty());
}

TEST(ExactOutcomes, JustWithinRangeIsComputed) {
  const Scene scene = SceneBuilder().ground("ground", 100);
  const double radius = 30 * std::sqrt(2.0);
  EXPECT_EQ(compute(scene, square(30), radius * (1 - 1e-6)).outcome, Outcome::out_of_range);
  EXPECT_EQ(compute(scene, square(30), radius).outcome, Outcome::out_of_range);  // a single point is not a volume
  for (const double over : {1e-5, 1e-3, 0.1}) {
    SCOPED_TRACE(over);
    const double range = radius * (1 + over);
    const Volume volume =
        compute_visibility(PreparedTarget(PreparedScene(scene), square(30), {range}), {0.01 * range * over, 0});
    ASSERT_EQ(volume.outcome, Outcome::computed);
    const MeshMeasures m = measure(volume.mesh);
    EXPECT_TRUE(m.closed && m.oriented && m.euler == 2);
    const Target target = square(30);
    for (const Vec3& v : volume.mesh.vertices)
      for (const Vec3& t : target.parts[0]) ASSERT_LE((v - t).norm(), range * (1 + 1e-12));
  }
}

TEST(ExactOutcomes, ATriangleSeenFromItsLongSideIsComputed) {
  // An obtuse triangle: the centre of the smallest enclosing circle is on its outline, and the range hardly reaches.
  const Target target = target_of({{-30, 0, 0}, {30, 0, 0}, {0, 5, 0}});
  for (const double range : {30.1, 31.0, 50.0}) {
    const Volume volume = compute(SceneBuilder().ground("ground", 100), target, range);
    ASSERT_EQ(volume.outcome, Outcome::computed) << range;
    const MeshMeasures m = measure(volume.mesh);
    EXPECT_TRUE(m.closed && m.oriented && m.euler == 2);
  }
}

TEST(ExactOutcomes, AgainstAWallIsComputedAndTold) {
  const Scene scene = SceneBuilder().ground("ground", 100).box("barn", {-60, -1, 0}, {60, -0.02, 60});
  const Volume volume = compute(scene, facade(4, {0, 0, 20}));  // looks to -y, into the barn's wall
  EXPECT_EQ(volume.outcome, Outcome::computed);
  ASSERT_EQ(volume.notes.size(), 1U);
  EXPECT_EQ(volume.notes[0].code, WarningCode::target_covered);
  testing::expect_wording(volume.notes[0].text);
  Target turned = facade(4, {0, 0, 20});
  turned.front = Vec3(0, 1, 0);
  const Volume right = compute(scene, turned);
  EXPECT_EQ(right.outcome, Outcome::computed);
  EXPECT_TRUE(right.notes.empty());
}

/// What is computed for a short range is computed for a longer one, which allows more.
TEST(ExactOutcomes, UnderASheetAllRangesAreComputed) {
  for (const double height : {0.003, 0.01, 0.09, 0.2}) {
    const Scene scene =
        SceneBuilder()
            .ground("ground", 50)
            .polygon("plate", {{-60, -60, height}, {60, -60, height}, {60, 60, height}, {-60, 60, height}});
    const Target target = square(2, {0, 0, 0});
    double before = 0;
    for (const double range : {4.0, 17.9, 19.0, 20.0, 40.0}) {
      SCOPED_TRACE(::testing::Message() << height << " m, range " << range);
      const Volume volume = compute(scene, target, range);
      ASSERT_EQ(volume.outcome, Outcome::computed);
      const double found = enclosed_volume(volume.mesh);
      EXPECT_GT(found, before);
      before = found;
      EXPECT_EQ(!volume.notes.empty(), height < 0.1 * std::min(1.0, range / 20));
      const ProofReport proof =
          prove_volume(scene, target, {.max_range_m = range}, {}, volume.mesh, {.lift_m = volume.lift_m});
      EXPECT_EQ(proof.verdict(), ProofVerdict::proved);
      Mesh raised = volume.mesh;
      for (Vec3& vertex : raised.vertices) vertex.z() *= 1.001;
      EXPECT_NE(prove_volume(scene, target, {.max_range_m = range}, {}, raised, {.lift_m = volume.lift_m}).verdict(),
                ProofVerdict::proved);
    }
  }
}

TEST(ExactOutcomes, TheSurfaceUnderTheTargetDoesNotBlock) {
  const Scene scene = SceneBuilder().ground("ground", 100);
  for (const double height : {0.0, 0.001, -0.0005, -0.0015}) {  // drawn a little too low
    SCOPED_TRACE(height);
    const Volume volume = compute(scene, square(4, {0, 0, height}));
    ASSERT_EQ(volume.outcome, Outcome::computed);
    EXPECT_NEAR(volume.lift_m.at(0), std::max(0.0, -height), 2e-6);
    const Volume free = compute(Scene(), square(4, {0, 0, height + volume.lift_m.at(0)}));
    EXPECT_NEAR(enclosed_volume(volume.mesh), enclosed_volume(free.mesh), 1e-6 * enclosed_volume(free.mesh));
  }
}

TEST(ExactOutcomes, APierceNamesObjectPlaceAndWayOut) {
  const Scene scene = SceneBuilder().ground("ground", 100).box("kiosk", {1, 1, 0}, {2, 2, 3});
  const Error error = refusal_of_pierced(scene, square(4), "kiosk");
  const std::string& where = error.where();
  EXPECT_TRUE(contains(where, "\"target\"")) << where;
  double x = 0, y = 0, z = 0;  // the place is on the kiosk
  ASSERT_EQ(std::sscanf(where.c_str() + where.find('('), "(%lf, %lf, %lf)", &x, &y, &z), 3) << where;
  EXPECT_TRUE(x >= 1 && x <= 2 && y >= 1 && y <= 2 && z == 0) << where;
  Target raised = square(4);
  raised.offset_m = offset_in(error.fix());
  EXPECT_NEAR(raised.offset_m, 3.0, 0.0011);
  EXPECT_EQ(compute(scene, raised).outcome, Outcome::computed);
  raised.offset_m = 2.9;  // and nothing much smaller will do
  refusal_of_pierced(scene, raised, "kiosk");
  raised.offset_m = 1;  // counted from the vertices, not from where the target is now
  EXPECT_NEAR(offset_in(refusal_of_pierced(scene, raised, "kiosk").fix()), 3.0, 0.0011);
}

TEST(ExactOutcomes, TheWayOutOfAPierceLeadsPastEverything) {
  // A tower with a mast, a bridge above it: clear between the two.
  const Scene scene = SceneBuilder()
                          .ground("ground", 100)
                          .box("tower", {-1, -1, 0}, {1, 1, 3})
                          .box("mast", {-0.1, -0.1, 3}, {0.1, 0.1, 4.5})
                          .box("bridge", {-3, -60, 12}, {3, 60, 13});
  Target target = square(4);
  target.offset_m = offset_in(refusal_of_pierced(scene, target, "tower").fix());
  EXPECT_NEAR(target.offset_m, 4.5, 0.0011);
  EXPECT_EQ(compute(scene, target).outcome, Outcome::computed);
  target.offset_m = 0;  // 117 m up there is another target
  const Scene high = SceneBuilder().ground("ground", 100).box("tower", {-1, -1, 0}, {1, 1, 117});
  EXPECT_FALSE(contains(refusal_of_pierced(high, target, "tower").fix(), "offset"));
}

TEST(ExactOutcomes, AFacadeTargetIsPiercedByABalcony) {
  const Scene scene = SceneBuilder()
                          .ground("ground", 100)
                          .box("house", {-9, 0, 0}, {9, 9, 15})
                          .box("balcony", {-1, -1.5, 9}, {1, 0, 9.2});
  Target target = facade(3, {0, 0, 9});
  target.offset_m = offset_in(refusal_of_pierced(scene, target, "balcony").fix());
  EXPECT_NEAR(target.offset_m, 1.5, 0.0011);
  EXPECT_EQ(compute(scene, target).outcome, Outcome::computed);
}

TEST(ExactOutcomes, ATargetOnASlopeIsClearedByItsOffset) {
  Mesh slope;
  slope.vertices = {{-50, -50, -5}, {50, -50, 5}, {50, 50, 5}, {-50, 50, -5}};
  slope.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Scene scene = SceneBuilder().add("hill", slope);
  Target target = square(4);
  target.offset_m = offset_in(refusal_of_pierced(scene, target, "hill").fix());
  EXPECT_NEAR(target.offset_m, 0.4, 0.0011);
  const Volume volume = compute(scene, target);
  ASSERT_EQ(volume.outcome, Outcome::computed);
  const VerifyReport report = verify_volume(scene, target, {50}, {}, volume.mesh);
  EXPECT_EQ(report.over_claimed, 0u) << report.worst_over_depth_m;
}

TEST(ExactOutcomes, WhatTouchesTheOutlineDoesNotPierce) {
  const Scene scene = SceneBuilder()
                          .ground("ground", 100)
                          .box("wall", {4, -8, 0}, {5, 8, 7})
                          .box("corner", {-6, -6, 0}, {-4, -4, 2})
                          .box("canopy", {-9, -9, 6}, {9, 9, 6.5});
  EXPECT_EQ(compute(scene, square(4)).outcome, Outcome::computed);
}

/// The one note of a target that seems to be under the ground, which is computed like any other.
std::string note_of_buried(const Scene& scene, const Target& target) {
  const Volume volume = compute(scene, target);
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  EXPECT_EQ(volume.notes.size(), 1U);
  if (volume.notes.empty()) return "";
  EXPECT_EQ(volume.notes[0].code, WarningCode::target_underground);
  testing::expect_wording(volume.notes[0].text);
  return volume.notes[0].text;
}

TEST(ExactOutcomes, UnderTheGroundIsToldAndComputed) {
  const Scene scene = SceneBuilder().ground("ground", 100).box("house", {-50, -50, 0}, {-40, -40, 20});
  const Target target = square(4, {0, 0, -3});
  const std::string note = note_of_buried(scene, target);
  EXPECT_TRUE(contains(note, "\"ground\"")) << note;
  EXPECT_TRUE(contains(note, "3.000 m")) << note;
  // What is seen is what is under the ground: a slab 3 m high.
  const Volume volume = compute(scene, target);
  EXPECT_NEAR(bounding_box(volume.mesh).max.z(), 0, 1e-6);
  EXPECT_GT(enclosed_volume(volume.mesh), 0.9 * 3 * 44 * 44 * 3.14);
  Target raised = target;
  raised.offset_m = offset_in(note);
  EXPECT_NEAR(raised.offset_m, 3.0, 0.0011);
  EXPECT_TRUE(compute(scene, raised).notes.empty());
  raised.offset_m = 2.8;  // and nothing much smaller will do
  EXPECT_EQ(compute(scene, raised).notes.size(), 1U);
  raised.offset_m = 1;  // counted from the vertices, not from where the target is now
  EXPECT_NEAR(offset_in(note_of_buried(scene, raised)), 3.0, 0.0011);
}

TEST(ExactOutcomes, TheWayOutOfTheGroundLeadsPastWhatStandsOnIt) {
  const Scene scene = SceneBuilder().ground("ground", 100).box("kiosk", {1, 1, 0}, {2, 2, 2.5});
  Target target = square(4, {0, 0, -2});
  target.offset_m = offset_in(note_of_buried(scene, target));
  EXPECT_NEAR(target.offset_m, 4.5, 0.0011);
  EXPECT_TRUE(compute(scene, target).notes.empty());
  const std::string deep = note_of_buried(scene, square(4, {0, 0, -20}));
  EXPECT_FALSE(contains(deep, "offset")) << "20 m higher it is another target: " << deep;
}

TEST(ExactOutcomes, ATiltedTargetLeavesTheGroundWithItsLowestCorner) {
  Target target = square(2, {0, 0, -2});
  for (Vec3& v : target.parts[0]) v.z() += 0.75 * v.x();  // from -3.5 to -0.5; the normal is (-0.6, 0, 0.8)
  const Scene scene = SceneBuilder().ground("ground", 100);
  target.offset_m = offset_in(note_of_buried(scene, target));
  EXPECT_NEAR(target.offset_m, 3.5 / 0.8, 0.0011);
  EXPECT_TRUE(compute(scene, target).notes.empty());
}

TEST(ExactOutcomes, NoOffsetBringsABuriedFacadeOut) {
  // Sideways it would pass a buried tank, and then the edge of the ground, which is not a way out.
  const Scene scene = SceneBuilder()
                          .ground("ground", 100)
                          .box("tank", {-9, -40, -8}, {9, -30, -2})
                          .polygon("skirt", {{-100, -100, -20}, {100, -100, -20}, {100, -100, 0}, {-100, -100, 0}});
  const std::string note = note_of_buried(scene, facade(2, {0, 0, -5}));
  EXPECT_FALSE(contains(note, "offset")) << note;
}

/// A scene may be anything: a canopy, a sail or a crane's jib without any ground.
TEST(ExactOutcomes, ACanopyAloneIsComputed) {
  const Scene canopy = SceneBuilder().box("canopy", {-6, -6, 5}, {6, 6, 5.2});
  const Scene sail = SceneBuilder().polygon("sail", {{-9, -8, 6}, {9, -7, 7}, {1, 9, 8}});
  for (const Scene* scene : {&canopy, &sail}) {
    for (const Target& target : {square(3), facade(3, {0, 0, 0})}) {
      const Volume volume = compute(*scene, target);
      ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
      const VerifyReport report = verify_volume(*scene, target, {50}, {}, volume.mesh, {.tolerance_m = 0.1});
      EXPECT_EQ(report.over_claimed, 0U) << report.worst_over_depth_m;
      EXPECT_EQ(report.under_claimed, 0U) << report.worst_under_depth_m;
    }
  }
}

TEST(ExactOutcomes, UnderARoofIsNotUnderTheGround) {
  const Scene scene = SceneBuilder().ground("ground", 100).box("roof", {-30, -30, 8}, {30, 30, 9});
  const Volume volume = compute(scene, square(4));
  EXPECT_EQ(volume.outcome, Outcome::computed);
  EXPECT_TRUE(volume.notes.empty());
}

TEST(ExactOutcomes, BadNumbersAreRefused) {
  const Scene scene = SceneBuilder().ground("ground", 100);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, std::nan(""), infinity}) {
    const std::string where = refusal(scene, square(4), ErrorCode::value_out_of_range, {bad}).where();
    EXPECT_EQ(where, bad == infinity ? "sensor" : "sensor.max_range");
    EXPECT_EQ(refusal(scene, square(4), ErrorCode::value_out_of_range, {50}, {bad, 0}).where(), "exact options");
  }
  refusal(scene, square(4), ErrorCode::tolerance_too_fine, {50}, {1e-9, 0});
  refusal(scene, target_of({{0, 0, 0}, {1, 0, 0}}), ErrorCode::target_vertex_count);
}

TEST(ExactOutcomes, ProgressIsReportedAndStops) {
  const PreparedScene scene(SceneBuilder().ground("ground", 100).box("house", {10, -5, 0}, {20, 5, 20}));
  const auto story = testing::check_progress(
      [&](const Progress& progress) { compute_visibility(PreparedTarget(scene, square(4), {50}), {}, progress); });
  EXPECT_EQ(story.stages.size(), 3U);
  testing::expect_wording(story.stages);
}

}  // namespace
}  // namespace vantage
