// What `--device` means.
#include <charconv>

#include "vantage/devices.h"
#include "vantage/error.h"

namespace vantage {

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
  throw Error(ErrorCode::unknown_choice, "'" + text + "' is not a device", "--device",
              "write auto, cpu, opengl, gpu, or a number that 'vantage devices' lists");
}

}  // namespace vantage
