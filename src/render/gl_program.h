// Shaders to programs.
#pragma once

#include <string>

#include "render/gl_context.h"
#include "render/gl_library.h"

namespace vantage::render {

/// A program that ends with the context. `geometry` may be null. Throws DeviceFailure with what the driver's compiler
/// says; `name` is for that message. The context must be current.
GLuint make_program(const GlContext& context, const std::string& name, const char* vertex, const char* geometry,
                    const char* fragment);

}  // namespace vantage::render
