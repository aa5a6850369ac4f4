#include "core/system_files.h"

#include <fcntl.h>
#include <io.h>

#include <system_error>

#include "core/windows/windows.h"

namespace vantage::internal::core {

namespace fs = std::filesystem;

/// Of lists of access nothing is asked: opening the file tells.
int access_error(const fs::path& path, Access wanted) {
  constexpr int kExists = 0, kWrite = 2, kRead = 4;
  const int mode = wanted == Access::read ? kRead : wanted == Access::write ? kWrite : kExists;
  return ::_waccess(path.c_str(), mode) == 0 ? 0 : errno;
}

int open_to_read(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) {
    errno = EISDIR;
    return -1;
  }
  return ::_wopen(file.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
}

int synchronise(int descriptor) { return ::_commit(descriptor) == 0 ? 0 : errno; }

void synchronise_folder(const fs::path&) {}  // Windows has no such call

void copy_permissions(const fs::path&, int) {}  // a file has those of its folder

void with_signals_held(const std::function<void()>& step) { step(); }

double memory_bytes() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  return ::GlobalMemoryStatusEx(&status) ? static_cast<double>(status.ullTotalPhys) : 0;
}

}  // namespace vantage::internal::core
