// Booleans of what is near the solid alone: the same solid as by the boolean of everything.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "solid/convex_body.h"
#include "solid/local_cut.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/solids.h"

namespace vantage {
namespace {

using solid::CutKind;
using solid::LabelledMesh;
using solid::LocalCut;
using solid::Solid;
using testing::first_open_edge;
using testing::make_dome;
using testing::Random;

LabelledMesh labelled(Mesh mesh, std::uint32_t first, std::uint32_t count) {
  LabelledMesh result{std::move(mesh), {}};
  for (std::uint32_t t = 0; t < result.mesh.triangles.size(); ++t) result.labels.push_back(first + t % count);
  return result;
}

/// A dome of a few thousand facets with a wavy surface.
LabelledMesh wavy_dome(Random& random, double scale, const Vec3& origin) {
  const double waves = random.uniform(2, 9), height = random.uniform(0, 0.3), phase = random.uniform(0, 6);
  const Volume dome = make_dome(origin, 90, 30, [&](double azimuth, double elevation) {
    const double wave = std::sin(std::round(waves) * azimuth + phase) * std::cos(elevation);
    return scale * (1 + height * wave);
  });
  return labelled(dome.mesh, 0, 3);
}

/// A ball of facets, or a box; with labels that the dome has too.
Solid draw_solid(Random& random, double scale, const Vec3& origin) {
  const Vec3 centre = origin + scale * random.in_box({Vec3(-1.2, -1.2, -0.3), Vec3(1.2, 1.2, 1.2)});
  if (random.chance(0.5)) {
    const Vec3 half = scale * Vec3(random.uniform(0.05, 1), random.uniform(0.05, 1), random.uniform(0.05, 1));
    solid::BoxLabels labels;
    labels.min = {0, 1, 2};
    labels.max = {3, 4, 5};
    return solid::make_box({centre - half, centre + half}, labels);
  }
  Mesh ball = solid::make_sphere(random.integer(1, 8)).mesh;
  const double radius = scale * random.uniform(0.05, 1);
  for (Vec3& vertex : ball.vertices) vertex = centre + radius * vertex;
  return Solid(labelled(std::move(ball), 2, 4));
}

using Corners = std::array<std::tuple<double, double, double>, 3>;

/// The facets of some label by their corners, from the least one on.
std::set<Corners> facets_of(const LabelledMesh& labelled) {
  std::set<Corners> facets;
  for (const Triangle& triangle : labelled.mesh.triangles) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = labelled.mesh.vertices[triangle[k]];
      corners[k] = {v.x(), v.y(), v.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    facets.insert(corners);
  }
  return facets;
}

std::map<std::uint32_t, double> areas_of(const LabelledMesh& labelled) {
  std::map<std::uint32_t, double> areas;
  for (std::size_t t = 0; t < labelled.labels.size(); ++t) {
    const auto& [a, b, c] = labelled.mesh.triangles[t];
    const std::vector<Vec3>& v = labelled.mesh.vertices;
    areas[labelled.labels[t]] += (v[b] - v[a]).cross(v[c] - v[a]).norm() / 2;
  }
  return areas;
}

TEST(LocalCut, IsTheSameAsTheBooleanOfEverything) {
  Random random(61);
  std::size_t through = 0, all = 0, kept = 0;
  for (int round = 0; round < 120; ++round) {
    const double scale = std::pow(10.0, random.uniform(-3, 3));
    const Vec3 origin = scale * random.point(-2, 2);
    const LabelledMesh dome = wavy_dome(random, scale, origin);
    const Solid by = draw_solid(random, scale, origin);
    const Solid whole(dome);
    for (const CutKind kind : {CutKind::keep_inside, CutKind::keep_outside}) {
      SCOPED_TRACE(round);
      const LabelledMesh expected =
          (kind == CutKind::keep_inside ? intersect(whole, by) : subtract(whole, by)).to_mesh();
      const LocalCut cut = cut_locally(dome, by, kind);
      EXPECT_EQ(first_open_edge(cut.mesh.mesh), "");
      const double volume = scale * scale * scale;
      EXPECT_NEAR(enclosed_volume(cut.mesh.mesh), enclosed_volume(expected.mesh), 1e-9 * volume);
      const auto areas = areas_of(cut.mesh), expected_areas = areas_of(expected);
      for (const auto& [label, area] : expected_areas) {
        const auto found = areas.find(label);
        EXPECT_NEAR(found == areas.end() ? 0 : found->second, area, 1e-9 * scale * scale) << label;
      }
      const std::set<Corners> original = facets_of(dome), left = facets_of(cut.mesh), by_all = facets_of(expected);
      for (const Corners& facet : by_all) {
        if (original.contains(facet)) {
          EXPECT_TRUE(left.contains(facet)) << "a facet that nothing cuts";
          ++kept;
        }
      }
      through += cut.through;
      all += dome.mesh.triangles.size();
    }
  }
  EXPECT_LT(through, all / 2) << "most facets are far from the solid";
  EXPECT_GT(kept, 10'000u);
}

TEST(LocalCut, WithoutASolidAllIsLeftOrNothing) {
  Random random(67);
  const LabelledMesh dome = wavy_dome(random, 1, Vec3::Zero());
  EXPECT_TRUE(cut_locally(dome, Solid(), CutKind::keep_inside).mesh.mesh.empty());
  EXPECT_NEAR(enclosed_volume(cut_locally(dome, Solid(), CutKind::keep_outside).mesh.mesh), enclosed_volume(dome.mesh),
              1e-12);
}

}  // namespace
}  // namespace vantage
