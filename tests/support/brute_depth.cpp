#include "support/brute_depth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "support/internals.h"

namespace vantage::testing {
namespace {

using Polygon = std::vector<Vec3>;

/// The part where inside . p >= 0.
Polygon clipped(const Polygon& polygon, const Vec3& inside) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double ha = inside.dot(a), hb = inside.dot(b);
    if (ha >= 0) kept.push_back(a);
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) kept.push_back(a + ha / (ha - hb) * (b - a));
  }
  return kept;
}

float rounded_up(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded >= value ? rounded : std::nextafter(rounded, std::numeric_limits<float>::infinity());
}

/// Of the part of the polygon in the texel; 0 if there is none.
double nearest_inverse(const Polygon& polygon, const depth::CubeFace& face, double u, double v, double half) {
  Polygon part = clipped(polygon, face.right - (u - half) * face.forward);
  part = clipped(part, (u + half) * face.forward - face.right);
  part = clipped(part, face.up - (v - half) * face.forward);
  part = clipped(part, (v + half) * face.forward - face.up);
  double inverse = 0;
  for (const Vec3& p : clipped(part, face.forward)) inverse = std::max(inverse, 1 / std::max(0.0, p.dot(face.forward)));
  return inverse;
}

}  // namespace

double first_hit(const Mesh& mesh, const Vec3& from, const Vec3& direction) {
  double first = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - from, ab = mesh.vertices[t[1]] - mesh.vertices[t[0]],
               ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const Vec3 normal = ab.cross(ac);
    const double slope = normal.dot(direction);
    if (slope == 0) continue;
    const double distance = normal.dot(a) / slope;
    const Vec3 at = distance * direction - a;
    const double square = normal.squaredNorm();
    const double p = at.cross(ac).dot(normal) / square, q = ab.cross(at).dot(normal) / square;
    if (distance >= 0 && p >= 0 && q >= 0 && p + q <= 1) first = std::min(first, distance);
  }
  return first;
}

BruteDepth::BruteDepth(Mesh mesh) : mesh_(std::move(mesh)) {
  device_.name = "brute force";
  device_.largest_face_size = 4096;
}

void BruteDepth::render(const depth::DepthRequest& request, const depth::DepthSink& sink) {
  ++requests;
  const int n = request.face_size;
  std::vector<float> inverse(6 * static_cast<std::size_t>(n) * n);
  for (std::size_t k = 0; k < request.viewpoints.size(); ++k) {
    std::vector<Polygon> polygons;
    for (const Triangle& t : mesh_.triangles) {
      Polygon& polygon = polygons.emplace_back();
      for (const auto v : t) polygon.push_back(mesh_.vertices[v] - request.viewpoints[k]);
    }
    std::size_t texel = 0;
    for (const depth::CubeFace& face : depth::cube_faces()) {
      for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column, ++texel) {
          const double u = (2.0 * column + 1) / n - 1, v = (2.0 * row + 1) / n - 1;
          if (request.sampling == depth::Sampling::centers) {
            const Vec3 direction = face.forward + u * face.right + v * face.up;
            inverse[texel] = static_cast<float>(1 / first_hit(mesh_, request.viewpoints[k], direction));
            continue;
          }
          double nearest = 0;
          for (const Polygon& polygon : polygons)
            nearest = std::max(nearest, nearest_inverse(polygon, face, u, v, 1.0 / n));
          inverse[texel] = rounded_up(nearest);
        }
      }
    }
    ++images;
    sink(k, inverse);
  }
}

}  // namespace vantage::testing
