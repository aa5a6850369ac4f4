// OpenGL objects that end with the scope they were made in.
#pragma once

#include <string>
#include <vector>

#include "depth/gl_context.h"
#include "depth/gl_library.h"
#include "depth/gl_program.h"
#include "vantage/export.h"

namespace vantage::internal::depth {

/// Makes objects of a context, which must be current; its end deletes them all. Throws DeviceFailure for a program that
/// does not build or a framebuffer that the device refuses.
class GlObjects {
 public:
  explicit GlObjects(const GlContext& context) : context_(context), gl_(context.gl()) {}
  ~GlObjects();
  GlObjects(const GlObjects&) = delete;
  GlObjects& operator=(const GlObjects&) = delete;

  GLuint texture(GLenum format, int width, int height);
  /// A stack of depth images that a sampler compares with, smoothly.
  GLuint shadow_maps(int size, int count);
  GLuint buffer(const void* data, std::size_t bytes, GLenum usage);
  GLuint vertex_array();
  GLuint query();
  GLuint framebuffer();
  /// A framebuffer with whole textures; `depth` may be 0.
  GLuint framebuffer(const std::vector<GLuint>& colours, GLuint depth);
  /// `name` is for messages.
  GLuint program(const std::string& name, const ShaderSources& sources);

 private:
  const GlContext& context_;
  const GlFunctions& gl_;
  std::vector<GLuint> textures_, buffers_, arrays_, framebuffers_, programs_, queries_;
};

}  // namespace vantage::internal::depth
