#include "core/system_limits.h"

#include "core/windows/windows.h"
#include "vantage/error.h"

namespace vantage::internal::core {

void fail_for_threads() {
  throw Error(ErrorCode::system_limit, "the system gives no more threads", "", "end other programs");
}

void check_open_files() {}  // Windows sets no limit that others could use up

void* load_library(const std::vector<std::string>& names, const std::string&) {
  // Of the system's folder alone: no file that lies beside the data is run.
  for (const std::string& name : names) {
    if (HMODULE handle = ::LoadLibraryExA(name.c_str(), nullptr, LOAD_LIBRARY_SEARCH_SYSTEM32)) return handle;
  }
  return nullptr;
}

}  // namespace vantage::internal::core
