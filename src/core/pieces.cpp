#include "core/pieces.h"

#include <Eigen/Geometry>
#include <limits>

#include "core/edges.h"
#include "core/exact_crossing.h"

namespace vantage::internal::core {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Pieces find_pieces(const Mesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  Pieces result;
  result.piece_of.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);  // by the set's root
  std::vector<Vec3> apex;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& piece = number[sets.find(t[0])];
    if (piece == kUnused) {
      piece = static_cast<std::uint32_t>(result.pieces.size());
      result.pieces.emplace_back();
      apex.push_back(mesh.vertices[t[0]]);
    }
    result.piece_of.push_back(piece);
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    Piece& grown = result.pieces[piece];
    ++grown.facets;
    grown.volume_m3 += (a - apex[piece]).dot((b - apex[piece]).cross(c - apex[piece])) / 6;
    grown.area_m2 += (b - a).cross(c - a).norm() / 2;
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::uint32_t piece = number[sets.find(v)];
    if (piece != kUnused) ++result.pieces[piece].vertices;
  }
  for (Piece& piece : result.pieces) {
    piece.euler = static_cast<long>(piece.vertices) - static_cast<long>(piece.facets / 2);  // E is 3 F / 2
  }
  return result;
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kUnused);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) new_index[v] = 0;
  }
  std::uint32_t used = 0;
  for (std::size_t v = 0; v < new_index.size(); ++v) {
    if (new_index[v] == kUnused) continue;
    mesh.vertices[used] = mesh.vertices[v];
    new_index[v] = used++;
  }
  mesh.vertices.resize(used);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = new_index[v];
  }
}

namespace {

/// Whether a point of one piece lies inside of the others, or on one; of the numbers as they are.
bool is_in_others(const Mesh& mesh, const Pieces& found, std::uint32_t own, const Vec3& point) {
  int winding = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (found.piece_of[t] == own) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const TriangleCorners corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    if (is_on_triangle(point, corners)) return true;
    winding += crossing_above(point, corners);
  }
  return winding > 0;
}

/// Per piece: whether it is inside out and lies in no other one, as far as the middles of its facets tell. Of a cavity
/// the first one does, as a rule, so that few are asked.
std::vector<char> find_inverted(const Mesh& mesh, const Pieces& found) {
  std::vector<char> inverted;
  for (const Piece& piece : found.pieces) inverted.push_back(piece.volume_m3 < 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t piece = found.piece_of[t];
    if (!inverted[piece]) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
    if (is_in_others(mesh, found, piece, middle)) inverted[piece] = 0;
  }
  return inverted;
}

}  // namespace

void drop_slivers(LabelledMesh& labelled, double thickness_m) {
  auto& [mesh, labels] = labelled;
  const Pieces found = find_pieces(mesh);
  const std::vector<char> inverted = find_inverted(mesh, found);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t number = found.piece_of[t];
    const Piece& piece = found.pieces[number];
    const bool is_thin = piece.volume_m3 >= 0 && piece.volume_m3 <= thickness_m * piece.area_m2;
    if (is_thin || inverted[number]) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    labels[kept++] = labels[t];
  }
  mesh.triangles.resize(kept);
  labels.resize(kept);
  drop_unused_vertices(mesh);
}

}  // namespace vantage::internal::core
