#include "solid/weld.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vantage::solid {

Mesh welded(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    const Vec3& p = mesh.vertices[v];
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  Mesh result;
  std::vector<std::uint32_t> new_index(mesh.vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || key(order[i]) != key(order[i - 1])) result.vertices.push_back(mesh.vertices[order[i]]);
    new_index[order[i]] = static_cast<std::uint32_t>(result.vertices.size() - 1);
  }
  for (const Triangle& t : mesh.triangles) {
    const Triangle n = {new_index[t[0]], new_index[t[1]], new_index[t[2]]};
    if (n[0] != n[1] && n[1] != n[2] && n[2] != n[0]) result.triangles.push_back(n);
  }
  return result;
}

}  // namespace vantage::solid
