// Choosing among back ends, apart from which there are, so that tests can choose among others.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "depth/depth.h"

namespace vantage::depth {

struct BackEnds {
  RenderDevices found;  ///< the CPU first
  /// Makes the renderer of a device of that list. Throws DeviceFailure when it cannot hold the scene.
  std::function<std::unique_ptr<DepthRenderer>(const RenderDevice&)> make;
};

/// Which of the devices found `choice` means, and why it is not a graphics processor where one would hope for it.
struct ChosenDevice {
  RenderDevice device;
  std::string note;
};

/// Throws Error(input), with what is there, when it insists on a device that is not.
ChosenDevice choose_device(const RenderDevices& found, const DeviceChoice& choice);

/// What make_depth_renderer does, with given back ends.
ChosenRenderer make_depth_renderer(const BackEnds& back_ends, const DeviceChoice& choice);

}  // namespace vantage::depth
