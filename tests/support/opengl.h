// Whether this machine can draw with OpenGL, for tests that need it.
#pragma once

#include <algorithm>
#include <string>

#include "vantage/devices.h"

namespace vantage::testing {

/// Why there is no OpenGL; empty where there is.
inline std::string why_no_opengl() {
  const RenderDevices found = render_devices();
  const bool has_opengl = std::any_of(found.devices.begin(), found.devices.end(),
                                      [](const RenderDevice& device) { return device.kind != DeviceKind::cpu; });
  return has_opengl ? "" : "needs OpenGL: " + found.why_no_opengl;
}

}  // namespace vantage::testing

#define VANTAGE_REQUIRE_OPENGL() \
  if (const std::string why = ::vantage::testing::why_no_opengl(); !why.empty()) GTEST_SKIP() << why
