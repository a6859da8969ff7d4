// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "gl/context.hpp"

namespace tessera::gl {

/// Device memory that can grow. reserve() discards the contents if it must reallocate.
class Buffer {
 public:
  enum class Use {
    device,    ///< read and written by shaders
    upload,    ///< mapped during its lifetime; written by the host
    readback,  ///< mapped during its lifetime; read by the host
  };

  Buffer(const Context& context, Use use) : context_(&context), use_(use) {}
  ~Buffer();
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  /// Ensures that the buffer has at least `bytes` bytes. Throws Error(system_failure) if the device does not have
  /// enough memory, or if shaders cannot address that many bytes.
  void reserve(std::size_t bytes);

  [[nodiscard]] GLuint name() const { return name_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// The memory of a mapped buffer. The host's writes are visible to later commands; before reading, the host must wait
  /// for a Fence.
  [[nodiscard]] std::byte* mapped() const { return mapped_; }
  /// Binds the buffer as shader storage `binding`.
  void bind(GLuint binding) const { context_->gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name_); }
  /// Copies `bytes` of `from`, starting at `from_byte`, to the beginning of this buffer.
  void copy_from(const Buffer& from, std::size_t from_byte, std::size_t bytes) const;
  /// Sets the first `bytes` bytes, a multiple of four, to zero.
  void clear(std::size_t bytes) const;

 private:
  void release();

  const Context* context_;
  Use use_;
  GLuint name_ = 0;
  std::size_t bytes_ = 0;
  std::byte* mapped_ = nullptr;
};

/// Marks a position in the command stream. wait() returns when the device has reached that position. Throws
/// Error(system_failure) if that takes more than ten minutes, or if the context is lost.
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
