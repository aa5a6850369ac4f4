// The three targets of charlotte/baseline.json: brute-force reference volumes, and the plain union of blockers.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/stopwatch.h"
#include "support/blocker_solids.h"
#include "support/internals.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::shared_data;

constexpr const char* kScene = "charlotte/uptownCharlotte.obj";
constexpr const char* kBaseline = "charlotte/baseline.json";

nlohmann::json baseline() {
  std::ifstream stream(shared_data(kBaseline));
  return nlohmann::json::parse(stream);
}

/// In the scene frame; the file keeps the axes of the OBJ, y up.
Target target_of(const nlohmann::json& entry) {
  Target target;
  target.name = entry.at("name");
  for (const auto& v : entry.at("vertices")) target.parts[0].emplace_back(v[0], -v[2].get<double>(), v[1]);
  return target;
}

Scene charlotte() { return read_scene(shared_data(kScene), {.up = UpAxis::y}); }

TEST(HeavyCharlotte, MeetsTheReferenceVolumes) {
  VANTAGE_REQUIRE_SHARED(kScene);
  const PreparedScene scene(charlotte());
  const auto file = baseline();
  const auto& reference = file.at("reference_m3").at("front_side_only");
  int compared = 0;
  for (const auto& entry : file.at("targets")) {
    const Target target = target_of(entry);
    for (const int range : {100, 300, 600}) {
      const std::string key = target.name + " r" + std::to_string(range);
      const double expected = reference.at(key);
      const Volume volume = compute_visibility(PreparedTarget(scene, target, {static_cast<double>(range)}));
      const MeshMeasures m = measure(volume.mesh);
      EXPECT_TRUE(m.closed && m.oriented && m.euler == 2 && m.pieces == 1) << key;
      EXPECT_NEAR(m.volume_m3, expected, 0.002 * expected) << key;
      std::printf("%s: %.0f m3, reference %.0f, %+.3f %%\n", key.c_str(), m.volume_m3, expected,
                  100 * (m.volume_m3 / expected - 1));
      ++compared;
    }
  }
  EXPECT_EQ(compared, 9);
}

TEST(HeavyCharlotte, EqualsThePlainUnionOfBlockers) {
  VANTAGE_REQUIRE_SHARED(kScene);
  const Scene scene = charlotte();
  const PreparedScene prepared(scene);
  const auto file = baseline();
  int compared = 0;
  for (const auto& entry : file.at("targets")) {
    const Target target = target_of(entry);
    const Volume volume = compute_visibility(PreparedTarget(prepared, target, {100}));
    // The region: a coarse polyhedron in the range region, two parts in a thousand smaller, which keeps it clear of the
    // facets of the range sphere.
    Volume region = compute_visibility(PreparedTarget(PreparedScene{Scene{}}, target, {100}), {1.0, 0});
    region.frame = volume.frame;
    for (Vec3& v : region.mesh.vertices) v = volume.frame.origin + 0.998 * (v - volume.frame.origin);
    const core::Stopwatch stopwatch;
    const testing::UnionComparison c = testing::compare_with_union(scene, volume, testing::local_solid(region));
    const double seconds = stopwatch.seconds();
    EXPECT_LT(c.error(), 1e-6) << target.name;
    EXPECT_GT(c.blockers, 100u);
    std::printf("%s: %.3f m3 by the union of %zu blockers, %.2g m3 missing, %.2g m3 too much; %.1f s\n",
                target.name.c_str(), c.volume, c.blockers, c.missing, c.excessive, seconds);
    ++compared;
  }
  EXPECT_EQ(compared, 3);
}

}  // namespace
}  // namespace vantage
