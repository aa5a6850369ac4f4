#include "vantage/temporary_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

#include "core/file_locks.h"
#include "vantage/error.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using internal::core::leads_to;
using internal::core::lock_alone;
using internal::core::lock_with_others;

constexpr std::size_t kRandomCharacters = 6;  // of mkdtemp
constexpr int kAttempts = 10;

fs::path folder_for_temporary_files() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return error ? fs::path("/tmp") : folder;
}

/// Removes those that were left by processes that have ended.
void remove_abandoned(const fs::path& parent, std::string_view prefix) {
  std::error_code error;
  for (fs::directory_iterator entry(parent, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() != prefix.size() + kRandomCharacters || !name.starts_with(prefix)) continue;
    const int descriptor = ::open(entry->path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && status.st_uid == ::geteuid() && lock_alone(descriptor) &&
        leads_to(entry->path(), descriptor)) {
      std::error_code ignored;
      fs::remove_all(entry->path(), ignored);
    }
    ::close(descriptor);
  }
}

/// Puts `folder` in the place of another one, and the other one in its place.
bool exchange(const fs::path& folder, const fs::path& place) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, folder.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0;
#else
  errno = ENOSYS;
  return false;
#endif
}

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(folder_for_temporary_files(), "vantage-tmp-") {}

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  remove_abandoned(parent, prefix);
  std::string pattern;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    pattern = (parent / (prefix + std::string(kRandomCharacters, 'X'))).string();
    if (::mkdtemp(pattern.data()) == nullptr) break;
    descriptor_ = ::open(pattern.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor_ >= 0 && lock_with_others(descriptor_) && leads_to(pattern, descriptor_)) {
      path_ = pattern;
      return;
    }
    if (descriptor_ >= 0) ::close(descriptor_);  // taken for an abandoned one before it was held
    descriptor_ = -1;
  }
  throw Error(ErrorCode::output_unwritable, std::string("no temporary folder can be made: ") + std::strerror(errno),
              pattern, "make room there, or set TMPDIR to a folder that can be written");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool TemporaryFolder::move_to(const fs::path& place) {
  std::error_code error;
  if (!fs::exists(place, error)) {
    if (::rename(path_.c_str(), place.c_str()) != 0) return false;
    path_.clear();
    return true;
  }
  if (exchange(path_, place)) return true;  // what was there goes with this object
  if (errno != EINVAL && errno != ENOSYS) return false;
  // The file system cannot do that: the old one steps aside, and comes back if this one does not take its place.
  const fs::path aside = path_.string() + "-old";
  if (::rename(place.c_str(), aside.c_str()) != 0) return false;
  if (::rename(path_.c_str(), place.c_str()) != 0) {
    const int reason = errno;
    ::rename(aside.c_str(), place.c_str());
    errno = reason;
    return false;
  }
  path_.clear();
  fs::remove_all(aside, error);
  return true;
}

}  // namespace vantage
