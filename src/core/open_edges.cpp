#include <span>

#include "core/edges.h"
#include "core/weld.h"
#include "vantage/volume.h"

namespace vantage {

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
