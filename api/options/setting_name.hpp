// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace tessera::api {

/// The name of the option `tile-size` in messages of libraries, `tile_size` in backquotes; with_options() turns it into
/// --tile-size.
inline std::string setting_name(std::string_view option) {
  std::string name(option);
  std::ranges::replace(name, '-', '_');
  return '`' + name + '`';
}

}  // namespace tessera::api
