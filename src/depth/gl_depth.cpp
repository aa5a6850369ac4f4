#include "depth/gl_depth.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>
#include <vector>

#include "depth/depth_request.h"
#include "depth/gl_clusters.h"
#include "depth/gl_library.h"
#include "depth/gl_program.h"
#include "depth/gl_shaders.h"
#include "scene/prepared_data.h"

namespace vantage::internal::depth {
namespace {

constexpr int kPatienceSeconds = 300;       // for the images of one pass
constexpr std::size_t kTexelBytes = 4;      // 32-bit float
constexpr std::size_t kCopiesOnDevice = 3;  // the image, and two copies on their way

std::string mib(std::size_t bytes) { return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB"; }

class GlDepthRenderer : public DepthRenderer {
 public:
  GlDepthRenderer(const PreparedScene& scene, const GlDeviceInfo& info, const GlDepthLimits& limits,
                  std::shared_ptr<const GlLibrary> library);
  const RenderDevice& device() const override { return device_; }
  void render(const DepthRequest& request, const DepthSink& sink) override;

 private:
  /// Some of a cube map's faces, on their way from the device.
  struct Pass {
    std::size_t viewpoint = 0;
    int first_face = 0, faces = 0;
    int slot = 0;
  };
  struct Slot {
    GLuint buffer = 0;
    GLsync fence = nullptr;
  };
  struct Program {
    GLuint id = 0;
    GLint eye = -1, first_face = -1, face_size = -1;
  };

  std::size_t device_limit() const;
  void upload(const PreparedScene::Data& data);
  Program build(const char* name, const ShaderSources& sources);
  void prepare_images(int face_size);
  void release_images();
  void submit(const DepthRequest& request, const Pass& pass);
  void collect(const Pass& pass, std::span<float> depths);
  void wait(Slot& slot);

  GlDepthLimits limits_;
  GlContext context_;
  RenderDevice device_;
  Vec3 origin_ = Vec3::Zero();
  std::vector<TriangleCluster> clusters_;
  std::size_t scene_bytes_ = 0;
  GLuint vertex_array_ = 0, command_buffer_ = 0;
  Program centers_, nearest_;

  int face_size_ = 0, faces_at_once_ = 0;
  GLuint image_ = 0, framebuffer_ = 0;
  std::array<Slot, 2> slots_;
  std::vector<DrawCommand> commands_;
};

GlDepthRenderer::GlDepthRenderer(const PreparedScene& scene, const GlDeviceInfo& info, const GlDepthLimits& limits,
                                 std::shared_ptr<const GlLibrary> library)
    : limits_(limits), context_(info, std::move(library)), device_(info.device) {
  origin_ = scene.data().origin;
  const GlCurrent current(context_);
  const GlFunctions& gl = context_.gl();
  gl.Enable(GL_DEBUG_OUTPUT);
  gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
  gl.DebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  upload(scene.data());
  centers_ = build("depth at centres", centers_shaders());
  nearest_ = build("nearest depth", nearest_shaders());
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_GREATER);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
  context_.check("preparing to draw");
}

std::size_t GlDepthRenderer::device_limit() const {
  return limits_.device_bytes > 0 ? limits_.device_bytes : device_.memory_bytes / 10 * 9;
}

void GlDepthRenderer::upload(const PreparedScene::Data& data) {
  ClusteredTriangles triangles = cluster_triangles(data);
  clusters_ = std::move(triangles.clusters);
  const std::size_t vertex_bytes = sizeof(Vec3) * data.vertices.size();
  const std::size_t index_bytes = sizeof(std::uint32_t) * triangles.indices.size();
  scene_bytes_ = vertex_bytes + index_bytes + 6 * sizeof(DrawCommand) * clusters_.size();
  if (device_limit() > 0 && scene_bytes_ > device_limit()) {
    throw DeviceFailure(device_.name + " cannot hold the scene: " + std::to_string(triangles.indices.size() / 3) +
                        " triangles need " + mib(scene_bytes_) + " of its memory, and " + mib(device_limit()) +
                        " may be used");
  }
  const GlFunctions& gl = context_.gl();
  std::array<GLuint, 3> buffers{};
  gl.CreateBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  // A buffer of no bytes is an error.
  const auto fill = [&](GLuint buffer, std::size_t bytes, const void* content) {
    gl.NamedBufferStorage(buffer, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 1)),
                          bytes > 0 ? content : nullptr, 0);
  };
  constexpr std::array<std::uint32_t, 6> faces{0, 1, 2, 3, 4, 5};
  fill(buffers[0], vertex_bytes, data.vertices.data());
  fill(buffers[1], index_bytes, triangles.indices.data());
  fill(buffers[2], sizeof(faces), faces.data());
  gl.CreateBuffers(1, &command_buffer_);
  gl.CreateVertexArrays(1, &vertex_array_);
  gl.VertexArrayVertexBuffer(vertex_array_, 0, buffers[0], 0, sizeof(Vec3));
  gl.VertexArrayElementBuffer(vertex_array_, buffers[1]);
  gl.EnableVertexArrayAttrib(vertex_array_, 0);
  gl.VertexArrayAttribLFormat(vertex_array_, 0, 3, GL_DOUBLE, 0);
  gl.VertexArrayAttribBinding(vertex_array_, 0, 0);
  gl.VertexArrayVertexBuffer(vertex_array_, 1, buffers[2], 0, sizeof(std::uint32_t));
  gl.EnableVertexArrayAttrib(vertex_array_, 2);
  gl.VertexArrayAttribIFormat(vertex_array_, 2, 1, GL_UNSIGNED_INT, 0);
  gl.VertexArrayAttribBinding(vertex_array_, 2, 1);
  gl.VertexArrayBindingDivisor(vertex_array_, 1, 1);
  context_.check("uploading a scene of " + mib(scene_bytes_));
}

