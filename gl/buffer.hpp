// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "gl/context.hpp"

namespace tessera::gl {

/// Device memory that grows: reserve() forgets what was in it if it has to.
class Buffer {
 public:
  enum class Use {
    device,    ///< shaders read and write it
    upload,    ///< mapped for as long as it lives; the host writes it
    readback,  ///< mapped for as long as it lives; the host reads it
  };

  Buffer(const Context& context, Use use) : context_(&context), use_(use) {}
  ~Buffer();
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  /// Room for at least that many bytes. Throws Error(system_failure) if the device has none, or shaders cannot address
  /// as much.
  void reserve(std::size_t bytes);

  [[nodiscard]] GLuint name() const { return name_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// Of mapped ones. Writes are seen by commands that follow; reads want a Fence waited for.
  [[nodiscard]] std::byte* mapped() const { return mapped_; }
  /// As shader storage number `binding`.
  void bind(GLuint binding) const { context_->gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name_); }
  /// The first `bytes` of `from`, from `from_byte` on, to the beginning of this one.
  void copy_from(const Buffer& from, std::size_t from_byte, std::size_t bytes) const;
  /// Zeros in the first `bytes`, a multiple of four.
  void clear(std::size_t bytes) const;

 private:
  void release();

  const Context* context_;
  Use use_;
  GLuint name_ = 0;
  std::size_t bytes_ = 0;
  std::byte* mapped_ = nullptr;
};

/// Marks a place in the commands; wait() returns when the device has come there. Throws Error(system_failure) if it
/// does not within ten minutes, or the context is lost.
class Fence {
 public:
  explicit Fence(const Context& context) : context_(&context) {}
  ~Fence();
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;

  void set();
  void wait();

 private:
  const Context* context_;
  GLsync sync_ = nullptr;
};

}  // namespace tessera::gl
