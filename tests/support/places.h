// Where the project and its program lie. The paths are compiled into one file alone, so that a build in another folder
// finds the rest in the compiler's cache.
#pragma once

#include <filesystem>

namespace vantage::testing {

std::filesystem::path source_folder();  ///< the project's root
std::filesystem::path program_file();   ///< the program `vantage` of this build

}  // namespace vantage::testing
