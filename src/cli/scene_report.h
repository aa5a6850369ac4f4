// What `vantage scene` made of a file, as text and JSON.
#pragma once

#include <filesystem>
#include <string>

#include "vantage/scene_source.h"

namespace vantage::cli {

/// For people: the place, counts by kind, and by reason what was not simply written.
std::string scene_table(const LoadedScene& loaded, const std::filesystem::path& file);

/// Everything: of a map also a record for each object that was read.
std::string scene_json(const LoadedScene& loaded);

}  // namespace vantage::cli
