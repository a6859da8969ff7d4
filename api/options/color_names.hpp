// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tessera::api {

struct NamedColor {
  std::string_view name;
  std::uint32_t rgb;  ///< 0xrrggbb, sRGB
};

/// The 148 names of the web's colours (W3C, CSS Color Module Level 4, 6.1), in alphabetical order.
std::span<const NamedColor> color_names();

}  // namespace tessera::api
