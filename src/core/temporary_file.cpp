#include "core/temporary_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "core/file_locks.h"

namespace vantage::internal::core {
namespace {

namespace fs = std::filesystem;

constexpr int kMostRetries = 10;  // at what another process may be doing at the same moment

[[noreturn]] void fail(int error_number) { throw std::system_error(error_number, std::generic_category()); }

std::string name_in_proc(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

/// The lowest number that `make` gets a file for: it returns 0, or the number of an error, EEXIST where that is taken.
/// Those that were abandoned make room.
template <typename Path, typename Make>
int first_free(const Path& path, const Make& make) {
  for (int number = 0; number < TemporaryFile::kMostNumbers; ++number) {
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

/// Removes the file that is open, and nothing that took its name meanwhile.
void unlink_own(const fs::path& path, int descriptor) {
  if (!path.empty() && leads_to(path, descriptor)) ::unlink(path.c_str());
}

/// All bytes and the permissions; 0, or the number of an error.
int copy_file(int from, int to) {
  std::array<char, 1 << 16> buffer{};
  for (off_t done = 0;;) {
    const ssize_t count = ::pread(from, buffer.data(), buffer.size(), done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) break;
    for (ssize_t written = 0; written < count;) {
      const ssize_t more = ::write(to, buffer.data() + written, static_cast<std::size_t>(count - written));
      if (more < 0 && errno == EINTR) continue;
      if (more < 0) return errno;
      written += more;
    }
    done += count;
  }
  struct stat status {};
  if (::fstat(from, &status) == 0) (void)::fchmod(to, status.st_mode & 07777);
  return ::fsync(to) == 0 ? 0 : errno;
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

TemporaryFile::TemporaryFile(const fs::path& target, Names names) : target_(target), names_(names) {
  remove_abandoned_ones();
  if (names == Names::from_the_start || !open_without_name()) open_with_name();
}

TemporaryFile::~TemporaryFile() {
  unlink_own(name_, descriptor_);
  unlink_own(kept_, old_descriptor_);
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
#if defined(__EMSCRIPTEN__) || !defined(O_TMPFILE)
  return false;
#else
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return false;
  if (::access(name_in_proc(descriptor_).c_str(), F_OK) == 0 && lock_with_others(descriptor_)) return true;
  ::close(descriptor_);
  descriptor_ = -1;
  return false;
#endif
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

/// False, with errno, where the file system does not do it.
bool TemporaryFile::try_to_link() {
  const auto make = [this](const fs::path& candidate) {
    if (::linkat(AT_FDCWD, name_in_proc(descriptor_).c_str(), AT_FDCWD, candidate.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return errno;
    }
    name_ = candidate;
    return 0;
  };
  errno = first_free([this](int number) { return numbered(number, ".tmp"); }, make);
  return errno == 0;
}

void TemporaryFile::copy_to_named_file() {
  const int original = descriptor_;
  try {
    open_with_name();
    if (const int error = copy_file(original, descriptor_)) fail(error);
  } catch (...) {
    if (original != descriptor_) ::close(original);
    throw;
  }
  ::close(original);
}

/// Some file systems make files without a name and cannot give them one. What took hours is not lost for that.
void TemporaryFile::give_name() {
  if (names_ == Names::by_copy || !try_to_link()) copy_to_named_file();
}

void TemporaryFile::put_in_place() {
  if (name_.empty()) give_name();
  if (!leads_to(name_, descriptor_)) fail(ESTALE);
  if (::rename(name_.c_str(), target_.c_str()) != 0) fail(errno);
  name_.clear();
}

/// 0; or EAGAIN where the target is another file by now.
int TemporaryFile::link_old_as(const fs::path& candidate) {
  if (::link(target_.c_str(), candidate.c_str()) != 0) return errno;
  if (!leads_to(candidate, old_descriptor_)) {
    remove_if_abandoned(candidate);  // or, if its writer still holds it, whoever writes next
    return EAGAIN;
  }
  kept_ = candidate;
  return 0;
}

bool TemporaryFile::hold_old() {
  if (old_descriptor_ >= 0) ::close(old_descriptor_);
  old_descriptor_ = ::open(target_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  return old_descriptor_ >= 0 && lock_with_others(old_descriptor_);
}

void TemporaryFile::keep_old() {
  for (int attempt = 0; attempt < kMostRetries && hold_old(); ++attempt) {
    const int error = first_free([this](int number) { return numbered(number, ".old"); },
                                 [this](const fs::path& candidate) { return link_old_as(candidate); });
    if (error != EAGAIN) return;
  }
}

bool TemporaryFile::give_back() {
  if (kept_.empty() || !leads_to(kept_, old_descriptor_)) return false;
  if (::rename(kept_.c_str(), target_.c_str()) != 0) return false;
  kept_.clear();
  return true;
}

}  // namespace vantage::internal::core
