#include "geo/proj_library.h"

#ifndef VANTAGE_PROJ_LINKED
#ifndef VANTAGE_PROJ_ABSENT
#include <dlfcn.h>
#endif

#include <string>

#include "core/system_limits.h"
#include "vantage/error.h"
#endif

// Set by cmake/Components.cmake: that PROJ is linked, or that there is none; or the name that the library of these
// headers has on the system, and where it was found.
#if !defined(VANTAGE_PROJ_LINKED) && !defined(VANTAGE_PROJ_ABSENT) && \
    (!defined(VANTAGE_PROJ_NAME) || !defined(VANTAGE_PROJ_FILE))
#error "which PROJ?"
#endif

namespace vantage::internal::geo {
#ifdef VANTAGE_PROJ_LINKED

const ProjLibrary& proj() {
#define VANTAGE_FUNCTION(name) &::name,
  static const ProjLibrary library{VANTAGE_PROJ_FUNCTIONS(VANTAGE_FUNCTION)};
#undef VANTAGE_FUNCTION
  return library;
}

#elif defined(VANTAGE_PROJ_ABSENT)

const ProjLibrary& proj() {
  throw Error(ErrorCode::library_missing, "this build cannot work out where a scene lies on the earth", "PROJ",
              "give coordinates in the scene's frame, or use the program");
}

#else

namespace {

/// Empty where all is there.
std::string load(ProjLibrary& library) {
  void* const handle = core::load_library({VANTAGE_PROJ_NAME, VANTAGE_PROJ_FILE}, "PROJ");
  if (!handle) return "PROJ is not installed";
  std::string missing;
#define VANTAGE_LOAD(name)                                                       \
  library.name = reinterpret_cast<decltype(library.name)>(dlsym(handle, #name)); \
  if (!library.name) missing = #name;
  VANTAGE_PROJ_FUNCTIONS(VANTAGE_LOAD)
#undef VANTAGE_LOAD
  return missing.empty() ? "" : "PROJ lacks the function " + missing;
}

}  // namespace

const ProjLibrary& proj() {
  static ProjLibrary library;
  static const std::string why_not = load(library);
  if (why_not.empty()) return library;
  throw Error(ErrorCode::library_missing, why_not + ", and where a scene lies on the earth is worked out with it",
              VANTAGE_PROJ_NAME, "install libproj25 (Debian 12), or build vantage with the PROJ that is there");
}

#endif

}  // namespace vantage::internal::geo
