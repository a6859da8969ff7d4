#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/grid.hpp"

namespace tessera::scene {

/// Smallest and largest value (scale and shift applied) of the samples that are not blank; empty if low > high. With
/// the number of blank samples.
struct ValueRange {
  double low = 1e300, high = -1e300;
  std::uint64_t blanks = 0;

  [[nodiscard]] bool empty() const { return low > high; }
  bool operator==(const ValueRange&) const = default;
};

/// How read() lays out samples: i fastest; `row_pitch` samples from one row (j) to the next, `slice_pitch` from one
/// slice (k) to the next. Zero: close together, box.extent(0) and row_pitch * box.extent(1).
struct SampleLayout {
  SampleType type = SampleType::float32;
  std::int64_t row_pitch = 0, slice_pitch = 0;
};

/// Where the samples of a volume come from: memory, a mapped file, a brick file. One number a sample; which component
/// or magnitude of a vector it is was chosen where the source was made.
///
/// All functions are const and may be called from several threads at once. A source never holds more memory than it was
/// made with: what read() gives is the caller's to keep.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const GridGeometry& geometry() const { return grid_.geometry; }

  /// Writes the samples of `box` (scale and shift not applied) to `destination`, as stored or converted to float32
  /// (rounded to nearest; beyond its range infinite, hence blank) or float64 (exact). The box lies inside the volume;
  /// elements between rows and slices are left as they are. Throws Error(bad_input) for another type, a box not inside
  /// or a destination too small; Error(system_failure) if the file can no longer be read.
  void read(const SampleBox& box, const SampleLayout& layout, std::span<std::byte> destination) const;

  /// The same, close together, for T the stored type, float or double.
  template <class T>
  void read(const SampleBox& box, std::span<T> destination) const;

  /// Bounds of the values in a box and the most blanks it may hold, if they are known without reading samples (a brick
  /// file keeps them): never less than the truth, perhaps more. Of all samples of the volume: the truth.
  [[nodiscard]] virtual std::optional<ValueRange> known_range(const SampleBox& /*box*/) const { return std::nullopt; }

  /// Boxes of this size, aligned to multiples of it, are the cheapest to read: a brick file's bricks, whole slices of
  /// a file in slice order.
  [[nodiscard]] virtual GridIndex storage_block() const {
    const GridIndex n = geometry().samples();
    return {n[0], n[1], 1};
  }

  /// Bytes of samples that have been read from the file so far; 0 for memory.
  [[nodiscard]] virtual std::uint64_t bytes_read() const { return 0; }

 protected:
  /// Throws what validate() throws; `source` is the file's name for messages.
  SampleSource(Grid grid, std::string source);
  [[nodiscard]] const std::string& source_name() const { return source_; }

 private:
  virtual void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const = 0;

  Grid grid_;
  std::string source_;
};

/// The type that a C++ number is stored as.
template <class T>
constexpr SampleType sample_type_of();

/// Converts `count` numbers, `stride` numbers apart in the source: from any type, `swapped` if of the other byte order,
/// to the same type, float32 or float64. Unaligned addresses are fine.
void convert_samples(const std::byte* source, SampleType from, std::int64_t stride, bool swapped, std::int64_t count,
                     std::byte* destination, SampleType to);

/// Which number of an interleaved tuple is the sample.
struct ComponentChoice {
  int components = 1;                     ///< a tuple's length
  int component = 0;                      ///< -1: the tuple's length (magnitude); Grid::type is then float32 or float64
  SampleType type = SampleType::float32;  ///< of the tuple's numbers; Grid::type unless the magnitude is asked for
};

/// Samples in memory or in a mapped file, in the file's order (k slowest, i fastest, components interleaved).
class MemorySource final : public SampleSource {
 public:
  /// Keeps a copy of the bytes' owner, not of the bytes. Throws Error(bad_input) unless the bytes are as many as the
  /// grid needs. `swapped`: they are of the other byte order than this machine.
  MemorySource(Grid grid, std::span<const std::byte> bytes, std::shared_ptr<const void> owner, std::string source,
               std::optional<ComponentChoice> choice = std::nullopt, bool swapped = false, bool from_file = false);

  /// Of numbers that it then owns; grid.type becomes theirs.
  template <class T>
  static std::unique_ptr<MemorySource> of(Grid grid, std::vector<T> values, std::string source = "volume");

  [[nodiscard]] std::uint64_t bytes_read() const override;

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override;

  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  ComponentChoice choice_;
  bool swapped_, from_file_;
  mutable std::atomic<std::uint64_t> bytes_read_ = 0, bytes_mapped_ = 0;
};

/// Range and blanks of a whole volume: its known_range(), or by reading all of it once, a few MiB at a time.
ValueRange value_range(const SampleSource& source);

/// Calls `use` with a zero of the C++ type that `type` stores.
template <class Use>
void with_sample_type(SampleType type, const Use& use) {
  switch (type) {
    case SampleType::int8:
      return use(std::int8_t{});
    case SampleType::uint8:
      return use(std::uint8_t{});
    case SampleType::int16:
      return use(std::int16_t{});
    case SampleType::uint16:
      return use(std::uint16_t{});
    case SampleType::int32:
      return use(std::int32_t{});
    case SampleType::uint32:
      return use(std::uint32_t{});
    case SampleType::float32:
      return use(float{});
    case SampleType::float64:
      return use(double{});
  }
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

template <class T>
void SampleSource::read(const SampleBox& box, std::span<T> destination) const {
  read(box, {.type = sample_type_of<T>()}, std::as_writable_bytes(destination));
}

template <class T>
std::unique_ptr<MemorySource> MemorySource::of(Grid grid, std::vector<T> values, std::string source) {
  auto kept = std::make_shared<const std::vector<T>>(std::move(values));
  grid.type = sample_type_of<T>();
  const auto bytes = std::as_bytes(std::span<const T>(*kept));
  return std::make_unique<MemorySource>(std::move(grid), bytes, std::move(kept), std::move(source));
}

}  // namespace tessera::scene
