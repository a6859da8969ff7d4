// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>

#include "gl/context.hpp"

namespace tessera::gl {

/// A 2D texture without filtering that can grow. reserve() discards the contents if it must reallocate.
class Texture {
 public:
  Texture(const Context& context, GLenum format) : context_(&context), format_(format) {}
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  /// Ensures at least this size; width and height may be at most GL_MAX_TEXTURE_SIZE. Throws Error(system_failure) if
  /// the device is out of memory. Returns true if a new texture was created.
  bool reserve(int width, int height);
  [[nodiscard]] GLuint name() const { return name_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  void bind(GLuint unit) const { context_->gl().BindTextureUnit(unit, name_); }

 private:
  const Context* context_;
  GLenum format_;
  GLuint name_ = 0;
  int width_ = 0, height_ = 0;
};

/// Textures as render targets: the first is attachment 0, the second attachment 1 and so on.
class Framebuffer {
 public:
  explicit Framebuffer(const Context& context);
  ~Framebuffer();
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;

  /// Throws Error(system_failure) if the device cannot render to these textures.
  void attach(std::initializer_list<const Texture*> textures);
  void bind() const { context_->gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, name_); }
  void clear(int attachment, const float (&value)[4]) const {
    context_->gl().ClearNamedFramebufferfv(name_, GL_COLOR, attachment, value);
  }

 private:
  const Context* context_;
  GLuint name_ = 0;
};

}  // namespace tessera::gl
