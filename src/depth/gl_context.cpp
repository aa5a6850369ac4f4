#include "depth/gl_context.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>

#include "depth/depth.h"
#include "depth/gl_library.h"

namespace vantage::internal::depth {
namespace {

constexpr const char* kInstall =
    "install libegl1 and libgl1-mesa-dri (Debian), or the driver of the graphics processor";

constexpr int kLargestFace = 16384;  // a face of these is 1 GiB

// GL_NVX_gpu_memory_info and GL_ATI_meminfo, in KiB; not in the core header.
constexpr GLenum kDedicatedMemoryNvx = 0x9047;
constexpr GLenum kTextureFreeMemoryAti = 0x87FC;

const char* egl_error_name(EGLint error) {
  switch (error) {
    case EGL_SUCCESS:
      return "no EGL error";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
      return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    case EGL_BAD_SURFACE:
      return "EGL_BAD_SURFACE";
    case EGL_CONTEXT_LOST:
      return "EGL_CONTEXT_LOST";
    default:
      return "an unknown EGL error";
  }
}

const char* gl_error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_STACK_OVERFLOW:
      return "GL_STACK_OVERFLOW";
    case GL_STACK_UNDERFLOW:
      return "GL_STACK_UNDERFLOW";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return "an unknown OpenGL error";
  }
}

/// Whether a space-separated list holds a whole word.
bool lists(std::string_view list, std::string_view word) {
  for (std::size_t at = list.find(word); at != std::string_view::npos; at = list.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' ')) return true;
  }
  return false;
}

std::string text(const char* string) { return string ? string : ""; }
std::string text(const GLubyte* string) { return text(reinterpret_cast<const char*>(string)); }

