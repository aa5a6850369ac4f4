// The mesh that a proof is about: closed, oriented, and outward.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

struct SolidMesh {
  Mesh mesh;
  std::vector<std::uint32_t> facet_of;  ///< per triangle: its number in the mesh that was given
};

/// With vertices in one place taken for one, and without triangles that have two corners there. Throws Error(input) for
/// what docs/proof.md needs and the mesh is not: without triangles, an index out of range, a coordinate that is not
/// finite, an edge that its triangles do not run as often one way as the other, a piece that is inside out and no
/// cavity of another one.
SolidMesh solid_mesh(const Mesh& volume);

}  // namespace vantage::internal::prove
