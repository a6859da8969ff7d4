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

/// Decodes groups of four characters (RFC 4648) from the front of `text`, up to the first that has another character
/// (padding, white space) or for whose three bytes `to` has no room. Returns the number of groups.
std::size_t decode_base64(std::string_view text, std::span<std::byte> to);

/// Bytes of a file from one place to another, in their order, out of their base64 text if they are one. White space in
/// the text is skipped. Padding may end a group anywhere: texts that were encoded one by one follow each other.
class PackedBytes {
 public:
  PackedBytes(const system::PositionalFile& file, bool base64, std::uint64_t first, std::uint64_t end);

  /// false: the bytes end before, or the text is not base64.
  [[nodiscard]] bool read(std::byte* to, std::uint64_t count);

  /// Behind what has been read, in the file.
  [[nodiscard]] std::uint64_t position() const { return base64_ ? at_ - (text_.size() - used_) : at_; }
  /// At most so many bytes follow.
  [[nodiscard]] std::uint64_t left() const;

 private:
  [[nodiscard]] bool decode_group();
  [[nodiscard]] bool fetch();

  const system::PositionalFile* file_;
  bool base64_;
  std::uint64_t at_, end_;
  std::string text_;
  std::size_t used_ = 0;      ///< of text_
  std::byte group_[3] = {};   ///< the bytes of a group that was read in part
  std::size_t group_at_ = 3;  ///< those from here on are left
};

}  // namespace tessera::io
