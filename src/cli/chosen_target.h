// Which volume of a mission is meant that has one for each target.
#pragma once

#include <string>
#include <vector>

#include "vantage/mission.h"
#include "vantage/result.h"

namespace vantage::cli {

/// What --target is for, for its help.
inline constexpr const char* kTargetHelp = "Of a mission with 'combine: each': the name of the target that is meant";

/// The names of the targets of which each has a volume; one for any other mission.
std::vector<std::string> target_names(const Mission& mission);

/// The mission of the target of that name alone. Throws Error(input) for a name that it does not have, with the
/// nearest.
Mission of_target(const Mission& mission, const std::string& name);

/// The mission of the target that a volume was computed for, as its file says, where `name` is empty; else that of
/// `name`. A mission of one volume stays as it is. Throws Error(input) where nothing tells.
Mission of_volume(Mission mission, const std::string& name, const VolumeFile& volume);

}  // namespace vantage::cli
