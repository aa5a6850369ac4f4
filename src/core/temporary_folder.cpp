#include "vantage/temporary_folder.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

#include "core/file_locks.h"
#include "core/replace_folder.h"
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

/// Removes those that were left by processes that have ended: PREFIXxxxxxx and an ending.
void remove_abandoned(const fs::path& parent, std::string_view prefix, std::string_view ending) {
  std::error_code error;
  for (fs::directory_iterator entry(parent, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() != prefix.size() + kRandomCharacters + ending.size()) continue;
    if (!name.starts_with(prefix) || !name.ends_with(ending)) continue;
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

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(folder_for_temporary_files(), "vantage-tmp-") {}

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  remove_abandoned(parent, prefix, "");
  std::string pattern;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    pattern = (parent / (prefix + std::string(kRandomCharacters, 'X'))).string();
    if (::mkdtemp(pattern.data()) == nullptr) break;
    descriptor_ = ::open(pattern.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor_ >= 0 && lock_with_others(descriptor_) && leads_to(pattern, descriptor_)) {
      path_ = pattern;
      return;
    }
    const int reason = errno;
    if (descriptor_ < 0) ::rmdir(pattern.c_str());
    if (descriptor_ < 0 && reason != ENOENT) {  // as when too many files are open: another attempt ends alike
      errno = reason;
      break;
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
  if (!internal::core::replace_folder(path_, place)) return false;
  // What a killed process left beside is older than what is in place now.
  const std::string name = path_.filename().string();
  remove_abandoned(path_.has_parent_path() ? path_.parent_path() : fs::path("."),
                   name.substr(0, name.size() - kRandomCharacters), "-old");
  return true;  // where a folder is at path_ now, it was at `place`, and goes with this object
}

}  // namespace vantage
