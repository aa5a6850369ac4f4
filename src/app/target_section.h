// A target as a mission file gives it.
#pragma once

#include <string>
#include <vector>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "core/limit_check.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// `mission`: with its scene and its `crs`. Throws Error(input) with the place for what docs/mission-file.md does not
/// allow, and for what make_target_frame refuses.
MissionTarget parse_target_section(const YamlNode& node, const ValueReader& reader, const MissionFile& mission);

/// For a polygon that stands upright, of which an outline says nothing: it is one in plan.
inline constexpr const char* kUprightAdvice = "write its corners as 'vertices', or take 'part: facade' of an object";

/// What to do about an outline that is no polygon in plan. `z_m`: the heights of its corners, if it has any: then it
/// may stand upright.
std::string advice_for_outline(const core::LimitFault& fault, const std::vector<double>& z_m);

/// "south"; "200 degrees from north".
std::string heading_text(double heading_deg);

}  // namespace vantage::internal::app
