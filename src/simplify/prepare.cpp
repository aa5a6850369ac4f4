#include "simplify/prepare.h"

#include <algorithm>
#include <span>
#include <string>

#include "core/edges.h"
#include "core/weld.h"
#include "vantage/error.h"

namespace vantage::internal::simplify {
namespace {

constexpr const char* kWhere = "volume";
constexpr const char* kAdvice = "give the closed, outward mesh of a volume";
constexpr double kFarthestM = 1e9;  // as for scenes

void check_numbers(const Mesh& mesh) {
  if (mesh.triangles.empty()) throw Error(ErrorCode::mesh_empty, "the mesh has no triangles", kWhere, kAdvice);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& vertex = mesh.vertices[v];
    if (!vertex.allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite,
                  "vertex " + std::to_string(v) + " has a coordinate that is not finite", kWhere, kAdvice);
    }
    if (vertex.cwiseAbs().maxCoeff() > kFarthestM) {
      throw Error(ErrorCode::coordinate_too_large,
                  "vertex " + std::to_string(v) + " is farther than 1e9 m from the origin", kWhere,
                  "move the mesh nearer to the origin");
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size()) continue;
      throw Error(ErrorCode::index_out_of_range,
                  "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                      std::to_string(mesh.vertices.size()),
                  kWhere, kAdvice);
    }
  }
}

void check_edges(const Mesh& mesh) {
  core::for_each_edge(core::edge_uses(mesh.triangles, mesh.vertices.size()), [&](std::span<const core::EdgeUse> uses) {
    const auto forward = std::count_if(uses.begin(), uses.end(), [](const core::EdgeUse& use) { return use.forward; });
    if (2 * forward == static_cast<std::ptrdiff_t>(uses.size())) return;
    const Vec3 middle = (mesh.vertices[uses[0].low] + mesh.vertices[uses[0].high]) / 2;
    const std::string at =
        " at " + std::to_string(middle.x()) + ", " + std::to_string(middle.y()) + ", " + std::to_string(middle.z());
    if (uses.size() % 2 != 0) {
      throw Error(ErrorCode::mesh_not_closed, "the mesh has a hole: an edge" + at + " has an odd number of triangles",
                  kWhere, kAdvice);
    }
    throw Error(ErrorCode::mesh_not_oriented, "the triangles at an edge" + at + " turn different ways", kWhere,
                kAdvice);
  });
}

}  // namespace

Prepared prepare(const Mesh& volume) {
  check_numbers(volume);
  Prepared prepared{{volume.vertices, {}}, {}, {}};
  Mesh& mesh = prepared.mesh;
  const std::vector<std::uint32_t> first = core::first_at_position(volume.vertices);
  for (std::uint32_t t = 0; t < volume.triangles.size(); ++t) {
    const auto& [a, b, c] = volume.triangles[t];
    const Triangle welded = {first[a], first[b], first[c]};
    if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;
    mesh.triangles.push_back(welded);
    prepared.facet_of.push_back(t);
  }
  if (mesh.triangles.empty()) throw Error(ErrorCode::mesh_empty, "the mesh has no area", kWhere, kAdvice);
  check_edges(mesh);
  core::split_where_pieces_touch(mesh);
  core::drop_unused_vertices(mesh);
  const double volume_m3 = enclosed_volume(mesh);
  if (volume_m3 < 0) {
    throw Error(ErrorCode::mesh_inside_out, "the mesh is inside out", kWhere, "turn its triangles round");
  }
  if (volume_m3 == 0) throw Error(ErrorCode::mesh_without_inside, "the mesh encloses nothing", kWhere, kAdvice);
  prepared.pieces = core::find_pieces(mesh);
  return prepared;
}

}  // namespace vantage::internal::simplify
