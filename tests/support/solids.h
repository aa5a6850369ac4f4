// Test solids made by hand, and an obvious check that a mesh is closed and oriented.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "vantage/volume.h"

namespace vantage::testing {

/// A star-shaped dome over the disc z = origin.z: `rings` rings of `sectors` quadrilaterals up to a pole, and a floor
/// fan. `radius(azimuth, elevation)` is the distance to the boundary. Causes: 0 to 2 are scene objects "north",
/// "way/17" and "tower east", in three sectors of azimuth; 3 is the range, above 60 degrees of elevation; 4 the target
/// plane.
inline Volume make_dome(const Vec3& origin, int sectors, int rings,
                        const std::function<double(double azimuth, double elevation)>& radius) {
  Volume volume;
  volume.frame.origin = origin;
  volume.frame.axis_u = Vec3::UnitX();
  volume.frame.axis_v = Vec3::UnitY();
  volume.frame.normal = Vec3::UnitZ();
  volume.tolerance_m = 0.01;
  volume.causes = {{CauseKind::scene, "north"},
                   {CauseKind::scene, "way/17"},
                   {CauseKind::scene, "tower east"},
                   {CauseKind::range, "max_range"},
                   {CauseKind::target_plane, "target plane"}};
  std::vector<Vec3>& vertices = volume.mesh.vertices;
  const auto index = [&](int ring, int sector) {
    return static_cast<std::uint32_t>(ring * sectors + (sector + sectors) % sectors);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      const double azimuth = 2 * std::numbers::pi * sector / sectors, elevation = std::numbers::pi / 2 * ring / rings;
      const Vec3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                           std::sin(elevation));
      Vec3 offset = radius(azimuth, elevation) * direction;
      if (ring == 0) offset.z() = 0;
      vertices.push_back(origin + offset);
    }
  }
  const auto pole = static_cast<std::uint32_t>(vertices.size()), centre = pole + 1;
  vertices.push_back(origin + Vec3(0, 0, radius(0, std::numbers::pi / 2)));
  vertices.push_back(origin);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t cause) {
    volume.mesh.triangles.push_back({a, b, c});
    volume.cause_of.push_back(cause);
  };
  for (int sector = 0; sector < sectors; ++sector) {
    for (int ring = 0; ring < rings; ++ring) {
      const std::uint32_t cause = ring * 3 >= rings * 2 ? 3u : static_cast<std::uint32_t>(sector * 3 / sectors);
      if (ring + 1 < rings) {
        add(index(ring, sector), index(ring, sector + 1), index(ring + 1, sector + 1), cause);
        add(index(ring, sector), index(ring + 1, sector + 1), index(ring + 1, sector), cause);
      } else {
        add(index(ring, sector), index(ring, sector + 1), pole, cause);
      }
    }
    add(index(0, sector + 1), index(0, sector), centre, 4);
  }
  return volume;
}

/// The dome of radius `radius`: a hemisphere.
inline Volume make_hemisphere(const Vec3& origin, double radius, int sectors = 24, int rings = 12) {
  return make_dome(origin, sectors, rings, [=](double, double) { return radius; });
}

/// An axis-aligned box of twelve outward triangles.
inline Mesh make_box_mesh(const Vec3& min, const Vec3& max) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(), i & 4 ? max.z() : min.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Appends `other` to `mesh`.
inline void append(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

/// Empty when every directed edge occurs once and its reverse once; else what is wrong first.
inline std::string first_open_edge(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) ++count[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, n] : count) {
    const auto reverse = count.find({edge.second, edge.first});
    if (n == 1 && reverse != count.end() && reverse->second == 1 && edge.first != edge.second) continue;
    return "edge " + std::to_string(edge.first) + " to " + std::to_string(edge.second) + " occurs " +
           std::to_string(n) + " times, its reverse " + std::to_string(reverse == count.end() ? 0 : reverse->second) +
           " times";
  }
  return {};
}

/// Whether an outward-oriented closed mesh holds a point: signed solid angles (Van Oosterom and Strackee 1983).
inline bool holds(const Mesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum > std::numbers::pi;
}

}  // namespace vantage::testing
