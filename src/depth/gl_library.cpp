#include "depth/gl_library.h"

#include <dlfcn.h>

#include "core/system_limits.h"

namespace vantage::internal::depth {

std::shared_ptr<const GlLibrary> load_gl_library(std::string& why_not, const char* file) {
  if (!core::can_load_libraries()) {
    why_not = std::string("no OpenGL: ") + core::kLoadsNone + "; " + core::kLoadsNoneFix;
    return nullptr;
  }
  void* const handle = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    const char* const reason = dlerror();
    why_not = "no OpenGL: " + std::string(reason ? reason : file) +
              "; install libegl1 and libgl1-mesa-dri (Debian), or the driver of the graphics processor";
    return nullptr;
  }
  auto library = std::make_shared<GlLibrary>();
  std::string missing;
#define VANTAGE_LOAD(type, name)                                                        \
  library->egl.name = reinterpret_cast<PFNEGL##type##PROC>(dlsym(handle, "egl" #name)); \
  if (!library->egl.name) missing = "egl" #name;
  VANTAGE_EGL_FUNCTIONS(VANTAGE_LOAD)
#undef VANTAGE_LOAD
  if (missing.empty()) {
    const auto get = library->egl.GetProcAddress;
#define VANTAGE_LOAD(type, name) library->egl.name = reinterpret_cast<PFNEGL##type##PROC>(get("egl" #name));
    VANTAGE_EGL_EXTENSION_FUNCTIONS(VANTAGE_LOAD)
#undef VANTAGE_LOAD
#define VANTAGE_LOAD(type, name)                                           \
  library->gl.name = reinterpret_cast<PFNGL##type##PROC>(get("gl" #name)); \
  if (!library->gl.name) missing = "gl" #name;
    VANTAGE_GL_FUNCTIONS(VANTAGE_LOAD)
#undef VANTAGE_LOAD
  }
  if (!missing.empty()) {
    why_not = std::string("no OpenGL 4.5: ") + file + " lacks " + missing +
              "; install a newer libegl1 and libgl1-mesa-dri (Debian) or a newer driver of the graphics processor";
    return nullptr;
  }
  return library;
}

}  // namespace vantage::internal::depth
