#include "scene/sample_source.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

template <class T>
T loaded(const std::byte* at, bool swapped) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

template <class From, class To>
void convert(const std::byte* source, std::int64_t stride, bool swapped, std::int64_t count, std::byte* destination) {
  const std::int64_t step = stride * static_cast<std::int64_t>(sizeof(From));
  for (std::int64_t i = 0; i < count; ++i) {
    const auto value = static_cast<To>(loaded<From>(source + i * step, swapped));
    std::memcpy(destination + i * static_cast<std::int64_t>(sizeof(To)), &value, sizeof(To));
  }
}

/// Length of a tuple of components, in double precision; hypot where squares might overflow.
template <class T>
double tuple_length(const std::byte* tuple, int components, bool swapped) {
  double sum = 0;
  for (int c = 0; c < components; ++c) {
    const auto value = static_cast<double>(loaded<T>(tuple + static_cast<std::size_t>(c) * sizeof(T), swapped));
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

MemorySource::MemorySource(Grid grid, std::span<const std::byte> bytes, std::shared_ptr<const void> owner,
                           std::string source, std::optional<ComponentChoice> choice, bool swapped, bool from_file)
    : SampleSource(std::move(grid), std::move(source)),
      bytes_(bytes),
      owner_(std::move(owner)),
      swapped_(swapped),
      from_file_(from_file) {
  choice_ = choice ? *choice : ComponentChoice{.type = this->grid().type};
  const auto tuple = static_cast<std::uint64_t>(choice_.components) * size_of(choice_.type);
  const auto needed = static_cast<std::uint64_t>(geometry().all_samples().count()) * tuple;
  if (bytes_.size() < needed)
    throw bad_input(
        fmt::format("{}: {} samples of {} bytes are {} bytes, {} are there; the file is truncated or its "
                    "size is stated wrongly, write it anew",
                    source_name(), geometry().all_samples().count(), tuple, needed, bytes_.size()));
}

std::uint64_t MemorySource::bytes_read() const { return bytes_read_.load(std::memory_order_relaxed); }

namespace {

/// Threads that read meanwhile get their pages anew.
void drop_pages(std::span<const std::byte> mapped) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(mapped.data()) % page) % page;
  if (mapped.size() < before + page) return;
  const auto pages = mapped.subspan(before, (mapped.size() - before) / page * page);
  madvise(const_cast<std::byte*>(pages.data()), pages.size(), MADV_DONTNEED);
}

/// Bytes of a mapped file that count as this process's once rows of `row` bytes, `stride` apart, have been read: the
/// system maps pages by sixteen.
std::uint64_t mapped_bytes(std::int64_t rows, std::int64_t row, std::int64_t stride) {
  constexpr std::int64_t around = 16 * 4096;
  return static_cast<std::uint64_t>(stride < around ? (rows - 1) * stride + row + around : rows * (row + around));
}

}  // namespace

void MemorySource::read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const {
  const GridIndex n = geometry().samples();
  const std::size_t to_size = size_of(layout.type), number = size_of(choice_.type);
  const auto tuple = static_cast<std::int64_t>(number) * choice_.components;
  const std::int64_t count = box.extent(0);
  for (std::int64_t k = 0; k < box.extent(2); ++k)
    for (std::int64_t j = 0; j < box.extent(1); ++j) {
      const std::int64_t first = ((box.low[2] + k) * n[1] + box.low[1] + j) * n[0] + box.low[0];
      const std::byte* from = bytes_.data() + first * tuple;
      std::byte* to =
          destination + (k * layout.slice_pitch + j * layout.row_pitch) * static_cast<std::int64_t>(to_size);
      if (choice_.component >= 0) {
        convert_samples(from + static_cast<std::size_t>(choice_.component) * number, choice_.type, choice_.components,
                        swapped_, count, to, layout.type);
        continue;
      }
      with_sample_type(choice_.type, [&](auto type) {
        for (std::int64_t i = 0; i < count; ++i)
          write_as(layout.type, tuple_length<decltype(type)>(from + i * tuple, choice_.components, swapped_),
                   to + i * static_cast<std::int64_t>(to_size));
      });
    }
  if (!from_file_) return;
  bytes_read_.fetch_add(static_cast<std::uint64_t>(box.count() * tuple), std::memory_order_relaxed);
  // Pages of a mapped file count as this process's until they are given back; the system keeps them as it can.
  constexpr std::uint64_t kept = 8 << 20;
  const bool whole = count == n[0] && box.extent(1) == n[1];
  const std::uint64_t mapped =
      whole ? mapped_bytes(1, box.count() * tuple, 0)
            : static_cast<std::uint64_t>(box.extent(2)) * mapped_bytes(box.extent(1), count * tuple, n[0] * tuple);
  const std::uint64_t before = bytes_mapped_.fetch_add(mapped, std::memory_order_relaxed);
  if (before / kept != (before + mapped) / kept) drop_pages(bytes_);
}

namespace {

template <class T>
ValueRange range_by_reading(const SampleSource& source) {
  const Grid& grid = source.grid();
  const SampleBox all = grid.geometry.all_samples();
  constexpr std::int64_t most = 1 << 18;  // samples at once: 2 MiB of doubles
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
  // In the precision that samples are held in: magnitudes of floats are floats.
  return fits_float(source.grid().type) ? range_by_reading<float>(source) : range_by_reading<double>(source);
}

}  // namespace tessera::scene

namespace tessera {

SampleSource::~SampleSource() = default;

SampleSource::SampleSource(Grid grid, std::string source) : grid_(std::move(grid)), source_(std::move(source)) {
  validate(grid_, source_);
}

void SampleSource::read(const SampleBox& box, const SampleLayout& layout, std::span<std::byte> destination) const {
  const GridIndex n = geometry().samples();
  for (std::size_t a = 0; a < 3; ++a)
    if (box.low[a] < 0 || box.high[a] > n[a] || box.low[a] > box.high[a])
      throw bad_input(fmt::format("{}: samples {} to {} along {} are asked for, it has {}; please report", source_,
                                  box.low[a], box.high[a], "xyz"[a], n[a]));
  if (box.count() == 0) return;
  if (layout.type != grid_.type && !is_float(layout.type))
    throw bad_input(fmt::format("{}: {} samples are asked for as {}; please report", source_, name_of(grid_.type),
                                name_of(layout.type)));
  SampleLayout pitched = layout;
  if (pitched.row_pitch == 0) pitched.row_pitch = box.extent(0);
  if (pitched.slice_pitch == 0) pitched.slice_pitch = pitched.row_pitch * box.extent(1);
  const std::int64_t needed =
      (box.extent(2) - 1) * pitched.slice_pitch + (box.extent(1) - 1) * pitched.row_pitch + box.extent(0);
  if (pitched.row_pitch < box.extent(0) || pitched.slice_pitch < pitched.row_pitch ||
      static_cast<std::uint64_t>(needed) * size_of(layout.type) > destination.size())
    throw bad_input(
        fmt::format("{}: {} samples do not fit {} bytes; please report", source_, needed, destination.size()));
  read_samples(box, pitched, destination.data());
}

}  // namespace tessera
