// Files that users name: can they be read, and in which axes are they?
#pragma once

#include <filesystem>
#include <string>

namespace vantage::app {

/// Whether the name ends in .obj or .obj.gz, whatever the case of the letters.
bool is_obj(const std::filesystem::path& file);

/// The whole of a text file, up to one byte more than parse_yaml takes. `name` is how messages call it: "mission file".
/// Throws Error(input) when it cannot be read or is larger.
std::string read_text(const std::filesystem::path& file, const std::string& name);

/// Throws Error(input), with `where` and "file: ..." as the place, unless `file` exists, is no folder and no device,
/// and may be read. `what` begins the message: "the scene's mesh".
void check_readable(const std::filesystem::path& file, const std::string& what, const std::string& where);

}  // namespace vantage::app
