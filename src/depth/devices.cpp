// What can render on this machine.
#include "vantage/devices.h"

#include "depth/cpu_depth.h"
#include "depth/device_list.h"

namespace vantage {

internal::depth::DeviceList internal::depth::list_devices() {
  DeviceList list;
  list.found.devices.push_back(cpu_device());
  list.opengl = gl_devices(list.found.why_no_opengl);
  for (GlDeviceInfo& info : list.opengl) {
    info.device.index = static_cast<int>(list.found.devices.size());
    list.found.devices.push_back(info.device);
  }
  return list;
}

RenderDevices render_devices() { return internal::depth::list_devices().found; }

}  // namespace vantage
