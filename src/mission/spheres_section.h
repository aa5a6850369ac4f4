// The section `spheres` of a mission file.
#pragma once

#include "mission/value_reader.h"
#include "mission/yaml_tree.h"
#include "vantage/spheres.h"

namespace vantage::mission_io {

/// Takes over what the section says. Throws Error(input) with the place in the file for an unknown key, a wrong type
/// and a value out of range.
void parse_spheres(const YamlNode& node, const ValueReader& reader, SpheresOptions& options);

}  // namespace vantage::mission_io
