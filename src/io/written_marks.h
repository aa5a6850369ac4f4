// What tells a file that vantage wrote from others.
#pragma once

#include <filesystem>
#include <string_view>

namespace vantage::internal::io {

/// The first line of a table of volumes.
inline constexpr std::string_view kVolumeTableHeader =
    "target,outcome,reason,volume_m3,area_m2,facets,pieces,lift_m,seconds,file";

/// Whether the file, which is there, is one that vantage wrote; false where it cannot be read.
bool is_own_file(const std::filesystem::path& file);

}  // namespace vantage::internal::io
