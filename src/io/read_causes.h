// What the writers left in a volume's file besides the mesh.
#pragma once

#include <filesystem>

#include "io/volume_statement.h"
#include "vantage/export.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

/// Fills `cause_of` and `causes`, areas too, of a volume whose mesh was read from `file`; leaves them empty for a file
/// that no write_ply wrote, or that other programs have changed since. Returns what the file states. Throws
/// Error(input) for a file that cannot be read, causes that are out of range and a statement that is garbled.
std::optional<VolumeStatement> read_causes(const std::filesystem::path& file, Volume& volume);

}  // namespace vantage::internal::io
