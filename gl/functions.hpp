// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GL/glcorearb.h>

namespace tessera::gl {

// The functions of OpenGL 4.5 core used here, each with its type from Khronos' glcorearb.h.
#define TESSERA_GL_FUNCTIONS(X)                                        \
  X(PFNGLATTACHSHADERPROC, AttachShader)                               \
  X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                           \
  X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                         \
  X(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)                         \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                         \
  X(PFNGLBLENDFUNCPROC, BlendFunc)                                     \
  X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, CheckNamedFramebufferStatus) \
  X(PFNGLCLEARNAMEDBUFFERSUBDATAPROC, ClearNamedBufferSubData)         \
  X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv)         \
  X(PFNGLCLIENTWAITSYNCPROC, ClientWaitSync)                           \
  X(PFNGLCOMPILESHADERPROC, CompileShader)                             \
  X(PFNGLCOPYNAMEDBUFFERSUBDATAPROC, CopyNamedBufferSubData)           \
  X(PFNGLCREATEBUFFERSPROC, CreateBuffers)                             \
  X(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers)                   \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram)                             \
  X(PFNGLCREATEQUERIESPROC, CreateQueries)                             \
  X(PFNGLCREATESHADERPROC, CreateShader)                               \
  X(PFNGLCREATETEXTURESPROC, CreateTextures)                           \
  X(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays)                   \
  X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                             \
  X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                   \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                             \
  X(PFNGLDELETEQUERIESPROC, DeleteQueries)                             \
  X(PFNGLDELETESHADERPROC, DeleteShader)                               \
  X(PFNGLDELETESYNCPROC, DeleteSync)                                   \
  X(PFNGLDELETETEXTURESPROC, DeleteTextures)                           \
  X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                   \
  X(PFNGLDISABLEPROC, Disable)                                         \
  X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute)                         \
  X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)                 \
  X(PFNGLENABLEPROC, Enable)                                           \
  X(PFNGLFENCESYNCPROC, FenceSync)                                     \
  X(PFNGLGETERRORPROC, GetError)                                       \
  X(PFNGLGETGRAPHICSRESETSTATUSPROC, GetGraphicsResetStatus)           \
  X(PFNGLGETINTEGER64VPROC, GetInteger64v)                             \
  X(PFNGLGETINTEGERVPROC, GetIntegerv)                                 \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                     \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                               \
  X(PFNGLGETQUERYOBJECTUI64VPROC, GetQueryObjectui64v)                 \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                       \
  X(PFNGLGETSHADERIVPROC, GetShaderiv)                                 \
  X(PFNGLGETSTRINGPROC, GetString)                                     \
  X(PFNGLGETTEXTUREIMAGEPROC, GetTextureImage)                         \
  X(PFNGLLINKPROGRAMPROC, LinkProgram)                                 \
  X(PFNGLMAPNAMEDBUFFERRANGEPROC, MapNamedBufferRange)                 \
  X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)                             \
  X(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage)                   \
  X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC, NamedFramebufferDrawBuffers) \
  X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, NamedFramebufferTexture)         \
  X(PFNGLPROGRAMUNIFORM1FPROC, ProgramUniform1f)                       \
  X(PFNGLPROGRAMUNIFORM1IPROC, ProgramUniform1i)                       \
  X(PFNGLPROGRAMUNIFORM1UIPROC, ProgramUniform1ui)                     \
  X(PFNGLQUERYCOUNTERPROC, QueryCounter)                               \
  X(PFNGLSHADERSOURCEPROC, ShaderSource)                               \
  X(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri)                     \
  X(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D)                       \
  X(PFNGLTEXTURESUBIMAGE2DPROC, TextureSubImage2D)                     \
  X(PFNGLUSEPROGRAMPROC, UseProgram)                                   \
  X(PFNGLVIEWPORTPROC, Viewport)

/// OpenGL's functions without the prefix `gl`, as loaded from a context: `gl.DispatchCompute(...)` is
/// glDispatchCompute.
struct Functions {
#define TESSERA_GL_MEMBER(type, name) type name = nullptr;
  TESSERA_GL_FUNCTIONS(TESSERA_GL_MEMBER)
#undef TESSERA_GL_MEMBER
};

}  // namespace tessera::gl
