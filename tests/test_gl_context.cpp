// OpenGL devices and contexts, and what is said when they fail: the table of functions gets some that do.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "depth/gl_context.h"
#include "depth/gl_depth.h"
#include "depth/gl_library.h"
#include "support/internals.h"
#include "support/scenes.h"
#include "support/wording.h"

namespace vantage::testing {
namespace {

using depth::DeviceFailure;
using depth::GlContext;
using depth::GlCurrent;
using depth::GlDeviceInfo;
using depth::GlLibrary;

std::shared_ptr<const GlLibrary> real;  // what replaced functions pass on to
int calls = 0;                          // of a replaced function, since the test began

class GlContexts : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string why;
    real = depth::load_gl_library(why);
    if (!real) GTEST_SKIP() << why;
    if (depth::gl_devices(why, real).empty()) GTEST_SKIP() << why;
    broken_ = std::make_shared<GlLibrary>(*real);
    calls = 0;
  }
  void TearDown() override { real.reset(); }

  std::vector<GlDeviceInfo> devices() {
    why_.clear();
    return depth::gl_devices(why_, broken_);
  }

  /// Expects that no device is found, and that the sentence says all of `words` and what to do.
  void expect_none(std::initializer_list<const char*> words) {
    EXPECT_TRUE(devices().empty());
    for (const char* word : words) EXPECT_NE(why_.find(word), std::string::npos) << why_;
    EXPECT_NE(why_.find("libegl1"), std::string::npos) << why_;
    EXPECT_EQ(why_.find('\n'), std::string::npos) << why_;
  }

  /// Expects a DeviceFailure that says `word`, from making a renderer or from rendering with it.
  void expect_failure(const char* word, const depth::GlDepthLimits& limits = {}, int face_size = 16) {
    std::string why;
    const GlDeviceInfo device = depth::gl_devices(why, real).front();
    const PreparedScene scene(SceneBuilder().ground("ground", 10).scene());
    const std::vector<Vec3> eyes(3, Vec3(0, 0, 1));
    std::size_t maps = 0;
    try {
      const auto renderer = depth::make_gl_depth_renderer(scene, device, limits, broken_);
      renderer->render({eyes, face_size, depth::Sampling::nearest, 100},
                       [&](std::size_t, std::span<const float>) { ++maps; });
      ADD_FAILURE() << "nothing failed";
    } catch (const DeviceFailure& failure) {
      EXPECT_NE(std::string(failure.what()).find(word), std::string::npos) << failure.what();
    }
    EXPECT_LT(maps, eyes.size());
  }

  std::shared_ptr<GlLibrary> broken_;
  std::string why_;
};

TEST(GlLibraries, MissingOnesSayWhatToInstall) {
  std::string why;
  EXPECT_EQ(depth::load_gl_library(why, "libnothing.so.1"), nullptr);
  testing::expect_wording(why);
  EXPECT_EQ(depth::load_gl_library(why, "libm.so.6"), nullptr);
  EXPECT_NE(why.find("libm.so.6"), std::string::npos) << why;
}

TEST_F(GlContexts, DevicesAreDescribed) {
  const std::vector<GlDeviceInfo> found = devices();
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(why_, "");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const RenderDevice& device = found[i].device;
    EXPECT_EQ(device.index, static_cast<int>(i));
    EXPECT_NE(device.kind, DeviceKind::cpu);
    EXPECT_NE(device.name, "");
    EXPECT_NE(device.driver, "");
    EXPECT_GE(device.largest_face_size, 16384);  // what OpenGL 4.5 promises
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(found[j].platform_device, found[i].platform_device);
  }
}

TEST_F(GlContexts, NoPlatform) {
  broken_->egl.QueryString = [](EGLDisplay, EGLint) -> const char* { return nullptr; };
  expect_none({"no device", "surfaceless"});
}

TEST_F(GlContexts, NoDeviceIsListed) {
  broken_->egl.QueryDevicesEXT = [](EGLint, EGLDeviceEXT*, EGLint* count) -> EGLBoolean {
    *count = 0;
    return EGL_TRUE;
  };
  broken_->egl.GetPlatformDisplayEXT = [](EGLenum, void*, const EGLint*) -> EGLDisplay { return EGL_NO_DISPLAY; };
  expect_none({"surfaceless", "no display"});
}

TEST_F(GlContexts, DisplayThatCannotBeInitialized) {
  broken_->egl.Initialize = [](EGLDisplay, EGLint*, EGLint*) -> EGLBoolean { return EGL_FALSE; };
  broken_->egl.GetError = []() -> EGLint { return EGL_NOT_INITIALIZED; };
  expect_none({"EGL_NOT_INITIALIZED", "/dev/dri"});
}

TEST_F(GlContexts, NoConfiguration) {
  broken_->egl.ChooseConfig = [](EGLDisplay, const EGLint*, EGLConfig*, EGLint, EGLint*) -> EGLBoolean {
    return EGL_FALSE;
  };
  broken_->egl.QueryString = [](EGLDisplay display, EGLint name) -> const char* {
    return display ? "" : real->egl.QueryString(display, name);
  };
  expect_none({"no configuration"});
}

