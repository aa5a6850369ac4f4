// What terrain over a rectangle and rasters as scenes do alike with a network of triangles.
#pragma once

#include <functional>
#include <initializer_list>
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

/// Raised until none of the points lies above it, but for rounding: the corners of a triangle as far as the farthest
/// point above it. So it is nowhere raised farther than some point lay above it. Points beyond it do not count.
TriangulatedTerrain raised_over(TriangulatedTerrain surface,
                                std::initializer_list<std::reference_wrapper<const std::vector<Vec3>>> points,
                                const core::ProgressReporter& progress);

/// Vertical, over all of these points; infinite where there is no surface under one.
double largest_error(const TriangulatedTerrain& surface, const std::vector<Vec3>& points,
                     const core::ProgressReporter& progress);

}  // namespace vantage::internal::terrain
