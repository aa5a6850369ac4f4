// A mesh that has no causes, as a volume to write or to cut.
#pragma once

#include <string>

#include "vantage/volume.h"

namespace vantage::cli {

/// The mesh with a single cause of that name.
Volume plain_volume(Mesh mesh, const std::string& cause);

}  // namespace vantage::cli
