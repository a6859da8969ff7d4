// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/foreign/messages/foreign_data.hpp"

namespace tessera::system {
class PositionalFile;
}

namespace tessera::io {

/// The numbers of an ascii array of a VTK XML file, in their order, each in a spelling that C++ streams read, or nan or
/// inf. Numbers of 8 bits are numbers too, not characters. What follows the last number that is asked for is not
/// looked at.
class VtkTextNumbers {
 public:
  /// Of the text from one place of the file to another.
  VtkTextNumbers(const system::PositionalFile& file, std::uint64_t first, std::uint64_t end);

  /// At most so many numbers follow.
  [[nodiscard]] std::uint64_t left() const { return (end_ - at_ + (text_.size() - used_)) / 2 + 1; }

  /// The next `count` numbers, as numbers of `type` in memory; false: the text ends before, or has another word or a
  /// number that the type cannot hold.
  [[nodiscard]] bool read(NumberType type, std::byte* to, std::uint64_t count);

  /// What read() could not, or its beginning; empty at the text's end.
  [[nodiscard]] std::string next_word() const;

 private:
  template <class T>
  [[nodiscard]] bool read_number(T& number);
  [[nodiscard]] bool fetch();

  const system::PositionalFile* file_;
  std::uint64_t at_, end_;
  std::string text_;
  std::size_t used_ = 0;
};

}  // namespace tessera::io
