// SPDX-License-Identifier: BSD-3-Clause
#include "scene/threshold_source.hpp"

#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace tessera::scene {
namespace {

Grid with_blanks(Grid grid) {
  grid.type = fits_float(grid.type) ? SampleType::float32 : SampleType::float64;
  return grid;
}

}  // namespace

ThresholdSource::ThresholdSource(std::unique_ptr<SampleSource> all, const std::array<double, 2>& range,
                                 std::string source)
    : SampleSource(with_blanks(all->grid()), std::move(source)), all_(std::move(all)), range_(range) {}

void ThresholdSource::read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const {
  if (grid().type == SampleType::float32)
    read_as<float>(box, layout, destination);
  else
    read_as<double>(box, layout, destination);
}

/// T is the type of the samples in memory.
template <class T>
void ThresholdSource::read_as(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const {
  std::vector<T> samples(static_cast<std::size_t>(box.count()));
  all_->read(box, std::span<T>(samples));
  const auto to_size = static_cast<std::int64_t>(size_of(layout.type));
  std::size_t next = 0;
  for (std::int64_t k = 0; k < box.extent(2); ++k)
    for (std::int64_t j = 0; j < box.extent(1); ++j) {
      std::byte* to = destination + (k * layout.slice_pitch + j * layout.row_pitch) * to_size;
      for (std::int64_t i = 0; i < box.extent(0); ++i, to += to_size) {
        const auto sample = static_cast<double>(samples[next++]);
        const double value = grid().value(sample);
        const double kept =
            value >= range_[0] && value <= range_[1] ? sample : std::numeric_limits<double>::quiet_NaN();
        const auto narrow = static_cast<float>(kept);
        if (layout.type == SampleType::float32)
          std::memcpy(to, &narrow, sizeof narrow);
        else
          std::memcpy(to, &kept, sizeof kept);
      }
    }
}

}  // namespace tessera::scene
