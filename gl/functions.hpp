#pragma once

#include "gl/declarations.hpp"

namespace tessera::gl {

// What the project calls of OpenGL 4.5 core: what each returns, its name, what it takes.
#define TESSERA_GL_FUNCTIONS(X)                                                                          \
  X(void, AttachShader, GLuint, GLuint)                                                                  \
  X(void, BindBufferBase, GLenum, GLuint, GLuint)                                                        \
  X(void, BindFramebuffer, GLenum, GLuint)                                                               \
  X(void, BindTextureUnit, GLuint, GLuint)                                                               \
  X(void, BindVertexArray, GLuint)                                                                       \
  X(void, BlendFunc, GLenum, GLenum)                                                                     \
  X(GLenum, CheckNamedFramebufferStatus, GLuint, GLenum)                                                 \
  X(void, ClearNamedBufferSubData, GLuint, GLenum, GLintptr, GLsizeiptr, GLenum, GLenum, const void*)    \
  X(void, ClearNamedFramebufferfv, GLuint, GLenum, GLint, const GLfloat*)                                \
  X(GLenum, ClientWaitSync, GLsync, GLbitfield, GLuint64)                                                \
  X(void, CompileShader, GLuint)                                                                         \
  X(void, CopyNamedBufferSubData, GLuint, GLuint, GLintptr, GLintptr, GLsizeiptr)                        \
  X(void, CreateBuffers, GLsizei, GLuint*)                                                               \
  X(void, CreateFramebuffers, GLsizei, GLuint*)                                                          \
  X(GLuint, CreateProgram)                                                                               \
  X(void, CreateQueries, GLenum, GLsizei, GLuint*)                                                       \
  X(GLuint, CreateShader, GLenum)                                                                        \
  X(void, CreateTextures, GLenum, GLsizei, GLuint*)                                                      \
  X(void, CreateVertexArrays, GLsizei, GLuint*)                                                          \
  X(void, DeleteBuffers, GLsizei, const GLuint*)                                                         \
  X(void, DeleteFramebuffers, GLsizei, const GLuint*)                                                    \
  X(void, DeleteProgram, GLuint)                                                                         \
  X(void, DeleteQueries, GLsizei, const GLuint*)                                                         \
  X(void, DeleteShader, GLuint)                                                                          \
  X(void, DeleteSync, GLsync)                                                                            \
  X(void, DeleteTextures, GLsizei, const GLuint*)                                                        \
  X(void, DeleteVertexArrays, GLsizei, const GLuint*)                                                    \
  X(void, Disable, GLenum)                                                                               \
  X(void, DispatchCompute, GLuint, GLuint, GLuint)                                                       \
  X(void, DrawArraysInstanced, GLenum, GLint, GLsizei, GLsizei)                                          \
  X(void, Enable, GLenum)                                                                                \
  X(GLsync, FenceSync, GLenum, GLbitfield)                                                               \
  X(GLenum, GetError)                                                                                    \
  X(GLenum, GetGraphicsResetStatus)                                                                      \
  X(void, GetInteger64v, GLenum, GLint64*)                                                               \
  X(void, GetIntegerv, GLenum, GLint*)                                                                   \
  X(void, GetProgramInfoLog, GLuint, GLsizei, GLsizei*, char*)                                           \
  X(void, GetProgramiv, GLuint, GLenum, GLint*)                                                          \
  X(void, GetQueryObjectui64v, GLuint, GLenum, GLuint64*)                                                \
  X(void, GetShaderInfoLog, GLuint, GLsizei, GLsizei*, char*)                                            \
  X(void, GetShaderiv, GLuint, GLenum, GLint*)                                                           \
  X(const GLubyte*, GetString, GLenum)                                                                   \
  X(void, GetTextureImage, GLuint, GLint, GLenum, GLenum, GLsizei, void*)                                \
  X(void, LinkProgram, GLuint)                                                                           \
  X(void*, MapNamedBufferRange, GLuint, GLintptr, GLsizeiptr, GLbitfield)                                \
  X(void, MemoryBarrier, GLbitfield)                                                                     \
  X(void, NamedBufferStorage, GLuint, GLsizeiptr, const void*, GLbitfield)                               \
  X(void, NamedFramebufferDrawBuffers, GLuint, GLsizei, const GLenum*)                                   \
  X(void, NamedFramebufferTexture, GLuint, GLenum, GLuint, GLint)                                        \
  X(void, ProgramUniform1f, GLuint, GLint, GLfloat)                                                      \
  X(void, ProgramUniform1i, GLuint, GLint, GLint)                                                        \
  X(void, ProgramUniform1ui, GLuint, GLint, GLuint)                                                      \
  X(void, QueryCounter, GLuint, GLenum)                                                                  \
  X(void, ShaderSource, GLuint, GLsizei, const char* const*, const GLint*)                               \
  X(void, TextureParameteri, GLuint, GLenum, GLint)                                                      \
  X(void, TextureStorage2D, GLuint, GLsizei, GLenum, GLsizei, GLsizei)                                   \
  X(void, TextureSubImage2D, GLuint, GLint, GLint, GLint, GLsizei, GLsizei, GLenum, GLenum, const void*) \
  X(void, UseProgram, GLuint)                                                                            \
  X(void, Viewport, GLint, GLint, GLsizei, GLsizei)

/// OpenGL's functions without their prefix, as a context gave them: `gl.DispatchCompute(...)` is glDispatchCompute.
struct Functions {
#define TESSERA_GL_MEMBER(result, name, ...) result (*name)(__VA_ARGS__) = nullptr;
  TESSERA_GL_FUNCTIONS(TESSERA_GL_MEMBER)
#undef TESSERA_GL_MEMBER
};

}  // namespace tessera::gl
