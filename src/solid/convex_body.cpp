#include "solid/convex_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "core/parallel.h"
#include "core/portable_math.h"
#include "core/twofold.h"
#include "solid/convex_hull.h"

namespace vantage::internal::solid {
namespace {

constexpr double kGolden = std::numbers::phi;

const std::array<Vec3, 12> kIcosahedron = {Vec3(-1, kGolden, 0),  Vec3(1, kGolden, 0),   Vec3(-1, -kGolden, 0),
                                           Vec3(1, -kGolden, 0),  Vec3(0, -1, kGolden),  Vec3(0, 1, kGolden),
                                           Vec3(0, -1, -kGolden), Vec3(0, 1, -kGolden),  Vec3(kGolden, 0, -1),
                                           Vec3(kGolden, 0, 1),   Vec3(-kGolden, 0, -1), Vec3(-kGolden, 0, 1)};
constexpr std::array<Triangle, 20> kFacets = {{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                               {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                               {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                               {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};

/// The angle from the middle of a spherical triangle's circumscribed circle to its corners.
double circumscribed_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 middle = (b - a).cross(c - a).normalized();
  return portable::acos(std::clamp(std::abs(middle.dot(a)), 0.0, 1.0));
}

using core::exact_difference;
using core::Twofold;

/// p q - r s, to 2^-100 of |p q| + |r s|.
double product_difference(const Twofold& p, const Twofold& q, const Twofold& r, const Twofold& s) {
  const double pq = p.high * q.high, rs = r.high * s.high;
  const double pq_low = std::fma(p.high, q.high, -pq) + (p.high * q.low + p.low * q.high);
  const double rs_low = std::fma(r.high, s.high, -rs) + (r.high * s.low + r.low * s.high);
  const Twofold sum = exact_difference(pq, rs);
  return sum.high + (sum.low + (pq_low - rs_low));
}

}  // namespace

Vec3 sure_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  Vec3 normal = u.cross(v);
  constexpr double kWide = 1e-4;  // of the product of the sides: up to there rounding turns the normal by 1e-11
  if (normal.squaredNorm() > kWide * kWide * u.squaredNorm() * v.squaredNorm()) return normal;
  std::array<Twofold, 3> along_u, along_v;
  for (unsigned axis = 0; axis < 3; ++axis) {
    along_u[axis] = exact_difference(b[axis], a[axis]);
    along_v[axis] = exact_difference(c[axis], a[axis]);
  }
  Vec3 sure;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned next = (axis + 1) % 3, last = (axis + 2) % 3;
    sure[axis] = product_difference(along_u[next], along_v[last], along_u[last], along_v[next]);
  }
  return sure;
}

Mesh intersect_half_spaces(std::span<const HalfSpace> half_spaces, const Vec3& inside) {
  // Duality (Preparata and Shamos 1985, 7.2.5): planes at the distance h along n become points n / h, and the facets of
  // these points' hull the corners of the intersection.
  std::vector<Vec3> duals;
  duals.reserve(half_spaces.size());
  for (const HalfSpace& half_space : half_spaces) {
    duals.push_back(half_space.normal / (half_space.at - half_space.normal.dot(inside)));
  }
  const Mesh dual_hull = convex_hull(duals);
  std::vector<Vec3> corners;
  corners.reserve(dual_hull.triangles.size());
  for (const Triangle& t : dual_hull.triangles) {
    const Vec3& a = dual_hull.vertices[t[0]];
    const Vec3 normal = sure_normal(a, dual_hull.vertices[t[1]], dual_hull.vertices[t[2]]);
    const double distance = normal.dot(a);
    if (distance > 0) corners.push_back(normal / distance);
  }
  // Planes that nearly coincide have no sure corner: pull it back into all half-spaces.
  parallel::for_ranges(corners.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double most = 0;
      for (const Vec3& dual : duals) most = std::max(most, dual.dot(corners[i]));
      corners[i] = inside + corners[i] / std::max(most, 1.0);
    }
  });
  return convex_hull(corners);
}

SphereMesh make_sphere(int parts) {
  SphereMesh sphere;
  std::map<std::array<std::pair<std::uint32_t, int>, 3>, std::uint32_t> index;
  for (const Triangle& facet : kFacets) {
    // A vertex is known by its weights of the icosahedron's corners, zero ones left out.
    const auto vertex = [&](int i, int j) {
      std::array<std::pair<std::uint32_t, int>, 3> key{{{facet[0], parts - i - j}, {facet[1], i}, {facet[2], j}}};
      for (auto& [corner, weight] : key) {
        if (weight == 0) corner = 0;
      }
      std::sort(key.begin(), key.end());
      const auto [entry, is_new] = index.try_emplace(key, static_cast<std::uint32_t>(sphere.mesh.vertices.size()));
      if (is_new) {
        Vec3 sum = Vec3::Zero();
        for (const auto& [corner, weight] : key) sum += weight * kIcosahedron[corner];
        sphere.mesh.vertices.push_back(sum.normalized());
      }
      return entry->second;
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        sphere.mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j + 1 < parts)
          sphere.mesh.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
    }
  }
  for (const Triangle& t : sphere.mesh.triangles) {
    const auto& v = sphere.mesh.vertices;
    sphere.cover = std::max(sphere.cover, circumscribed_angle(v[t[0]], v[t[1]], v[t[2]]));
  }
  return sphere;
}

SphereMesh make_sphere_for(double share) {
  // The corners of a facet that is one of n parts along each side lie within 0.77 / n of its middle.
  const double cover = std::sqrt(2 * share);
  return make_sphere(std::max(1, static_cast<int>(std::ceil(0.77 / cover))));
}

}  // namespace vantage::internal::solid
