// From the creases to the closed mesh: docs/theory.md, "Triangulation".
#pragma once

#include <optional>
#include <vector>

#include "exact/floor_tracer.h"
#include "exact/octahedral_grid.h"
#include "exact/quadrant_mesh.h"

namespace vantage::internal::exact {

/// The boundary in the target's frame: closed and outward oriented. Without a floor it is of genus 0 and star-shaped
/// about the origin.
struct Boundary {
  static constexpr std::uint32_t kRange = ~0u;
  static constexpr std::uint32_t kTargetPlane = ~0u - 1;
  static constexpr std::uint32_t kFloor = 1u << 31;  ///< added to the number of the floor's plane

  Mesh mesh;
  std::vector<std::uint32_t> blocker_of;  ///< per triangle: index of the blocker that causes it, or one of the above
  std::size_t constraint_edges = 0;
};

/// What lies beyond the envelope is left out, and before the floor.
struct Creases {
  const Skeleton& envelope;
  const FloorSkeleton* floor;  ///< null where there is none
};

/// Cells of the grid that hold nothing but range sphere are cut in two; the rest of the octahedral map is triangulated
/// quadrant by quadrant, the envelope and the floor each for itself. Every vertex is lifted to where the gauge says;
/// those of the rim are of both. nullopt where the floor and the envelope meet in a way that no snapping makes closed.
std::optional<Boundary> triangulate_boundary(const Creases& creases, const Envelope& envelope, OctahedralGrid& grid);

}  // namespace vantage::internal::exact
