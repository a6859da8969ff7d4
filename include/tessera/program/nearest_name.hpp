// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// The name that was probably meant by `word`: the one with the fewest edits, where an edit inserts, deletes or
/// replaces a letter or swaps two neighbours. Case does not matter, and only the last part of a path need match. None
/// if more than a third of the letters (at least one) would change, unless `word` begins exactly one name. The first of
/// several equally near names.
/// Source: F. J. Damerau, "A technique for computer detection and correction of spelling errors", CACM, 1964.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace v0_1
}  // namespace tessera
