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

/// Values of at least this magnitude are rarely quantities, but often fill values of climate models.
inline constexpr double huge_value = 1e20;

/// One or several values that many programs use for "no data" (-9999, 1e20, -FLT_MAX, the largest value of an integer
/// type, ...) and that are far from all other values of the field. If a field has huge fill values, only these are
/// included.
struct FillValue {
  double value = 0;              ///< the fill value that is farthest from the other values
  std::uint64_t count = 0;       ///< number of samples with one of the fill values
  ValueRange others;             ///< range of all other values
  std::vector<double> values{};  ///< all fill values, ascending

  /// Whether a threshold excludes the fill values.
  [[nodiscard]] bool is_outside(const std::optional<std::array<double, 2>>& threshold) const {
    return threshold && !(value >= (*threshold)[0] && value <= (*threshold)[1]);
  }

  /// Whether the value is so large that a quantity is unlikely to have it, so that it may be left out automatically.
  [[nodiscard]] bool is_huge() const { return std::abs(value) >= huge_value; }
};

/// Whether a value is a common fill value. This cheap test decides whether all values are read again.
bool may_be_fill(double value);

/// Counts how often each common fill value occurs in a field or a part of it, and finds the range of the other values.
/// The tallies of parts can be added to obtain the tally of the whole field.
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

/// Finds the fill value of a field with a known range. Returns none unless one end of the range is a common fill value
/// (may_be_fill()).
std::optional<FillValue> find_fill_value(std::span<const double> values, double low, double high);
std::optional<FillValue> find_fill_value(const SampleSource& source, const ValueRange& range);

/// Returns the text of a note that states how many `things` have the fill value ("some" if the count is 0), and the
/// threshold that leaves them out.
std::string words_on(const FillValue& fill, const char* things);

}  // namespace tessera::scene
