// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace tessera::cells {

/// Returns the first item of part `part` if n items are divided over the parts; n for part == parts.
inline std::uint64_t first_of_part(std::uint64_t n, int part, int parts) {
  const auto p = static_cast<std::uint64_t>(part), count = static_cast<std::uint64_t>(parts);
  return n / count * p + std::min(p, n % count);
}

}  // namespace tessera::cells
