// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// Arbitrary text of a file in a form that can be shown: one line, with a blank for each control character (C0, C1 and
/// DEL, which terminals may execute) and for each character that changes the direction of writing, and without its
/// middle if it is longer than 4000 bytes. UTF-8 characters stay whole.
std::string printable(std::string_view text);

}  // namespace v0_1
}  // namespace tessera
