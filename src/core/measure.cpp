#include <span>
#include <vector>

#include "core/edges.h"
#include "core/weld.h"
#include "vantage/volume.h"

namespace vantage {

MeshMeasures measure(const Mesh& mesh) {
  const std::vector<internal::core::EdgeUse> uses = internal::core::edge_uses(mesh.triangles, mesh.vertices.size());

  MeshMeasures result;
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (used[vertex]) continue;
      used[vertex] = true;
      ++result.vertices;
      result.bounds.extend(mesh.vertices[vertex]);
    }
  }

  long edges = 0;
  result.closed = result.oriented = true;
  internal::core::DisjointSets pieces(mesh.triangles.size());
  internal::core::for_each_edge(uses, [&](std::span<const internal::core::EdgeUse> edge) {
    ++edges;
    const bool pair = edge.size() == 2 && edge[0].low != edge[0].high;
    result.closed = result.closed && pair;
    result.oriented = result.oriented && pair && edge[0].forward != edge[1].forward;
    for (const internal::core::EdgeUse& use : edge) pieces.join(edge[0].triangle, use.triangle);
  });

  result.facets = mesh.triangles.size();
  result.pieces = pieces.count();
  result.euler = static_cast<long>(result.vertices) - edges + static_cast<long>(result.facets);
  result.volume_m3 = enclosed_volume(mesh);
  result.area_m2 = surface_area(mesh);
  return result;
}

OpenEdges find_open_edges(const Mesh& mesh) {
  const Mesh joined = internal::core::welded(mesh);
  OpenEdges open;
  internal::core::for_each_edge(internal::core::edge_uses(joined.triangles, joined.vertices.size()),
                                [&](std::span<const internal::core::EdgeUse> edge) {
                                  if (edge.size() % 2 == 0) return;
                                  if (open.count++ > 0) return;
                                  open.middle_of_first =
                                      0.5 * (joined.vertices[edge.front().low] + joined.vertices[edge.front().high]);
                                });
  return open;
}

}  // namespace vantage
