#pragma once

#include <filesystem>
#include <string>

namespace vantage::live {

/// All of a file. Throws Error(input).
std::string bytes_of(const std::filesystem::path& file);

}  // namespace vantage::live
