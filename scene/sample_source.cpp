// SPDX-License-Identifier: BSD-3-Clause
#include "scene/sample_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "scene/byte_order.hpp"
#include "scene/error.hpp"

namespace tessera::scene {
namespace {

template <class From, class To>
void convert(const std::byte* source, std::int64_t stride, bool swapped, std::int64_t count, std::byte* destination) {
  const std::int64_t step = stride * static_cast<std::int64_t>(sizeof(From));
  for (std::int64_t i = 0; i < count; ++i) {
    const auto value = static_cast<To>(load<From>(source + i * step, swapped));
    std::memcpy(destination + i * static_cast<std::int64_t>(sizeof(To)), &value, sizeof(To));
  }
}

/// Returns the Euclidean length of a tuple of components, in double precision. hypot is used if squares could overflow
/// or underflow.
template <class T>
double tuple_length(const std::byte* tuple, int components, bool swapped) {
  double sum = 0;
  for (int c = 0; c < components; ++c) {
    const auto value = static_cast<double>(load<T>(tuple + static_cast<std::size_t>(c) * sizeof(T), swapped));
    if constexpr (std::is_same_v<T, double>)
      sum = std::hypot(sum, value);
    else
      sum += value * value;
  }
  return std::is_same_v<T, double> ? sum : std::sqrt(sum);
}

void write_as(SampleType type, double value, std::byte* destination) {
  const auto narrow = static_cast<float>(value);
  if (type == SampleType::float32) std::memcpy(destination, &narrow, sizeof narrow);
  if (type == SampleType::float64) std::memcpy(destination, &value, sizeof value);
}

}  // namespace

void convert_samples(const std::byte* source, SampleType from, std::int64_t stride, bool swapped, std::int64_t count,
                     std::byte* destination, SampleType to) {
  with_sample_type(from, [&](auto number) {
    using From = decltype(number);
    if (to == from && stride == 1 && !swapped)
      std::memcpy(destination, source, static_cast<std::size_t>(count) * sizeof(From));
    else if (to == from)
      convert<From, From>(source, stride, swapped, count, destination);
    else if (to == SampleType::float32)
      convert<From, float>(source, stride, swapped, count, destination);
    else
      convert<From, double>(source, stride, swapped, count, destination);
  });
}

void convert_tuples(const std::byte* tuples, const ComponentChoice& choice, bool swapped, std::int64_t count,
                    std::byte* destination, SampleType to) {
  const std::size_t number = size_of(choice.type), to_size = size_of(to);
  if (choice.component >= 0)
    return convert_samples(tuples + static_cast<std::size_t>(choice.component) * number, choice.type, choice.components,
                           swapped, count, destination, to);
  const std::size_t tuple = number * static_cast<std::size_t>(choice.components);
  with_sample_type(choice.type, [&](auto type) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      write_as(to, tuple_length<decltype(type)>(tuples + i * tuple, choice.components, swapped),
               destination + i * to_size);
  });
}

void require_samples(const Grid& grid, const ComponentChoice& choice, std::uint64_t bytes, const std::string& source) {
  const auto tuple = static_cast<std::uint64_t>(choice.components) * size_of(choice.type);
  const std::int64_t samples = grid.geometry.all_samples().count();
  const auto needed = static_cast<std::uint64_t>(samples) * tuple;
  if (bytes < needed)
    throw bad_input(
        fmt::format("{}: {} samples of {} bytes need {} bytes, but it has {}; the file is truncated or its size is "
                    "stated incorrectly, write it again",
                    source, samples, tuple, needed, bytes));
}

MemorySource::MemorySource(Grid grid, std::span<const std::byte> bytes, std::shared_ptr<const void> owner,
                           std::string source, std::optional<ComponentChoice> choice, bool swapped)
    : SampleSource(std::move(grid), std::move(source)), bytes_(bytes), owner_(std::move(owner)), swapped_(swapped) {
  choice_ = choice ? *choice : ComponentChoice{.type = this->grid().type};
  require_samples(this->grid(), choice_, bytes_.size(), source_name());
}

