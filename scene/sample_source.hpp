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

/// Converts `count` numbers, `stride` numbers apart in the source: from any type, `swapped` if they have the other byte
/// order, to the same type, float32 or float64. Unaligned addresses are allowed.
void convert_samples(const std::byte* source, SampleType from, std::int64_t stride, bool swapped, std::int64_t count,
                     std::byte* destination, SampleType to);

/// Which number of an interleaved tuple is the sample.
struct ComponentChoice {
  int components = 1;                     ///< a tuple's length
  int component = 0;                      ///< -1: the tuple's length (magnitude); Grid::type is then float32 or float64
  SampleType type = SampleType::float32;  ///< of the tuple's numbers; equals Grid::type except for the magnitude
};

/// The samples of `count` tuples, `swapped` if they have the other byte order: the chosen number of each, as stored or
/// converted to float32 or float64.
void convert_tuples(const std::byte* tuples, const ComponentChoice& choice, bool swapped, std::int64_t count,
                    std::byte* destination, SampleType to);

/// Throws Error(bad_input) unless `bytes` is the size of all of the grid's tuples; `source` is the file's name.
void require_samples(const Grid& grid, const ComponentChoice& choice, std::uint64_t bytes, const std::string& source);

/// Samples in memory, in the order of files (k slowest, i fastest, components interleaved).
class MemorySource final : public SampleSource {
 public:
  /// Keeps a copy of the bytes' owner, not of the bytes. Throws Error(bad_input) unless the bytes have the size that
  /// the grid needs. `swapped`: they have the other byte order than this machine.
  MemorySource(Grid grid, std::span<const std::byte> bytes, std::shared_ptr<const void> owner, std::string source,
               std::optional<ComponentChoice> choice = std::nullopt, bool swapped = false);

  /// Takes ownership of the numbers; grid.type becomes their type.
  template <class T>
  static std::unique_ptr<MemorySource> of(Grid grid, std::vector<T> values, std::string source = "volume");

 private:
  void read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const override;

  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  ComponentChoice choice_;
  bool swapped_;
};

/// Range and blanks of a whole volume: its known_range(), or by reading it once, a few MiB at a time.
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
