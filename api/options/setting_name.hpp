// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace tessera::api {

/// Returns the name of an option's setting as libraries write it in messages: for `tile-size` it is `tile_size`, in
/// backquotes. with_options() replaces this name by --tile-size.
inline std::string setting_name(std::string_view option) {
  std::string name(option);
  std::ranges::replace(name, '-', '_');
  return '`' + name + '`';
}

}  // namespace tessera::api
