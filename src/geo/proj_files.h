// Which files PROJ may read.
#pragma once

#include <proj.h>

#include <filesystem>
#include <vector>

namespace vantage::internal::geo {

/// The folders that PROJ's data may be in: that of its database, and where users put grids.
std::vector<std::filesystem::path> data_folders(PJ_CONTEXT* context);

/// Those that the user's environment names.
std::vector<std::filesystem::path> folders_of_user();

/// Files that lie in these folders, and nothing else: a text of a coordinate reference system may name grids, and texts
/// come from mission files. Not a pipe either, that nobody writes to. Nothing is written. The folders must outlive the
/// context.
void allow_files_in(PJ_CONTEXT* context, const std::vector<std::filesystem::path>& folders);

}  // namespace vantage::internal::geo
