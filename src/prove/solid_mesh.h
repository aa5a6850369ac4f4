// The mesh that a proof is about: closed, oriented, and outward.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::prove {

/// Coordinates are no larger: beyond that the exact predicates overflow, and would take a triangle for one without
/// area.
constexpr double kFarthestM = 1e9;

struct SolidMesh {
  Mesh mesh;
  std::vector<std::uint32_t> facet_of;  ///< per triangle: its number in the mesh that was given
};

/// With vertices in one place taken for one, and without triangles that have two corners there. Throws Error(input) for
/// what docs/proof.md needs and the mesh is not: without triangles, an index out of range, a coordinate that is not
/// finite, an edge that its triangles do not run as often one way as the other, a piece that is inside out and no
/// cavity of another one. `where`: what errors call it.
SolidMesh solid_mesh(const Mesh& mesh, const std::string& where = "volume");

}  // namespace vantage::internal::prove
