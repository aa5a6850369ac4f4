// The section `spheres` of a mission file.
#pragma once

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "vantage/spheres.h"

namespace vantage::internal::app {

/// Takes over what the section says. Throws Error(input) with the place in the file for an unknown key, a wrong type
/// and a value out of range.
void parse_spheres(const YamlNode& node, const ValueReader& reader, SpheresOptions& options);

}  // namespace vantage::internal::app
