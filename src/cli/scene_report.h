// What `vantage scene` made of a file, as text and JSON.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/text_table.h"
#include "vantage/scene_source.h"

namespace vantage::cli {

/// For people: the place, counts by kind, and by reason what was not simply written.
std::string scene_table(const LoadedScene& loaded, const std::filesystem::path& file);

/// Everything: of a map also a record for each object that was read.
std::string scene_json(const LoadedScene& loaded);

/// What maps and rasters have to tell beside the scene itself; nothing of meshes.
void add_source(TextTable& table, const LoadedScene& loaded);
void add_source(nlohmann::ordered_json& json, const LoadedScene& loaded);

/// What is worth a sentence, whatever the source.
std::vector<std::string> notes_of(const LoadedScene& loaded);

}  // namespace vantage::cli