std::string client_extensions(const EglFunctions& egl) {
  std::string extensions = text(egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
  egl.GetError();  // EGL 1.4 without client extensions notes an error
  return extensions;
}

bool has_device_platform(const EglFunctions& egl, std::string_view extensions) {
  return egl.QueryDevicesEXT && egl.GetPlatformDisplayEXT && lists(extensions, "EGL_EXT_platform_device") &&
         (lists(extensions, "EGL_EXT_device_enumeration") || lists(extensions, "EGL_EXT_device_base"));
}

bool has_surfaceless_platform(const EglFunctions& egl, std::string_view extensions) {
  return egl.GetPlatformDisplayEXT && lists(extensions, "EGL_MESA_platform_surfaceless");
}

std::vector<EGLDeviceEXT> platform_devices(const EglFunctions& egl) {
  EGLint count = 0;
  if (!egl.QueryDevicesEXT(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(count, nullptr);
  if (!egl.QueryDevicesEXT(count, devices.data(), &count)) return {};
  devices.resize(count);
  return devices;
}

/// The kernel's file of a graphics processor ("/dev/dri/card0"), by which two drivers name the same one; may be empty.
std::string kernel_file(const EglFunctions& egl, int platform_device) {
  if (platform_device == GlDeviceInfo::kSurfaceless || !egl.QueryDeviceStringEXT) return "";
  const std::vector<EGLDeviceEXT> devices = platform_devices(egl);
  if (static_cast<std::size_t>(platform_device) >= devices.size()) return "";
  const EGLDeviceEXT device = devices[platform_device];
  if (!lists(text(egl.QueryDeviceStringEXT(device, EGL_EXTENSIONS)), "EGL_EXT_device_drm")) return "";
  return text(egl.QueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT));
}

std::string describe_place(int platform_device) {
  if (platform_device == GlDeviceInfo::kSurfaceless) return "Mesa's surfaceless platform";
  return "EGL device " + std::to_string(platform_device);
}

bool is_software(std::string_view name) {
  for (const char* rasterizer : {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"}) {
    if (name.find(rasterizer) != std::string_view::npos) return true;
  }
  return false;
}

/// What OpenGL itself says of the device of the current context.
RenderDevice describe(const GlContext& context) {
  const GlFunctions& gl = context.gl();
  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major < 4 || (major == 4 && minor < 5)) {
    throw DeviceFailure("the driver has OpenGL " + std::to_string(major) + "." + std::to_string(minor) +
                        ", and 4.5 is needed; a newer driver may: " + kInstall);
  }
  RenderDevice device;
  device.name = text(gl.GetString(GL_RENDERER));
  device.driver = text(gl.GetString(GL_VERSION));
  device.kind = is_software(device.name) ? DeviceKind::opengl_software : DeviceKind::opengl_hardware;
  GLint texture = 0;
  std::array<GLint, 2> viewport{};
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  gl.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  device.largest_face_size = std::min({texture, viewport[0], viewport[1], kLargestFace});
  if (device.kind == DeviceKind::opengl_hardware) {
    std::array<GLint, 4> kib{};
    if (context.has_extension("GL_NVX_gpu_memory_info")) {
      gl.GetIntegerv(kDedicatedMemoryNvx, kib.data());
    } else if (context.has_extension("GL_ATI_meminfo")) {
      gl.GetIntegerv(kTextureFreeMemoryAti, kib.data());
    }
    device.memory_bytes = kib[0] > 0 ? static_cast<std::size_t>(kib[0]) * 1024 : 0;
  }
  context.check("asking the device for its limits");
  return device;
}

struct Found {
  GlDeviceInfo info;
  std::string kernel_file;
};

bool same_device(const Found& a, const Found& b) {
  if (a.info.device.kind != b.info.device.kind) return false;
  if (a.info.device.kind == DeviceKind::opengl_software) return a.info.device.name == b.info.device.name;
  return !a.kernel_file.empty() && a.kernel_file == b.kernel_file;
}

/// Appends the device unless it is there already; notes why it cannot be used.
void try_device(int platform_device, const std::shared_ptr<const GlLibrary>& library, std::vector<Found>& found,
                std::string& reasons) {
  try {
    Found candidate;
    candidate.info.platform_device = platform_device;
    const GlContext context(candidate.info, library);
    const GlCurrent current(context);
    candidate.info.device = describe(context);
    candidate.info.device.index = static_cast<int>(found.size());
    candidate.kernel_file = kernel_file(library->egl, platform_device);
    for (const Found& other : found) {
      if (same_device(other, candidate)) return;
    }
    found.push_back(std::move(candidate));
  } catch (const DeviceFailure& failure) {
    reasons += (reasons.empty() ? "" : "; ") + text(failure.what());
  }
}

}  // namespace

std::vector<GlDeviceInfo> gl_devices(std::string& why_none) {
  const std::shared_ptr<const GlLibrary> library = load_gl_library(why_none);
  return library ? gl_devices(why_none, library) : std::vector<GlDeviceInfo>{};
}

std::vector<GlDeviceInfo> gl_devices(std::string& why_none, const std::shared_ptr<const GlLibrary>& library) {
  const std::string extensions = client_extensions(library->egl);
  std::vector<Found> found;
  std::string reasons;
  if (has_device_platform(library->egl, extensions)) {
    const int count = static_cast<int>(platform_devices(library->egl).size());
    for (int i = 0; i < count; ++i) try_device(i, library, found, reasons);
  }
  if (found.empty() && has_surfaceless_platform(library->egl, extensions)) {
    try_device(GlDeviceInfo::kSurfaceless, library, found, reasons);
  }
  why_none.clear();
  if (found.empty()) {
    why_none = reasons.empty() ? "no OpenGL: EGL lists no device and has no surfaceless platform; " + text(kInstall)
                               : "no OpenGL: " + reasons;
  }
  std::vector<GlDeviceInfo> devices;
  devices.reserve(found.size());
  for (Found& one : found) devices.push_back(std::move(one.info));
  return devices;
}

GlContext::GlContext(const GlDeviceInfo& info) : info_(info) {
  std::string why_not;
  library_ = load_gl_library(why_not);
  if (!library_) throw DeviceFailure(why_not);
  open();
}

GlContext::GlContext(const GlDeviceInfo& info, std::shared_ptr<const GlLibrary> library)
    : info_(info), library_(std::move(library)) {
  open();
}

// The display stays initialized: EGL shares it with whoever else uses it in this process, and does not count.
GlContext::~GlContext() {
  if (surface_) library_->egl.DestroySurface(display_, surface_);
  if (context_) library_->egl.DestroyContext(display_, context_);
}

const GlFunctions& GlContext::gl() const { return library_->gl; }

void GlContext::open() {
  const EglFunctions& egl = library_->egl;
  const std::string place = describe_place(info_.platform_device);
  const std::string known = client_extensions(egl);
  if (info_.platform_device == GlDeviceInfo::kSurfaceless) {
    if (has_surfaceless_platform(egl, known)) {
      display_ = egl.GetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    }
  } else if (has_device_platform(egl, known)) {
    const std::vector<EGLDeviceEXT> devices = platform_devices(egl);
    if (info_.platform_device >= 0 && static_cast<std::size_t>(info_.platform_device) < devices.size()) {
      display_ = egl.GetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[info_.platform_device], nullptr);
    }
  }
  if (!display_) throw DeviceFailure(place + " gives no display; " + kInstall);
  {
    static std::mutex initializing;  // drivers differ in whether two threads may
    const std::lock_guard<std::mutex> lock(initializing);
    EGLint major = 0, minor = 0;
    if (!egl.Initialize(display_, &major, &minor)) {
      throw DeviceFailure(place + " cannot be initialized (" + egl_error_name(egl.GetError()) + "); " + kInstall +
                          ", and see that /dev/dri/renderD* may be opened");
    }
  }
  extensions_ = text(egl.QueryString(display_, EGL_EXTENSIONS));
  choose_config();
  create();
}

