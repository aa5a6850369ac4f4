// Text files that users name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/yaml_tree.h"

namespace vantage::internal::app {

/// The whole of a text file, up to one byte more than `most_bytes`, by default what parse_yaml takes. `name` is how
/// messages call it: "mission file". Throws Error(input) when it cannot be read or is larger.
std::string read_text(const std::filesystem::path& file, const std::string& name,
                      std::uintmax_t most_bytes = kMaxYamlBytes);

}  // namespace vantage::internal::app
