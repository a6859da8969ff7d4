// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace tessera::system {

/// A file descriptor that this object owns and closes.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;

  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  int release();

 private:
  int number_ = -1;
};

/// Writes all bytes. Returns false if this fails.
bool write_all(int file, const void* bytes, std::size_t count);

}  // namespace tessera::system
