// Whether a mesh is closed, before it is asked about its inside.
#pragma once

#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// Throws Error(input) for an index out of range, a coordinate that is not finite, or an edge with an odd number of
/// triangles; vertices in one place count as one.
VANTAGE_INTERNAL_API void check_closed(const Mesh& mesh);

/// Throws Error(input) where an edge's triangles do not run it as often in one direction as in the other. The mesh must
/// have passed check_closed.
VANTAGE_INTERNAL_API void check_oriented(const Mesh& mesh);

}  // namespace vantage::internal::core
