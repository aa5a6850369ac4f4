// Visibility spheres of a real city, by the back end that is used here: inner bounds of what is seen, and closed
// volumes.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/brute_depth.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "vantage/scene.h"
#include "vantage/spheres.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::Random;
using testing::shared_data;

constexpr const char* kScene = "charlotte/uptownCharlotte.obj";
constexpr const char* kBaseline = "charlotte/baseline.json";

Scene charlotte() { return read_scene(shared_data(kScene), {.up = UpAxis::y}); }

/// In the scene frame; the file keeps the axes of the OBJ, y up.
std::vector<Target> targets() {
  std::ifstream stream(shared_data(kBaseline));
  const nlohmann::json file = nlohmann::json::parse(stream);
  std::vector<Target> result;
  for (const auto& entry : file.at("targets")) {
    Target& target = result.emplace_back();
    target.name = entry.at("name").get<std::string>();
    for (const auto& v : entry.at("vertices")) target.parts[0].emplace_back(v[0], -v[2].get<double>(), v[1]);
  }
  return result;
}

/// How many of the points are deeper inside than a millionth of their distance, but hidden from `from` or too far.
int count_over_claimed(const Scene& scene, const Mesh& mesh, const Vec3& from, double range, int points,
                       Random& random) {
  Volume volume;
  volume.mesh = mesh;
  volume.frame.origin = from;
  const testing::MeshProbe probe(volume);
  int over_claimed = 0;
  for (int k = 0; k < points; ++k) {
    Vec3 point;
    if (k % 2 == 0) {
      point = probe.draw(random);
    } else {  // just within the boundary, where a bound is wrong first
      const Triangle& t = mesh.triangles[random.integer(0, static_cast<int>(mesh.triangles.size()) - 1)];
      double a = random.uniform(0, 1), b = random.uniform(0, 1);
      if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
      }
      const Vec3& corner = mesh.vertices[t[0]];
      point = corner + a * (mesh.vertices[t[1]] - corner) + b * (mesh.vertices[t[2]] - corner);
      point = from + (1 - 1e-5) * (point - from);
    }
    const double distance = (point - from).norm();
    const bool is_wrong = distance > range || testing::first_hit(scene.mesh, from, point - from) < 1;
    over_claimed += is_wrong && probe.depth(point) > 1e-6 * distance;
  }
  return over_claimed;
}

TEST(HeavySpheres, ConservativeSpheresOfCharlotteClaimNothingHidden) {
  VANTAGE_REQUIRE_SHARED(kScene);
  const Scene scene = charlotte();
  const PreparedScene prepared(scene);
  Random random(31);
  ASSERT_EQ(targets().size(), 3U);
  for (const Target& target : targets()) {
    const Vec3 from = target.parts[0][0] + Vec3(0, 0, 0.5);
    SpheresOptions options;
    options.device = parse_device_choice("cpu");
    for (const bool is_grid : {false, true}) {
      options.cubemap = 40;
      if (is_grid) options.resolution = {96, 48};
      const Mesh mesh = visibility_sphere(prepared, from, 300, options);
      const MeshMeasures m = measure(mesh);
      EXPECT_TRUE(m.closed && m.oriented && m.euler == 2 && m.pieces == 1) << target.name;
      EXPECT_EQ(count_over_claimed(scene, mesh, from, 300, 2000, random), 0) << target.name;
      options.sphere = SpheresOptions::Sphere::centers;
      const Mesh centers = visibility_sphere(prepared, from, 300, options);
      EXPECT_GT(count_over_claimed(scene, centers, from, 300, 2000, random), 0) << "or this test notices nothing";
      EXPECT_GT(enclosed_volume(centers), m.volume_m3);
      EXPECT_GT(m.volume_m3, 0.5 * enclosed_volume(centers));
      options.sphere = SpheresOptions::Sphere::conservative;
    }
  }
}

TEST(HeavySpheres, VolumesOfTheBaselineAreClosed) {
  VANTAGE_REQUIRE_SHARED(kScene);
  const PreparedScene prepared(charlotte());
  ASSERT_EQ(targets().size(), 3U);
  for (const Target& target : targets()) {
    for (const int range : {100, 300}) {
      for (const auto sphere : {SpheresOptions::Sphere::conservative, SpheresOptions::Sphere::centers}) {
        SpheresOptions options;
        options.device = parse_device_choice("cpu");
        options.cubemap = 40;
        options.sphere = sphere;
        SpheresReport report;
        const Volume volume = compute_visibility_spheres(PreparedTarget(prepared, target, {static_cast<double>(range)}),
                                                         options, &report);
        const MeshMeasures m = measure(volume.mesh);
        EXPECT_TRUE(m.closed && m.oriented) << target.name << " " << range;
        EXPECT_GT(m.volume_m3, 0);
        const Volume exact = compute_visibility(PreparedTarget(prepared, target, {static_cast<double>(range)}));
        std::printf("%s %d m, %s: %.0f m3 (exact %.0f), %.3f s, %zu splits, %zu unresolved\n", target.name.c_str(),
                    range, sphere == SpheresOptions::Sphere::centers ? "centers" : "conservative", m.volume_m3,
                    enclosed_volume(exact.mesh), volume.seconds.engine, report.splits, report.unresolved_pairs);
      }
    }
  }
}

}  // namespace
}  // namespace vantage