GlDepthRenderer::Program GlDepthRenderer::build(const char* name, const ShaderSources& sources) {
  const GlFunctions& gl = context_.gl();
  Program program;
  program.id = make_program(context_, name, sources);
  program.eye = gl.GetUniformLocation(program.id, "eye");
  program.first_face = gl.GetUniformLocation(program.id, "first_face");
  program.face_size = gl.GetUniformLocation(program.id, "face_size");
  std::array<float, 54> axes{};
  for (std::size_t face = 0; face < 6; ++face) {
    const CubeFace& cube_face = cube_faces()[face];
    const std::array<const Vec3*, 3> rows{&cube_face.right, &cube_face.up, &cube_face.forward};
    for (std::size_t row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        axes[9 * face + 3 * row + column] = static_cast<float>((*rows[row])[column]);
    }
  }
  gl.ProgramUniformMatrix3fv(program.id, gl.GetUniformLocation(program.id, "faces"), 6, GL_TRUE, axes.data());
  context_.check("setting up the shaders");
  return program;
}

void GlDepthRenderer::release_images() {
  const GlFunctions& gl = context_.gl();
  for (Slot& slot : slots_) {
    if (slot.fence) gl.DeleteSync(slot.fence);
    gl.DeleteBuffers(1, &slot.buffer);
    slot = {};
  }
  gl.DeleteFramebuffers(1, &framebuffer_);
  gl.DeleteTextures(1, &image_);
  framebuffer_ = image_ = 0;
  face_size_ = 0;
}

void GlDepthRenderer::prepare_images(int face_size) {
  if (face_size == face_size_) return;
  release_images();
  const std::size_t face_bytes = kTexelBytes * face_size * face_size;
  std::size_t allowed = limits_.image_bytes;
  if (device_limit() > 0) allowed = std::min(allowed, device_limit() - std::min(device_limit(), scene_bytes_));
  faces_at_once_ = 6;
  while (faces_at_once_ > 1 && kCopiesOnDevice * faces_at_once_ * face_bytes > allowed) {
    faces_at_once_ = faces_at_once_ == 6 ? 3 : faces_at_once_ - 1;
  }
  const std::size_t pass_bytes = faces_at_once_ * face_bytes;
  if (kCopiesOnDevice * pass_bytes > allowed) {
    throw DeviceFailure(device_.name + " cannot hold a face of " + std::to_string(face_size) +
                        " texels a side: it needs " + mib(kCopiesOnDevice * pass_bytes) + " of its memory, and " +
                        mib(allowed) + " may be used");
  }
  const GlFunctions& gl = context_.gl();
  gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &image_);
  gl.TextureStorage3D(image_, 1, GL_DEPTH_COMPONENT32F, face_size, face_size, faces_at_once_);
  gl.CreateFramebuffers(1, &framebuffer_);
  gl.NamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, image_, 0);
  gl.NamedFramebufferDrawBuffer(framebuffer_, GL_NONE);
  gl.NamedFramebufferReadBuffer(framebuffer_, GL_NONE);
  for (Slot& slot : slots_) {
    gl.CreateBuffers(1, &slot.buffer);
    gl.NamedBufferStorage(slot.buffer, static_cast<GLsizeiptr>(pass_bytes), nullptr,
                          GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
  }
  context_.check("setting aside " + mib(kCopiesOnDevice * pass_bytes) + " for images");
  if (gl.CheckNamedFramebufferStatus(framebuffer_, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw DeviceFailure(device_.name + " does not draw 32-bit float depth in layers");
  }
  face_size_ = face_size;
}

void GlDepthRenderer::submit(const DepthRequest& request, const Pass& pass) {
  const GlFunctions& gl = context_.gl();
  const Vec3 eye = request.viewpoints[pass.viewpoint] - origin_;
  commands_.clear();
  for (int face = pass.first_face; face < pass.first_face + pass.faces; ++face) {
    append_commands(clusters_, eye, request.range_m, face, commands_);
  }
  constexpr float kNothing = 0;
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  gl.ClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &kNothing);
  if (!commands_.empty()) {
    const Program& program = request.sampling == Sampling::centers ? centers_ : nearest_;
    gl.Viewport(0, 0, face_size_, face_size_);
    gl.UseProgram(program.id);
    gl.ProgramUniform3d(program.id, program.eye, eye.x(), eye.y(), eye.z());
    gl.ProgramUniform1i(program.id, program.first_face, pass.first_face);
    gl.ProgramUniform1f(program.id, program.face_size, static_cast<float>(face_size_));
    gl.NamedBufferData(command_buffer_, static_cast<GLsizeiptr>(sizeof(DrawCommand) * commands_.size()),
                       commands_.data(), GL_STREAM_DRAW);
    gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, command_buffer_);
    gl.BindVertexArray(vertex_array_);
    gl.MultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(commands_.size()), 0);
  }
  Slot& slot = slots_[pass.slot];
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer);
  const std::size_t bytes = kTexelBytes * face_size_ * face_size_ * pass.faces;
  gl.GetTextureImage(image_, 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(bytes), nullptr);
  slot.fence = gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.Flush();
  context_.check("drawing depth images");
}

