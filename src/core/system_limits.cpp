#include "core/system_limits.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "vantage/error.h"

namespace vantage::internal::core {

void fail_for_threads() {
  throw Error(ErrorCode::system_limit, "the system gives no more threads", "",
              "raise the limits of processes and of memory (ulimit -u, ulimit -v), or end other programs");
}

void check_open_files() {
  const int file = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int error = errno;
  if (file >= 0) ::close(file);
  if (file < 0 && (error == EMFILE || error == ENFILE)) {
    throw Error(ErrorCode::system_limit, "no more files can be opened", "",
                "raise the limit of open files (ulimit -n)");
  }
}

bool can_load_libraries() {
#ifdef VANTAGE_LOADS_NO_LIBRARIES  // set by cmake/Components.cmake
  return false;
#else
  return true;
#endif
}

void* load_library(const std::vector<std::string>& names, const std::string& what) {
  if (!can_load_libraries()) return nullptr;
  for (const std::string& name : names) {
    if (void* const handle = ::dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL)) return handle;
    const char* const reason = ::dlerror();
    const std::string said = reason ? reason : "";
    // In the words of the C library: the file cannot be mapped, or the loader has no memory for it.
    if (said.find("failed to map segment") != std::string::npos ||
        said.find("annot allocate memory") != std::string::npos || said.find("annot create") != std::string::npos) {
      throw Error(ErrorCode::out_of_memory,
                  std::string("there is not enough memory to load ").append(what).append(" (").append(said).append(")"),
                  "", "free some memory, or raise its limit (ulimit -v)");
    }
    check_open_files();
  }
  return nullptr;
}

}  // namespace vantage::internal::core
