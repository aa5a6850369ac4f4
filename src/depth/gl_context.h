// OpenGL 4.5 without a window: which devices there are, and contexts on them. Through EGL's device platform where the
// driver has it (EGL_EXT_platform_device), on Mesa's surfaceless platform otherwise.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/devices.h"

namespace vantage::internal::depth {

struct EglFunctions;
struct GlFunctions;
struct GlLibrary;

struct GlDeviceInfo {
  RenderDevice device;      ///< `index`: position in the list of gl_devices
  int platform_device = 0;  ///< position in EGL's list of devices; kSurfaceless: there is no such list
  static constexpr int kSurfaceless = -1;
};

/// The devices that give an OpenGL 4.5 context, as EGL lists them, each once. When there is none, `why_none` says why
/// and what to install or mend. Never throws for what is missing. Opens and closes a context on each.
std::vector<GlDeviceInfo> gl_devices(std::string& why_none);
std::vector<GlDeviceInfo> gl_devices(std::string& why_none, const std::shared_ptr<const GlLibrary>& library);

/// A context that no window belongs to. It is current on no thread until a GlCurrent is made. Throws DeviceFailure.
class GlContext {
 public:
  explicit GlContext(const GlDeviceInfo& info);
  GlContext(const GlDeviceInfo& info, std::shared_ptr<const GlLibrary> library);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const RenderDevice& device() const { return info_.device; }
  const GlFunctions& gl() const;

  /// Throws DeviceFailure, with what was being done ("uploading the scene"), when OpenGL has noted an error or the
  /// device was lost. Only while this context is current.
  void check(std::string_view doing) const;

  bool has_extension(std::string_view name) const;  ///< of OpenGL; only while this context is current

 private:
  friend class GlCurrent;
  void open();
  void choose_config();
  void create();

  GlDeviceInfo info_;
  std::shared_ptr<const GlLibrary> library_;
  std::string extensions_;  ///< of the display
  void* display_ = nullptr;
  void* config_ = nullptr;
  void* context_ = nullptr;
  void* surface_ = nullptr;  ///< one texel, where the driver wants a surface; else null
};

/// Makes a context current on this thread; its end makes current again what was before.
class GlCurrent {
 public:
  explicit GlCurrent(const GlContext& context);  ///< throws DeviceFailure
  ~GlCurrent();
  GlCurrent(const GlCurrent&) = delete;
  GlCurrent& operator=(const GlCurrent&) = delete;

 private:
  const GlContext& context_;
  unsigned api_;
  void *display_, *draw_, *read_, *previous_;
};

}  // namespace vantage::internal::depth
