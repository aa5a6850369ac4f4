// The name of the device that pictures are drawn on.
#include "vantage/devices.h"

namespace example {

std::string device_name() {
  return vantage::choose_device(vantage::render_devices(), {.kind = vantage::DeviceChoice::Kind::automatic})
      .device.name;
}

}  // namespace example
