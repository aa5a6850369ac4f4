#include "support/ray_caster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::testing {
namespace {

bool meets(const Box& box, const Vec3& inverse, double limit) {
  double from = 0, to = limit;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = box.min[axis] * inverse[axis], b = box.max[axis] * inverse[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to * (1 + 1e-9) + 1e-9;
}

}  // namespace

RayCaster::RayCaster(const Mesh& mesh, const Vec3& centre) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - centre;
    triangles_.push_back({a, mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]});
  }
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void RayCaster::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t at = nodes_.size();
  Box box;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Corners& c = triangles_[i];
    for (const Vec3& corner : {c.a, Vec3(c.a + c.ab), Vec3(c.a + c.ac)}) box.extend(corner);
  }
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= 4) return;
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const auto middle_of = [axis](const Corners& c) { return c.a[axis] + (c.ab[axis] + c.ac[axis]) / 3; };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const Corners& a, const Corners& b) { return middle_of(a) < middle_of(b); });
  build(begin, middle);
  nodes_[at].second = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

double RayCaster::first_hit(const Vec3& direction, double limit, double ignore) const {
  const Vec3 inverse = direction.cwiseInverse();
  std::vector<std::size_t> stack{0};
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    const Node& node = nodes_[at];
    if (!meets(node.box, inverse, limit)) continue;
    if (node.second != 0) {
      stack.push_back(node.second);
      stack.push_back(at + 1);
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      // Moeller and Trumbore 1997.
      const Corners& c = triangles_[i];
      const Vec3 p = direction.cross(c.ac);
      const double scale = c.ab.dot(p);
      if (scale == 0) continue;
      const double u = -c.a.dot(p) / scale;
      const Vec3 q = (-c.a).cross(c.ab);
      const double v = direction.dot(q) / scale, distance = c.ac.dot(q) / scale;
      if (u >= 0 && v >= 0 && u + v <= 1 && distance > ignore) limit = std::min(limit, distance);
    }
  }
  return limit;
}

Vec3 even_direction(std::size_t i, std::size_t count) {
  const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
  const double azimuth = 2 * std::numbers::pi * std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

double radial_volume(const std::function<double(const Vec3& direction)>& radius, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::pow(radius(even_direction(i, count)), 3);
  return 4 * std::numbers::pi / 3 * sum / static_cast<double>(count);
}

}  // namespace vantage::testing
