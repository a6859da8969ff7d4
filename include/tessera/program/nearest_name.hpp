// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// Returns the name that was probably meant by `word`: the name that requires the fewest edits, where an edit inserts,
/// deletes or replaces a letter or swaps two adjacent letters. Case is ignored, and only the last part of a path needs
/// to match. If several names require equally few edits, the first is returned. Returns none if the name requires more
/// edits than a third of the letters (one edit is always allowed), unless exactly one name begins with `word`.
/// Source: F. J. Damerau, "A technique for computer detection and correction of spelling errors", CACM, 1964.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace v0_1
}  // namespace tessera
