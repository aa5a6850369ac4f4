#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "core/progress_reporter.h"
#include "solid/csg.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/trim.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::solid {
namespace {

using vantage::testing::first_open_edge;
using vantage::testing::make_box_mesh;
using vantage::testing::trim;

const Vec3 kOrigin = Vec3::Zero();

/// A box whose sides are labelled first, first + 1, ... : min x, y, z, then max x, y, z.
Solid labelled_box(const Vec3& min, const Vec3& max, std::uint32_t first) {
  return make_box({min, max}, {{first, first + 1, first + 2}, {first + 3, first + 4, first + 5}});
}

std::set<std::uint32_t> labels_of(const LabelledMesh& labelled) {
  return {labelled.labels.begin(), labelled.labels.end()};
}

double area_of(const LabelledMesh& labelled, std::uint32_t label) {
  Mesh part;
  part.vertices = labelled.mesh.vertices;
  for (std::size_t i = 0; i < labelled.labels.size(); ++i) {
    if (labelled.labels[i] == label) part.triangles.push_back(labelled.mesh.triangles[i]);
  }
  return surface_area(part);
}

TEST(Csg, BoxKeepsItsCornersAndLabels) {
  const Box box{Vec3(0.1, 0.2, 0.3), Vec3(1.7, 2.9, 3.1)};
  const Solid solid = make_box(box, {{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(solid.facets(), 12u);
  EXPECT_EQ(solid.euler(), 2);
  EXPECT_NEAR(solid.volume(), 1.6 * 2.7 * 2.8, 1e-12);
  const LabelledMesh mesh = solid.to_mesh();
  EXPECT_EQ(first_open_edge(mesh.mesh), "");
  EXPECT_EQ(bounding_box(mesh.mesh).min, box.min);
  EXPECT_EQ(bounding_box(mesh.mesh).max, box.max);
  for (std::size_t i = 0; i < mesh.labels.size(); ++i) {
    const unsigned axis = (mesh.labels[i] - 1) % 3;
    const double at = mesh.labels[i] <= 3 ? box.min[axis] : box.max[axis];
    for (const std::uint32_t v : mesh.mesh.triangles[i]) EXPECT_EQ(mesh.mesh.vertices[v][axis], at);
  }
}

TEST(Csg, IntersectionOfBoxesIsExactAndLabelled) {
  const Solid a = labelled_box(kOrigin, Vec3(1, 1, 1), 0), b = labelled_box(Vec3(0.3, 0.7, -5), Vec3(9, 9, 0.9), 10);
  const LabelledMesh result = intersect(a, b).to_mesh();
  EXPECT_EQ(first_open_edge(result.mesh), "");
  EXPECT_EQ(bounding_box(result.mesh).min, Vec3(0.3, 0.7, 0));
  EXPECT_EQ(bounding_box(result.mesh).max, Vec3(1, 1, 0.9));
  EXPECT_EQ(labels_of(result), (std::set<std::uint32_t>{2, 3, 4, 10, 11, 15}));
  EXPECT_NEAR(area_of(result, 10), 0.3 * 0.9, 1e-12);
  EXPECT_NEAR(area_of(result, 15), 0.7 * 0.3, 1e-12);
}

TEST(Csg, DifferenceKeepsTheLabelsOfWhatIsTakenAway) {
  const Solid a = labelled_box(kOrigin, Vec3(4, 4, 4), 0), b = labelled_box(Vec3(1, 1, 1), Vec3(2, 2, 9), 10);
  const Solid result = subtract(a, b);
  EXPECT_EQ(result.euler(), 2);
  EXPECT_NEAR(result.volume(), 64 - 3, 1e-12);
  EXPECT_EQ(labels_of(result.to_mesh()), (std::set<std::uint32_t>{0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 14}));
}

TEST(Csg, CoplanarFacetsOfDifferentLabelsStayApart) {
  // Two boxes side by side make one flat top, half of it labelled 5 and half 15; a hole is then cut across the border.
  const Solid left = labelled_box(kOrigin, Vec3(1, 1, 1), 0), right = labelled_box(Vec3(1, 0, 0), Vec3(2, 1, 1), 10);
  const Solid both = unite(left, right);
  EXPECT_EQ(measure(both.to_mesh().mesh).pieces, 1u);
  EXPECT_NEAR(both.volume(), 2, 1e-12);
  EXPECT_NEAR(area_of(both.to_mesh(), 5), 1, 1e-12);
  EXPECT_NEAR(area_of(both.to_mesh(), 15), 1, 1e-12);
  const LabelledMesh cut = subtract(both, labelled_box(Vec3(0.75, 0.25, 0.5), Vec3(1.25, 0.75, 2), 20)).to_mesh();
  EXPECT_EQ(first_open_edge(cut.mesh), "");
  EXPECT_NEAR(area_of(cut, 5), 1 - 0.25 * 0.5, 1e-12);
  EXPECT_NEAR(area_of(cut, 15), 1 - 0.25 * 0.5, 1e-12);
}

TEST(Csg, LabelsWithinOneMeshStayApart) {
  // The same, but the two halves of the top come from one mesh.
  LabelledMesh dome;
  const Volume volume = vantage::testing::make_hemisphere(kOrigin, 10);
  dome.mesh = volume.mesh;
  dome.labels = volume.cause_of;
  for (std::size_t i = 0; i < dome.labels.size(); ++i) {
    if (dome.labels[i] != 4) continue;
    const Vec3 corner = dome.mesh.vertices[dome.mesh.triangles[i][0]] + dome.mesh.vertices[dome.mesh.triangles[i][1]];
    dome.labels[i] = corner.x() > 0 ? 4 : 5;
  }
  const double half = area_of(dome, 4);
  const LabelledMesh cut = subtract(Solid(dome), labelled_box(Vec3(-1, -1, -1), Vec3(1, 1, 1), 20)).to_mesh();
  EXPECT_EQ(first_open_edge(cut.mesh), "");
  EXPECT_NEAR(area_of(cut, 4), half - 2, 1e-9);
  EXPECT_NEAR(area_of(cut, 5), half - 2, 1e-9);
}

TEST(Csg, SurvivingVerticesKeepTheirBits) {
  const Volume volume = vantage::testing::make_hemisphere(Vec3(0.1, 0.2, 0.3), 100);
  const Solid dome({volume.mesh, volume.cause_of});
  const LabelledMesh cut = trim(dome, Vec3::UnitZ(), 37.7, 9).to_mesh();
  std::set<std::array<double, 3>> before;
  for (const Vec3& v : volume.mesh.vertices) before.insert({v.x(), v.y(), v.z()});
  std::size_t kept = 0, on_plane = 0;
  for (const Vec3& v : cut.mesh.vertices) {
    kept += before.count({v.x(), v.y(), v.z()});
    on_plane += v.z() == 37.7;
    EXPECT_LE(v.z(), 37.7);
  }
  EXPECT_EQ(kept + on_plane, cut.mesh.vertices.size());
  EXPECT_GT(kept, 24u);
  EXPECT_GE(on_plane, 24u);
  EXPECT_GT(area_of(cut, 9), 0);
}

TEST(Csg, TrimKeepsOneSide) {
  const Solid cube = labelled_box(kOrigin, Vec3(2, 2, 2), 0);
  EXPECT_NEAR(trim(cube, -Vec3::UnitX(), -0.5, 7).volume(), 6, 1e-12);
  const Vec3 diagonal = Vec3(1, 1, 1).normalized();
  const Solid corner = trim(cube, diagonal, std::sqrt(3.0) / 3, 7);
  EXPECT_NEAR(corner.volume(), 1.0 / 6, 1e-12);
  EXPECT_NEAR(area_of(corner.to_mesh(), 7), std::sqrt(3.0) / 2, 1e-12);
  EXPECT_EQ(trim(cube, Vec3::UnitZ(), 5, 7).facets(), 12u);
  EXPECT_TRUE(trim(cube, Vec3::UnitZ(), -1, 7).empty());
  EXPECT_TRUE(trim(cube, Vec3::UnitZ(), -100, 7).empty());
}

TEST(Csg, ManyOperandsAtOnce) {
  std::vector<Solid> boxes;
  for (int i = 0; i < 10; ++i) {
    boxes.push_back(labelled_box(Vec3(i, 0, 0), Vec3(i + 1.5, 1, 1), static_cast<std::uint32_t>(10 * i)));
  }
  EXPECT_NEAR(unite(boxes).volume(), 10.5, 1e-12);
  EXPECT_EQ(measure(unite(boxes).to_mesh().mesh).pieces, 1u);
  EXPECT_NEAR(intersect(std::span(boxes).first(2)).volume(), 0.5, 1e-12);
  EXPECT_TRUE(intersect(boxes).empty());
  EXPECT_TRUE(unite(std::span<const Solid>()).empty());
  EXPECT_THROW(intersect(std::span<const Solid>()), Error);
}

TEST(Csg, WhatMerelyTouchesDoesNotMeet) {
  const Solid a = labelled_box(kOrigin, Vec3(1, 1, 1), 0);
  EXPECT_TRUE(intersect(a, labelled_box(Vec3(1, 0, 0), Vec3(2, 1, 1), 10)).empty());
  EXPECT_TRUE(subtract(a, a).empty());
  EXPECT_NEAR(intersect(a, a).volume(), 1, 1e-12);
  // Along an edge: two pieces that share none by index, so the mesh is closed in the strict sense.
  const Solid touching = unite(a, labelled_box(Vec3(1, 1, 0), Vec3(2, 2, 1), 10));
  EXPECT_NEAR(touching.volume(), 2, 1e-12);
  EXPECT_EQ(first_open_edge(touching.to_mesh().mesh), "");
}

TEST(Csg, TunnelAndCavity) {
  const Solid cube = labelled_box(kOrigin, Vec3(3, 3, 3), 0);
  const Solid tunnel = subtract(cube, labelled_box(Vec3(1, 1, -1), Vec3(2, 2, 4), 10));
  EXPECT_EQ(tunnel.euler(), 0);
  const Solid hollow = subtract(cube, labelled_box(Vec3(1, 1, 1), Vec3(2, 2, 2), 10));
  EXPECT_EQ(hollow.euler(), 4);
  EXPECT_NEAR(hollow.volume(), 26, 1e-12);
  EXPECT_EQ(measure(hollow.to_mesh().mesh).pieces, 2u);
  EXPECT_TRUE(Solid().bounds().empty());
}

TEST(Csg, RefusesWhatIsNotClosed) {
  LabelledMesh open{make_box_mesh(kOrigin, Vec3(1, 1, 1)), std::vector<std::uint32_t>(12, 0)};
  open.mesh.triangles.pop_back();
  open.labels.pop_back();
  testing::expect_error([&] { Solid(open, "airspace.ply"); }, ErrorCode::mesh_not_closed, "airspace.ply");
  LabelledMesh bad_index{make_box_mesh(kOrigin, Vec3(1, 1, 1)), std::vector<std::uint32_t>(12, 0)};
  bad_index.mesh.triangles[3][1] = 99;
  EXPECT_THROW(Solid{bad_index}, Error);
  LabelledMesh not_finite{make_box_mesh(kOrigin, Vec3(1, 1, 1)), std::vector<std::uint32_t>(12, 0)};
  not_finite.mesh.vertices[2].y() = std::nan("");
  EXPECT_THROW(Solid{not_finite}, Error);
  EXPECT_THROW((make_box({Vec3(1, 0, 0), Vec3(0, 1, 1)}, {})), Error);
}

// Booleans leave such meshes where solids touch: a facet of the top is turned over, and lies in the top's plane beyond
// the wall. It is no facet without area, to be given to the wall.
TEST(Csg, AFacetFoldedBackIntoAPlaneStaysInIt) {
  testing::Random random(331);
  for (int round = 0; round < 200; ++round) {
    Mesh mesh = make_box_mesh(kOrigin, Vec3(1, 1, 1));
    // The top is a fan about a point beyond one of its sides.
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.vertices[v].z() == 1; });
    });
    ASSERT_EQ(mesh.triangles.size(), 10U);
    const auto apex = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(random.uniform(0.2, 0.8), random.uniform(-0.4, -0.01), 1);
    for (const auto& [a, b] : {std::pair(4U, 5U), {5U, 7U}, {7U, 6U}, {6U, 4U}}) mesh.triangles.push_back({a, b, apex});
    ASSERT_EQ(first_open_edge(mesh), "");
    ASSERT_NEAR(enclosed_volume(mesh), 1, 1e-12);
    const Solid solid({mesh, std::vector<std::uint32_t>(mesh.triangles.size(), 0)});
    EXPECT_NEAR(solid.volume(), 1, 1e-9) << mesh.vertices[apex].transpose();
    EXPECT_NEAR(intersect(solid, labelled_box(Vec3(-1, -1, -1), Vec3(2, 0, 0.99), 1)).volume(), 0, 1e-9);
    EXPECT_NEAR(intersect(solid, labelled_box(Vec3(-1, 0, -1), Vec3(2, 2, 2), 1)).volume(), 1, 1e-9);
  }
}

TEST(Csg, AsksAndMayBeStopped) {
  const Volume volume = vantage::testing::make_hemisphere(kOrigin, 100, 300, 150);
  const Solid dome({volume.mesh, volume.cause_of});
  std::vector<Solid> boxes;
  for (int i = 0; i < 8; ++i) boxes.push_back(labelled_box(Vec3(i * 9, -50, 1), Vec3(i * 9 + 8.5, 50, 60), 10));
  Solid all;
  const auto story = testing::follow(
      [&](const Progress& progress) { all = intersect(dome, unite(boxes), core::ProgressReporter(progress)); });
  EXPECT_FALSE(all.empty());
  EXPECT_GT(story.calls, 0U);
  const Progress no = [](std::string_view, double) { return false; };
  try {
    intersect(dome, unite(boxes), core::ProgressReporter(no));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
  const Progress broken = [](std::string_view, double) -> bool { throw std::logic_error("mine"); };
  EXPECT_THROW(intersect(dome, unite(boxes), core::ProgressReporter(broken)), std::logic_error);
}

}  // namespace
}  // namespace vantage::internal::solid
