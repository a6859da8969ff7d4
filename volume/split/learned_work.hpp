// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/grid.hpp"

namespace tessera::volume {

/// Coarse cells of a volume. They are cubes whose side is the smallest of 8, 16, 32, ... voxels for which there are at
/// most 2^15 cells.
struct WorkCells {
  std::int64_t side = 8;
  scene::GridIndex cells{0, 0, 0};

  explicit WorkCells(const scene::GridIndex& voxels);
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(cells[0] * cells[1] * cells[2]); }
  /// Index of the cell of a voxel; voxels outside the volume belong to the nearest cell.
  [[nodiscard]] std::size_t number(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto along = [&](std::int64_t v, std::size_t axis) {
      return v < 0 ? 0 : v / side < cells[axis] ? v / side : cells[axis] - 1;
    };
    return static_cast<std::size_t>(along(i, 0) + cells[0] * (along(j, 1) + cells[1] * along(k, 2)));
  }
  bool operator==(const WorkCells&) const = default;
};

/// Counts the caster's work separately for each cell in which it occurs. Any number of threads may add work.
class WorkTally {
 public:
  explicit WorkTally(const scene::GridIndex& voxels) : cells_(voxels), words_(2 * cells_.count()) {}

  /// Adds a packet's path through a cell: the samples (pieces) that it took, the slabs that it crossed (a slab is one
  /// layer of voxels along one ray), and the optical depth over the length of a slab, summed over rays.
  void add(std::size_t cell, std::uint64_t samples, float slabs, float depth) {
    words_[2 * cell].fetch_add(samples | static_cast<std::uint64_t>(slabs * slab_units) << 32,
                               std::memory_order_relaxed);
    words_[2 * cell + 1].fetch_add(static_cast<std::uint64_t>(depth * depth_units), std::memory_order_relaxed);
  }
  [[nodiscard]] const WorkCells& cells() const { return cells_; }

  /// Returns the counts as integers, to be summed over ranks, and resets them to zero.
  std::vector<std::uint64_t> take();

  static constexpr float slab_units = 16, depth_units = 4096;

 private:
  WorkCells cells_;
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// Work rates estimated from tallies. The rates of cells that few rays met are moved towards those of the larger cubes
/// that contain them.
class WorkRates {
 public:
  explicit WorkRates(const scene::GridIndex& voxels) : cells_(voxels), rates_(cells_.count()) {}

  /// Adds a tally to the sums of earlier frames. These sums are first reduced by a quarter, because a cell's work
  /// changes with the direction of the rays.
  static void add(std::span<const std::uint64_t> tally, std::span<std::uint64_t> sums);

  /// Estimates the rates from the words of WorkTally::take(), summed over ranks.
  void learn(std::span<const std::uint64_t> tally);

  [[nodiscard]] const WorkCells& cells() const { return cells_; }
  /// Samples per slab of one ray in the cell.
  [[nodiscard]] double samples(std::size_t cell) const { return rates_[cell].samples; }
  /// Optical depth in the cell per unit of the caster's length.
  [[nodiscard]] double depth(std::size_t cell) const { return rates_[cell].depth; }

 private:
  struct Rates {
    double samples = 1, depth = 0;
  };
  WorkCells cells_;
  std::vector<Rates> rates_;
};

}  // namespace tessera::volume
