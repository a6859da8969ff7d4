// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/sample_source.hpp"

namespace tessera::scene {

/// From here on quantities are rare, and fill values of climate models common.
inline constexpr double huge_value = 1e20;

/// A value that stands for "nothing here" by the custom of many programs (-9999, 1e20, -FLT_MAX, the greatest of a type
/// of integers, ...) and is far from all others; or several: of a field with huge ones and others only the huge ones.
struct FillValue {
  double value = 0;              ///< the farthest
  std::uint64_t count = 0;       ///< samples that have one of them
  ValueRange others;             ///< of all other values
  std::vector<double> values{};  ///< all, ascending

  /// Whether a threshold leaves them out.
  [[nodiscard]] bool is_outside(const std::optional<std::array<double, 2>>& threshold) const {
    return threshold && !(value >= (*threshold)[0] && value <= (*threshold)[1]);
  }

  /// No quantity is likely to have it: it may be left out without asking.
  [[nodiscard]] bool is_huge() const { return std::abs(value) >= huge_value; }
};

/// Whether a value is one of the usual ones. Cheap: what follows reads all values once more.
bool may_be_fill(double value);

/// Of a field's values, or a part of them: how often each that may_be_fill() comes, and the range of the others. The
/// sum of all parts' tallies is the whole's.
class FillTally {
 public:
  void add(double value) { add(value, 1); }
  void add(const FillTally& part);
  [[nodiscard]] std::optional<FillValue> found() const;

 private:
  struct Usual {
    double value = 0;
    std::uint64_t count = 0;
  };

  void add(double value, std::uint64_t count);

  std::array<Usual, 8> usual_{};
  std::size_t usuals_ = 0;
  ValueRange others_;
};

/// Of values whose range is known; nothing unless an end of it may_be_fill().
std::optional<FillValue> find_fill_value(std::span<const double> values, double low, double high);
std::optional<FillValue> find_fill_value(const SampleSource& source, const ValueRange& range);

/// What a note says of it: how many `things` have it, or some if the count is 0, and the threshold that leaves them
/// out.
std::string words_on(const FillValue& fill, const char* things);

}  // namespace tessera::scene
