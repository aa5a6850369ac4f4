// Folders for a while, on Windows. The mark is what locks one: as long as it is open nobody else can remove it, nor,
// with it, the folder.
#include "common/temporary_folder.h"

#include <fcntl.h>
#include <io.h>

#include <array>
#include <cstring>
#include <random>
#include <string_view>
#include <system_error>

#include "core/replace_folder.h"
#include "core/temporary_mark.h"
#include "core/windows/windows.h"
#include "vantage/error.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using internal::core::descriptor_of;
using internal::core::errno_of;
using internal::core::is_named_so;
using internal::core::is_temporary_name;
using internal::core::kAside;
using internal::core::kRandomCharacters;
using internal::core::kTemporaryMark;

constexpr std::string_view kMarkText =
    "vantage made this folder for a short time. It removes the folder with all that is in it.\n";
constexpr int kAttempts = 10;

std::string random_characters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";  // names differ in more than case
  std::random_device random;
  std::string made;
  for (std::size_t i = 0; i < kRandomCharacters; ++i) made += kLetters[random() % kLetters.size()];
  return made;
}

/// The mark of a folder, held as above; -1, with errno. `creation`: CREATE_NEW or OPEN_EXISTING.
int open_mark(const fs::path& folder, DWORD creation) {
  const HANDLE handle = ::CreateFileW((folder / kTemporaryMark).c_str(), GENERIC_READ | GENERIC_WRITE, 0, nullptr,
                                      creation, FILE_ATTRIBUTE_NORMAL | FILE_FLAG_OPEN_REPARSE_POINT, nullptr);
  return descriptor_of(handle);
}

bool has_whole_text(int mark) {
  std::array<char, kMarkText.size() + 1> bytes{};
  const int count = ::_read(mark, bytes.data(), static_cast<unsigned>(bytes.size()));
  return count >= 0 && std::string_view(bytes.data(), static_cast<std::size_t>(count)) == kMarkText;
}

/// Whether it is a folder that vantage made for a while and that nobody uses.
bool is_abandoned(const fs::path& folder) {
  std::error_code error;
  if (fs::symlink_status(folder, error).type() != fs::file_type::directory) return false;
  const int mark = open_mark(folder, OPEN_EXISTING);
  if (mark < 0) return false;
  const bool is_ours = has_whole_text(mark);
  ::_close(mark);
  return is_ours;
}

/// All but the mark first: what a killed process leaves is still marked.
void remove_folder(const fs::path& folder) {
  std::error_code error, ignored;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    if (entry->path().filename() != kTemporaryMark) fs::remove_all(entry->path(), ignored);
  }
  fs::remove_all(folder, ignored);
}

void remove_abandoned(const fs::path& parent, std::string_view prefix, std::string_view ending) {
  std::error_code error;
  for (fs::directory_iterator entry(parent, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    if (!is_named_so(entry->path().filename().string(), prefix, ending)) continue;
    if (is_abandoned(entry->path())) remove_folder(entry->path());
  }
}

bool rename_folder(const fs::path& from, const fs::path& to) {
  if (::MoveFileExW(from.c_str(), to.c_str(), MOVEFILE_WRITE_THROUGH)) return true;
  errno = errno_of(::GetLastError());
  return false;
}

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(fs::temp_directory_path(), "vantage-tmp-") {}

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  remove_abandoned(parent, prefix, "");
  fs::path made;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    made = parent / (prefix + random_characters());
    if (!::CreateDirectoryW(made.c_str(), nullptr)) {
      errno = errno_of(::GetLastError());
      if (errno == EEXIST) continue;
      break;
    }
    descriptor_ = open_mark(made, CREATE_NEW);
    errno = ENOSPC;  // of a part that was written, nothing is said
    const auto bytes = static_cast<unsigned>(kMarkText.size());
    if (descriptor_ >= 0 && ::_write(descriptor_, kMarkText.data(), bytes) == static_cast<int>(bytes)) {
      path_ = made;
      return;
    }
    const int reason = errno;
    if (descriptor_ >= 0) ::_close(descriptor_);
    remove_folder(made);
    descriptor_ = -1;
    errno = reason;
    break;
  }
  throw Error(ErrorCode::output_unwritable, std::string("no temporary folder can be made: ") + std::strerror(errno),
              made.string(), "make room there, or set TMP to a folder that can be written");
}

TemporaryFolder::~TemporaryFolder() {
  if (descriptor_ >= 0) ::_close(descriptor_);
  if (!path_.empty()) remove_folder(path_);
}

bool TemporaryFolder::move_to(const fs::path& place) {
  const std::string own = path_.filename().string(), prefix = own.substr(0, own.size() - kRandomCharacters);
  if (is_temporary_name(place.filename().string(), prefix)) {
    errno = EINVAL;
    return false;
  }
  ::_close(descriptor_);  // Windows renames no folder that a file is open in
  descriptor_ = -1;
  std::error_code error;
  const bool replaces = fs::exists(place, error);
  fs::path aside = path_;
  aside += kAside;
  // The old one is marked while it has a temporary name, so that it is known whenever the process is killed.
  if (replaces) {
    fs::copy_file(path_ / kTemporaryMark, place / kTemporaryMark, fs::copy_options::overwrite_existing, error);
    if (!rename_folder(place, aside)) {
      const int reason = errno;
      fs::remove(place / kTemporaryMark, error);
      errno = reason;
      return false;
    }
  }
  if (!rename_folder(path_, place)) {
    const int reason = errno;
    if (replaces && rename_folder(aside, place)) fs::remove(place / kTemporaryMark, error);
    errno = reason;
    return false;
  }
  fs::remove(place / kTemporaryMark, error);
  path_.clear();
  if (replaces) remove_folder(aside);
  remove_abandoned(place.has_parent_path() ? place.parent_path() : fs::path("."), prefix, kAside);
  return true;
}

}  // namespace vantage
