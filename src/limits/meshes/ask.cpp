#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "query/point_limit.h"

namespace vantage::internal::query {
namespace {

bool within(const Box& box, const Vec3& p) {
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
  return sum / (2 * std::numbers::pi);
}

/// Where the line passes a triangle, or nearly: a crossing too many does no harm, one too few would. Triangles that the
/// line slides along are left out; where they end it passes their neighbours.
void add_mesh_crossings(const Mesh& mesh, const ViewRay& line, std::vector<double>& out) {
  constexpr double kNear = 1e-9;  // of the triangle's size
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - line.origin, u = mesh.vertices[t[1]] - mesh.vertices[t[0]],
               v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const Vec3 normal = u.cross(v);
    const double slope = normal.dot(line.direction);
    if (slope == 0) continue;
    const double distance = normal.dot(a) / slope;
    const Vec3 p = distance * line.direction - a;
    const double scale = normal.squaredNorm();
    const double along_u = p.cross(v).dot(normal) / scale, along_v = u.cross(p).dot(normal) / scale;
    if (along_u >= -kNear && along_v >= -kNear && along_u + along_v <= 1 + kNear) out.push_back(distance);
  }
}

class MeshesOfPoint : public PointLimit {
 public:
  explicit MeshesOfPoint(const std::vector<KeepInMesh>& meshes) : meshes_(meshes) {
    for (const KeepInMesh& mesh : meshes_) boxes_.push_back(bounding_box(mesh.mesh));
  }

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      // Also because the winding number overflows far away.
      const bool is_in = within(boxes_[i], point) && !(winding_number(meshes_[i].mesh, point) < 0.5);
      if (!is_in) broken.push_back("mesh " + meshes_[i].name);
    }
  }
  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    for (const KeepInMesh& mesh : meshes_) add_mesh_crossings(mesh.mesh, line, cuts);
  }

 private:
  std::vector<KeepInMesh> meshes_;
  std::vector<Box> boxes_;
};

}  // namespace

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::meshes>(const std::vector<KeepInMesh>& meshes,
                                                             GroundPool& /*grounds*/) {
  return std::make_unique<MeshesOfPoint>(meshes);
}

}  // namespace vantage::internal::query
