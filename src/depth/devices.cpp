// What can render on this machine, and what `--device` means.
#include "vantage/devices.h"

#include <charconv>

#include "depth/cpu_depth.h"
#include "depth/device_list.h"
#include "vantage/error.h"

namespace vantage {

depth::DeviceList depth::list_devices() {
  DeviceList list;
  list.found.devices.push_back(cpu_device());
  list.opengl = gl_devices(list.found.why_no_opengl);
  for (GlDeviceInfo& info : list.opengl) {
    info.device.index = static_cast<int>(list.found.devices.size());
    list.found.devices.push_back(info.device);
  }
  return list;
}

RenderDevices render_devices() { return depth::list_devices().found; }

DeviceChoice parse_device_choice(const std::string& text) {
  using Kind = DeviceChoice::Kind;
  if (text == "auto") return {Kind::automatic, 0};
  if (text == "cpu") return {Kind::cpu, 0};
  if (text == "opengl") return {Kind::opengl, 0};
  if (text == "gpu") return {Kind::gpu, 0};
  int index = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, index);
  if (parsed.ec == std::errc() && parsed.ptr == end && index >= 0) return {Kind::index, index};
  throw Error(ErrorCode::unknown_choice, "'" + text + "' is no device", "--device",
              "write auto, cpu, opengl, gpu, or a number that 'vantage devices' lists");
}

}  // namespace vantage
