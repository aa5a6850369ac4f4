// Files that the library reads besides those it is given.
#pragma once

#include <filesystem>

#include "vantage/export.h"

namespace vantage {

/// Says where a package of vantage keeps what is otherwise taken from the system:
///   proj/proj.db                    PROJ's database of coordinate reference systems
///   fonts/DejaVuSans.ttf, fonts/DejaVuSans-Bold.ttf   the fonts of pictures
/// What the folder lacks is looked for on the system as before. With a proj/proj.db in it, grids of PROJ are read from
/// that folder, then from the folders that PROJ_DATA (or PROJ_LIB) names, then from /usr/local/share/proj and
/// /usr/share/proj. Holds for all threads of the process, for what is read after the call. An empty path takes it back.
VANTAGE_API void set_resource_folder(const std::filesystem::path& folder);

/// The folder that was set; empty at first.
VANTAGE_API std::filesystem::path resource_folder();

}  // namespace vantage
