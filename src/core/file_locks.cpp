#include "core/file_locks.h"

#include <sys/stat.h>

#include <cerrno>
#ifndef __EMSCRIPTEN__
#include <sys/file.h>
#endif

namespace vantage::internal::core {

#ifdef __EMSCRIPTEN__  // a page has files of its own, and nobody beside it

bool lock_with_others(int) { return true; }
bool lock_alone(int) { return false; }

#else

bool lock_with_others(int descriptor) { return ::flock(descriptor, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK; }
bool lock_alone(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0; }

#endif

bool leads_to(const std::filesystem::path& path, int descriptor) {
  struct stat of_path {
  }, of_descriptor{};
  return ::lstat(path.c_str(), &of_path) == 0 && ::fstat(descriptor, &of_descriptor) == 0 &&
         of_path.st_dev == of_descriptor.st_dev && of_path.st_ino == of_descriptor.st_ino;
}

}  // namespace vantage::internal::core
