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

/// False in what is linked statically, without a loader (VANTAGE_LOAD_LIBRARIES=OFF). Errors then say kLoadsNone, and
/// kLoadsNoneFix instead of what to install.
VANTAGE_INTERNAL_API bool can_load_libraries();
inline constexpr const char* kLoadsNone = "this program is linked statically and can load no library";
inline constexpr const char* kLoadsNoneFix =
    "use the program for glibc (vantage-VERSION-linux-PROCESSOR.tar.xz without -static), or build vantage from source";

/// Loads the first of the libraries of these names that is there, for as long as the program runs. Null where none is,
/// or where libraries cannot be loaded.
/// Throws Error(out_of_memory) where there is not enough memory to load it, or Error(system_limit) where no more files
/// can be opened. `what`: for people, "GDAL".
VANTAGE_INTERNAL_API void* load_library(const std::vector<std::string>& names, const std::string& what);

}  // namespace vantage::internal::core
