// The functions of EGL and OpenGL that are used, found at run time: nothing is linked, so that the program starts where
// no OpenGL is installed.
#pragma once

#define EGL_EGL_PROTOTYPES 0  // a call that is not through the table must not compile
#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <memory>
#include <string>

namespace vantage::internal::depth {

// EGL 1.4, and what its extensions add (may be null).
#define VANTAGE_EGL_FUNCTIONS(X)                \
  X(BINDAPI, BindAPI)                           \
  X(CHOOSECONFIG, ChooseConfig)                 \
  X(CREATECONTEXT, CreateContext)               \
  X(CREATEPBUFFERSURFACE, CreatePbufferSurface) \
  X(DESTROYCONTEXT, DestroyContext)             \
  X(DESTROYSURFACE, DestroySurface)             \
  X(GETCURRENTCONTEXT, GetCurrentContext)       \
  X(GETCURRENTDISPLAY, GetCurrentDisplay)       \
  X(GETCURRENTSURFACE, GetCurrentSurface)       \
  X(GETERROR, GetError)                         \
  X(GETPROCADDRESS, GetProcAddress)             \
  X(INITIALIZE, Initialize)                     \
  X(MAKECURRENT, MakeCurrent)                   \
  X(QUERYAPI, QueryAPI)                         \
  X(QUERYSTRING, QueryString)

#define VANTAGE_EGL_EXTENSION_FUNCTIONS(X)        \
  X(GETPLATFORMDISPLAYEXT, GetPlatformDisplayEXT) \
  X(QUERYDEVICESEXT, QueryDevicesEXT)             \
  X(QUERYDEVICESTRINGEXT, QueryDeviceStringEXT)

// OpenGL 4.5 core.
#define VANTAGE_GL_FUNCTIONS(X)                                 \
  X(ATTACHSHADER, AttachShader)                                 \
  X(BEGINQUERY, BeginQuery)                                     \
  X(BINDBUFFER, BindBuffer)                                     \
  X(BINDBUFFERBASE, BindBufferBase)                             \
  X(BINDFRAMEBUFFER, BindFramebuffer)                           \
  X(BINDTEXTUREUNIT, BindTextureUnit)                           \
  X(BINDVERTEXARRAY, BindVertexArray)                           \
  X(BLENDFUNC, BlendFunc)                                       \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate)                       \
  X(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus)   \
  X(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv)           \
  X(CLIENTWAITSYNC, ClientWaitSync)                             \
  X(CLIPCONTROL, ClipControl)                                   \
  X(COMPILESHADER, CompileShader)                               \
  X(CREATEBUFFERS, CreateBuffers)                               \
  X(CREATEFRAMEBUFFERS, CreateFramebuffers)                     \
  X(CREATEPROGRAM, CreateProgram)                               \
  X(CREATEQUERIES, CreateQueries)                               \
  X(CREATESHADER, CreateShader)                                 \
  X(CREATETEXTURES, CreateTextures)                             \
  X(CREATEVERTEXARRAYS, CreateVertexArrays)                     \
  X(DEBUGMESSAGECONTROL, DebugMessageControl)                   \
  X(DELETEBUFFERS, DeleteBuffers)                               \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers)                     \
  X(DELETEPROGRAM, DeleteProgram)                               \
  X(DELETEQUERIES, DeleteQueries)                               \
  X(DELETESHADER, DeleteShader)                                 \
  X(DELETESYNC, DeleteSync)                                     \
  X(DELETETEXTURES, DeleteTextures)                             \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays)                     \
  X(DEPTHFUNC, DepthFunc)                                       \
  X(DISABLE, Disable)                                           \
  X(DRAWARRAYS, DrawArrays)                                     \
  X(ENABLE, Enable)                                             \
  X(ENABLEVERTEXARRAYATTRIB, EnableVertexArrayAttrib)           \
  X(ENDQUERY, EndQuery)                                         \
  X(FENCESYNC, FenceSync)                                       \
  X(FLUSH, Flush)                                               \
  X(GETDEBUGMESSAGELOG, GetDebugMessageLog)                     \
  X(GETERROR, GetError)                                         \
  X(GETGRAPHICSRESETSTATUS, GetGraphicsResetStatus)             \
  X(GETINTEGERV, GetIntegerv)                                   \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog)                       \
  X(GETPROGRAMIV, GetProgramiv)                                 \
  X(GETQUERYOBJECTUIV, GetQueryObjectuiv)                       \
  X(GETSHADERINFOLOG, GetShaderInfoLog)                         \
  X(GETSHADERIV, GetShaderiv)                                   \
  X(GETSTRING, GetString)                                       \
  X(GETSTRINGI, GetStringi)                                     \
  X(GETTEXTUREIMAGE, GetTextureImage)                           \
  X(GETUNIFORMLOCATION, GetUniformLocation)                     \
  X(LINKPROGRAM, LinkProgram)                                   \
  X(MAPNAMEDBUFFERRANGE, MapNamedBufferRange)                   \
  X(MULTIDRAWELEMENTSINDIRECT, MultiDrawElementsIndirect)       \
  X(NAMEDBUFFERDATA, NamedBufferData)                           \
  X(NAMEDBUFFERSTORAGE, NamedBufferStorage)                     \
  X(NAMEDBUFFERSUBDATA, NamedBufferSubData)                     \
  X(NAMEDFRAMEBUFFERDRAWBUFFER, NamedFramebufferDrawBuffer)     \
  X(NAMEDFRAMEBUFFERDRAWBUFFERS, NamedFramebufferDrawBuffers)   \
  X(NAMEDFRAMEBUFFERREADBUFFER, NamedFramebufferReadBuffer)     \
  X(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture)           \
  X(NAMEDFRAMEBUFFERTEXTURELAYER, NamedFramebufferTextureLayer) \
  X(PIXELSTOREI, PixelStorei)                                   \
  X(PROGRAMUNIFORM1F, ProgramUniform1f)                         \
  X(PROGRAMUNIFORM1I, ProgramUniform1i)                         \
  X(PROGRAMUNIFORM3D, ProgramUniform3d)                         \
  X(PROGRAMUNIFORMMATRIX3FV, ProgramUniformMatrix3fv)           \
  X(SHADERSOURCE, ShaderSource)                                 \
  X(TEXTUREPARAMETERI, TextureParameteri)                       \
  X(TEXTURESTORAGE2D, TextureStorage2D)                         \
  X(TEXTURESTORAGE3D, TextureStorage3D)                         \
  X(UNMAPNAMEDBUFFER, UnmapNamedBuffer)                         \
  X(USEPROGRAM, UseProgram)                                     \
  X(VERTEXARRAYATTRIBBINDING, VertexArrayAttribBinding)         \
  X(VERTEXARRAYATTRIBFORMAT, VertexArrayAttribFormat)           \
  X(VERTEXARRAYATTRIBIFORMAT, VertexArrayAttribIFormat)         \
  X(VERTEXARRAYATTRIBLFORMAT, VertexArrayAttribLFormat)         \
  X(VERTEXARRAYBINDINGDIVISOR, VertexArrayBindingDivisor)       \
  X(VERTEXARRAYELEMENTBUFFER, VertexArrayElementBuffer)         \
  X(VERTEXARRAYVERTEXBUFFER, VertexArrayVertexBuffer)           \
  X(VIEWPORT, Viewport)

struct EglFunctions {
#define VANTAGE_MEMBER(type, name) PFNEGL##type##PROC name = nullptr;
  VANTAGE_EGL_FUNCTIONS(VANTAGE_MEMBER)
  VANTAGE_EGL_EXTENSION_FUNCTIONS(VANTAGE_MEMBER)
#undef VANTAGE_MEMBER
};

/// Only valid while a context is current.
struct GlFunctions {
#define VANTAGE_MEMBER(type, name) PFNGL##type##PROC name = nullptr;
  VANTAGE_GL_FUNCTIONS(VANTAGE_MEMBER)
#undef VANTAGE_MEMBER
};

/// A plain table: a test copies it and puts functions that fail in place of some.
struct GlLibrary {
  EglFunctions egl;
  GlFunctions gl;
};

/// Loads EGL, and through it OpenGL. Null when there is none or it lacks a function; `why_not` then is a sentence with
/// what to install. The library stays loaded until the program ends: drivers leave threads and exit handlers behind.
std::shared_ptr<const GlLibrary> load_gl_library(std::string& why_not, const char* file = "libEGL.so.1");

}  // namespace vantage::internal::depth
