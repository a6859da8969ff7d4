// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tessera::scene {

/// Whether numbers in this byte order must be swapped on this machine.
constexpr bool is_swapped(bool big_endian) { return big_endian != (std::endian::native == std::endian::big); }

/// Returns a number of 1, 2, 4 or 8 bytes with its bytes reversed.
template <class T>
T byteswapped(T number) {
  if constexpr (sizeof(T) == 8)
    return std::bit_cast<T>(__builtin_bswap64(std::bit_cast<std::uint64_t>(number)));
  else if constexpr (sizeof(T) == 4)
    return std::bit_cast<T>(__builtin_bswap32(std::bit_cast<std::uint32_t>(number)));
  else if constexpr (sizeof(T) == 2)
    return std::bit_cast<T>(__builtin_bswap16(std::bit_cast<std::uint16_t>(number)));
  else
    return number;
}

/// Reads the number that begins at `bytes`, in this machine's byte order or, if `swapped`, in the other one.
template <class T>
T load(const void* bytes, bool swapped) {
  T number;
  std::memcpy(&number, bytes, sizeof number);
  return swapped ? byteswapped(number) : number;
}

/// Reverses the bytes of each number of type T.
template <class T>
void swap_numbers(std::span<std::byte> bytes) {
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    const T number = load<T>(bytes.data() + at, true);
    std::memcpy(bytes.data() + at, &number, sizeof number);
  }
}

}  // namespace tessera::scene
