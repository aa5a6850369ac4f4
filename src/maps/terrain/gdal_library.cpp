#include "maps/terrain/gdal_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <memory>
#include <new>

#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

thread_local GdalMessages* innermost = nullptr;

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
  why_not = "GDAL is not installed";
  for (const std::string& name : names) {
    void* const handle = dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!handle) continue;
    std::string missing;
    std::unique_ptr<GdalLibrary> library = functions_of(handle, missing);
    if (!missing.empty()) {
      why_not = "GDAL is too old: ";
      why_not.append(name).append(" lacks ").append(missing);
      continue;
    }
    {
      const GdalMessages silence(*library);
      library->GDALAllRegister();
    }
    return library.release();  // for as long as the program runs, as the library itself
  }
  return nullptr;
}

const GdalLibrary& gdal(const std::filesystem::path& file) {
  static std::string why_not;
  static const GdalLibrary* const library = load_gdal_library(why_not, gdal_library_names());
  if (!library) {
    throw Error(ErrorCode::library_missing, "rasters are read with GDAL: " + why_not, file.string(),
                "install libgdal32 (Debian 12), or GDAL 3.1 or later");
  }
  return *library;
}

GdalMessages::GdalMessages(const GdalLibrary& library) : library_(library), outer_(innermost) {
  innermost = this;
  library_.CPLPushErrorHandlerEx(handle, nullptr);
}

GdalMessages::~GdalMessages() {
  library_.CPLPopErrorHandler();
  innermost = outer_;
}

void GdalMessages::handle(int severity, int /*number*/, const char* message) noexcept {
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
