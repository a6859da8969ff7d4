// SPDX-License-Identifier: BSD-3-Clause
#include "gl/buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "scene/error.hpp"

namespace tessera::gl {

Buffer::~Buffer() { release(); }

void Buffer::release() {
  if (name_ != 0) context_->gl().DeleteBuffers(1, &name_);  // also unmaps the buffer
  name_ = 0;
  bytes_ = 0;
  mapped_ = nullptr;
}

void Buffer::reserve(std::size_t bytes) {
  if (bytes <= bytes_) return;
  const auto most = static_cast<std::size_t>(context_->limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
  if (use_ == Use::device && bytes > most)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: {} bytes of ray segments are needed at once, but its shaders can access only "
                                   "{}; make `tile_size` smaller, or use `backend` cpu",
                                   context_->name(), bytes, most));
  release();
  const Functions& gl = context_->gl();
  std::size_t room = std::bit_ceil(std::max<std::size_t>(bytes, 4096));
  if (use_ == Use::device) room = std::min(room, most);
  const GLbitfield map = use_ == Use::upload     ? GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT
                         : use_ == Use::readback ? GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT
                                                 : 0;
  gl.CreateBuffers(1, &name_);
  gl.NamedBufferStorage(name_, static_cast<GLsizeiptr>(room), nullptr, map);
  context_->check("reserving memory");
  if (map != 0) {
    mapped_ = static_cast<std::byte*>(gl.MapNamedBufferRange(name_, 0, static_cast<GLsizeiptr>(room), map));
    if (mapped_ == nullptr) {
      context_->check("mapping memory");
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("{}: its memory cannot be mapped; use `backend` cpu", context_->name()));
    }
  }
  bytes_ = room;
}

void Buffer::copy_from(const Buffer& from, std::size_t from_byte, std::size_t bytes) const {
  if (bytes > 0)
    context_->gl().CopyNamedBufferSubData(from.name_, name_, static_cast<GLintptr>(from_byte), 0,
                                          static_cast<GLsizeiptr>(bytes));
}

void Buffer::clear(std::size_t bytes) const {
  if (bytes > 0)
    context_->gl().ClearNamedBufferSubData(name_, GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                                           GL_UNSIGNED_INT, nullptr);
}

Fence::~Fence() {
  if (sync_ != nullptr) context_->gl().DeleteSync(sync_);
}

void Fence::set() {
  if (sync_ != nullptr) context_->gl().DeleteSync(sync_);
  sync_ = context_->gl().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void Fence::wait() {
  if (sync_ == nullptr) return;
  constexpr GLuint64 second = 1'000'000'000;
  for (int waited = 0;; ++waited) {
    const GLenum answer = context_->gl().ClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, second);
    context_->check("waiting for the device");
    if (answer == GL_ALREADY_SIGNALED || answer == GL_CONDITION_SATISFIED) break;
    // A software device may need a long time for a large batch. A device that was lost reports that, or never signals.
    if (answer == GL_WAIT_FAILED || waited >= 600)
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("{}: the device does not answer; start again, or use `backend` cpu", context_->name()));
  }
  context_->gl().DeleteSync(sync_);
  sync_ = nullptr;
}

}  // namespace tessera::gl
