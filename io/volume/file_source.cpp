// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/file_source.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace tessera::io {

FileSource::FileSource(scene::Grid grid, const std::filesystem::path& file, std::uint64_t first_byte,
                       const std::string& source, const scene::ComponentChoice& choice, bool swapped)
    : SampleSource(std::move(grid), source),
      file_(file, source),
      first_byte_(first_byte),
      choice_(choice),
      swapped_(swapped) {
  const std::uint64_t size = file_.size();
  scene::require_samples(this->grid(), choice_, size - std::min(first_byte_, size), source);
}

void FileSource::read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout,
                              std::byte* destination) const {
  // Reading the gap between short rows costs less than another call; reads longer than `most_at_once` are not faster.
  constexpr std::int64_t longest_gap = 2048, most_at_once = 1 << 17;
  const scene::GridIndex n = geometry().samples();
  const auto to_size = static_cast<std::int64_t>(scene::size_of(layout.type));
  const auto tuple = static_cast<std::int64_t>(scene::size_of(choice_.type)) * choice_.components;
  const std::int64_t row = box.extent(0) * tuple, stride = n[0] * tuple;
  const std::int64_t together =
      stride - row > longest_gap ? 1 : std::clamp<std::int64_t>((most_at_once - row) / stride + 1, 1, box.extent(1));
  const bool as_stored = choice_.components == 1 && !swapped_ && layout.type == choice_.type;
  // Stored on the stack, because on the heap it would fragment the memory of bricks.
  std::array<std::byte, most_at_once> few;
  std::vector<std::byte> many;
  for (std::int64_t k = 0; k < box.extent(2); ++k)
    for (std::int64_t j = 0; j < box.extent(1); j += together) {
      const std::int64_t count = std::min(together, box.extent(1) - j);
      const std::int64_t first = ((box.low[2] + k) * n[1] + box.low[1] + j) * n[0] + box.low[0];
      const auto bytes = static_cast<std::uint64_t>((count - 1) * stride + row);
      std::byte* const to = destination + (k * layout.slice_pitch + j * layout.row_pitch) * to_size;
      const bool in_place = as_stored && (count == 1 || (stride == row && layout.row_pitch == box.extent(0)));
      if (!in_place && bytes > few.size()) many.resize(static_cast<std::size_t>(bytes));
      std::byte* const rows = in_place ? to : bytes > few.size() ? many.data() : few.data();
      file_.read(first_byte_ + static_cast<std::uint64_t>(first * tuple), rows, bytes);
      for (std::int64_t r = 0; r < (in_place ? 0 : count); ++r)
        scene::convert_tuples(rows + r * stride, choice_, swapped_, box.extent(0), to + r * layout.row_pitch * to_size,
                              layout.type);
    }
  bytes_read_.fetch_add(static_cast<std::uint64_t>(box.count() * tuple), std::memory_order_relaxed);
}

}  // namespace tessera::io
