// What `vantage scene` made of a file, for people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/text_table.h"
#include "vantage/scene_source.h"

namespace vantage::cli {

struct WrittenScene {
  std::string file;
  double rounding_m = 0;  ///< what write_scene returns
};

/// For people: the place, counts by kind, and by reason what was not simply written.
std::string scene_table(const LoadedScene& loaded, const std::filesystem::path& file,
                        const std::vector<WrittenScene>& written);

/// What the scene's file says stands there and is not built as it stands; nothing of an empty ledger.
void add_ledger(TextTable& table, const Scene& scene);

/// What maps and rasters have to tell beside the scene itself; nothing of meshes.
void add_source(TextTable& table, const LoadedScene& loaded);

}  // namespace vantage::cli
