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

/// Reads the numbers of an ascii array of a VTK XML file sequentially. Each number has a notation that C++ streams
/// accept, or is nan or inf. 8-bit values are numbers, too, not characters. Text after the last requested number is not
/// examined.
class VtkTextNumbers {
 public:
  /// Reads the text between two positions of the file.
  VtkTextNumbers(const system::PositionalFile& file, std::uint64_t first, std::uint64_t end);

  /// Upper bound of the number of numbers that follow.
  [[nodiscard]] std::uint64_t left() const { return (end_ - at_ + (text_.size() - used_)) / 2 + 1; }

  /// Reads the next `count` numbers and stores them as `type`. Returns false if the text ends early, or contains
  /// another word or a number outside the type's range.
  [[nodiscard]] bool read(NumberType type, std::byte* to, std::uint64_t count);

  /// Returns the word that read() refused, or the beginning of that word; empty at the end of the text.
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
