// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/grid.hpp"

namespace tessera::volume {

/// Coarse cells of a volume, cubes of 8, 16, 32, ... voxels a side, so large that there are at most 2^15 of them.
struct WorkCells {
  std::int64_t side = 8;
  scene::GridIndex cells{0, 0, 0};

  explicit WorkCells(const scene::GridIndex& voxels);
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(cells[0] * cells[1] * cells[2]); }
  /// Of a voxel; the nearest cell to one outside.
  [[nodiscard]] std::size_t number(std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto along = [&](std::int64_t v, std::size_t axis) {
      return v < 0 ? 0 : v / side < cells[axis] ? v / side : cells[axis] - 1;
    };
    return static_cast<std::size_t>(along(i, 0) + cells[0] * (along(j, 1) + cells[1] * along(k, 2)));
  }
  bool operator==(const WorkCells&) const = default;
};

/// What the caster counts of its own work while it casts, by the cells in which it did it. Any number of threads add.
class WorkTally {
 public:
  explicit WorkTally(const scene::GridIndex& voxels) : cells_(voxels), words_(2 * cells_.count()) {}

  /// A packet's stretch through a cell: samples (pieces) taken, slabs crossed (a plane of voxels along one ray each),
  /// and optical depth over the length of a slab, summed over rays.
  void add(std::size_t cell, std::uint64_t samples, float slabs, float depth) {
    words_[2 * cell].fetch_add(samples | static_cast<std::uint64_t>(slabs * slab_units) << 32,
                               std::memory_order_relaxed);
    words_[2 * cell + 1].fetch_add(static_cast<std::uint64_t>(depth * depth_units), std::memory_order_relaxed);
  }
  [[nodiscard]] const WorkCells& cells() const { return cells_; }

  /// The counts as whole numbers, to be added up over ranks, and from zero again.
  std::vector<std::uint64_t> take();

  static constexpr float slab_units = 16, depth_units = 4096;

 private:
  WorkCells cells_;
  std::vector<std::atomic<std::uint64_t>> words_;
};

/// What a tally teaches. Cells that few rays met lean on the larger cubes round them.
class WorkRates {
 public:
  explicit WorkRates(const scene::GridIndex& voxels) : cells_(voxels), rates_(cells_.count()) {}

  /// Adds a tally to those of frames before, of which each frame forgets a quarter: a cell's work changes with the
  /// direction of rays.
  static void add(std::span<const std::uint64_t> tally, std::span<std::uint64_t> sums);

  /// From WorkTally::take(), summed over ranks.
  void learn(std::span<const std::uint64_t> tally);

  [[nodiscard]] const WorkCells& cells() const { return cells_; }
  /// Samples a slab of one ray there.
  [[nodiscard]] double samples(std::size_t cell) const { return rates_[cell].samples; }
  /// Optical depth a unit of length (the caster's) there.
  [[nodiscard]] double depth(std::size_t cell) const { return rates_[cell].depth; }

 private:
  struct Rates {
    double samples = 1, depth = 0;
  };
  WorkCells cells_;
  std::vector<Rates> rates_;
};

}  // namespace tessera::volume
