// How kinds of causes, outcomes and devices are called in files.
#pragma once

#include "vantage/devices.h"
#include "vantage/volume.h"

namespace vantage::core {

/// "scene", "range", "target_plane", "navigation".
const char* name_of(CauseKind kind);

/// "computed", "out_of_range", "blocked_at_once", "outside_limits", "no_common_view".
const char* name_of(Outcome outcome);

/// "cpu", "opengl_software", "opengl_hardware".
const char* name_of(DeviceKind kind);

}  // namespace vantage::core
