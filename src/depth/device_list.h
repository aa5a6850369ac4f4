// The devices of render_devices() with what opening them takes.
#pragma once

#include <vector>

#include "depth/gl_context.h"
#include "vantage/devices.h"

namespace vantage::internal::depth {

struct DeviceList {
  RenderDevices found;               ///< the CPU first, then those of `opengl` in their order
  std::vector<GlDeviceInfo> opengl;  ///< numbered as in `found`
};

DeviceList list_devices();

}  // namespace vantage::internal::depth
