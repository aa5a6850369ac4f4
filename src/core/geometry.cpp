#include "vantage/geometry.h"

#include <Eigen/Geometry>

namespace vantage {

Box bounding_box(const Mesh& mesh) {
  Box box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) box.extend(mesh.vertices[vertex]);
  }
  return box;
}

double enclosed_volume(const Mesh& mesh) {
  if (mesh.empty()) return 0;
  // About a vertex of the mesh rather than the origin of the scene: with large coordinates the terms would cancel.
  const Vec3 apex = mesh.vertices[mesh.triangles[0][0]];
  double six_volumes = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3 a = mesh.vertices[triangle[0]] - apex;
    const Vec3 b = mesh.vertices[triangle[1]] - apex;
    const Vec3 c = mesh.vertices[triangle[2]] - apex;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

double surface_area(const Mesh& mesh) {
  double twice_area = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3& a = mesh.vertices[triangle[0]];
    twice_area += (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm();
  }
  return twice_area / 2;
}

}  // namespace vantage