TEST_F(GlContexts, NoContext) {
  broken_->egl.CreateContext = [](EGLDisplay, EGLConfig, EGLContext, const EGLint*) -> EGLContext { return nullptr; };
  broken_->egl.GetError = []() -> EGLint { return EGL_BAD_MATCH; };
  expect_none({"no OpenGL 4.5 context", "EGL_BAD_MATCH"});
}

TEST_F(GlContexts, OpenGlEsOnly) {
  broken_->egl.BindAPI = [](EGLenum) -> EGLBoolean { return EGL_FALSE; };
  expect_none({"OpenGL ES only"});
}

TEST_F(GlContexts, OldVersion) {
  broken_->gl.GetIntegerv = [](GLenum name, GLint* value) { *value = name == GL_MAJOR_VERSION ? 4 : 3; };
  expect_none({"4.3", "4.5"});
}

TEST_F(GlContexts, ContextThatCannotBeMadeCurrent) {
  broken_->egl.MakeCurrent = [](EGLDisplay, EGLSurface, EGLSurface, EGLContext) -> EGLBoolean { return EGL_FALSE; };
  broken_->egl.GetError = []() -> EGLint { return EGL_BAD_ACCESS; };
  EXPECT_TRUE(devices().empty());
  EXPECT_NE(why_.find("EGL_BAD_ACCESS"), std::string::npos) << why_;
}

TEST_F(GlContexts, ASurfaceIsMadeWhereOneIsNeeded) {
  broken_->egl.QueryString = [](EGLDisplay display, EGLint name) -> const char* {
    return display ? "" : real->egl.QueryString(display, name);
  };
  EXPECT_FALSE(devices().empty()) << why_;
  broken_->egl.CreatePbufferSurface = [](EGLDisplay, EGLConfig, const EGLint*) -> EGLSurface { return nullptr; };
  broken_->egl.GetError = []() -> EGLint { return EGL_BAD_ALLOC; };
  expect_none({"no surface", "EGL_BAD_ALLOC"});
}