void GlDepthRenderer::wait(Slot& slot) {
  const GlFunctions& gl = context_.gl();
  for (int second = 0; second < kPatienceSeconds; ++second) {
    const GLenum state = gl.ClientWaitSync(slot.fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1'000'000'000);
    context_.check("waiting for depth images");
    if (state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) {
      gl.DeleteSync(std::exchange(slot.fence, nullptr));
      return;
    }
  }
  throw DeviceFailure(device_.name + " did not finish its depth images within " + std::to_string(kPatienceSeconds) +
                      " seconds");
}

void GlDepthRenderer::collect(const Pass& pass, std::span<float> depths) {
  const GlFunctions& gl = context_.gl();
  Slot& slot = slots_[pass.slot];
  wait(slot);
  const std::size_t face = static_cast<std::size_t>(face_size_) * face_size_, count = face * pass.faces;
  const auto* const mapped = static_cast<const float*>(
      gl.MapNamedBufferRange(slot.buffer, 0, static_cast<GLsizeiptr>(kTexelBytes * count), GL_MAP_READ_BIT));
  context_.check("reading depth images back");
  if (!mapped) throw DeviceFailure(device_.name + " does not let its depth images be read");
  constexpr float scale = static_cast<float>(1 / kDepthScale);
  std::transform(mapped, mapped + count, depths.data() + face * pass.first_face,
                 [](float depth) { return depth * scale; });
  if (gl.UnmapNamedBuffer(slot.buffer) != GL_TRUE) {
    context_.check("reading depth images back");
    throw DeviceFailure(device_.name + " lost its depth images while they were read");
  }
}

void GlDepthRenderer::render(const DepthRequest& request, const DepthSink& sink) {
  check_request(request, device_);
  if (request.viewpoints.empty()) return;
  const GlCurrent current(context_);
  const GlFunctions& gl = context_.gl();
  prepare_images(request.face_size);
  for (Slot& slot : slots_) {  // a sink that threw leaves images behind
    if (slot.fence) gl.DeleteSync(std::exchange(slot.fence, nullptr));
  }
  std::vector<float> depths(6 * static_cast<std::size_t>(face_size_) * face_size_);
  const int passes = 6 / faces_at_once_;
  const std::size_t total = request.viewpoints.size() * passes;
  const auto pass_of = [&](std::size_t i) {
    return Pass{i / passes, static_cast<int>(i % passes) * faces_at_once_, faces_at_once_, static_cast<int>(i % 2)};
  };
  for (std::size_t i = 0; i <= total; ++i) {
    if (i < total) submit(request, pass_of(i));
    if (i == 0) continue;
    const Pass ready = pass_of(i - 1);
    collect(ready, depths);
    if (ready.first_face + ready.faces == 6) sink(ready.viewpoint, depths);
  }
}

}  // namespace

std::unique_ptr<DepthRenderer> make_gl_depth_renderer(const PreparedScene& scene, const GlDeviceInfo& device) {
  return make_gl_depth_renderer(scene, device, GlDepthLimits{});
}

std::unique_ptr<DepthRenderer> make_gl_depth_renderer(const PreparedScene& scene, const GlDeviceInfo& device,
                                                      const GlDepthLimits& limits,
                                                      std::shared_ptr<const GlLibrary> library) {
  std::string why_not;
  if (!library) library = load_gl_library(why_not);
  if (!library) throw DeviceFailure(why_not);
  return std::make_unique<GlDepthRenderer>(scene, device, limits, std::move(library));
}

}  // namespace vantage::internal::depth
