// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera::scene {

/// Text from outside in a message: quoted, one line, at most 40 characters, unprintable bytes as `?`.
std::string quote(std::string_view text);

}  // namespace tessera::scene