TEST_F(GlContexts, TheSurfacelessPlatformServesWithoutDevices) {
  broken_->egl.QueryString = [](EGLDisplay display, EGLint name) -> const char* {
    return display ? real->egl.QueryString(display, name) : "EGL_EXT_client_extensions EGL_MESA_platform_surfaceless";
  };
  if (!std::strstr(real->egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
    GTEST_SKIP() << "this driver has no surfaceless platform";
  }
  const std::vector<GlDeviceInfo> found = devices();
  ASSERT_EQ(found.size(), 1U) << why_;
  EXPECT_EQ(found[0].platform_device, GlDeviceInfo::kSurfaceless);
}

TEST_F(GlContexts, ADeviceIsListedOnce) {
  broken_->egl.QueryDevicesEXT = [](EGLint most, EGLDeviceEXT* list, EGLint* count) -> EGLBoolean {
    *count = 3;
    for (int i = 0; i < std::min(most, 3); ++i) {
      EGLint one = 0;
      real->egl.QueryDevicesEXT(1, list + i, &one);
    }
    return EGL_TRUE;
  };
  broken_->gl.GetString = [](GLenum name) -> const GLubyte* {
    return reinterpret_cast<const GLubyte*>(name == GL_RENDERER ? "llvmpipe" : "4.5");
  };
  EXPECT_EQ(devices().size(), 1U) << why_;
}

TEST_F(GlContexts, GraphicsProcessorsOfOneKindAreSeveral) {
  broken_->egl.QueryDevicesEXT = [](EGLint most, EGLDeviceEXT* list, EGLint* count) -> EGLBoolean {
    *count = 2;
    for (int i = 0; i < std::min(most, 2); ++i) {
      EGLint one = 0;
      real->egl.QueryDevicesEXT(1, list + i, &one);
    }
    return EGL_TRUE;
  };
  broken_->egl.QueryDeviceStringEXT = [](EGLDeviceEXT, EGLint) -> const char* { return ""; };
  broken_->gl.GetString = [](GLenum name) -> const GLubyte* {
    return reinterpret_cast<const GLubyte*>(name == GL_RENDERER ? "Quick 9000" : "4.6");
  };
  broken_->gl.GetStringi = [](GLenum, GLuint) -> const GLubyte* {
    return reinterpret_cast<const GLubyte*>("GL_NVX_gpu_memory_info");
  };
  broken_->gl.GetIntegerv = [](GLenum name, GLint* value) {
    if (name == 0x9047) {
      *value = 2048;  // KiB
    } else {
      real->gl.GetIntegerv(name, value);
    }
  };
  const std::vector<GlDeviceInfo> found = devices();
  ASSERT_EQ(found.size(), 2U) << why_;
  EXPECT_EQ(found[1].device.index, 1);
  EXPECT_EQ(found[1].device.kind, DeviceKind::opengl_hardware);
  EXPECT_EQ(found[1].device.memory_bytes, static_cast<std::size_t>(2) << 20);
  // The same file of the kernel: the same processor.
  broken_->egl.QueryDeviceStringEXT = [](EGLDeviceEXT, EGLint name) -> const char* {
    return name == EGL_EXTENSIONS ? "EGL_EXT_device_drm" : "/dev/dri/card0";
  };
  EXPECT_EQ(devices().size(), 1U) << why_;
}

TEST_F(GlContexts, ADeviceThatIsNotThere) {
  GlDeviceInfo info;
  info.platform_device = 1000;
  EXPECT_THROW(GlContext(info, real), DeviceFailure);
}

TEST_F(GlContexts, WhatWasCurrentIsCurrentAgain) {
  const GlDeviceInfo info = devices().front();
  const GlContext outer(info, real), inner(info, real);
  EXPECT_EQ(real->egl.GetCurrentContext(), EGL_NO_CONTEXT);
  {
    const GlCurrent first(outer);
    const EGLContext context = real->egl.GetCurrentContext();
    EXPECT_NE(context, EGL_NO_CONTEXT);
    {
      const GlCurrent second(inner);
      EXPECT_NE(real->egl.GetCurrentContext(), context);
    }
    EXPECT_EQ(real->egl.GetCurrentContext(), context);
  }
  EXPECT_EQ(real->egl.GetCurrentContext(), EGL_NO_CONTEXT);
}

TEST_F(GlContexts, ARendererWorksOnAnyThread) {
  const PreparedScene scene(SceneBuilder().ground("ground", 10).scene());
  const auto renderer = depth::make_gl_depth_renderer(scene, devices().front());
  const Vec3 eye(0, 0, 2);
  float down = 0;
  std::thread([&] {
    renderer->render({std::span(&eye, 1), 3, depth::Sampling::centers, 100},
                     [&](std::size_t, std::span<const float> depths) { down = depths[5 * 9 + 4]; });
  }).join();
  EXPECT_NEAR(down, 0.5, 1e-6);
}

TEST_F(GlContexts, LostWhileWaiting) {
  broken_->gl.GetGraphicsResetStatus = []() -> GLenum { return ++calls < 15 ? GL_NO_ERROR : GL_GUILTY_CONTEXT_RESET; };
  expect_failure("was lost while");
}

TEST_F(GlContexts, OutOfMemory) {
  broken_->gl.TextureStorage3D = [](GLenum, GLsizei, GLenum, GLsizei, GLsizei, GLsizei) { calls = 1; };
  broken_->gl.GetError = []() -> GLenum { return std::exchange(calls, 0) == 1 ? GL_OUT_OF_MEMORY : GL_NO_ERROR; };
  expect_failure("ran out of memory while setting aside");
}

TEST_F(GlContexts, WrongCallsAreNoticed) {
  broken_->gl.TextureStorage3D = [](GLenum, GLsizei, GLenum, GLsizei, GLsizei, GLsizei) {
    real->gl.Enable(GL_TEXTURE_2D_ARRAY);
  };
  expect_failure("GL_INVALID_ENUM");
}

TEST_F(GlContexts, ShadersThatDoNotCompile) {
  broken_->gl.ShaderSource = [](GLuint shader, GLsizei, const GLchar* const*, const GLint*) {
    const char* text = "#version 450 core\nvoid main() { no; }";
    real->gl.ShaderSource(shader, 1, &text, nullptr);
  };
  expect_failure("does not compile");
}

TEST_F(GlContexts, ImagesThatCannotBeRead) {
  broken_->gl.MapNamedBufferRange = [](GLuint, GLintptr, GLsizeiptr, GLbitfield) -> void* { return nullptr; };
  expect_failure("does not let its depth images be read");
}

TEST_F(GlContexts, ImagesThatAreLostWhileRead) {
  broken_->gl.UnmapNamedBuffer = [](GLuint buffer) -> GLboolean {
    real->gl.UnmapNamedBuffer(buffer);
    return GL_FALSE;
  };
  expect_failure("lost its depth images");
}

TEST_F(GlContexts, ADeviceThatNeverEnds) {
  broken_->gl.ClientWaitSync = [](GLsync, GLbitfield, GLuint64) -> GLenum { return GL_TIMEOUT_EXPIRED; };
  expect_failure("did not finish");
}

TEST_F(GlContexts, ASceneThatDoesNotFit) {
  expect_failure("cannot hold the scene: 2 triangles need", {.device_bytes = 100});
}

TEST_F(GlContexts, AFaceThatDoesNotFit) {
  expect_failure("cannot hold a face of 512 texels a side: it needs 3 MiB", {.image_bytes = 1 << 20}, 512);
  expect_failure("cannot hold a face of 512 texels", {.device_bytes = 1 << 20}, 512);
}

}  // namespace
}  // namespace vantage::testing
