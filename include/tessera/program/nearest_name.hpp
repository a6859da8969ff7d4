// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tessera {
inline namespace v0_1 {

/// The name that was probably meant by `word`: the one that the fewest changes make of it, a change being a letter that
/// is missing, too much or another, or two neighbours swapped; capitals do not count, and of a path its
/// last part may be meant. None if more than a third of the
/// letters (at least one) would change, unless `word` begins just one name. The first of several as near.
/// Source: F. J. Damerau, "A technique for computer detection and correction of spelling errors", CACM, 1964.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace v0_1
}  // namespace tessera
