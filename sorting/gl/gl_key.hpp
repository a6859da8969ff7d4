// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::sorting {

/// The sort key on a device: `front`, then `back`, then `tie`. Each is an unsigned integer with the same order as the
/// value that it encodes. The number of the element comes last and makes the order total.
struct GlKey {
  std::uint32_t front, back, tie, element;
};
static_assert(sizeof(GlKey) == 16);

}  // namespace tessera::sorting
