#include "arrays.h"

#include <cstring>

namespace vantage::python {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t),
              "arrays of points and of triangles are seen as plain numbers");

std::vector<Vec3> points_of(const PointArray& array) {
  std::vector<Vec3> points(array.shape(0));
  if (!points.empty()) std::memcpy(points.front().data(), array.data(), points.size() * sizeof(Vec3));
  return points;
}

Mesh mesh_of(const PointArray& vertices, const FaceArray& faces) {
  Mesh mesh{points_of(vertices), std::vector<Triangle>(faces.shape(0))};
  if (!mesh.triangles.empty()) {
    std::memcpy(mesh.triangles.front().data(), faces.data(), mesh.triangles.size() * sizeof(Triangle));
  }
  return mesh;
}

}  // namespace vantage::python
