// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/grid.hpp"
#include "tessera/sample_source.hpp"

namespace tessera::scene {

using tessera::sample_type_of;
using tessera::SampleLayout;
using tessera::SampleSource;
using tessera::ValueRange;

/// Converts `count` numbers, which are `stride` numbers apart in the source, from any type to the same type, float32 or
/// float64. If `swapped`, the numbers in the source have the other byte order. Addresses need not be aligned.
void convert_samples(const std::byte* source, SampleType from, std::int64_t stride, bool swapped, std::int64_t count,
                     std::byte* destination, SampleType to);

/// Specifies which number of an interleaved tuple is the sample.
struct ComponentChoice {
  int components = 1;                     ///< number of components of a tuple
  int component = 0;                      ///< index of the component; -1: the magnitude, for which Grid::type is
                                          ///< float32 or float64
  SampleType type = SampleType::float32;  ///< type of the tuple's numbers; equals Grid::type except for the magnitude
};

/// Extracts the chosen number of each of `count` tuples, in the stored type or converted to float32 or float64. If
/// `swapped`, the tuples have the other byte order.
void convert_tuples(const std::byte* tuples, const ComponentChoice& choice, bool swapped, std::int64_t count,
                    std::byte* destination, SampleType to);

/// Throws Error(bad_input) unless `bytes` is the size of all of the grid's tuples. `source` is the file's name in the
/// message.
void require_samples(const Grid& grid, const ComponentChoice& choice, std::uint64_t bytes, const std::string& source);

/// Samples in memory, in the order of files (k slowest, i fastest, components interleaved).
class MemorySource final : public SampleSource {
 public:
  /// Makes a source of bytes that are not copied; `owner` keeps them alive. Throws Error(bad_input) unless the number
  /// of bytes is that of the grid. If `swapped`, the numbers do not have the byte order of this machine.
  MemorySource(Grid grid, std::span<const std::byte> bytes, std::shared_ptr<const void> owner, std::string source,
               std::optional<ComponentChoice> choice = std::nullopt, bool swapped = false);

  /// Makes a source that owns the numbers. The type of the grid is set to their type.
  template <class T>
  static std::unique_ptr<MemorySource> of(Grid grid, std::vector<T> values, std::string source = "volume");

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override;

  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  ComponentChoice choice_;
  bool swapped_;
};

/// Returns the range and the number of blanks of a whole volume: known_range(), or, if that is unknown, the result of
/// reading all samples once, a few MiB at a time.
ValueRange value_range(const SampleSource& source);

/// Calls `use` with a zero of the C++ type of `type`.
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
std::unique_ptr<MemorySource> MemorySource::of(Grid grid, std::vector<T> values, std::string source) {
  auto kept = std::make_shared<const std::vector<T>>(std::move(values));
  grid.type = sample_type_of<T>();
  const auto bytes = std::as_bytes(std::span<const T>(*kept));
  return std::make_unique<MemorySource>(std::move(grid), bytes, std::move(kept), std::move(source));
}

}  // namespace tessera::scene
