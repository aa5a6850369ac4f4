#include "cli/open_edges.h"

#include <span>

#include "solid/edges.h"
#include "solid/weld.h"

namespace vantage::cli {

OpenEdges find_open_edges(const Mesh& mesh) {
  const Mesh joined = solid::welded(mesh);
  OpenEdges open;
  solid::for_each_edge(
      solid::edge_uses(joined.triangles, joined.vertices.size()), [&](std::span<const solid::EdgeUse> edge) {
        if (edge.size() % 2 == 0) return;
        if (open.count++ > 0) return;
        open.middle_of_first = 0.5 * (joined.vertices[edge.front().low] + joined.vertices[edge.front().high]);
      });
  return open;
}

}  // namespace vantage::cli
