#include "common/temporary_folder.h"

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
#include "core/temporary_mark.h"
#include "vantage/error.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using internal::core::has_temporary_mark;
using internal::core::is_named_so;
using internal::core::is_temporary_name;
using internal::core::kAside;
using internal::core::kRandomCharacters;
using internal::core::leads_to;
using internal::core::lock_alone;
using internal::core::lock_with_others;
using internal::core::put_temporary_mark;
using internal::core::remove_temporary_folder;
using internal::core::remove_unmarked_folder;

constexpr int kAttempts = 10;

fs::path folder_for_temporary_files() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  return error ? fs::path("/tmp") : folder;
}

/// Removes those that were left by processes that have ended: PREFIXxxxxxx and an ending. A name shows nothing, since
/// others may give it too: the mark does. Without it only what is new and empty goes.
void remove_abandoned(const fs::path& parent, std::string_view prefix, std::string_view ending) {
  std::error_code error;
  for (fs::directory_iterator entry(parent, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    if (!is_named_so(entry->path().filename().string(), prefix, ending)) continue;
    const int descriptor = ::open(entry->path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && status.st_uid == ::geteuid() && lock_alone(descriptor) &&
        leads_to(entry->path(), descriptor)) {
      if (has_temporary_mark(descriptor)) {
        remove_temporary_folder(entry->path());
      } else if (ending.empty()) {
        remove_unmarked_folder(entry->path(), descriptor);
      }
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
    const bool is_held = descriptor_ >= 0 && lock_with_others(descriptor_) && leads_to(pattern, descriptor_);
    if (is_held && put_temporary_mark(descriptor_)) {  // before anything else is in it
      path_ = pattern;
      return;
    }
    const int reason = errno;
    if (is_held || descriptor_ < 0) ::rmdir(pattern.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
    const bool is_gone = descriptor_ >= 0 ? !is_held : reason == ENOENT;  // somebody removed it before it was held
    descriptor_ = -1;
    errno = reason;
    if (!is_gone) break;  // as when too many files are open: another attempt ends alike
  }
  throw Error(ErrorCode::output_unwritable, std::string("no temporary folder can be made: ") + std::strerror(errno),
              pattern, "make room there, or set TMPDIR to a folder that can be written");
}

TemporaryFolder::~TemporaryFolder() {
  if (!path_.empty()) remove_temporary_folder(path_);
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool TemporaryFolder::move_to(const fs::path& place) {
  const std::string own = path_.filename().string(), prefix = own.substr(0, own.size() - kRandomCharacters);
  if (is_temporary_name(place.filename().string(), prefix)) {
    errno = EINVAL;
    return false;
  }
  // Both are marked while they change places: what has a temporary name then is known for one whenever the process is
  // killed, and the name of `place` is none.
  if (!internal::core::replace_folder(path_, place)) return false;
  (void)internal::core::take_temporary_mark(descriptor_);
  // What a killed process left beside is older than what is in place now.
  remove_abandoned(path_.has_parent_path() ? path_.parent_path() : fs::path("."), prefix, kAside);
  return true;  // where a folder is at path_ now, it was at `place`, and goes with this object
}

}  // namespace vantage
