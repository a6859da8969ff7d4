// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace tessera::cells {

/// Returns the mixed bits of a number: the finalizer of MurmurHash3 after a golden-ratio step (Steele, Lea, Flood,
/// "Fast Splittable Pseudorandom Number Generators", 2014).
inline std::uint64_t mixed_bits(std::int64_t number) {
  std::uint64_t bits = static_cast<std::uint64_t>(number) + 0x9e3779b97f4a7c15u;
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111ebu;
  return bits ^ bits >> 31;
}

/// Summary of an array's values, mainly their finite range; for vectors, that of their lengths.
struct NumberTally {
  double low = 0, high = 0;
  std::uint64_t not_finite = 0;
  bool any_finite = false;        ///< if false, low and high are meaningless
  bool whole = true;              ///< all finite values are integers below 2^53
  std::uint64_t finite = 0;       ///< number of finite values
  std::uint64_t fingerprint = 0;  ///< sum of mixed_bits(), while `whole`; independent of the numbers' order

  void add(std::span<const double> values) {
    for (const double value : values) {
      if (!std::isfinite(value)) {
        ++not_finite;
        continue;
      }
      low = any_finite ? std::min(low, value) : value;
      high = any_finite ? std::max(high, value) : value;
      any_finite = true;
      ++finite;
      if (!whole) continue;
      whole = std::abs(value) < 0x1p53 && value == std::trunc(value);
      if (whole) fingerprint += mixed_bits(static_cast<std::int64_t>(value));
    }
  }

  /// Adds the tally of another part of the array.
  void add(const NumberTally& more) {
    not_finite += more.not_finite;
    if (!more.any_finite) return;
    low = any_finite ? std::min(low, more.low) : more.low;
    high = any_finite ? std::max(high, more.high) : more.high;
    any_finite = true;
    whole = whole && more.whole;
    finite += more.finite;
    fingerprint += more.fingerprint;
  }

  /// Whether the values are low, low + 1, ... high, each once, in any order. Always false for fewer than four values.
  /// For others, a result of true is wrong with probability 2^-64.
  [[nodiscard]] bool counts_up() const {
    if (!whole || finite < 4 || not_finite > 0 || high - low != static_cast<double>(finite - 1)) return false;
    std::uint64_t expected = 0;
    const auto first = static_cast<std::int64_t>(low);
    for (std::uint64_t k = 0; k < finite; ++k) expected += mixed_bits(first + static_cast<std::int64_t>(k));
    return fingerprint == expected;
  }
};

}  // namespace tessera::cells
