// What others may read of where a scene comes from.
#pragma once

#include <filesystem>

#include "vantage/export.h"

namespace vantage {

/// Of the file of a scene: a web address without its user, its password and its query, which may be keys of a server.
/// Other files as they are.
VANTAGE_API std::filesystem::path shown_address(const std::filesystem::path& file);

}  // namespace vantage
