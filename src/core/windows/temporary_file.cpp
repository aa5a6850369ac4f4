// Files that take the place of others, on Windows. The lock is how a file is opened: while it is, nobody else may write
// to it, rename it or remove it. So whatever can be removed was left by a process that was killed.
#include "core/temporary_file.h"

#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "core/windows/windows.h"

namespace vantage::internal::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(int error_number) { throw std::system_error(error_number, std::generic_category()); }

bool is_there(const fs::path& path) { return ::GetFileAttributesW(path.c_str()) != INVALID_FILE_ATTRIBUTES; }

HANDLE handle_of(int descriptor) { return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor)); }

/// A new file that is held as above. -1, with errno, where it cannot be made.
int make_held(const fs::path& path) {
  const HANDLE handle = ::CreateFileW(path.c_str(), GENERIC_READ | GENERIC_WRITE | DELETE, FILE_SHARE_READ, nullptr,
                                      CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
  return descriptor_of(handle);
}

/// Renames an open file, in one step where another file has the name. 0, or the number of an error.
int rename_open(int descriptor, const fs::path& target) {
  std::error_code error;
  const std::wstring name = fs::absolute(target, error).make_preferred().native();
  if (error) return ENOENT;
  const std::size_t bytes = name.size() * sizeof(wchar_t);
  std::vector<std::max_align_t> room((sizeof(FILE_RENAME_INFO) + bytes) / sizeof(std::max_align_t) + 1);
  auto* const asked = reinterpret_cast<FILE_RENAME_INFO*>(room.data());
  asked->ReplaceIfExists = TRUE;
  asked->RootDirectory = nullptr;
  asked->FileNameLength = static_cast<DWORD>(bytes);
  std::copy(name.begin(), name.end(), asked->FileName);
  const auto size = static_cast<DWORD>(room.size() * sizeof(std::max_align_t));
  const bool is_done = ::SetFileInformationByHandle(handle_of(descriptor), FileRenameInfo, asked, size);
  return is_done ? 0 : errno_of(::GetLastError());
}

/// The file that is open goes when it is closed, whatever its name is then.
void remove_open(int descriptor) {
  FILE_DISPOSITION_INFO asked{};
  asked.DeleteFile = TRUE;
  ::SetFileInformationByHandle(handle_of(descriptor), FileDispositionInfo, &asked, sizeof asked);
}

}  // namespace

void remove_if_abandoned(const fs::path& path) {
  const DWORD attributes = ::GetFileAttributesW(path.c_str());
  constexpr DWORD kNoFile = FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_REPARSE_POINT | FILE_ATTRIBUTE_DEVICE;
  if (attributes != INVALID_FILE_ATTRIBUTES && !(attributes & kNoFile)) ::DeleteFileW(path.c_str());
}

TemporaryFile::TemporaryFile(const fs::path& target, Names names) : target_(target), names_(names) {
  remove_abandoned_ones();
  open_with_name();
}

TemporaryFile::~TemporaryFile() {
  if (!kept_.empty()) remove_if_abandoned(kept_);
  if (descriptor_ < 0) return;
  remove_open(descriptor_);
  ::_close(descriptor_);
}

fs::path TemporaryFile::numbered(int number, const char* ending) const {
  std::wstring name(L".");
  name.append(target_.filename().native(), 0, 200);
  name.append(L".vantage-").append(std::to_wstring(number)).append(fs::path(ending).native());
  return target_.parent_path() / name;
}

void TemporaryFile::open_with_name() {
  for (int number = 0; number < kMostNumbers; ++number) {
    const fs::path candidate = numbered(number, ".tmp");
    descriptor_ = make_held(candidate);
    if (descriptor_ >= 0) {
      name_ = candidate;
      return;
    }
    if (errno != EEXIST && !(errno == EACCES && is_there(candidate))) fail(errno);
  }
  fail(EEXIST);
}

void TemporaryFile::put_in_place() {
  if (const int error = rename_open(descriptor_, target_)) fail(error);
  name_.clear();
  ::_close(descriptor_);  // so that it can be replaced again
  descriptor_ = -1;
}

/// A second name does not hold the file: another process that writes it at the same moment may remove that name. Then
/// give_back() says so.
void TemporaryFile::keep_old() {
  for (int number = 0; number < kMostNumbers; ++number) {
    const fs::path candidate = numbered(number, ".old");
    if (::CreateHardLinkW(candidate.c_str(), target_.c_str(), nullptr)) {
      kept_ = candidate;
      return;
    }
    if (::GetLastError() != ERROR_ALREADY_EXISTS) return;  // as where the file system has no second names
  }
}

bool TemporaryFile::give_back() {
  if (kept_.empty()) return false;
  if (!::MoveFileExW(kept_.c_str(), target_.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) return false;
  kept_.clear();
  return true;
}

}  // namespace vantage::internal::core
