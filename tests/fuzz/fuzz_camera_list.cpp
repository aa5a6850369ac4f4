// libFuzzer target: any bytes as a list of cameras. They may be refused with an input error; a camera without a problem
// must be one that can be completed, with a pinhole of finite numbers if it has all that takes.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "io/camera_list.h"
#include "vantage/error.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_listed(const vantage::ListedCamera& listed) {
  for (const std::string* text : {&listed.camera.name, &listed.camera.maker, &listed.camera.model, &listed.problem}) {
    for (const char c : *text) require(static_cast<unsigned char>(c) >= 0x20);
  }
  require(!listed.camera.source.empty());
  if (!listed.problem.empty()) {
    require(!vantage::pinhole_if_known(listed).has_value());
    return;
  }
  require(!listed.camera.name.empty());
  const vantage::Camera complete = vantage::completed(listed.camera);
  require(complete.sensor_width_mm >= listed.camera.sensor_width_mm);
  if (const auto pinhole = vantage::pinhole_if_known(listed)) {
    require(std::isfinite(pinhole->half_width) && pinhole->half_width > 0);
    require(std::isfinite(pinhole->half_height) && pinhole->half_height > 0);
    require(!pinhole->focal_px || (std::isfinite(*pinhole->focal_px) && *pinhole->focal_px > 0));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    for (const vantage::ListedCamera& listed : vantage::internal::io::parse_cameras(text, "/nowhere/cameras.json")) {
      check_listed(listed);
    }
  } catch (const vantage::Error& error) {
    require(error.code() == vantage::ErrorCode::camera_list_syntax);
    require(!error.problem().empty() && !error.where().empty() && !error.fix().empty());
    require(error.problem().find('\n') == std::string::npos);
  }
  return 0;
}
