#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scene/sample_source.hpp"

namespace tessera::scene {

/// From here on quantities are rare, and fill values of climate models common.
inline constexpr double huge_value = 1e20;

/// A value that stands for "nothing here" by the custom of many programs (-9999, 1e20, -FLT_MAX, ...), is the least or
/// greatest of a field and is far from all others.
struct FillValue {
  double value = 0;
  std::uint64_t count = 0;  ///< samples that have it
  ValueRange others;        ///< of all other values

  /// No quantity is likely to have it: it may be left out without asking.
  [[nodiscard]] bool is_huge() const { return std::abs(value) >= huge_value; }
};

/// Whether a value is one of the usual ones. Cheap: what follows reads all values once more.
bool may_be_fill(double value);

/// Of a field's values, or a part of them, those at an end of its range that may_be_fill(), and the range of the
/// others. The sum of all parts' tallies is the whole's.
class FillTally {
 public:
  FillTally() = default;
  FillTally(double low, double high);  ///< of the whole field

  [[nodiscard]] bool has_candidates() const { return candidates_ > 0; }
  void add(double value);
  void add(const FillTally& part);  ///< of the same field
  [[nodiscard]] std::optional<FillValue> found() const;

 private:
  std::array<FillValue, 2> ends_{};
  std::uint64_t candidates_ = 0;
  ValueRange others_;
};

/// Of values whose range is known; nothing unless an end of it may_be_fill().
std::optional<FillValue> find_fill_value(std::span<const double> values, double low, double high);
std::optional<FillValue> find_fill_value(const SampleSource& source, const ValueRange& range);

/// What a note says of it: how many `things` have it, or some if the count is 0, and the threshold that leaves them
/// out.
std::string words_on(const FillValue& fill, const char* things);

}  // namespace tessera::scene
