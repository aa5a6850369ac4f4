#include "depth/gl_objects.h"

#include "depth/depth.h"

namespace vantage::internal::depth {

GlObjects::~GlObjects() {
  for (const GLuint program : programs_) gl_.DeleteProgram(program);
  gl_.DeleteFramebuffers(static_cast<GLsizei>(framebuffers_.size()), framebuffers_.data());
  gl_.DeleteVertexArrays(static_cast<GLsizei>(arrays_.size()), arrays_.data());
  gl_.DeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  gl_.DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  gl_.DeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

GLuint GlObjects::texture(GLenum format, int width, int height) {
  GLuint name = 0;
  gl_.CreateTextures(GL_TEXTURE_2D, 1, &name);
  textures_.push_back(name);
  gl_.TextureStorage2D(name, 1, format, width, height);
  gl_.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return name;
}

GLuint GlObjects::shadow_maps(int size, int count) {
  GLuint name = 0;
  gl_.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  textures_.push_back(name);
  gl_.TextureStorage3D(name, 1, GL_DEPTH_COMPONENT32F, size, size, count);
  gl_.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TextureParameteri(name, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TextureParameteri(name, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
  return name;
}

GLuint GlObjects::buffer(const void* data, std::size_t bytes, GLenum usage) {
  GLuint name = 0;
  gl_.CreateBuffers(1, &name);
  buffers_.push_back(name);
  gl_.NamedBufferData(name, static_cast<GLsizeiptr>(bytes), data, usage);
  return name;
}

GLuint GlObjects::vertex_array() {
  GLuint name = 0;
  gl_.CreateVertexArrays(1, &name);
  arrays_.push_back(name);
  return name;
}

GLuint GlObjects::query() {
  GLuint name = 0;
  gl_.CreateQueries(GL_ANY_SAMPLES_PASSED, 1, &name);
  queries_.push_back(name);
  return name;
}

GLuint GlObjects::framebuffer() {
  GLuint name = 0;
  gl_.CreateFramebuffers(1, &name);
  framebuffers_.push_back(name);
  return name;
}

GLuint GlObjects::framebuffer(const std::vector<GLuint>& colours, GLuint depth) {
  const GLuint name = framebuffer();
  std::vector<GLenum> buffers;
  for (const GLuint colour : colours) {
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
    gl_.NamedFramebufferTexture(name, buffers.back(), colour, 0);
  }
  gl_.NamedFramebufferDrawBuffers(name, static_cast<GLsizei>(buffers.size()), buffers.data());
  if (depth != 0) gl_.NamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth, 0);
  if (gl_.CheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw DeviceFailure("the device refuses to draw into an image that a picture needs");
  }
  return name;
}

GLuint GlObjects::program(const std::string& name, const ShaderSources& sources) {
  programs_.push_back(make_program(context_, name, sources));
  return programs_.back();
}

}  // namespace vantage::internal::depth
