// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera::api {

/// Text from anywhere as it can stand in a message: in quotes, its first 40 characters, other bytes than ASCII's
/// printable ones as `?`.
inline std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) shown += c >= 0x20 && c < 0x7f ? c : '?';
  return shown + (text.size() > longest ? "...'" : "'");
}

}  // namespace tessera::api
