#include "prove/solid_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "prove/winding.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::prove {
namespace {

constexpr const char* kAdvice = "give the closed, outward mesh of a volume";

void check_numbers(const Mesh& mesh, const std::string& where) {
  if (mesh.triangles.empty()) throw Error(ErrorCode::mesh_empty, "the mesh has no triangles", where, kAdvice);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite,
                  "vertex " + std::to_string(v) + " has a coordinate that is not finite", where, kAdvice);
    }
    if (mesh.vertices[v].cwiseAbs().maxCoeff() > kFarthestM) {
      throw Error(ErrorCode::coordinate_too_large,
                  "vertex " + std::to_string(v) + " is farther than 1e9 m from the origin", where,
                  "move the mesh nearer to the origin");
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size()) continue;
      throw Error(ErrorCode::index_out_of_range,
                  "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                      std::to_string(mesh.vertices.size()),
                  where, kAdvice);
    }
  }
}

/// For each vertex the first one in its place.
std::vector<std::uint32_t> first_in_place(const std::vector<Vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::tuple(vertices[v].x(), vertices[v].y(), vertices[v].z()); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = is_same ? first[order[i - 1]] : order[i];
  }
  return first;
}

void check_edges(const Mesh& mesh, const std::string& where) {
  struct Run {
    std::uint32_t low, high;
    int way;
  };
  std::vector<Run> runs;
  runs.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      runs.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  }
  std::sort(runs.begin(), runs.end(),
            [](const Run& a, const Run& b) { return std::tuple(a.low, a.high) < std::tuple(b.low, b.high); });
  for (std::size_t i = 0; i < runs.size();) {
    std::size_t end = i;
    int sum = 0;
    for (; end < runs.size() && runs[end].low == runs[i].low && runs[end].high == runs[i].high; ++end) {
      sum += runs[end].way;
    }
    if (sum != 0) {
      const Vec3 middle = (mesh.vertices[runs[i].low] + mesh.vertices[runs[i].high]) / 2;
      const std::string at =
          " at " + std::to_string(middle.x()) + ", " + std::to_string(middle.y()) + ", " + std::to_string(middle.z());
      if ((end - i) % 2 != 0) {
        throw Error(ErrorCode::mesh_not_closed, "the mesh has a hole: an edge" + at + " has an odd number of triangles",
                    where, kAdvice);
      }
      throw Error(ErrorCode::mesh_not_oriented, "the triangles at an edge" + at + " turn different ways", where,
                  kAdvice);
    }
    i = end;
  }
}

/// For each triangle the number of the piece that it is a part of; pieces share vertices with no other.
std::vector<std::uint32_t> piece_of(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[find(b)] = find(a);
    parent[find(c)] = find(a);
  }
  std::vector<std::uint32_t> pieces;
  for (const Triangle& t : mesh.triangles) pieces.push_back(find(t[0]));
  return pieces;
}

/// A piece that is inside out must lie in another one.
void check_pieces(const Mesh& mesh, const std::string& where) {
  const std::vector<std::uint32_t> pieces = piece_of(mesh);
  std::vector<double> volume(mesh.vertices.size(), 0.0);
  Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3& origin = mesh.vertices[pieces[t]];  // of its own: a small piece may lie far from the others
    volume[pieces[t]] +=
        (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin)) / 6;
  }
  for (std::uint32_t piece = 0; piece < volume.size(); ++piece) {
    if (volume[piece] >= 0) continue;
    Winding winding(mesh.vertices[piece], box);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      if (pieces[t] != piece) winding.add({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    }
    if (winding.turns(0).value_or(1) > 0) continue;  // also where it touches another one
    const Vec3& at = mesh.vertices[piece];
    throw Error(ErrorCode::mesh_inside_out,
                "a piece of the mesh is inside out, at " + std::to_string(at.x()) + ", " + std::to_string(at.y()) +
                    ", " + std::to_string(at.z()),
                where, "turn its triangles round");
  }
}

}  // namespace

SolidMesh solid_mesh(const Mesh& mesh, const std::string& where) {
  check_numbers(mesh, where);
  SolidMesh solid{{mesh.vertices, {}}, {}};
  const std::vector<std::uint32_t> first = first_in_place(mesh.vertices);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Triangle welded = {first[a], first[b], first[c]};
    if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;
    solid.mesh.triangles.push_back(welded);
    solid.facet_of.push_back(t);
  }
  if (solid.mesh.triangles.empty()) throw Error(ErrorCode::mesh_empty, "the mesh has no area", where, kAdvice);
  check_edges(solid.mesh, where);
  check_pieces(solid.mesh, where);
  return solid;
}

}  // namespace vantage::internal::prove
