// SPDX-License-Identifier: BSD-3-Clause
#include "gl/texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scene/error.hpp"

namespace tessera::gl {

Texture::~Texture() {
  if (name_ != 0) context_->gl().DeleteTextures(1, &name_);
}

bool Texture::reserve(int width, int height) {
  if (width <= width_ && height <= height_) return false;
  const Functions& gl = context_->gl();
  if (name_ != 0) gl.DeleteTextures(1, &name_);
  width_ = std::max(width, width_), height_ = std::max(height, height_);
  gl.CreateTextures(GL_TEXTURE_2D, 1, &name_);
  gl.TextureStorage2D(name_, 1, format_, width_, height_);
  gl.TextureParameteri(name_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TextureParameteri(name_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  context_->check("reserving a texture");
  return true;
}

Framebuffer::Framebuffer(const Context& context) : context_(&context) { context.gl().CreateFramebuffers(1, &name_); }

Framebuffer::~Framebuffer() { context_->gl().DeleteFramebuffers(1, &name_); }

void Framebuffer::attach(std::initializer_list<const Texture*> textures) {
  const Functions& gl = context_->gl();
  std::vector<GLenum> buffers;
  for (const Texture* texture : textures) {
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
    gl.NamedFramebufferTexture(name_, buffers.back(), texture->name(), 0);
  }
  gl.NamedFramebufferDrawBuffers(name_, static_cast<GLsizei>(buffers.size()), buffers.data());
  if (gl.CheckNamedFramebufferStatus(name_, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("{}: cannot draw into the textures that this needs; use `backend` cpu", context_->name()));
}

}  // namespace tessera::gl
