// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// Text of a file, which may be anything, as it can be shown: one line, with a blank for each control character (C0, C1
/// and DEL, which terminals may take for orders) and each character that changes the direction of writing, and without
/// its middle if it is longer than 4000 bytes. What is UTF-8 stays whole characters.
std::string printable(std::string_view text);

}  // namespace v0_1
}  // namespace tessera
