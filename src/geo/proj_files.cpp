#include "geo/proj_files.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <system_error>

#include "geo/proj_library.h"

namespace vantage::internal::geo {
namespace {

namespace fs = std::filesystem;

/// Links are followed: what they lead to counts.
bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error), above = error ? fs::path() : fs::canonical(folder, error);
  if (error) return false;
  return std::mismatch(above.begin(), above.end(), real.begin(), real.end()).first == above.end();
}

bool is_allowed(const char* name, const void* folders) {
  const auto& all = *static_cast<const std::vector<fs::path>*>(folders);
  std::error_code error;
  return fs::is_regular_file(name, error) &&
         std::any_of(all.begin(), all.end(), [&](const fs::path& folder) { return lies_in(name, folder); });
}

std::FILE* stream(PROJ_FILE_HANDLE* handle) { return reinterpret_cast<std::FILE*>(handle); }

PROJ_FILE_HANDLE* open(PJ_CONTEXT*, const char* name, PROJ_OPEN_ACCESS access, void* folders) noexcept {
  try {
    if (access != PROJ_OPEN_ACCESS_READ_ONLY || !is_allowed(name, folders)) return nullptr;
  } catch (const std::exception&) {  // no memory for the path
    return nullptr;
  }
  return reinterpret_cast<PROJ_FILE_HANDLE*>(std::fopen(name, "rbe"));
}

std::size_t read(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void* to, std::size_t size, void*) noexcept {
  return std::fread(to, 1, size, stream(handle));
}

std::size_t write(PJ_CONTEXT*, PROJ_FILE_HANDLE*, const void*, std::size_t, void*) noexcept { return 0; }

int seek(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, long long offset, int from, void*) noexcept {
  return ::fseeko(stream(handle), offset, from) == 0;
}

unsigned long long tell(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void*) noexcept {
  return static_cast<unsigned long long>(::ftello(stream(handle)));
}

void close(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void*) noexcept { std::fclose(stream(handle)); }

int exists(PJ_CONTEXT*, const char* name, void* folders) noexcept {
  try {
    return is_allowed(name, folders);
  } catch (const std::exception&) {
    return 0;
  }
}

int change(PJ_CONTEXT*, const char*, void*) noexcept { return 0; }
int rename(PJ_CONTEXT*, const char*, const char*, void*) noexcept { return 0; }

constexpr PROJ_FILE_API kReadOnly{1, open, read, write, seek, tell, close, exists, change, change, rename};

}  // namespace

std::vector<fs::path> folders_of_user() {
  const char* text = std::getenv("PROJ_DATA");
  if (!text) text = std::getenv("PROJ_LIB");
  std::vector<fs::path> folders;
  std::istringstream words(text ? text : "");
  for (std::string folder; std::getline(words, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

// Not proj_info(): what it reads of the environment stays for all contexts made later.
std::vector<fs::path> data_folders(PJ_CONTEXT* context) {
  std::vector<fs::path> folders = folders_of_user();
  if (const char* database = proj().proj_context_get_database_path(context))
    folders.push_back(fs::path(database).parent_path());
  if (const char* own = proj().proj_context_get_user_writable_directory(context, 0)) folders.emplace_back(own);
  folders.insert(folders.end(), {"/usr/local/share/proj", "/usr/share/proj"});
  return folders;
}

void allow_files_in(PJ_CONTEXT* context, const std::vector<fs::path>& folders) {
  // Not written to: the functions above take it as it was given.
  proj().proj_context_set_fileapi(context, &kReadOnly, const_cast<std::vector<fs::path>*>(&folders));
}

}  // namespace vantage::internal::geo
