// What is checked and derived of the options of the spheres method before anything is rendered.
#pragma once

#include <array>
#include <cstddef>

#include "vantage/spheres.h"

namespace vantage::internal::options {

/// Throws Error(input) for options out of range, and for a mesh that would need more memory than there is.
void check_options(const SpheresOptions& options);

/// Face size of the cube map that a longitude and latitude grid is made from: texels at most half as wide as the
/// smaller of the grid's two steps.
int face_size_for(const std::array<int, 2>& grid);

/// Texels along a face's side.
int face_size(const SpheresOptions& options);

/// Facets of a whole sphere.
std::size_t facet_count(const SpheresOptions& options);

}  // namespace vantage::internal::options
