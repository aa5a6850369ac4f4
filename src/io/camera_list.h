// Lists of cameras as texts.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "vantage/camera.h"

namespace vantage::internal::io {

/// What read_cameras() makes of a file with this content.
std::vector<ListedCamera> parse_cameras(std::string_view text, const std::filesystem::path& file);

}  // namespace vantage::internal::io
