// The surface that is to be simplified: checked, with two facets to an edge.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pieces.h"
#include "core/progress_reporter.h"
#include "vantage/geometry.h"

namespace vantage::internal::simplify {

struct Prepared {
  Mesh mesh;                            ///< vertices in one place are one where their facets hang together
  std::vector<std::uint32_t> facet_of;  ///< per triangle: its number in the mesh that was given
  core::Pieces pieces;
};

/// Throws Error(input) and Error(cancelled) as simplify_volume does.
Prepared prepare(const Mesh& volume, const core::ProgressReporter& progress);

}  // namespace vantage::internal::simplify
