// What is checked and derived of the options of the spheres method before anything is rendered.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "vantage/export.h"
#include "vantage/spheres.h"

namespace vantage::internal::options {

/// Throws Error(input) for options out of range, and for a mesh that would need more memory than there is.
VANTAGE_INTERNAL_API void check_options(const SpheresOptions& options);

/// Face size of the cube map that a longitude and latitude grid is made from: texels at most half as wide as the
/// smaller of the grid's two steps.
inline int face_size_for(const std::array<int, 2>& grid) {
  const double step = std::min(2 * std::numbers::pi / grid[0], std::numbers::pi / grid[1]);
  // A texel is widest in the middle of its face: 2 / n.
  return 2 * static_cast<int>(std::ceil(2 / step));
}

/// Texels along a face's side.
inline int face_size(const SpheresOptions& options) {
  return options.resolution ? face_size_for(*options.resolution) : options.cubemap;
}

/// Facets of a whole sphere.
inline std::size_t facet_count(const SpheresOptions& options) {
  if (options.resolution) {
    return 2 * static_cast<std::size_t>((*options.resolution)[0]) * ((*options.resolution)[1] - 1);
  }
  return 12 * static_cast<std::size_t>(options.cubemap) * options.cubemap;
}

}  // namespace vantage::internal::options
