// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/grid.hpp"

namespace tessera::volume {

/// Memory for floats that are written before they are read. Large allocations are separate mappings: blocks that grow
/// gradually leave gaps in the heap that cannot be reused, up to a third of a small budget.
class FloatRoom {
 public:
  FloatRoom() = default;
  ~FloatRoom() { let_go(); }
  FloatRoom(const FloatRoom&) = delete;
  FloatRoom& operator=(const FloatRoom&) = delete;

  [[nodiscard]] float* data() { return first_; }
  [[nodiscard]] const float* data() const { return first_; }
  /// Ensures room for at least `count` floats. If this allocates memory, all floats are 0.
  void make_room(std::size_t count);

 private:
  void let_go();

  float* first_ = nullptr;
  std::size_t count_ = 0;
  bool mapped_ = false;
};

/// The part of the cast box of voxels in a chunk of 32 slabs, as the kernels use it.
struct ChunkBox {
  std::int64_t first_k;              ///< k of the chunk's first plane, independent of the box
  int first_slab, slabs;             ///< the slabs of the box are [first_slab, slabs)
  int i_low, i_last, j_low, j_last;  ///< first and last voxels of the box
  scene::GridIndex low, high;        ///< the whole box, along the volume's own axes; `high` is not included
};

/// The samples that one tile's rays need in a chunk of 32 slabs of voxels, as lane scalars.
///
/// Slices    Slice n is at k = first_k + n (point data: lattice planes 0..32; cell data: voxels 0..31). It contains
///           columns i in [low_i[n], low_i[n] + pitch) and rows j in [low_j[n], low_j[n] + rows): slices are shifted
///           along with the rays. Columns and rows beyond the box repeat its last ones; slices in front of it are not
///           filled.
/// Slabs     Slab n is between slices n and n + 1. Samples slab_i[n] <= i <= slab_i_last[n], and likewise for j, are in
///           both slices; they include all samples that the tile's rays need, and at least 8 columns and rows.
/// Chunks    Chunk c begins at k = 32 c, independently of the bricks.
struct SlabBlock {
  static constexpr int slabs = 32, slices = slabs + 1;
  static constexpr std::ptrdiff_t margin = 64;  ///< floats that may be read beyond either end

  std::array<int, slices> low_i, low_j;
  std::array<int, slabs> slab_i, slab_i_last, slab_j, slab_j_last;
  std::ptrdiff_t pitch = 0, rows = 0;
  FloatRoom samples;
  /// The difference between exact samples and their floats, as lane scalars, at the same positions. Filled if gradients
  /// are needed of samples that are not exact as floats, otherwise empty.
  bool has_rest = false;
  FloatRoom rest;

  /// The rest of a sample in the block; null if `has_rest` is false.
  [[nodiscard]] float* rest_of(const float* sample) {
    return has_rest ? rest.data() + (sample - samples.data()) : nullptr;
  }
  [[nodiscard]] const float* rest_of(const float* sample) const {
    return has_rest ? rest.data() + (sample - samples.data()) : nullptr;
  }
  [[nodiscard]] float* slice(int n) { return samples.data() + margin + n * pitch * rows; }
  [[nodiscard]] const float* slice(int n) const { return samples.data() + margin + n * pitch * rows; }
  [[nodiscard]] const float* at(int n, int i, int j) const {
    const auto s = static_cast<std::size_t>(n);
    return samples.data() + margin + (n * rows + (j - low_j[s])) * pitch + (i - low_i[s]);
  }
  /// Allocates memory for the current `pitch` and `rows`; the contents are arbitrary finite numbers or NaN.
  void reserve() {
    const auto size = static_cast<std::size_t>(2 * margin + slices * pitch * rows);
    samples.make_room(size);
    if (has_rest) rest.make_room(size);
  }
};

}  // namespace tessera::volume
