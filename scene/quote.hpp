// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera::scene {

/// Returns text from a file or a user for use in a message: quoted, on one line, with at most 40 characters, and with
/// `?` for unprintable bytes.
std::string quote(std::string_view text);

}  // namespace tessera::scene
