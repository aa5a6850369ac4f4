#include "cli/open_edges.h"

#include <span>

#include "solid/edges.h"
#include "solid/weld.h"

namespace vantage::cli {

std::size_t count_open_edges(const Mesh& mesh) {
  const Mesh joined = solid::welded(mesh);
  std::size_t open = 0;
  solid::for_each_edge(solid::edge_uses(joined.triangles, joined.vertices.size()),
                       [&](std::span<const solid::EdgeUse> edge) { open += edge.size() % 2; });
  return open;
}

}  // namespace vantage::cli
