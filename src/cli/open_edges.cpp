#include "cli/open_edges.h"

#include <functional>
#include <span>
#include <unordered_map>

#include "solid/edges.h"

namespace vantage::cli {
namespace {

struct PositionHash {
  std::size_t operator()(const Vec3& point) const {
    std::size_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // 0.0 == -0.0, so both must hash alike: adding 0.0 turns the latter into the former.
      hash = hash * 0x9E3779B97F4A7C15ULL + std::hash<double>()(point[axis] + 0.0);
    }
    return hash;
  }
};

/// The triangles that are left, by position.
std::vector<Triangle> welded(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  std::unordered_map<Vec3, std::uint32_t, PositionHash> index_of;
  index_of.reserve(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& position = mesh.vertices[triangle[k]];
      corners[k] = index_of.emplace(position, static_cast<std::uint32_t>(index_of.size())).first->second;
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    triangles.push_back(corners);
  }
  return triangles;
}

}  // namespace

std::size_t count_open_edges(const Mesh& mesh) {
  std::size_t open = 0;
  solid::for_each_edge(solid::edge_uses(welded(mesh), mesh.vertices.size()),
                       [&](std::span<const solid::EdgeUse> edge) { open += edge.size() % 2; });
  return open;
}

}  // namespace vantage::cli
