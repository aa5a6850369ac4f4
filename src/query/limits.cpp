#include "query/limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vantage::query {
namespace {

bool strictly_inside(const Box& box, const Vec3& p) {
  return (p.array() > box.min.array()).all() && (p.array() < box.max.array()).all();
}
bool inside(const Box& box, const Vec3& p) {
  return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
}

// Winding number by signed solid angles (Van Oosterom and Strackee 1983): 1 inside a closed outward-oriented mesh, else
// 0.
double winding_number(const Mesh& mesh, const Vec3& point) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point, c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * M_PI);
}

}  // namespace

std::vector<std::string> limits_broken(const Navigation& navigation, const Vec3& point) {
  std::vector<std::string> broken;
  if (navigation.altitude) {
    if (point.z() < navigation.altitude->min_m) broken.push_back("altitude min");
    if (point.z() > navigation.altitude->max_m) broken.push_back("altitude max");
  }
  const auto& boxes = navigation.boxes;
  if (!boxes.empty() && std::none_of(boxes.begin(), boxes.end(), [&](const Box& box) { return inside(box, point); }))
    broken.push_back("boxes");
  for (std::size_t i = 0; i < navigation.keep_out.size(); ++i)
    if (strictly_inside(navigation.keep_out[i], point)) broken.push_back("keep_out " + std::to_string(i));
  for (const KeepInMesh& mesh : navigation.meshes)
    if (winding_number(mesh.mesh, point) < 0.5) broken.push_back("mesh " + mesh.name);
  return broken;
}

}  // namespace vantage::query
