#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "vantage/geometry.h"

namespace vantage {
namespace {

/// The corner tetrahedron of a cube with edges of `size` metres, moved by `offset`.
Mesh corner(double size, const Vec3& offset) {
  Mesh mesh;
  mesh.vertices = {offset, offset + Vec3(size, 0, 0), offset + Vec3(0, size, 0), offset + Vec3(0, 0, size)};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

TEST(Geometry, MeasuresATetrahedron) {
  const Mesh mesh = corner(2, Vec3::Zero());
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), 8.0 / 6);
  EXPECT_DOUBLE_EQ(surface_area(mesh), 6 + 2 * std::sqrt(3.0));
  const Box box = bounding_box(mesh);
  EXPECT_EQ(box.min, Vec3::Zero());
  EXPECT_EQ(box.max, Vec3::Constant(2));
}

TEST(Geometry, AVertexThatNoTriangleUsesDoesNotCount) {
  Mesh mesh = corner(2, Vec3(580000, 4785000, 1000));
  mesh.vertices.push_back(Vec3::Zero());
  EXPECT_EQ(bounding_box(mesh).min, Vec3(580000, 4785000, 1000));
}

TEST(Geometry, VolumeSurvivesLargeCoordinates) {
  EXPECT_NEAR(enclosed_volume(corner(2, Vec3(580000, 4785000, 1000))), 8.0 / 6, 1e-9);
}

TEST(Geometry, TurningTheTrianglesNegatesTheVolume) {
  Mesh mesh = corner(2, Vec3::Zero());
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), -8.0 / 6);
}

TEST(Geometry, ADirectionMayHaveAnyLength) {
  const Vec3 ordinary(3, -4, 12);
  EXPECT_EQ(unit(ordinary), ordinary.normalized());
  for (const double length : {5e-324, 1e-320, 1e-200, 1e-162, 1e-30, 1e30, 1e160, 1e200, 1e300}) {
    SCOPED_TRACE(length);
    const Vec3 direction = unit(Vec3(length, 0, -length));
    EXPECT_NEAR(direction.norm(), 1, 1e-15);
    EXPECT_LT((direction - Vec3(1, 0, -1).normalized()).norm(), 1e-15);
  }
}

TEST(Geometry, AnEmptyMeshHasNoSize) {
  EXPECT_TRUE(bounding_box({}).empty());
  EXPECT_EQ(enclosed_volume({}), 0);
  EXPECT_EQ(surface_area({}), 0);
}

}  // namespace
}  // namespace vantage
