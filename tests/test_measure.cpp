#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "core/edges.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::append;
using testing::make_box_mesh;

/// A ring of 4 x 4 quadrilaterals: one piece of genus 1.
Mesh make_torus() {
  Mesh mesh;
  const double pi = std::numbers::pi;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double r = 3 + std::cos(pi / 2 * j);
      mesh.vertices.emplace_back(r * std::cos(pi / 2 * i), r * std::sin(pi / 2 * i), std::sin(pi / 2 * j));
    }
  }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(i % 4 * 4 + j % 4); };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TEST(Measure, Box) {
  Mesh mesh = make_box_mesh(Vec3(1, 2, 3), Vec3(2, 4, 6));
  mesh.vertices.emplace_back(100, 100, 100);  // used by no triangle
  const MeshMeasures m = measure(mesh);
  EXPECT_EQ(m.vertices, 8u);
  EXPECT_EQ(m.facets, 12u);
  EXPECT_EQ(m.pieces, 1u);
  EXPECT_EQ(m.euler, 2);
  EXPECT_TRUE(m.closed);
  EXPECT_TRUE(m.oriented);
  EXPECT_DOUBLE_EQ(m.volume_m3, 6);
  EXPECT_DOUBLE_EQ(m.area_m2, 22);
  EXPECT_EQ(m.bounds.min, Vec3(1, 2, 3));
  EXPECT_EQ(m.bounds.max, Vec3(2, 4, 6));
}

TEST(Measure, TorusAndPieces) {
  EXPECT_EQ(measure(make_torus()).euler, 0);
  EXPECT_TRUE(measure(make_torus()).oriented);
  Mesh three = make_torus();
  append(three, make_box_mesh(Vec3(10, 0, 0), Vec3(11, 1, 1)));
  append(three, make_box_mesh(Vec3(12, 0, 0), Vec3(13, 1, 1)));
  const MeshMeasures m = measure(three);
  EXPECT_EQ(m.pieces, 3u);
  EXPECT_EQ(m.euler, 4);
  EXPECT_DOUBLE_EQ(m.volume_m3, measure(make_torus()).volume_m3 + 2);
}

TEST(Measure, PiecesAreJoinedByEdgesNotByVertices) {
  // Two boxes that share one corner by index.
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  append(mesh, make_box_mesh(Vec3(1, 1, 1), Vec3(2, 2, 2)));
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = v == 8 ? 7 : v;
  }
  const MeshMeasures m = measure(mesh);
  EXPECT_EQ(m.vertices, 15u);
  EXPECT_EQ(m.pieces, 2u);
  EXPECT_TRUE(m.closed);
}

TEST(Measure, OpenMesh) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles.pop_back();
  EXPECT_FALSE(measure(mesh).closed);
  EXPECT_FALSE(measure(mesh).oriented);
}

TEST(Measure, TurnedTriangle) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_TRUE(measure(mesh).closed);
  EXPECT_FALSE(measure(mesh).oriented);
}

TEST(Measure, FourTrianglesOnAnEdgeAreNotClosed) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  append(mesh, make_box_mesh(Vec3(1, 1, 0), Vec3(2, 2, 1)));
  EXPECT_TRUE(measure(mesh).closed);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = v == 8 ? 3 : v == 12 ? 7 : v;
  }
  EXPECT_FALSE(measure(mesh).closed);
}

TEST(Measure, RepeatedVertexIsNotClosed) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_FALSE(measure(mesh).closed);
}

TEST(Measure, EmptyMesh) {
  const MeshMeasures m = measure({});
  EXPECT_EQ(m.vertices + m.facets + m.pieces, 0u);
  EXPECT_EQ(m.euler, 0);
  EXPECT_EQ(m.volume_m3, 0);
  EXPECT_TRUE(m.bounds.empty());
}

TEST(Measure, Dome) {
  const MeshMeasures m = measure(testing::make_hemisphere(Vec3(580000, 4785000, 1000), 100, 200, 100).mesh);
  EXPECT_EQ(m.euler, 2);
  EXPECT_TRUE(m.closed && m.oriented);
  EXPECT_NEAR(m.volume_m3, 2e6 / 3 * std::numbers::pi, 1000);
}

TEST(Measure, NamesTheTriangleWithABadIndex) {
  Mesh mesh = make_box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles[3][2] = 8;
  testing::expect_error([&] { measure(mesh); }, ErrorCode::index_out_of_range);
}

}  // namespace
}  // namespace vantage
