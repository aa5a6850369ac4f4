// What `vantage scene` made of a file, for people.
#pragma once

#include <filesystem>
#include <string>

#include "cli/text_table.h"
#include "vantage/scene_source.h"

namespace vantage::cli {

/// For people: the place, counts by kind, and by reason what was not simply written.
std::string scene_table(const LoadedScene& loaded, const std::filesystem::path& file);

/// What maps and rasters have to tell beside the scene itself; nothing of meshes.
void add_source(TextTable& table, const LoadedScene& loaded);

}  // namespace vantage::cli
