#include "simplify/prepare.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

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

/// How often triangles wind round a point, but for those of one piece (van Oosterom and Strackee 1983).
double turns_round(const Mesh& mesh, const core::Pieces& pieces, std::uint32_t left_out, const Vec3& point) {
  double angle = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (pieces.piece_of[t] == left_out) continue;
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.vertices[i] - point, b = mesh.vertices[j] - point, c = mesh.vertices[k] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

/// A piece that is inside out takes away: where there is nothing to take away, something would be added for those who
/// count what a mesh winds round in either direction. Looks at some facets of each, so that it finds mistakes, and
/// proves nothing.
void check_cavities(const Mesh& mesh, const core::Pieces& pieces, const core::ProgressReporter& progress) {
  constexpr std::size_t kMostTried = 64;
  std::vector<std::vector<std::uint32_t>> own(pieces.pieces.size());  // of those that are inside out
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t piece = pieces.piece_of[t];
    if (pieces.pieces[piece].volume_m3 < 0) own[piece].push_back(t);
  }
  for (std::uint32_t piece = 0; piece < own.size(); ++piece) {
    for (std::size_t i = 0; i < own[piece].size(); i += 1 + own[piece].size() / kMostTried) {
      progress.check();
      const auto& [a, b, c] = mesh.triangles[own[piece][i]];
      const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
      if (turns_round(mesh, pieces, piece, middle) > 0.5) continue;
      throw Error(ErrorCode::mesh_inside_out,
                  "a piece of the mesh is inside out, at " + std::to_string(middle.x()) + ", " +
                      std::to_string(middle.y()) + ", " + std::to_string(middle.z()),
                  kWhere, "turn its triangles round");
    }
  }
}

}  // namespace

Prepared prepare(const Mesh& volume, const core::ProgressReporter& progress) {
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
  check_cavities(mesh, prepared.pieces, progress);
  return prepared;
}

}  // namespace vantage::internal::simplify
