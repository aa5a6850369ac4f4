// The shaders of the depth cube maps.
#pragma once

#include "depth/gl_program.h"

namespace vantage::internal::depth {

/// What the depth image holds, for an inverse depth of 1/m: a power of two, so that dividing by it is exact. Also the
/// least depth, in metres, that an image holds: less is nothing that a scene is exact to.
inline constexpr double kDepthScale = 0x1p-27;

/// Sampling::centers: triangles, and the depth of their plane along each texel's centre.
ShaderSources centers_shaders();

/// Sampling::nearest: conservative rasterization. A quadrilateral that holds the triangle's image, and in each of its
/// texels the nearest point of what the triangle and the texel's pyramid share.
ShaderSources nearest_shaders();

}  // namespace vantage::internal::depth
