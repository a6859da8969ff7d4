// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstddef>
#include <string_view>

#include "annotation/typeface.hpp"

namespace tessera::annotation {
namespace {

/// Number of bytes of the UTF-8 sequence at the beginning of the text; 0 if there is no valid sequence. As in RFC 3629,
/// overlong forms, surrogates and values above U+10FFFF are invalid.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
    return follows(1) && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
    return follows(1) && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

}  // namespace

std::string clean_text(const std::string& text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(std::string_view(text).substr(i));
    const auto first = static_cast<unsigned char>(text[i]);
    if (length == 0)
      clean += "\xEF\xBF\xBD";
    else if (first < 0x20 || first == 0x7F)
      clean += ' ';
    else
      clean.append(text, i, length);
    i += length == 0 ? 1 : length;
  }
  return clean;
}

}  // namespace tessera::annotation
