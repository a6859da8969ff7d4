// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/learned_work.hpp"

#include <utility>

namespace tessera::volume {

WorkCells::WorkCells(const scene::GridIndex& voxels) {
  for (;; side *= 2) {
    for (std::size_t a = 0; a < 3; ++a) cells[a] = (voxels[a] + side - 1) / side;
    if (count() <= std::size_t{1} << 15) return;
  }
}

std::vector<std::uint64_t> WorkTally::take() {
  std::vector<std::uint64_t> taken;
  taken.reserve(words_.size());
  for (auto& word : words_) taken.push_back(word.exchange(0, std::memory_order_relaxed));
  return taken;
}

void WorkRates::add(std::span<const std::uint64_t> tally, std::span<std::uint64_t> sums) {
  // Reduces the sums by a quarter. Two numbers share a word and are reduced separately.
  constexpr std::uint64_t low = 0xffffffffu;
  for (std::size_t word = 0; word < sums.size(); ++word) {
    std::uint64_t& sum = sums[word];
    const std::uint64_t a = word % 2 == 0 ? sum & low : sum, b = word % 2 == 0 ? sum >> 32 : 0;
    sum = (a - a / 4) + ((b - b / 4) << 32) + tally[word];
  }
}

void WorkRates::learn(std::span<const std::uint64_t> tally) {
  struct Sums {
    double samples = 0, slabs = 0, depth = 0;
  };
  // The first level contains the cells. At each further level, cubes have twice the side, up to a single cube.
  struct Level {
    scene::GridIndex cells;
    std::vector<Sums> sums;
  };
  std::vector<Level> levels(1);
  levels[0].cells = cells_.cells;
  for (std::size_t cell = 0; cell < cells_.count(); ++cell)
    levels[0].sums.push_back({static_cast<double>(tally[2 * cell] & 0xffffffffu),
                              static_cast<double>(tally[2 * cell] >> 32) / static_cast<double>(WorkTally::slab_units),
                              static_cast<double>(tally[2 * cell + 1]) / static_cast<double>(WorkTally::depth_units)});
  const auto over = [](const Level& fine, const Level& coarse, std::size_t cell) {
    const auto n = static_cast<std::int64_t>(cell);
    const std::int64_t a = n % fine.cells[0], b = n / fine.cells[0] % fine.cells[1],
                       c = n / fine.cells[0] / fine.cells[1];
    return static_cast<std::size_t>(a / 2 + coarse.cells[0] * (b / 2 + coarse.cells[1] * (c / 2)));
  };
  while (levels.back().sums.size() > 1) {
    Level coarse;
    const Level& fine = levels.back();
    for (std::size_t a = 0; a < 3; ++a) coarse.cells[a] = (fine.cells[a] + 1) / 2;
    coarse.sums.resize(static_cast<std::size_t>(coarse.cells[0] * coarse.cells[1] * coarse.cells[2]));
    for (std::size_t cell = 0; cell < fine.sums.size(); ++cell) {
      Sums& sums = coarse.sums[over(fine, coarse, cell)];
      sums.samples += fine.sums[cell].samples;
      sums.slabs += fine.sums[cell].slabs;
      sums.depth += fine.sums[cell].depth;
    }
    levels.push_back(std::move(coarse));
  }
  std::vector<Rates> above(1);
  for (std::size_t l = levels.size(); l-- > 0;) {
    const Level& level = levels[l];
    std::vector<Rates> rates(level.sums.size());
    for (std::size_t cell = 0; cell < rates.size(); ++cell) {
      const Rates& prior = l + 1 < levels.size() ? above[over(level, levels[l + 1], cell)] : above[0];
      const Sums& sums = level.sums[cell];
      constexpr double prior_slabs = 16;  // about the number of slabs of two rays in a small cell
      rates[cell].samples = (sums.samples + prior_slabs * prior.samples) / (sums.slabs + prior_slabs);
      rates[cell].depth = (sums.depth + prior_slabs * prior.depth) / (sums.slabs + prior_slabs);
    }
    above = std::move(rates);
  }
  rates_ = std::move(above);
}

}  // namespace tessera::volume
