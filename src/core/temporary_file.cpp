#include "core/temporary_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "core/file_locks.h"

namespace vantage::internal::core {
namespace {

namespace fs = std::filesystem;

// As many processes may write the same file at once. The first few numbers are looked at whenever a file is made.
constexpr int kMostNumbers = 256, kUsualNumbers = 4;

[[noreturn]] void fail(int error_number) { throw std::system_error(error_number, std::generic_category()); }

std::string name_in_proc(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

/// The lowest number that `make` gets a file for: it returns 0, or the number of an error, EEXIST where that is taken.
/// Those that were abandoned make room.
template <typename Path, typename Make>
int first_free(const Path& path, const Make& make) {
  for (int number = 0; number < kMostNumbers; ++number) {
    const fs::path candidate = path(number);
    int error = make(candidate);
    if (error == EEXIST) {
      remove_if_abandoned(candidate);
      error = make(candidate);
    }
    if (error != EEXIST) return error;
  }
  return EEXIST;
}

}  // namespace

void remove_if_abandoned(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && lock_alone(descriptor) &&
      leads_to(path, descriptor)) {
    ::unlink(path.c_str());
  }
  ::close(descriptor);
}

TemporaryFile::TemporaryFile(const fs::path& target, Names names) : target_(target) {
  for (int number = 0; number < kUsualNumbers; ++number) {
    for (const char* ending : {".tmp", ".old"}) remove_if_abandoned(numbered(number, ending));
  }
  if (names == Names::from_the_start || !open_without_name()) open_with_name();
}

TemporaryFile::~TemporaryFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
  if (!kept_.empty()) ::unlink(kept_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);  // and with it the lock
  if (old_descriptor_ >= 0) ::close(old_descriptor_);
}

fs::path TemporaryFile::numbered(int number, const char* ending) const {
  std::string name(".");
  name.append(target_.filename().string(), 0, 200).append(".vantage-").append(std::to_string(number)).append(ending);
  return target_.parent_path() / name;
}

/// False where the file system, or a system without /proc, cannot do it: the other way says what is wrong, if anything.
bool TemporaryFile::open_without_name() {
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
#ifdef __EMSCRIPTEN__
  return false;
#endif
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return false;
  if (::access(name_in_proc(descriptor_).c_str(), F_OK) == 0 && lock_with_others(descriptor_)) return true;
  ::close(descriptor_);
  descriptor_ = -1;
  return false;
}

void TemporaryFile::open_with_name() {
  const auto make = [this](const fs::path& candidate) {
    const int opened = ::open(candidate.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (opened < 0) return errno;
    if (!lock_with_others(opened) || !leads_to(candidate, opened)) {  // taken for an abandoned one before it was held
      ::close(opened);
      return EEXIST;
    }
    descriptor_ = opened;
    name_ = candidate;
    return 0;
  };
  if (const int error = first_free([this](int number) { return numbered(number, ".tmp"); }, make)) fail(error);
}

void TemporaryFile::give_name() {
  const auto make = [this](const fs::path& candidate) {
    if (::linkat(AT_FDCWD, name_in_proc(descriptor_).c_str(), AT_FDCWD, candidate.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return errno;
    }
    name_ = candidate;
    return 0;
  };
  if (const int error = first_free([this](int number) { return numbered(number, ".tmp"); }, make)) fail(error);
}

void TemporaryFile::put_in_place() {
  if (name_.empty()) give_name();
  if (::rename(name_.c_str(), target_.c_str()) != 0) fail(errno);
  name_.clear();
}

void TemporaryFile::keep_old() {
  old_descriptor_ = ::open(target_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (old_descriptor_ < 0 || !lock_with_others(old_descriptor_)) return;
  const auto make = [this](const fs::path& candidate) {
    if (::link(target_.c_str(), candidate.c_str()) != 0) return errno;
    kept_ = candidate;
    return 0;
  };
  (void)first_free([this](int number) { return numbered(number, ".old"); }, make);
}

bool TemporaryFile::give_back() {
  if (kept_.empty() || ::rename(kept_.c_str(), target_.c_str()) != 0) return false;
  kept_.clear();
  return true;
}

}  // namespace vantage::internal::core
