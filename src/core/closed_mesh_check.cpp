#include "core/closed_mesh_check.h"

#include <span>
#include <string>
#include <vector>

#include "core/edges.h"
#include "core/weld.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::core {

void check_closed(const Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        throw Error(ErrorCode::index_out_of_range,
                    "triangle " + std::to_string(t) + " names a vertex that is not there", "mesh",
                    "pass indices below the number of vertices");
      }
      if (mesh.vertices[v].allFinite()) continue;
      throw Error(ErrorCode::coordinate_not_finite,
                  "vertex " + std::to_string(v) + " has a coordinate that is not finite", "mesh",
                  "pass finite coordinates");
    }
  }
  if (const OpenEdges open = find_open_edges(mesh); open.count > 0) {
    throw Error(ErrorCode::mesh_not_closed, std::to_string(open.count) + " edges of the mesh are open", "mesh",
                "close the mesh");
  }
}

void check_oriented(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_position(mesh.vertices);
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = first[v];
  }
  for_each_edge(edge_uses(triangles, mesh.vertices.size()), [&](std::span<const EdgeUse> uses) {
    if (uses[0].low == uses[0].high) return;
    long forward = 0;
    for (const EdgeUse& use : uses) forward += use.forward ? 1 : -1;
    if (forward == 0) return;
    throw Error(ErrorCode::mesh_not_oriented,
                "triangle " + std::to_string(uses[0].triangle) + " of the mesh turns another way than its neighbour",
                "mesh", "turn all triangles so that their corners run counter-clockwise seen from outside");
  });
}

}  // namespace vantage::internal::core
