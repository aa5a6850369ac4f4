// What several volumes have in common, or hold together.
#pragma once

#include <vector>

#include "vantage/progress.h"
#include "vantage/volume.h"

namespace vantage::internal::app {

/// What all volumes share.
Volume joined(std::vector<Volume> volumes, const Progress& progress, double work_limit);

/// What at least one volume holds.
Volume united(std::vector<Volume> volumes, const Progress& progress, double work_limit);

}  // namespace vantage::internal::app
