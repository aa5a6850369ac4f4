#include "support/blocker_solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "support/internals.h"
#include "support/trim.h"

namespace vantage::testing {
namespace {

using Real = long double;
using Homogeneous = Eigen::Matrix<Real, 4, 1>;

/// Heights over the target's plane up to this are the surface that it lies on, metres.
constexpr double kOnPlane = 1e-9;

std::vector<Vec3> clip_to_front(const std::array<Vec3, 3>& triangle) {
  std::vector<Vec3> polygon;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = triangle[i], &b = triangle[(i + 1) % 3];
    if (a.z() >= 0) polygon.push_back(a);
    if ((a.z() < 0) == (b.z() < 0)) continue;
    Vec3 cut = a + a.z() / (a.z() - b.z()) * (b - a);
    cut.z() = 0;
    polygon.push_back(cut);
  }
  return polygon;
}

/// The vector orthogonal to three others.
Homogeneous orthogonal(const Homogeneous& a, const Homogeneous& b, const Homogeneous& c) {
  Homogeneous n;
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix<Real, 3, 3> minor;
    for (int row = 0, k = 0; row < 4; ++row)
      if (row != i) minor.row(k++) << a[row], b[row], c[row];
    n[i] = (i % 2 ? -1 : 1) * minor.determinant();
  }
  return n;
}

/// Half-spaces n . (x, 1) >= 0 whose intersection is conv(O) + cone{ o - t }: the facets of the cone over (o, 1) and
/// (o - t, 0).
std::vector<Homogeneous> half_spaces(const std::vector<Vec3>& polygon, const std::vector<Eigen::Vector2d>& target) {
  Real size = 1;
  for (const Vec3& o : polygon) size = std::max<Real>(size, o.norm());
  std::vector<Homogeneous> generators;
  const auto add = [&](const Vec3& v, Real w) {
    Homogeneous g(v.x() / size, v.y() / size, v.z() / size, w);
    if (g.norm() > 1e-15L) generators.push_back(g.normalized());
  };
  for (const Vec3& o : polygon) add(o, 1);
  for (const Vec3& o : polygon)
    for (const Eigen::Vector2d& t : target) add(o - Vec3(t.x(), t.y(), 0), 0);

  std::vector<Homogeneous> found;
  const std::size_t count = generators.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k) {
        Homogeneous n = orthogonal(generators[i], generators[j], generators[k]);
        if (!(n.norm() > 1e-11L)) continue;  // long doubles: the direction is good to 1e-8 at worst
        n.normalize();
        Real low = 0, high = 0;
        for (const Homogeneous& g : generators) {
          low = std::min(low, n.dot(g));
          high = std::max(high, n.dot(g));
          if (low < -1e-12L && high > 1e-12L) break;
        }
        if (low < -1e-12L && high > 1e-12L) continue;
        if (low < -1e-12L) n = -n;
        const auto same = [&](const Homogeneous& m) { return (m - n).norm() < 1e-12L; };
        if (std::none_of(found.begin(), found.end(), same)) found.push_back(n);
      }
    }
  }
  for (Homogeneous& n : found) n.head<3>() /= size;
  return found;
}

Box box_of(const solid::Solid& region, const TargetFrame& frame) {
  Box box = region.bounds();
  for (const Eigen::Vector2d& t : frame.polygon) box.extend(Vec3(t.x(), t.y(), 0));
  return box;
}

bool disjoint(const Box& a, const Box& b) {
  return (a.min.array() > b.max.array()).any() || (b.min.array() > a.max.array()).any();
}

}  // namespace

solid::Solid blocker_solid(const std::array<Vec3, 3>& triangle, const std::vector<Eigen::Vector2d>& target,
                           const Box& box) {
  const std::vector<Vec3> polygon = clip_to_front(triangle);
  if (polygon.size() < 3) return {};
  solid::Solid solid = solid::make_box(box, {});
  for (const Homogeneous& n : half_spaces(polygon, target)) {
    const Real length = n.head<3>().norm();
    if (!(length > 1e-15L)) continue;  // the plane at infinity
    const Vec3 normal = (n.head<3>() / -length).cast<double>();
    solid = trim(solid, normal, static_cast<double>(n[3] / length), 0);
    if (solid.empty()) break;
  }
  return solid;
}

solid::Solid local_solid(const Volume& volume) {
  solid::LabelledMesh local{volume.mesh, volume.cause_of};
  for (Vec3& v : local.mesh.vertices) v = volume.frame.to_local(v);
  return solid::Solid(local, "volume");
}

solid::Solid local_box(const TargetFrame& frame, double reach, double height) {
  Box box;
  for (const Eigen::Vector2d& t : frame.polygon) {
    box.extend(Vec3(t.x() - reach, t.y() - reach, 0));
    box.extend(Vec3(t.x() + reach, t.y() + reach, height));
  }
  return solid::make_box(box, {});
}

UnionComparison compare_with_union(const Scene& scene, const Volume& volume, const solid::Solid& region) {
  const TargetFrame& frame = volume.frame;
  const Box box = box_of(region, frame);
  std::vector<solid::Solid> blockers;
  for (const Triangle& t : scene.mesh.triangles) {
    std::array<Vec3, 3> triangle;
    Box bounds;
    for (int i = 0; i < 3; ++i) {
      triangle[i] = frame.to_local(scene.mesh.vertices[t[i]]);
      if (std::abs(triangle[i].z()) <= kOnPlane) triangle[i].z() = 0;
      bounds.extend(triangle[i]);
    }
    if (bounds.max.z() <= 0 || disjoint(bounds, box)) continue;
    const double area = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
    if (!(area > 1e-12)) continue;
    solid::Solid blocker = blocker_solid(triangle, frame.polygon, box);
    if (!blocker.empty()) blockers.push_back(std::move(blocker));
  }
  const solid::Solid expected = solid::subtract(region, solid::unite(blockers));
  const solid::Solid computed = solid::intersect(local_solid(volume), region);
  return {expected.volume(), solid::subtract(expected, computed).volume(), solid::subtract(computed, expected).volume(),
          blockers.size()};
}

}  // namespace vantage::testing
