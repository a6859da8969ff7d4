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

/// Smallest and largest value (scale and shift applied) of the samples that are not blank; empty if low > high. With
/// the number of blank samples.
struct ValueRange {
  double low = 1e300, high = -1e300;
  std::uint64_t blanks = 0;

  [[nodiscard]] bool empty() const { return low > high; }
  bool operator==(const ValueRange&) const = default;
};

/// How read() lays out samples: i fastest; `row_pitch` samples from one row (j) to the next, `slice_pitch` from one
/// slice (k) to the next. Zero: contiguous, that is box.extent(0) and row_pitch * box.extent(1).
struct SampleLayout {
  SampleType type = SampleType::float32;
  std::int64_t row_pitch = 0, slice_pitch = 0;
};

/// The source of a volume's samples: memory, a mapped file, a brick file. One number per sample; the component or
/// magnitude of a vector was chosen when the source was made.
///
/// All functions are const and may be called from several threads at once. A source never holds more memory than it was
/// made with: the caller owns what read() returns. Callers may derive their own sources from this class: samples that
/// are computed, or fetched where they are needed.
class TESSERA_EXPORT SampleSource {
 public:
  virtual ~SampleSource();
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const GridGeometry& geometry() const { return grid_.geometry; }

  /// Writes the samples of `box` (scale and shift not applied) to `destination`, as stored or converted to float32
  /// (rounded to nearest; infinite beyond its range, hence blank) or float64 (exact). The box is inside the volume;
  /// elements between rows and slices are not changed. Throws Error(bad_input) for another type, a box not inside or a
  /// destination too small; Error(system_failure) if the file can no longer be read.
  void read(const SampleBox& box, const SampleLayout& layout, std::span<std::byte> destination) const;

  /// The same, contiguous, for T the stored type, float or double.
  template <class T>
  void read(const SampleBox& box, std::span<T> destination) const;

  /// Bounds of the values in a box and of the number of blanks, if they are known without reading samples (a brick file
  /// stores them): never too narrow, perhaps too wide. For the box of all samples they are exact.
  [[nodiscard]] virtual std::optional<ValueRange> known_range(const SampleBox& /*box*/) const { return std::nullopt; }

  /// Boxes of this size, aligned to multiples of it, are the cheapest to read: a brick file's bricks, or whole slices
  /// of a file in slice order.
  [[nodiscard]] virtual GridIndex storage_block() const {
    const GridIndex n = geometry().samples();
    return {n[0], n[1], 1};
  }

  /// Bytes of samples read from the file so far; 0 for memory.
  [[nodiscard]] virtual std::uint64_t bytes_read() const { return 0; }

 protected:
  /// Throws what validate() throws; `source` is the file's name in messages.
  SampleSource(Grid grid, std::string source);
  [[nodiscard]] const std::string& source_name() const { return source_; }

 private:
  /// Arguments that read() has checked; pitches are no longer zero.
  virtual void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const = 0;

  Grid grid_;
  std::string source_;
};

/// The type in which a C++ number is stored.
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
