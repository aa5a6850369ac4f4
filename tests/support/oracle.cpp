#include "support/oracle.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <utility>

namespace vantage::testing {
namespace {

constexpr double kBand = 1e-7;  // what is closer than this to a border or an end counts as grazing
constexpr double kSkin = 1e-3;  // metres: the surface that the target lies on

}  // namespace

Oracle::Oracle(const Mesh& mesh, std::vector<Vec3> polygon, const Vec3& normal)
    : polygon_(std::move(polygon)), origin_(polygon_[0]), normal_(normal.normalized()) {
  for (Vec3& vertex : polygon_) vertex -= origin_;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]];
    triangles_.push_back({a - origin_, mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a});
  }
}

bool Oracle::on_surface(const Vec3& hit) const {
  if (normal_.dot(hit) >= kSkin) return false;
  double turn = 0;
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    turn += polygon_[i].cross(polygon_[(i + 1) % polygon_.size()]).dot(normal_);
  }
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Vec3 edge = polygon_[(i + 1) % polygon_.size()] - polygon_[i];
    const Vec3 inwards = (turn > 0 ? normal_ : Vec3(-normal_)).cross(edge).normalized();
    if (inwards.dot(hit - polygon_[i]) < -kSkin) return false;
  }
  return true;
}

// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", JGT 1997.
Visibility Oracle::look(const Vec3& viewpoint, const Vec3& target_point) const {
  const Vec3 from = viewpoint - origin_, direction = target_point - viewpoint;
  bool touched = false;
  for (const Corners& triangle : triangles_) {
    const Vec3 p = direction.cross(triangle.ac);
    const double determinant = triangle.ab.dot(p);
    const Vec3 offset = from - triangle.a;
    const double u = offset.dot(p) / determinant;
    if (u < -kBand || u > 1 + kBand) continue;
    const Vec3 q = offset.cross(triangle.ab);
    const double v = direction.dot(q) / determinant;
    if (v < -kBand || u + v > 1 + kBand) continue;
    const double s = triangle.ac.dot(q) / determinant;
    if (s < -kBand || s > 1 + kBand) continue;
    // A segment that runs almost in the triangle's plane: the quotients above mean nothing, or not enough.
    const double size = direction.norm() * triangle.ab.cross(triangle.ac).norm();
    const bool parallel = !(std::abs(determinant) > kBand * size);
    const bool inner = u > kBand && v > kBand && u + v < 1 - kBand && s > kBand && s < 1 - kBand;
    if (!parallel && on_surface(from + s * direction)) continue;
    if (!parallel && inner) return Visibility::hidden;
    touched = true;
  }
  return touched ? Visibility::grazing : Visibility::clear;
}

bool Oracle::sees_all(const Vec3& viewpoint, int samples, std::uint64_t seed) const {
  const auto hidden = [&](const Vec3& local) { return look(viewpoint, local + origin_) == Visibility::hidden; };
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Vec3 edge = polygon_[(i + 1) % polygon_.size()] - polygon_[i];
    for (int k = 0; k < 6; ++k) {
      if (hidden(polygon_[i] + k / 6.0 * edge)) return false;
    }
  }
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> weight;
  for (int k = 0; k < samples; ++k) {
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (const Vec3& vertex : polygon_) {
      const double share = weight(random);
      sum += share * vertex;
      total += share;
    }
    if (hidden(sum / total)) return false;
  }
  return true;
}

bool sees_all(const Scene& scene, const std::vector<Vec3>& polygon, const Vec3& viewpoint, int samples) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return Oracle(scene.mesh, polygon, normal).sees_all(viewpoint, samples);
}

}  // namespace vantage::testing
