// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/printable.hpp"

#include <algorithm>
#include <cstddef>

namespace tessera {
inline namespace v0_1 {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// Number of bytes of the UTF-8 character at the beginning of the text; 1 if there is no valid character.
std::size_t character_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t bytes = first >= 0xf0 && first < 0xf8 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 1;
  if (first >= 0xf8 || bytes > text.size()) return 1;
  return std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(bytes), continues) ? bytes : 1;
}

bool is_shown(std::string_view character) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(character[k]); };
  if (character.size() == 1) return byte(0) >= 0x20 && byte(0) != 0x7f && (byte(0) < 0x80 || byte(0) >= 0xa0);
  if (character.size() == 2) return !(byte(0) == 0xc2 && byte(1) < 0xa0) && character != "\xd8\x9c";  // C1, U+061C
  if (byte(0) != 0xe2) return true;
  const bool turns = byte(1) == 0x80 && (byte(2) == 0x8e || byte(2) == 0x8f || (byte(2) >= 0xa8 && byte(2) <= 0xae));
  return !turns && !(byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9);  // U+200E, U+2028 to 202E, U+2066 to 2069
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::size_t longest = 4000, half = longest / 2;
  if (text.size() > longest) {
    std::size_t begin = half, end = text.size() - half;
    while (begin > 0 && continues(text[begin])) --begin;
    while (end < text.size() && continues(text[end])) ++end;
    return printable(text.substr(0, begin)) + " ... " + printable(text.substr(end));
  }
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const std::string_view character = text.substr(0, character_bytes(text));
    is_shown(character) ? shown.append(character) : shown.append(1, ' ');
    text.remove_prefix(character.size());
  }
  return shown;
}

}  // namespace v0_1
}  // namespace tessera
