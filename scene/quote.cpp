// SPDX-License-Identifier: BSD-3-Clause
#include "scene/quote.hpp"

namespace tessera::scene {

std::string quote(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string out = "'";
  for (const char c : text.substr(0, most)) out += (c >= 0x20 && c < 0x7f) ? c : '?';
  if (text.size() > most) out += "...";
  return out + "'";
}

}  // namespace tessera::scene
