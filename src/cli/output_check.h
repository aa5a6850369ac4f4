// Finds out before a long computation whether its result can be written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::cli {

/// Throws Error(output or input) unless a file can be made at `file`: its folder exists and takes new files, `file` is
/// no folder and no device, and an existing file is not write-protected.
void check_can_write(const std::filesystem::path& file);

/// What chooses the format: the extension in lower case, ".ply".
std::string format_extension(const std::filesystem::path& file);

/// check_can_write, and the extension must be one that write_volume knows.
void check_volume_output(const std::filesystem::path& file);

/// Throws Error(input) if `output` is one of the `inputs`: writing it would destroy what it was made from.
void check_not_an_input(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

/// The files that a mission was read from, and those it names.
std::vector<std::filesystem::path> input_files(const Mission& mission);

}  // namespace vantage::cli
