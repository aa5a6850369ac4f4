// What terrain over a rectangle and rasters as scenes do alike with a network of triangles.
#pragma once

#include <vector>

#include "core/progress_reporter.h"
#include "maps/terrain/tin.h"
#include "maps/terrain/triangulate.h"
#include "vantage/geometry.h"

namespace vantage::internal::terrain {

/// Inserts its candidates, worst first, down to the error. Throws Error(cancelled).
void grow(Tin& tin, double max_error_m, const core::ProgressReporter& progress);

/// The facets that are wanted, with the vertices that they use.
Mesh mesh_of(const Tin& tin, const std::vector<bool>& wanted);

/// Vertical, over all of these points; infinite where there is no surface under one.
double largest_error(const TriangulatedTerrain& surface, const std::vector<Vec3>& points);

}  // namespace vantage::internal::terrain
