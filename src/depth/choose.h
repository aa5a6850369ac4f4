// Choosing among back ends, apart from which there are, so that tests can choose among others.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "depth/depth.h"

namespace vantage::internal::depth {

struct BackEnds {
  RenderDevices found;  ///< the CPU first
  /// Makes the renderer of a device of that list. Throws DeviceFailure when it cannot hold the scene.
  std::function<std::unique_ptr<DepthRenderer>(const RenderDevice&)> make;
};

/// What make_depth_renderer does, with given back ends.
ChosenRenderer make_depth_renderer(const BackEnds& back_ends, const DeviceChoice& choice);

}  // namespace vantage::internal::depth
