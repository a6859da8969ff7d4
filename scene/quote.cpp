// SPDX-License-Identifier: BSD-3-Clause
#include "scene/quote.hpp"

#include "tessera/program/text.hpp"

namespace tessera::scene {

std::string quote(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string quoted = "'";
  quoted += printable_ascii(text.substr(0, most));
  return quoted += text.size() > most ? "...'" : "'";
}

}  // namespace tessera::scene
