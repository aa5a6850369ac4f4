#include "maps/terrain/gdal_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include "core/system_limits.h"
#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

thread_local GdalCalls* innermost = nullptr;

constexpr std::pair<const char*, const char*> kOptions[] = {
    // FILE.aux.xml may name any file for the overviews, and a driver opens it.
    {"GDAL_PAM_ENABLED", "NO"},
    // Nor FILE.ovr and FILE.msk, which any driver would open.
    {"GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR"},
    // The only name that /vsicurl/ and what is built on it (s3, ...) may open: none.
    {"CPL_VSIL_CURL_ALLOWED_FILENAME", "/vsicurl/"},
    {"GDAL_CACHEMAX", "64"},  // MB; counts only where GDAL has not begun to cache
};

std::unique_ptr<GdalLibrary> functions_of(void* handle, std::string& missing) {
  auto library = std::make_unique<GdalLibrary>();
// NOLINTBEGIN(bugprone-macro-parentheses): the arguments are types
#define VANTAGE_LOAD(result, name, arguments)                                  \
  library->name = reinterpret_cast<result(*) arguments>(dlsym(handle, #name)); \
  if (!library->name) missing = #name;
  // NOLINTEND(bugprone-macro-parentheses)
  VANTAGE_GDAL_FUNCTIONS(VANTAGE_LOAD)
#undef VANTAGE_LOAD
  return library;
}

}  // namespace

std::vector<std::string> gdal_library_names() {
  std::vector<std::string> names = {"libgdal.so.32"};
  for (int version = 40; version >= 28; --version) {
    if (version != 32) names.push_back("libgdal.so." + std::to_string(version));
  }
  names.emplace_back("libgdal.so");
  return names;
}

const GdalLibrary* load_gdal_library(std::string& why_not, const std::vector<std::string>& names) {
  why_not = core::can_load_libraries() ? "GDAL is not installed" : core::kLoadsNone;
  for (const std::string& name : names) {
    void* const handle = core::load_library({name}, "GDAL");
    if (!handle) continue;
    std::string missing;
    std::unique_ptr<GdalLibrary> library = functions_of(handle, missing);
    if (!missing.empty()) {
      why_not = "GDAL is too old: ";
      why_not.append(name).append(" lacks ").append(missing);
      continue;
    }
    {
      const GdalCalls calls(*library);
      library->GDALRegister_GTiff();
      library->GDALRegister_AAIGrid();
      library->GDALRegister_SRTMHGT();
    }
    return library.release();  // for as long as the program runs, as the library itself
  }
  return nullptr;
}

const GdalLibrary& gdal(const std::filesystem::path& file) {
  static std::string why_not;
  static const GdalLibrary* const library = load_gdal_library(why_not, gdal_library_names());
  if (!library) {
    throw Error(
        ErrorCode::library_missing, "rasters are read with GDAL: " + why_not, file.string(),
        core::can_load_libraries() ? "install libgdal32 (Debian 12), or GDAL 3.1 or later" : core::kLoadsNoneFix);
  }
  return *library;
}

GdalCalls::GdalCalls(const GdalLibrary& library) : library_(library), outer_(innermost) {
  for (const auto& [name, value] : kOptions) {
    const char* const before = library_.CPLGetThreadLocalConfigOption(name, nullptr);
    options_before_.push_back(before ? std::optional<std::string>(before) : std::nullopt);
  }
  innermost = this;
  library_.CPLPushErrorHandlerEx(handle, nullptr);
  for (const auto& [name, value] : kOptions) library_.CPLSetThreadLocalConfigOption(name, value);
}

GdalCalls::~GdalCalls() {
  for (std::size_t i = 0; i < options_before_.size(); ++i) {
    library_.CPLSetThreadLocalConfigOption(kOptions[i].first,
                                           options_before_[i] ? options_before_[i]->c_str() : nullptr);
  }
  library_.CPLPopErrorHandler();
  innermost = outer_;
}

void GdalCalls::handle(int severity, int /*number*/, const char* message) noexcept {
  if (severity < gdal_values::kFailure || !message || !innermost || !innermost->first_error_.empty()) return;
  try {
    innermost->first_error_.assign(message).resize(std::min<std::size_t>(innermost->first_error_.size(), 200));
  } catch (const std::bad_alloc&) {  // a message less
    return;
  }
  for (char& c : innermost->first_error_) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
}

}  // namespace vantage::internal::terrain
