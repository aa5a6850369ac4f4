// Text files that users name.
#pragma once

#include <filesystem>
#include <string>

namespace vantage::internal::app {

/// The whole of a text file, up to one byte more than parse_yaml takes. `name` is how messages call it: "mission file".
/// Throws Error(input) when it cannot be read or is larger.
std::string read_text(const std::filesystem::path& file, const std::string& name);

}  // namespace vantage::internal::app
