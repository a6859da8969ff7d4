// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::sorting {

/// What a device sorts by: front, then back, then `tie`, each an integer in the order of what it stands for; then
/// `element`, the element's number, which makes the order total.
struct GlKey {
  std::uint32_t front, back, tie, element;
};
static_assert(sizeof(GlKey) == 16);

}  // namespace tessera::sorting
