// Depth cube maps by OpenGL 4.5.
#pragma once

#include <cstddef>
#include <memory>

#include "depth/depth.h"
#include "depth/gl_context.h"

namespace vantage::internal::depth {

/// What the renderer may take of the device's memory.
///   scene:  24 bytes for each vertex and 12 for each triangle, and 20 for each cluster of triangles and face
///   images: 12 bytes for each texel of the faces that are rendered at once (the image, and two copies on their way)
/// As many faces at once (6, 3, 2 or 1) as `image_bytes` allows. Main memory holds 24 bytes more for each texel of a
/// side squared: the depths that the sink gets.
struct GlDepthLimits {
  std::size_t image_bytes = static_cast<std::size_t>(1) << 30;
  std::size_t device_bytes = 0;  ///< scene and images together; 0: nine tenths of what the device says it has
};

/// Uploads the scene. Throws DeviceFailure, with numbers, when it does not fit. A face size whose single face is beyond
/// the limits throws DeviceFailure when it is asked for.
std::unique_ptr<DepthRenderer> make_gl_depth_renderer(const PreparedScene& scene, const GlDeviceInfo& device);
std::unique_ptr<DepthRenderer> make_gl_depth_renderer(const PreparedScene& scene, const GlDeviceInfo& device,
                                                      const GlDepthLimits& limits,
                                                      std::shared_ptr<const GlLibrary> library = nullptr);

}  // namespace vantage::internal::depth
