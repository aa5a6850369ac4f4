// Triangles that cover a rectangle of the plane, looked at by plain loops.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "maps/terrain/tin.h"

namespace vantage::internal::terrain {

using Vec2 = Eigen::Vector2d;

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

inline double area(const Mesh& mesh, const Triangle& t) {
  const Vec2 a = mesh.vertices[t[0]].head<2>();
  return cross(mesh.vertices[t[1]].head<2>() - a, mesh.vertices[t[2]].head<2>() - a) / 2;
}

/// A mesh that covers [min, max] once: no triangle is turned over, their areas add up, and every edge is shared by two
/// triangles or lies on the border.
inline void expect_tiling(const Mesh& mesh, const Vec2& min, const Vec2& max) {
  double sum = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    ASSERT_GT(area(mesh, t), 0);
    sum += area(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  EXPECT_NEAR(sum, (max - min).prod(), 1e-9 * (max - min).prod());
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    if (edges.count({edge.second, edge.first})) continue;
    const Vec2 a = mesh.vertices[edge.first].head<2>(), b = mesh.vertices[edge.second].head<2>();
    const bool on_border = (a.x() == b.x() && (a.x() == min.x() || a.x() == max.x())) ||
                           (a.y() == b.y() && (a.y() == min.y() || a.y() == max.y()));
    ASSERT_TRUE(on_border) << a.transpose() << " - " << b.transpose();
  }
}

/// The height over a place, by trying every triangle.
inline std::optional<double> slow_height(const Mesh& mesh, const Vec2& at) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double whole = area(mesh, t) * 2;
    const double u = cross(b.head<2>() - at, c.head<2>() - at) / whole,
                 v = cross(c.head<2>() - at, a.head<2>() - at) / whole;
    if (u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9) return u * a.z() + v * b.z() + (1 - u - v) * c.z();
  }
  return std::nullopt;
}

inline Mesh mesh_of_all(const Tin& tin) {
  Mesh mesh;
  mesh.vertices = tin.points();
  for (const Tin::Facet& facet : tin.facets()) mesh.triangles.push_back(facet.corner);
  return mesh;
}

inline Tin unit_square(double side = 1) {
  return Tin({Vec3(0, 0, 0), Vec3(side, 0, 0), Vec3(side, side, 0), Vec3(0, side, 0)});
}

}  // namespace vantage::internal::terrain
