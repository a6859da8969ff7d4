// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tessera::system {
class PositionalFile;
}

namespace tessera::io {

/// Decodes groups of four characters (RFC 4648) from the start of `text`. Stops at the first group that contains
/// another character (padding, white space) or whose three bytes do not fit into `to`. Returns the number of groups
/// decoded.
std::size_t decode_base64(std::string_view text, std::span<std::byte> to);

/// Reads a range of a file's bytes sequentially and decodes the bytes if they are base64 text. White space in the text
/// is skipped. Padding may end a group anywhere, because texts that were encoded separately may follow each other.
class PackedBytes {
 public:
  PackedBytes(const system::PositionalFile& file, bool base64, std::uint64_t first, std::uint64_t end);

  /// Reads the next `count` bytes. Returns false if the bytes end early or the text is not base64.
  [[nodiscard]] bool read(std::byte* to, std::uint64_t count);

  /// Position in the file after the bytes read so far.
  [[nodiscard]] std::uint64_t position() const { return base64_ ? at_ - (text_.size() - used_) : at_; }
  /// Upper bound of the number of bytes that follow.
  [[nodiscard]] std::uint64_t left() const;

 private:
  [[nodiscard]] bool decode_group();
  [[nodiscard]] bool fetch();

  const system::PositionalFile* file_;
  bool base64_;
  std::uint64_t at_, end_;
  std::string text_;
  std::size_t used_ = 0;      ///< of text_
  std::byte group_[3] = {};   ///< decoded bytes of a group, some of which were returned
  std::size_t group_at_ = 3;  ///< index of the first byte of `group_` that was not returned yet
};

}  // namespace tessera::io
