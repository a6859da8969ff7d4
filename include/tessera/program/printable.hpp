// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// Returns arbitrary text of a file in a form that can be shown, as one line. A blank replaces each control character
/// (C0, C1 and DEL, which terminals may execute) and each character that changes the direction of writing. If the text
/// is longer than 4000 bytes, its middle is left out. UTF-8 characters are not split.
std::string printable(std::string_view text);

}  // namespace v0_1
}  // namespace tessera
