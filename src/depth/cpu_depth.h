// Depth cube maps on the processor. Centres of texels: rays (Embree) for small faces, whose cost hardly grows with the
// scene, a rasteriser for large ones. Footprints of texels: a conservative rasteriser.
#pragma once

#include <memory>

#include "depth/depth.h"

namespace vantage::internal::depth {

/// What render_devices() says about the processor.
RenderDevice cpu_device();

/// Shares the scene. Uses the threads of the caller's arena; the images do not depend on their number. Surfaces nearer
/// than 1e-8 m to a viewpoint touch it and are not seen. Memory: 24 size^2 bytes for each viewpoint that is rendered
/// ahead, of which there are several only while they fit into 64 MB.
std::unique_ptr<DepthRenderer> make_cpu_depth_renderer(const PreparedScene& scene);

}  // namespace vantage::internal::depth