void MemorySource::read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const {
  const GridIndex n = geometry().samples();
  const auto to_size = static_cast<std::int64_t>(size_of(layout.type));
  const auto tuple = static_cast<std::int64_t>(size_of(choice_.type)) * choice_.components;
  for (std::int64_t k = 0; k < box.extent(2); ++k)
    for (std::int64_t j = 0; j < box.extent(1); ++j) {
      const std::int64_t first = ((box.low[2] + k) * n[1] + box.low[1] + j) * n[0] + box.low[0];
      convert_tuples(bytes_.data() + first * tuple, choice_, swapped_, box.extent(0),
                     destination + (k * layout.slice_pitch + j * layout.row_pitch) * to_size, layout.type);
    }
}

namespace {

template <class T>
ValueRange range_by_reading(const SampleSource& source) {
  const Grid& grid = source.grid();
  const SampleBox all = grid.geometry.all_samples();
  constexpr std::int64_t most = 1 << 18;  // number of samples read at once: 2 MiB of doubles
  ValueRange range;
  std::vector<T> values;
  T low = std::numeric_limits<T>::infinity(), high = -low;
  const std::int64_t rows = std::clamp<std::int64_t>(most / all.high[0], 1, all.high[1]);
  const std::int64_t slices =
      rows < all.high[1] ? 1 : std::clamp<std::int64_t>(most / (all.high[0] * rows), 1, all.high[2]);
  for (std::int64_t k = 0; k < all.high[2]; k += slices)
    for (std::int64_t j = 0; j < all.high[1]; j += rows) {
      const SampleBox box{{0, j, k}, {all.high[0], std::min(j + rows, all.high[1]), std::min(k + slices, all.high[2])}};
      values.resize(static_cast<std::size_t>(box.count()));
      source.read(box, std::span<T>(values));
      for (const T v : values) {
        if (!std::isfinite(v)) {
          ++range.blanks;
          continue;
        }
        low = std::min(low, v);
        high = std::max(high, v);
      }
    }
  if (low <= high) {
    const double a = grid.value(static_cast<double>(low)), b = grid.value(static_cast<double>(high));
    range.low = std::min(a, b);
    range.high = std::max(a, b);
  }
  return range;
}

}  // namespace

ValueRange value_range(const SampleSource& source) {
  if (const auto known = source.known_range(source.geometry().all_samples())) return *known;
  // The range is computed in the precision of the samples: magnitudes of floats are floats.
  return fits_float(source.grid().type) ? range_by_reading<float>(source) : range_by_reading<double>(source);
}

}  // namespace tessera::scene

namespace tessera {
inline namespace v0_1 {

SampleSource::~SampleSource() = default;

SampleSource::SampleSource(Grid grid, std::string source) : grid_(std::move(grid)), source_(std::move(source)) {
  validate(grid_, source_);
}

void SampleSource::read(const SampleBox& box, const SampleLayout& layout, std::span<std::byte> destination) const {
  const GridIndex n = geometry().samples();
  for (std::size_t a = 0; a < 3; ++a)
    if (box.low[a] < 0 || box.high[a] > n[a] || box.low[a] > box.high[a])
      throw bad_input(fmt::format("{}: samples {} to {} along {} were requested, but it has {}; please report this",
                                  source_, box.low[a], box.high[a], "xyz"[a], n[a]));
  if (box.count() == 0) return;
  if (layout.type != grid_.type && !is_float(layout.type))
    throw bad_input(fmt::format("{}: {} samples were requested as {}; please report this", source_, name_of(grid_.type),
                                name_of(layout.type)));
  SampleLayout pitched = layout;
  if (pitched.row_pitch == 0) pitched.row_pitch = box.extent(0);
  if (pitched.slice_pitch == 0) pitched.slice_pitch = pitched.row_pitch * box.extent(1);
  const std::int64_t needed =
      (box.extent(2) - 1) * pitched.slice_pitch + (box.extent(1) - 1) * pitched.row_pitch + box.extent(0);
  if (pitched.row_pitch < box.extent(0) || pitched.slice_pitch < pitched.row_pitch ||
      static_cast<std::uint64_t>(needed) * size_of(layout.type) > destination.size())
    throw bad_input(fmt::format("{}: {} samples do not fit into {} bytes; please report this", source_, needed,
                                destination.size()));
  read_samples(box, pitched, destination.data());
}

}  // namespace v0_1
}  // namespace tessera
