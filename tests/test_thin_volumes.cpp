// Volumes that limits leave thinner than the length up to which edges are merged: facets that were moved inward,
// through the other side, once made lobes and pieces that were inside out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "core/crossings.h"
#include "core/pieces.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "vantage/prove.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using core::LabelledMesh;
using testing::Random;
using testing::SceneBuilder;

constexpr double kDegree = std::numbers::pi / 180;

/// No claim may be refuted; a mesh with a piece that is inside out is refused with an error.
void expect_not_wrong(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
                      const Volume& volume) {
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  ProofReport report;
  ASSERT_NO_THROW(report = prove_volume(scene, target, sensor, navigation, volume.mesh, {.lift_m = volume.lift_m}));
  for (const ClaimProof& claim : report.claims) EXPECT_NE(claim.verdict, ProofVerdict::wrong) << claim.text;
}

// Near a point, between its plane and the double cone in which a camera that looks level has it in its picture, the
// volume is a wedge that gets thinner without end.
TEST(ThinVolumes, PointSeenWithOnePitch) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(5e5, 5e6, 100)}) {
      const auto at = [&](double x, double y, double z) { return Vec3(shift + scale * Vec3(x, y, z)); };
      const Scene scene = SceneBuilder().polygon("ground", {at(-2000, -2000, 0), at(2000, -2000, 0), at(0, 2000, 0)});
      Target target = Target::point(at(0, 0, 20));
      target.front = Vec3(0, 1, 0);
      Sensor sensor{.max_range_m = 120 * scale,
                    .camera = Pinhole{std::tan(kDegree * 30), std::tan(kDegree * 20), 0, 0, {}}};
      sensor.mount = {.min_pitch_deg = 0, .max_pitch_deg = 0};
      const ExactOptions options{.tolerance_m = 1.2 * scale};
      SCOPED_TRACE("scale " + std::to_string(scale) + ", shift " + std::to_string(shift.x()));
      expect_not_wrong(scene, target, sensor, {},
                       compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), {}, options));
    }
  }
}

/// Covers all but notches whose mouths are thousands of kilometres away: towards their ends they get as thin as the
/// lengths that are merged.
Zone::Ring notched(Random& random, double reach) {
  constexpr int kNotches = 12;
  const double pitch = reach / kNotches, far = 2e4 * reach;
  Zone::Ring ring{{-reach, -far}, {reach, -far}};
  for (int notch = kNotches - 1; notch > -kNotches; --notch) {
    const double end = notch * pitch;
    ring.emplace_back(end + pitch * random.uniform(0.1, 0.45), far);
    ring.emplace_back(end, -reach * random.uniform(-0.5, 1));
    ring.emplace_back(end - pitch * random.uniform(0.1, 0.45), far);
  }
  return ring;
}

TEST(ThinVolumes, NotchesOfZones) {
  Random random(2026);
  for (int round = 0; round < 24; ++round) {
    const double reach = std::vector<double>{0.03, 57, 400}[static_cast<std::size_t>(round % 3)];
    const Scene scene = SceneBuilder().ground("ground", 9 * reach);
    const Target target = Target::point({0, 0, 0.01 * reach});
    const Sensor sensor{.max_range_m = reach};
    Navigation navigation;
    Zone& out = navigation.keep_out.emplace_back();
    out.outer = notched(random, reach);
    Zone& in = navigation.keep_in.emplace_back();
    const double wide = 88 * reach;
    in.outer = {{wide, -wide}, {wide, wide}, {-wide, wide}, {-wide, -wide}};
    in.holes = {{{-80 * reach, -0.3 * reach}, {79 * reach, -0.1 * reach}, {70 * reach, 0.3 * reach}}};
    in.min_z_m = random.uniform(0.1, 0.3) * reach;
    in.max_z_m = in.min_z_m + 0.15 * reach;
    SCOPED_TRACE("round " + std::to_string(round));
    expect_not_wrong(scene, target, sensor, navigation,
                     compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), navigation,
                                    {.tolerance_m = 0.01 * reach}));
  }
}

LabelledMesh boxes(const std::vector<Box>& outward, const std::vector<Box>& inward) {
  LabelledMesh result;
  const auto add = [&](const Box& box, bool is_inward) {
    const Mesh mesh = testing::make_box_mesh(box.min, box.max);
    const auto first = static_cast<std::uint32_t>(result.mesh.vertices.size());
    result.mesh.vertices.insert(result.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.triangles) {
      result.mesh.triangles.push_back(is_inward ? Triangle{first + c, first + b, first + a}
                                                : Triangle{first + a, first + b, first + c});
      result.labels.push_back(0);
    }
  };
  for (const Box& box : outward) add(box, false);
  for (const Box& box : inward) add(box, true);
  return result;
}

TEST(DropSlivers, KeepsCavitiesAndDropsWhatElseIsInsideOut) {
  const Box whole{{0, 0, 0}, {10, 10, 10}}, cavity{{2, 2, 2}, {3, 3, 3}}, at_a_side{{0, 5, 5}, {1, 6, 6}},
      outside{{11, 0, 0}, {12, 1, 1}}, thin{{20, 0, 0}, {21, 1, 1e-9}};
  LabelledMesh labelled = boxes({whole, thin}, {cavity, at_a_side, outside});
  core::drop_slivers(labelled, 1e-8);
  const LabelledMesh expected = boxes({whole}, {cavity, at_a_side});
  EXPECT_EQ(labelled.mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(labelled.mesh.triangles, expected.mesh.triangles);
  EXPECT_EQ(labelled.labels.size(), labelled.mesh.triangles.size());
}

TEST(DropSlivers, KeepsAPieceThatFillsItsCavity) {
  const Box box{{0, 0, 0}, {10, 10, 10}};
  LabelledMesh labelled = boxes({box}, {box});
  core::drop_slivers(labelled, 1e-8);
  EXPECT_EQ(labelled.mesh.triangles.size(), 24u);
}

TEST(Crossings, AreFoundWhereTheyAreDeeperThanTheDistance) {
  const LabelledMesh two = boxes({{{0, 0, 0}, {2, 2, 2}}, {{1, 1, 1.9}, {3, 3, 4}}}, {});
  std::vector<std::uint32_t> first_box(12);
  std::iota(first_box.begin(), first_box.end(), 0u);
  const auto crossings = core::find_crossings(two.mesh, first_box, 1e-9);
  EXPECT_FALSE(crossings.empty());
  for (const auto& [a, b] : crossings) {
    EXPECT_LT(a, 12u);
    EXPECT_GE(b, 12u);  // neighbours do not cross
  }
  EXPECT_TRUE(core::find_crossings(two.mesh, first_box, 0.2).empty());
  EXPECT_TRUE(core::find_crossings(boxes({{{0, 0, 0}, {2, 2, 2}}, {{2, 0, 0}, {3, 3, 3}}}, {}).mesh, first_box, 1e-9)
                  .empty());  // they touch
}

}  // namespace
}  // namespace vantage
