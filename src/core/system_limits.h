// What the system refuses: it is neither the fault of a file nor a defect.
#pragma once

#include <string>
#include <vector>

#include "vantage/export.h"

namespace vantage::internal::core {

/// Throws Error(system_limit): the system gives no more threads.
[[noreturn]] VANTAGE_INTERNAL_API void fail_for_threads();

/// Throws Error(system_limit) if no more files can be opened: what is there would be taken for missing.
void check_open_files();

/// Loads the first of the libraries of these names that is there, for as long as the program runs. Null where none is.
/// Throws Error(out_of_memory) where there is not enough memory to load it, or Error(system_limit) where no more files
/// can be opened. `what`: for people, "GDAL".
VANTAGE_INTERNAL_API void* load_library(const std::vector<std::string>& names, const std::string& what);

}  // namespace vantage::internal::core
