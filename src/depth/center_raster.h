// Rasterisation of convex polygons at the centres of texels, in double precision. A row of texel centres cuts a convex
// polygon in a segment, along which the inverse depth is linear.
#pragma once

#include <span>

#include "depth/face_view.h"

namespace vantage::internal::depth {

/// Raises every texel of the band whose centre the polygon covers to at least its inverse depth there. `corners` are
/// what FaceClip made of it: (right, up, forward); `inverse_depths` holds the rows of the band.
void draw_at_centers(const FaceBand& band, std::span<const Vec3> corners, std::span<float> inverse_depths);

}  // namespace vantage::internal::depth
