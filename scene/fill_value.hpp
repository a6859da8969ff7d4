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

/// From this magnitude on quantities are rare, and fill values of climate models common.
inline constexpr double huge_value = 1e20;

/// A value that many programs use for "no data" (-9999, 1e20, -FLT_MAX, the largest of an integer type, ...) and that
/// is far from all others; or several: if a field has huge ones, only these.
struct FillValue {
  double value = 0;              ///< the farthest
  std::uint64_t count = 0;       ///< samples with one of these values
  ValueRange others;             ///< of all other values
  std::vector<double> values{};  ///< all, ascending

  /// Whether a threshold excludes them.
  [[nodiscard]] bool is_outside(const std::optional<std::array<double, 2>>& threshold) const {
    return threshold && !(value >= (*threshold)[0] && value <= (*threshold)[1]);
  }

  /// No quantity is likely to have this value: it may be left out automatically.
  [[nodiscard]] bool is_huge() const { return std::abs(value) >= huge_value; }
};

/// Whether a value is a common fill value. A cheap test before all values are read again.
bool may_be_fill(double value);

/// For a field's values, or a part of them: how often each common fill value occurs, and the range of the others. The
/// tallies of parts add up to that of the whole.
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

/// For values with a known range; none unless may_be_fill() holds for one of its ends.
std::optional<FillValue> find_fill_value(std::span<const double> values, double low, double high);
std::optional<FillValue> find_fill_value(const SampleSource& source, const ValueRange& range);

/// The text of a note: how many `things` have the fill value (some, if the count is 0), and the threshold that leaves
/// them out.
std::string words_on(const FillValue& fill, const char* things);

}  // namespace tessera::scene
