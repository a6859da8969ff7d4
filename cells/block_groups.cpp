// SPDX-License-Identifier: BSD-3-Clause
#include "cells/block_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace tessera::cells {
namespace {

constexpr std::size_t most_groups = 256;

BlockField field_of_numbers(const std::string& name, std::span<const std::int64_t> numbers) {
  return field_of_values(name, "int64", scene::Association::cell, 1,
                         std::vector<double>(numbers.begin(), numbers.end()));
}

/// Returns the cells with a number, or all cells, with the points that they use. Before and after the call, all entries
/// of `local` are unset.
CellBlock group_of(const CellBlock& all, std::span<const std::int64_t> numbers, std::optional<std::int64_t> number,
                   std::vector<std::uint32_t>& local) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  CellBlock block;
  block.offsets.push_back(0);
  std::vector<std::uint32_t> used;
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    if (number && numbers[c] != *number) continue;
    for (std::uint64_t k = all.offsets[c]; k < all.offsets[c + 1]; ++k) {
      const std::uint32_t point = all.connectivity[k];
      if (local[point] == unused) {
        local[point] = static_cast<std::uint32_t>(used.size());
        used.push_back(point);
        block.positions.push_back(all.positions[point]);
      }
      block.connectivity.push_back(local[point]);
    }
    block.types.push_back(all.types[c]);
    block.offsets.push_back(block.connectivity.size());
  }
  for (const std::uint32_t point : used) local[point] = unused;
  return block;
}

}  // namespace

std::vector<CellBlock> blocks_by_number(const CellBlock& all, std::span<const std::int64_t> numbers,
                                        const std::string& word, const std::string& field) {
  std::vector<std::int64_t> distinct(numbers.begin(), numbers.end());
  std::ranges::sort(distinct);
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<CellBlock> blocks;
  std::vector<std::uint32_t> local(all.positions.size(), std::numeric_limits<std::uint32_t>::max());
  if (distinct.size() <= 1 || distinct.size() > most_groups) {
    blocks.push_back(group_of(all, numbers, std::nullopt, local));
    if (distinct.size() > 1) blocks[0].fields.push_back(field_of_numbers(field, numbers));
    return blocks;
  }
  for (const std::int64_t number : distinct) {
    CellBlock block = group_of(all, numbers, number, local);
    block.name = fmt::format("{} {}", word, number);
    block.fields.push_back(field_of_numbers(field, std::vector<std::int64_t>(block.types.size(), number)));
    blocks.push_back(std::move(block));
  }
  return blocks;
}

}  // namespace tessera::cells
