// Which polygon of the scene each facet of a volume names. The oracle: just beyond the facet that polygon alone hides
// part of the target.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>
#include <vector>

#include "support/clip_oracle.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::ClipOracle;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;

using Polygon = std::vector<Vec3>;

Vec3 mean(const Polygon& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

constexpr double kToleranceM = 0.01;  // that facets near the range limit may lie inside

/// Whether the polygon hides part of one of the targets from a point just beyond the triangle.
bool hides_beyond(const Polygon& blocker, const Mesh& mesh, const Triangle& facet,
                  const std::vector<Polygon>& targets) {
  const Vec3 middle = (mesh.vertices[facet[0]] + mesh.vertices[facet[1]] + mesh.vertices[facet[2]]) / 3;
  const SceneBuilder alone = SceneBuilder().polygon("blocker", blocker);
  for (const Polygon& target : targets) {
    const Vec3 away = middle - mean(target);
    const Vec3 beyond = middle + (1e-4 + 1.5 * kToleranceM / away.norm()) * away;
    if (ClipOracle(alone.scene().mesh, target).is_hidden_from(beyond, 1e-12)) return true;
  }
  return false;
}

double area_of(const Mesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm() / 2;
}

/// Returns how many facets are due to the scene.
std::size_t check(const Volume& volume, const PreparedScene& scene, const std::vector<Polygon>& targets) {
  EXPECT_EQ(volume.polygon_of.size(), volume.mesh.triangles.size());
  if (volume.polygon_of.size() != volume.mesh.triangles.size()) return 0;
  std::size_t of_scene = 0;
  for (std::size_t t = 0; t < volume.mesh.triangles.size(); ++t) {
    const Cause& cause = volume.causes[volume.cause_of[t]];
    const std::uint32_t polygon = volume.polygon_of[t];
    EXPECT_EQ(polygon == kNoPolygon, cause.kind != CauseKind::scene) << cause.name;
    if (polygon == kNoPolygon) continue;
    EXPECT_EQ(scene.object_of_polygon(polygon), cause.object);
    if (area_of(volume.mesh, volume.mesh.triangles[t]) < 1e-6)
      continue;  // its middle may be off its plane by as much as it is wide
    EXPECT_TRUE(hides_beyond(scene.polygon(polygon), volume.mesh, volume.mesh.triangles[t], targets))
        << "facet " << t << ", polygon " << polygon << " of " << cause.name;
    ++of_scene;
  }
  return of_scene;
}

TEST(FacetPolygons, HideTheTargetBeyondTheFacet) {
  const std::uint64_t seed = 4100;
  std::cout << "seeds from " << seed << "\n";
  std::size_t facets = 0;
  for (std::uint64_t round = 0; round < 6; ++round) {
    Random random(seed + round);
    const PreparedScene scene(testing::random_city(random, 14, 8));
    const Polygon target = {{-5, -4, 0.5}, {4, -5, 0.5}, {5, 3, 0.5}, {-3, 5, 0.5}};
    const Volume volume = compute_visibility(PreparedTarget(scene, target_of(target), {60}), {kToleranceM});
    facets += check(volume, scene, {target});

    Navigation limits;
    limits.altitude = {2, 30};
    limits.keep_out = {Box{Vec3(10, 10, 0), Vec3(25, 30, 40)}};
    facets += check(cut_to_navigation(volume, limits), scene, {target});
  }
  EXPECT_GT(facets, 500U);
}

TEST(FacetPolygons, OfATargetInPartsAndOfAPoint) {
  Random random(4200);
  const PreparedScene scene(testing::random_city(random, 14, 8));
  const Polygon west = {{-5, -4, 0.5}, {-1, -4, 0.5}, {-1, 4, 0.5}}, east = {{1, -4, 0.5}, {5, -4, 0.5}, {1, 4, 0.5}};
  Target both = target_of(west);
  both.parts.push_back(east);
  EXPECT_GT(check(compute_volume(PreparedTarget(scene, both, {60}), {}, {kToleranceM}), scene, {west, east}), 50U);

  const Volume of_point = compute_visibility(PreparedTarget(scene, Target::point({0, 0, 6}), {60}), {kToleranceM});
  ASSERT_EQ(of_point.polygon_of.size(), of_point.mesh.triangles.size());
  for (std::size_t t = 0; t < of_point.polygon_of.size(); ++t) {
    const Cause& cause = of_point.causes[of_point.cause_of[t]];
    if (cause.kind != CauseKind::scene) continue;
    EXPECT_EQ(scene.object_of_polygon(of_point.polygon_of[t]), cause.object);
  }
}

TEST(FacetPolygons, AreRefusedWhereTheyDoNotFit) {
  const PreparedScene scene(SceneBuilder().ground("ground", 30).box("house", {8, -2, 0}, {12, 2, 6}).scene());
  EXPECT_THROW(scene.polygon(static_cast<std::uint32_t>(scene.statistics().polygons)), Error);
  EXPECT_THROW(scene.object_of_polygon(kNoPolygon), Error);
  const Polygon target = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  Volume volume = compute_visibility(PreparedTarget(scene, target_of(target), {30}));
  Navigation limits;
  limits.altitude = {2, 20};
  volume.polygon_of.pop_back();
  EXPECT_THROW(cut_to_navigation(volume, limits), Error);
  volume.polygon_of.clear();  // not known
  EXPECT_TRUE(cut_to_navigation(volume, limits).polygon_of.empty());
}

}  // namespace
}  // namespace vantage
