// What missions need of the component `solid`: solid.cpp, or without_solid.cpp in builds without it.
#pragma once

#include <string>
#include <vector>

#include "vantage/navigation.h"

namespace vantage::internal::app {

/// The exact volume of a target of any number of parts, before limits besides the range.
Volume exact_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& progress);

/// What all volumes share.
Volume joined(std::vector<Volume> volumes, const Progress& progress, double work_limit);

/// What at least one volume holds.
Volume united(std::vector<Volume> volumes, const Progress& progress, double work_limit);

/// As cut_to_limits.
Volume within_limits(const Volume& volume, const PreparedTarget& target, const Navigation& navigation,
                     const Progress& progress, double work_limit);

}  // namespace vantage::internal::app
