// Shaders to programs.
#pragma once

#include <string>

#include "depth/gl_context.h"
#include "depth/gl_library.h"

namespace vantage::internal::depth {

/// GLSL of a program's stages.
struct ShaderSources {
  const char* vertex;
  const char* geometry;  ///< null: none
  const char* fragment;
  const char* header = "";  ///< put in front of each of them
};

/// A program that ends with the context. Throws DeviceFailure with what the driver's compiler says; `name` is for that
/// message. The context must be current.
GLuint make_program(const GlContext& context, const std::string& name, const ShaderSources& sources);

}  // namespace vantage::internal::depth
