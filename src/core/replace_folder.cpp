#include "core/replace_folder.h"

#include <fcntl.h>
#include <stdio.h>
#if __has_include(<sys/syscall.h>)  // Linux
#include <sys/syscall.h>
#endif
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/file_locks.h"
#include "core/temporary_mark.h"

namespace vantage::internal::core {
namespace {

namespace fs = std::filesystem;

/// Puts `folder` in the place of another one, and the other one in its place.
bool exchange_folders(const fs::path& folder, const fs::path& place) {
#ifdef SYS_renameat2
  // The system's call itself: the C library has a function for it, and the name of the flag, since glibc 2.28 only.
  constexpr unsigned kExchange = 2;  // RENAME_EXCHANGE of renameat2(2)
  return ::syscall(SYS_renameat2, AT_FDCWD, folder.c_str(), AT_FDCWD, place.c_str(), kExchange) == 0;
#else
  errno = ENOSYS;
  return false;
#endif
}

/// The old one steps aside, and comes back if the new one does not take its place.
bool replace_in_two_steps(const fs::path& folder, const fs::path& place) {
  const fs::path aside = folder.string() + "-old";
  if (::rename(place.c_str(), aside.c_str()) != 0) return false;
  if (::rename(folder.c_str(), place.c_str()) != 0) {
    const int reason = errno;
    ::rename(aside.c_str(), place.c_str());
    errno = reason;
    return false;
  }
  remove_temporary_folder(aside);
  return true;
}

bool replace(const fs::path& folder, const fs::path& place, bool try_in_one_step) {
  if (try_in_one_step && exchange_folders(folder, place)) return true;
  if (try_in_one_step && errno != EINVAL && errno != ENOSYS) return false;
  return replace_in_two_steps(folder, place);
}

}  // namespace

bool replace_folder(const fs::path& folder, const fs::path& place, bool try_in_one_step) {
  std::error_code error;
  if (!fs::exists(place, error)) return ::rename(folder.c_str(), place.c_str()) == 0;
  // The old one is marked first, so that it is found by that whenever the process is killed.
  const int old = ::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (old >= 0) {
    (void)lock_with_others(old);  // nobody takes it for one that was left
    if (!has_temporary_mark(old)) (void)put_temporary_mark(old);
  }
  const bool is_done = replace(folder, place, try_in_one_step);
  const int reason = errno;
  if (!is_done && old >= 0) (void)take_temporary_mark(old);
  if (old >= 0) ::close(old);
  errno = reason;
  return is_done;
}

}  // namespace vantage::internal::core
