// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace tessera::datasets {

/// Random numbers whose bits depend only on the seed. The standard defines the sequence of mt19937_64 but not the
/// results of distributions, so the mapping to numbers is implemented here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Returns a number in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns an integer in [0, n), n > 0. The bias of the modulus is below n / 2^64.
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }

  /// Fisher-Yates.
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tessera::datasets
