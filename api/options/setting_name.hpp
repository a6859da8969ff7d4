// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace tessera::api {

/// The option `tile-size` as messages of libraries name it, which with_options() turns into --tile-size: `tile_size`.
inline std::string setting_name(std::string_view option) {
  std::string name(option);
  std::ranges::replace(name, '-', '_');
  return '`' + name + '`';
}

}  // namespace tessera::api
