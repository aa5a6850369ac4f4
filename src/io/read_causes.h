// The causes that write_ply left in a file.
#pragma once

#include <filesystem>

#include "vantage/volume.h"

namespace vantage::io {

/// Fills `cause_of` and `causes`, areas too, of a volume whose mesh was read from `file`. Leaves them empty for a file
/// that no write_ply wrote, or that other programs have changed since. Throws Error(input) for a file that cannot be
/// read, or whose causes are out of range.
void read_causes(const std::filesystem::path& file, Volume& volume);

}  // namespace vantage::io