void GlContext::choose_config() {
  const EglFunctions& egl = library_->egl;
  for (const EGLint surface : {EGL_PBUFFER_BIT, 0}) {
    const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, surface, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (egl.ChooseConfig(display_, wanted.data(), &config_, 1, &count) && count > 0) return;
  }
  config_ = nullptr;
  egl.GetError();
  if (!lists(extensions_, "EGL_KHR_no_config_context") && !lists(extensions_, "EGL_MESA_configless_context")) {
    throw DeviceFailure(describe_place(info_.platform_device) +
                        " has no configuration for OpenGL (its driver knows OpenGL ES only?); " + kInstall);
  }
}

void GlContext::create() {
  const EglFunctions& egl = library_->egl;
  const std::string place = describe_place(info_.platform_device);
  const EGLenum api_before = egl.QueryAPI();
  if (!egl.BindAPI(EGL_OPENGL_API)) throw DeviceFailure(place + " knows OpenGL ES only; " + kInstall);
  // A context that tells of a reset rather than end the program, where the driver can.
  constexpr std::array<EGLint, 9> plain{
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  std::array<EGLint, 9> robust = plain;
  robust[6] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR;
  robust[7] = EGL_LOSE_CONTEXT_ON_RESET_KHR;
  robust[8] = EGL_NONE;
  context_ = egl.CreateContext(display_, config_, EGL_NO_CONTEXT, robust.data());
  if (!context_) context_ = egl.CreateContext(display_, config_, EGL_NO_CONTEXT, plain.data());
  const EGLint error = context_ ? EGL_SUCCESS : egl.GetError();
  if (api_before != EGL_OPENGL_API && api_before != EGL_NONE) egl.BindAPI(api_before);
  if (!context_) {
    throw DeviceFailure(place + " gives no OpenGL 4.5 context (" + egl_error_name(error) +
                        "); a newer driver may: " + kInstall);
  }
  if (lists(extensions_, "EGL_KHR_surfaceless_context")) return;
  constexpr std::array<EGLint, 5> one_texel{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
  surface_ = config_ ? egl.CreatePbufferSurface(display_, config_, one_texel.data()) : nullptr;
  if (!surface_) {
    const std::string reason = config_ ? egl_error_name(egl.GetError()) : "no configuration";
    egl.DestroyContext(display_, context_);
    throw DeviceFailure(place + " gives no surface to render to (" + reason + "); " + kInstall);
  }
}

bool GlContext::has_extension(std::string_view name) const {
  const GlFunctions& gl = library_->gl;
  GLint count = 0;
  gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    if (text(gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))) == name) return true;
  }
  return false;
}

void GlContext::check(std::string_view doing) const {
  const GlFunctions& gl = library_->gl;
  const GLenum error = gl.GetError();
  const GLenum reset = gl.GetGraphicsResetStatus();
  if (error == GL_NO_ERROR && reset == GL_NO_ERROR) return;
  const std::string name = info_.device.name.empty() ? describe_place(info_.platform_device) : info_.device.name;
  if (reset != GL_NO_ERROR || error == GL_CONTEXT_LOST) {
    throw DeviceFailure(name + " was lost while " + std::string(doing) +
                        ": its driver was reset or another program took it down");
  }
  for (int i = 0; i < 8 && gl.GetError() != GL_NO_ERROR; ++i) {  // one flag per kind of error may stand
  }
  if (error == GL_OUT_OF_MEMORY) throw DeviceFailure(name + " ran out of memory while " + std::string(doing));
  std::array<GLchar, 512> message{};
  gl.GetDebugMessageLog(1, static_cast<GLsizei>(message.size()), nullptr, nullptr, nullptr, nullptr, nullptr,
                        message.data());
  throw DeviceFailure(name + " failed while " + std::string(doing) + ": " + gl_error_name(error) +
                      (message[0] ? " (" + text(message.data()) + ")" : ""));
}

GlCurrent::GlCurrent(const GlContext& context) : context_(context) {
  const EglFunctions& egl = context.library_->egl;
  api_ = egl.QueryAPI();
  egl.BindAPI(EGL_OPENGL_API);
  display_ = egl.GetCurrentDisplay();
  draw_ = egl.GetCurrentSurface(EGL_DRAW);
  read_ = egl.GetCurrentSurface(EGL_READ);
  previous_ = egl.GetCurrentContext();
  if (!egl.MakeCurrent(context.display_, context.surface_, context.surface_, context.context_)) {
    const std::string reason = egl_error_name(egl.GetError());
    egl.BindAPI(api_);
    throw DeviceFailure(describe_place(context.info_.platform_device) + ": its context cannot be made current (" +
                        reason + ")");
  }
}

GlCurrent::~GlCurrent() {
  const EglFunctions& egl = context_.library_->egl;
  if (previous_) {
    egl.MakeCurrent(display_, draw_, read_, previous_);
  } else {
    egl.MakeCurrent(context_.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  if (api_ != EGL_OPENGL_API) egl.BindAPI(api_);
}

}  // namespace vantage::internal::depth
