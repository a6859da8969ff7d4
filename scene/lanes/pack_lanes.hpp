// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace tessera::scene {

/// The orders of lanes that move the lanes of a mask to the front: order[mask bits][i] is the lane that moves to
/// position i. There is a table for 8 lanes of 32 bits, and one for 4 lanes, as the bytes of a shuffle. (With some
/// compilers, Compress of Highway 1.0 copies its tables to the stack in every call, which takes 40 times as long as the
/// permutation.)
struct PackingOrders {
  alignas(32) std::array<std::array<std::int32_t, 8>, 256> lanes8{};
  alignas(16) std::array<std::array<std::uint8_t, 16>, 16> bytes4{};

  constexpr PackingOrders() {
    for (unsigned bits = 0; bits < 256; ++bits) {
      std::size_t next = 0;
      for (int lane = 0; lane < 8; ++lane)
        if ((bits >> lane & 1) != 0) lanes8[bits][next++] = lane;
    }
    for (unsigned bits = 0; bits < 16; ++bits) {
      std::size_t next = 0;
      for (unsigned lane = 0; lane < 4; ++lane)
        if ((bits >> lane & 1) != 0)
          for (unsigned byte = 0; byte < 4; ++byte) bytes4[bits][next++] = static_cast<std::uint8_t>(4 * lane + byte);
    }
  }
};
inline constexpr PackingOrders packing_orders;

}  // namespace tessera::scene
