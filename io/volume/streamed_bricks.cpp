// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/streamed_bricks.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "io/volume/brick_layout.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using scene::GridIndex;
using scene::SampleBox;

/// Collects whole slices, some at a time, from tuples that arrive in pieces of any size.
class Slabs {
 public:
  explicit Slabs(const StreamedSamples& samples) : streamed_(samples), n_(samples.grid.geometry.samples()) {
    tuple_ = scene::size_of(samples.choice.type) * static_cast<std::size_t>(samples.choice.components);
    as_stored_ = samples.choice.components == 1 && !samples.swapped && samples.choice.type == samples.grid.type;
  }

  /// Calls `use` with the samples of slices [first, first + count) in the grid's storage format. `count` is at most
  /// `most_slices`, and the slices never cross a multiple of `most_slices`.
  template <class Use>
  void each(std::int64_t most_slices, const Use& use) {
    constexpr std::size_t most_bytes = 8 << 20;
    const auto slice = static_cast<std::size_t>(n_[0] * n_[1]);
    const std::int64_t at_once = std::clamp<std::int64_t>(static_cast<std::int64_t>(most_bytes / (slice * tuple_)), 1,
                                                          std::min(most_slices, n_[2]));
    std::vector<std::byte> tuples(slice * tuple_ * static_cast<std::size_t>(at_once)), samples;
    std::int64_t first = 0;
    std::size_t filled = 0;
    streamed_.tuples([&](std::span<const std::byte> part) {
      while (!part.empty()) {
        const std::int64_t count = std::min({at_once, n_[2] - first, most_slices - first % most_slices});
        const std::size_t whole = slice * tuple_ * static_cast<std::size_t>(count);
        const std::size_t now = std::min(part.size(), whole - filled);
        std::memcpy(tuples.data() + filled, part.data(), now);
        filled += now, part = part.subspan(now);
        if (filled < whole) return;
        filled = 0;
        use(first, count, converted(std::span(tuples).first(whole), samples));
        first += count;
      }
    });
    if (first != n_[2] || filled != 0)
      throw scene::Error(scene::ErrorCode::system_failure, "a volume",
                         fmt::format("only {} of {} slices could be read from its file", first, n_[2]),
                         "please report");
  }

 private:
  std::span<const std::byte> converted(std::span<const std::byte> tuples, std::vector<std::byte>& samples) const {
    if (as_stored_) return tuples;
    const std::size_t count = tuples.size() / tuple_;
    samples.resize(count * scene::size_of(streamed_.grid.type));
    scene::convert_tuples(tuples.data(), streamed_.choice, streamed_.swapped, static_cast<std::int64_t>(count),
                          samples.data(), streamed_.grid.type);
    return samples;
  }

  const StreamedSamples& streamed_;
  GridIndex n_;
  std::size_t tuple_ = 0;
  bool as_stored_ = false;
};

/// Returns the part of a block in slices [first, first + count), contiguous.
std::vector<std::byte> part_of_block(const SampleBox& box, const GridIndex& n, std::size_t size, std::int64_t count,
                                     std::span<const std::byte> slab) {
  const std::size_t row = static_cast<std::size_t>(box.extent(0)) * size;
  std::vector<std::byte> part(row * static_cast<std::size_t>(box.extent(1) * count));
  std::byte* to = part.data();
  for (std::int64_t k = 0; k < count; ++k)
    for (std::int64_t j = box.low[1]; j < box.high[1]; ++j, to += row)
      std::memcpy(to, slab.data() + static_cast<std::size_t>((k * n[1] + j) * n[0] + box.low[0]) * size, row);
  return part;
}

}  // namespace

std::uint64_t bytes_of(const StreamedSamples& samples) {
  return static_cast<std::uint64_t>(samples.grid.geometry.all_samples().count()) * scene::size_of(samples.grid.type);
}

std::unique_ptr<system::ScratchFile> scratch_bricks(const StreamedSamples& samples, const std::string& subject) {
  constexpr int side = 64;
  const BrickLayout layout(samples.grid, side);
  const Blocks& blocks = layout.blocks();
  auto out = std::make_unique<system::ScratchFile>(subject, layout.bytes());
  const GridIndex n = samples.grid.geometry.samples();
  const std::size_t size = scene::size_of(samples.grid.type);
  std::vector<BlockRange> ranges(static_cast<std::size_t>(blocks.total()));
  Slabs(samples).each(side, [&](std::int64_t first, std::int64_t count, std::span<const std::byte> slab) {
    const std::int64_t layer = first / side, in_layer = blocks.count()[0] * blocks.count()[1];
    tbb::parallel_for(std::int64_t{0}, in_layer, [&](std::int64_t number) {
      const GridIndex b{number % blocks.count()[0], number / blocks.count()[0], layer};
      const SampleBox box = blocks.box(b);
      const std::vector<std::byte> part = part_of_block(box, n, size, count, slab);
      ranges[static_cast<std::size_t>(blocks.number(b))].add(samples.grid, part);
      const std::int64_t before = blocks.first_sample(b) + (first - box.low[2]) * box.extent(0) * box.extent(1);
      out->write_at(layout.first_byte() + static_cast<std::uint64_t>(before) * size, part.data(), part.size());
    });
  });
  out->seek(0);
  out->write(layout.beginning(ranges));
  return out;
}

scene::ValueRange value_range(const StreamedSamples& samples) {
  BlockRange range;
  Slabs(samples).each(samples.grid.geometry.samples()[2],
                      [&](std::int64_t /*first*/, std::int64_t /*count*/, std::span<const std::byte> slab) {
                        range.add(samples.grid, slab);
                      });
  return {range.low, range.high, range.blanks};
}

}  // namespace tessera::io
