// The volume of a target in parts. The oracle: a convex polygon is seen from just where both its halves are.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;

constexpr double kRange = 80;

PreparedScene courtyard() {
  SceneBuilder builder;
  builder.ground("ground", 200).box("west", {-40, -30, 0}, {-20, 30, 18}).box("east", {22, -10, 0}, {35, 25, 30});
  builder.box("bridge", {-20, 12, 9}, {22, 14, 10}).box("post", {12, -12, 0}, {13, -11, 6});
  return PreparedScene(builder.scene());
}

Volume volume_of(const PreparedScene& scene, const std::vector<Vec3>& polygon) {
  return compute_visibility(PreparedTarget(scene, target_of(polygon), {kRange}), {1e-3, 0});
}

TEST(IntersectVolumes, AMeshHasItsOriginInItsMiddle) {
  const Mesh box = testing::make_box_mesh({10, 20, 30}, {12, 24, 36});
  const Volume volume = volume_of_mesh(box, "hall");
  EXPECT_EQ(volume.frame.origin, Vec3(11, 22, 33));
  EXPECT_EQ(volume_of_mesh({}, "none").frame.origin, Vec3::Zero());
  EXPECT_EQ(measure(intersect_volumes({volume, volume}).mesh).bounds.max, Vec3(12, 24, 36));
}

TEST(IntersectVolumes, StatesNothingThatDoesNotHoldOfAll) {
  const PreparedScene scene = courtyard();
  const std::vector<Vec3> triangle = {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}, other = {{0, 0, 2}, {2, 0, 2}, {0, 2, 2}};
  const Volume near = volume_of(scene, triangle), beside = volume_of(scene, other);
  const Volume far = compute_visibility(PreparedTarget(scene, target_of(triangle), {kRange + 1}), {1e-3, 0});
  ASSERT_TRUE(near.provenance && far.provenance);
  Volume elsewhere = beside;
  elsewhere.provenance->scene_hash = "of another scene";
  Volume sampled = beside, asked = beside;
  sampled.provenance->method = "spheres";
  asked.provenance->mission_hash = "of another mission";
  const Volume both = intersect_volumes({asked, near});
  ASSERT_TRUE(both.provenance);
  EXPECT_EQ(both.provenance->mission_hash, "");
  EXPECT_TRUE(intersect_volumes({near, beside}).provenance);
  EXPECT_TRUE(unite_volumes({near, beside}).provenance);
  for (const Volume& volume : {far, elsewhere, sampled}) {
    EXPECT_FALSE(intersect_volumes({near, volume}).provenance);
    EXPECT_FALSE(unite_volumes({near, volume}).provenance);
  }
}

TEST(IntersectVolumes, HalvesMakeTheWhole) {
  const PreparedScene scene = courtyard();
  Random random(811);
  for (int round = 0; round < 8; ++round) {
    const double x = random.uniform(-12, 2), y = random.uniform(-8, 2), w = random.uniform(3, 9);
    const double cut = x + w * random.uniform(0.2, 0.8);
    const Volume whole = volume_of(scene, {{x, y, 0}, {x + w, y, 0}, {x + w, y + w, 0}, {x, y + w, 0}});
    const Volume left = volume_of(scene, {{x, y, 0}, {cut, y, 0}, {cut, y + w, 0}, {x, y + w, 0}});
    const Volume right = volume_of(scene, {{cut, y, 0}, {x + w, y, 0}, {x + w, y + w, 0}, {cut, y + w, 0}});
    const Volume both = intersect_volumes({left, right});
    ASSERT_EQ(both.outcome, Outcome::computed) << both.reason;
    EXPECT_EQ(first_open_edge(both.mesh), "");
    const double expected = enclosed_volume(whole.mesh);
    EXPECT_NEAR(enclosed_volume(both.mesh), expected, 1e-4 * expected) << "target at " << x << " " << y << ", " << w;
    EXPECT_GT(enclosed_volume(left.mesh), 1.005 * expected) << "a half alone must claim more, or nothing is tested";
  }
}

// What both were cut to is kept exactly, though booleans round, and cleaning moves corners.
TEST(IntersectVolumes, KeepsAltitudesExactly) {
  Random random(813);
  int computed = 0;
  for (int round = 0; round < 40; ++round) {
    const PreparedScene scene(testing::random_city(random, 12, 12));
    Navigation navigation;
    navigation.altitude = {random.uniform(0.1, 3), random.uniform(5, 20)};
    std::vector<Volume> volumes;
    for (int i = 0; i < 2; ++i) {
      const Vec3 centre(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(4, 12));
      const Target target = testing::random_target(random, 4, 1.5, centre, random.direction());
      volumes.push_back(compute_volume(PreparedTarget(scene, target, {40}), navigation, {0.1, 0}));
    }
    for (const Volume& volume : {intersect_volumes(volumes), unite_volumes(volumes)}) {
      if (volume.outcome != Outcome::computed) continue;
      ++computed;
      const Box box = bounding_box(volume.mesh);
      EXPECT_GE(box.min.z(), navigation.altitude->min_m) << "round " << round;
      EXPECT_LE(box.max.z(), navigation.altitude->max_m) << "round " << round;
    }
  }
  EXPECT_GT(computed, 30);
}

TEST(IntersectVolumes, KeepsCausesAndNamesEachOnce) {
  const PreparedScene scene = courtyard();
  const Volume both = intersect_volumes(
      {volume_of(scene, {{-9, 0, 0}, {-3, 0, 0}, {-3, 6, 0}}), volume_of(scene, {{3, 0, 0}, {9, 0, 0}, {9, 6, 0}})});
  ASSERT_EQ(both.outcome, Outcome::computed) << both.reason;
  ASSERT_EQ(both.cause_of.size(), both.mesh.triangles.size());
  std::set<std::string> names;
  double area = 0;
  for (const Cause& cause : both.causes) {
    EXPECT_TRUE(names.insert(cause.name).second) << cause.name << " stands twice";
    area += cause.area_m2;
  }
  EXPECT_TRUE(names.contains("west")) << "hides the eastern part";
  EXPECT_TRUE(names.contains("east")) << "hides the western part";
  EXPECT_TRUE(names.contains("max_range"));
  EXPECT_NEAR(area, surface_area(both.mesh), 1e-6 * area);
}

TEST(IntersectVolumes, SaysWhenNothingIsInCommon) {
  SceneBuilder builder;
  builder.ground("ground", 500);
  const PreparedScene scene(builder.scene());
  const Volume both = intersect_volumes({volume_of(scene, {{-100, 0, 0}, {-95, 0, 0}, {-95, 5, 0}}),
                                         volume_of(scene, {{95, 0, 0}, {100, 0, 0}, {100, 5, 0}})});
  EXPECT_EQ(both.outcome, Outcome::no_common_view);
  EXPECT_TRUE(both.mesh.empty());
  testing::expect_wording(both.reason);
}

TEST(IntersectVolumes, TakesOverAnEmptyPart) {
  const PreparedScene scene = courtyard();
  const Volume good = volume_of(scene, {{-9, 0, 0}, {-3, 0, 0}, {-3, 6, 0}});
  Volume empty;
  empty.outcome = Outcome::out_of_range;
  empty.reason = "too far";
  const Volume both = intersect_volumes({good, empty});
  EXPECT_EQ(both.outcome, Outcome::out_of_range);
  testing::expect_wording(both.reason);
  EXPECT_TRUE(both.mesh.empty() && both.causes.empty());
}

TEST(IntersectVolumes, RefusesNothingAtAll) { EXPECT_THROW(intersect_volumes({}), Error); }

}  // namespace
}  // namespace vantage
