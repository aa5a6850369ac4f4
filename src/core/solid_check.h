// Whether a mesh from outside bounds a solid, and if not, what is wrong with it and where. Manifold itself checks only
// that edges pair up.
#pragma once

#include <string>

#include "core/progress_reporter.h"
#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::core {

/// `mesh` with vertices at equal positions welded and triangles without extent in their indices dropped: ready for
/// Solid. Touching parts and cavities are fine. Throws Error(input), `name` in `where`, for a mesh that
///   - is empty, has a coordinate that is not finite or an index out of range,
///   - is open (how many edges, the first one's ends), or whose triangles turn different ways,
///   - passes through itself (the first place, and which triangles), deeper than 1e-6 of its diagonal,
///   - is inside out or has parts that overlap, so that some space counts other than once or not at all.
/// Triangles that pass through others are let be where they make up no more than `folds` of the mesh's area.
/// Error(cancelled) when told to stop. Cost: O(n log n) for meshes as they are drawn.
VANTAGE_INTERNAL_API Mesh checked_solid(const Mesh& mesh, const std::string& name,
                                        const ProgressReporter& progress = {}, double folds = 0);

}  // namespace vantage::internal::core
