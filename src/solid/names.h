// How kinds of causes and outcomes are called in files.
#pragma once

#include "vantage/volume.h"

namespace vantage::solid {

/// "scene", "range", "target_plane", "navigation".
const char* name_of(CauseKind kind);

/// "computed", "out_of_range", "blocked_at_once", "outside_limits".
const char* name_of(Outcome outcome);

}  // namespace vantage::solid
