// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::sorting {

/// The sort key on a device: `front`, then `back`, then `tie`, each an unsigned integer in the order of the value that
/// it encodes. The element's number comes last and makes the order total.
struct GlKey {
  std::uint32_t front, back, tie, element;
};
static_assert(sizeof(GlKey) == 16);

}  // namespace tessera::sorting
