#include "core/temporary_mark.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace vantage::internal::core {
namespace {

constexpr std::string_view kMarkText =
    "vantage made this folder for a short time. It removes the folder with all that is in it.\n";

constexpr int kOpenFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;

/// Calls `visit(name)` for what is in an open folder. False where it cannot be read.
template <typename Visit>
bool for_each_name(int folder, const Visit& visit) {
  const int again = ::openat(folder, ".", kOpenFolder);
  DIR* const entries = again < 0 ? nullptr : ::fdopendir(again);
  if (entries == nullptr) {
    if (again >= 0) ::close(again);
    return false;
  }
  while (const dirent* const entry = ::readdir(entries)) {
    const std::string_view text = entry->d_name;
    if (text != "." && text != "..") visit(entry->d_name);
  }
  ::closedir(entries);
  return true;
}

/// Empties a folder that may have been moved meanwhile: by its descriptor, not by its name.
void empty_folder(int folder, std::string_view kept) {
  for_each_name(folder, [&](const char* name) {
    if (name == kept || ::unlinkat(folder, name, 0) == 0) return;
    const int deeper = ::openat(folder, name, kOpenFolder);
    if (deeper < 0) return;
    empty_folder(deeper, "");
    ::close(deeper);
    ::unlinkat(folder, name, AT_REMOVEDIR);
  });
}

/// Whether there is more in a folder than the mark, or that cannot be known.
bool has_other_names(int folder) {
  bool has_others = false;
  const bool is_read = for_each_name(folder, [&](std::string_view name) { has_others |= name != kTemporaryMark; });
  return has_others || !is_read;
}

/// What is in the mark, and no more than a byte beyond its text; nothing where it is no file of this user.
std::optional<std::string> mark_in(int folder) {
  const int file = ::openat(folder, kTemporaryMark, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  struct stat status {};
  std::array<char, kMarkText.size() + 1> bytes{};
  const bool is_own_file = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
  const ssize_t count = is_own_file ? ::read(file, bytes.data(), bytes.size()) : -1;
  ::close(file);
  if (count < 0) return std::nullopt;
  return std::string(bytes.data(), static_cast<std::size_t>(count));
}

}  // namespace

bool put_temporary_mark(int folder) {
  const int file = ::openat(folder, kTemporaryMark, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0) return false;
  errno = ENOSPC;  // of a part that was written, nothing is said
  const bool is_written = ::write(file, kMarkText.data(), kMarkText.size()) == static_cast<ssize_t>(kMarkText.size());
  const int reason = errno;
  ::close(file);
  if (!is_written) ::unlinkat(folder, kTemporaryMark, 0);
  errno = reason;
  return is_written;
}

bool has_temporary_mark(int folder) { return mark_in(folder) == kMarkText; }

bool take_temporary_mark(int folder) {
  return !has_temporary_mark(folder) || ::unlinkat(folder, kTemporaryMark, 0) == 0;
}

void remove_unmarked_folder(const std::filesystem::path& folder, int opened) {
  constexpr mode_t kAllBits = 07777;
  struct stat status {};
  if (::fstat(opened, &status) != 0 || status.st_uid != ::geteuid() || (status.st_mode & kAllBits) != 0700) return;
  const std::optional<std::string> mark = mark_in(opened);
  if (mark && !kMarkText.starts_with(*mark)) return;
  if (has_other_names(opened)) return;
  if (mark) ::unlinkat(opened, kTemporaryMark, 0);
  ::rmdir(folder.c_str());
}

void remove_temporary_folder(const std::filesystem::path& folder) {
  if (const int opened = ::open(folder.c_str(), kOpenFolder); opened >= 0) {
    empty_folder(opened, kTemporaryMark);
    ::close(opened);
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

}  // namespace vantage::internal::core
