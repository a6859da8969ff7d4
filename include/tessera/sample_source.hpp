// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "tessera/export.hpp"
#include "tessera/grid.hpp"

namespace tessera {
inline namespace v0_1 {

/// The smallest and the largest value (scale and shift applied) of the samples that are not blank, and the number of
/// blank samples. The range is empty if low > high.
struct ValueRange {
  double low = 1e300, high = -1e300;
  std::uint64_t blanks = 0;

  [[nodiscard]] bool empty() const { return low > high; }
  bool operator==(const ValueRange&) const = default;
};

/// How read() arranges samples in memory: i varies fastest; rows (j) are `row_pitch` samples apart and slices (k) are
/// `slice_pitch` samples apart. A pitch of zero makes them contiguous: box.extent(0) for rows, row_pitch *
/// box.extent(1) for slices.
struct SampleLayout {
  SampleType type = SampleType::float32;
  std::int64_t row_pitch = 0, slice_pitch = 0;
};

/// The source of a volume's samples: memory, a mapped file or a brick file. A sample is one number; for vectors, the
/// component or the magnitude was chosen when the source was made.
///
/// All functions are const and may be called from several threads at once. The memory that a source uses does not grow:
/// the caller owns the memory into which read() writes. Callers may derive their own sources from this class, for
/// samples that are computed or fetched when they are needed.
class TESSERA_EXPORT SampleSource {
 public:
  virtual ~SampleSource();
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const GridGeometry& geometry() const { return grid_.geometry; }

  /// Writes the samples of `box` (scale and shift not applied) to `destination`, in the stored type or converted to
  /// float32 or float64. The conversion to float32 rounds to nearest; values beyond its range become infinite and
  /// therefore blank. The conversion to float64 is exact. Elements between rows and slices are not changed. Throws
  /// Error(bad_input) for another type, a box that is not inside the volume, or a destination that is too small;
  /// Error(system_failure) if the file can no longer be read.
  void read(const SampleBox& box, const SampleLayout& layout, std::span<std::byte> destination) const;

  /// Writes contiguous samples. T must be float, double or the stored type.
  template <class T>
  void read(const SampleBox& box, std::span<T> destination) const;

  /// Returns bounds of the values and of the number of blank samples in a box, if they are known without reading
  /// samples (a brick file stores them). The bounds may be too wide, but are never too narrow. For the box of all
  /// samples they are exact.
  [[nodiscard]] virtual std::optional<ValueRange> known_range(const SampleBox& /*box*/) const { return std::nullopt; }

  /// Size of the boxes that are cheapest to read if they are aligned to multiples of it: the bricks of a brick file, or
  /// whole slices of a file in slice order.
  [[nodiscard]] virtual GridIndex storage_block() const {
    const GridIndex n = geometry().samples();
    return {n[0], n[1], 1};
  }

  /// Number of bytes of samples read from the file so far; 0 for samples in memory.
  [[nodiscard]] virtual std::uint64_t bytes_read() const { return 0; }

 protected:
  /// Throws the same errors as validate(). `source` is the name of the file in messages.
  SampleSource(Grid grid, std::string source);
  [[nodiscard]] const std::string& source_name() const { return source_; }

 private:
  /// Called by read() after it has checked the arguments and replaced pitches of zero.
  virtual void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const = 0;

  Grid grid_;
  std::string source_;
};

/// The SampleType of a C++ number type.
template <class T>
constexpr SampleType sample_type_of();

template <class T>
void SampleSource::read(const SampleBox& box, std::span<T> destination) const {
  read(box, {.type = sample_type_of<T>()}, std::as_writable_bytes(destination));
}

template <class T>
constexpr SampleType sample_type_of() {
  if constexpr (std::is_same_v<T, std::int8_t>) return SampleType::int8;
  if constexpr (std::is_same_v<T, std::uint8_t>) return SampleType::uint8;
  if constexpr (std::is_same_v<T, std::int16_t>) return SampleType::int16;
  if constexpr (std::is_same_v<T, std::uint16_t>) return SampleType::uint16;
  if constexpr (std::is_same_v<T, std::int32_t>) return SampleType::int32;
  if constexpr (std::is_same_v<T, std::uint32_t>) return SampleType::uint32;
  if constexpr (std::is_same_v<T, float>) return SampleType::float32;
  static_assert(sizeof(T) < 8 || std::is_same_v<T, double>, "no 64-bit integers");
  return SampleType::float64;
}

}  // namespace v0_1
}  // namespace tessera
