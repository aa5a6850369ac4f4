#include "depth/gl_program.h"

#include <array>

#include "depth/depth.h"

namespace vantage::internal::depth {
namespace {

GLuint compile(const GlContext& context, const std::string& name, GLenum stage, const char* header,
               const char* source) {
  const GlFunctions& gl = context.gl();
  const GLuint shader = gl.CreateShader(stage);
  const std::array<const char*, 2> parts{header, source};
  gl.ShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  gl.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  context.check("compiling the shaders of " + name);
  if (compiled == GL_TRUE) return shader;
  std::array<GLchar, 1024> log{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw DeviceFailure(context.device().name + " does not compile the shaders of " + name + ": " + log.data());
}

}  // namespace

GLuint make_program(const GlContext& context, const std::string& name, const ShaderSources& sources) {
  const GlFunctions& gl = context.gl();
  const GLuint program = gl.CreateProgram();
  const std::array<std::pair<GLenum, const char*>, 3> stages{{{GL_VERTEX_SHADER, sources.vertex},
                                                              {GL_GEOMETRY_SHADER, sources.geometry},
                                                              {GL_FRAGMENT_SHADER, sources.fragment}}};
  for (const auto& [stage, source] : stages) {
    if (!source) continue;
    const GLuint shader = compile(context, name, stage, sources.header, source);
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // goes with the program
  }
  gl.LinkProgram(program);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  context.check("linking the shaders of " + name);
  if (linked == GL_TRUE) return program;
  std::array<GLchar, 1024> log{};
  gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw DeviceFailure(context.device().name + " does not link the shaders of " + name + ": " + log.data());
}

}  // namespace vantage::internal::depth
