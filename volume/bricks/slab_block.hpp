// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/grid.hpp"

namespace tessera::volume {

/// Room for floats that are written before they are read. Much of it lies in a mapping of its own: blocks that grow by
/// and by leave gaps in the heap that nothing else fills, a third of a small budget.
class FloatRoom {
 public:
  FloatRoom() = default;
  ~FloatRoom() { let_go(); }
  FloatRoom(const FloatRoom&) = delete;
  FloatRoom& operator=(const FloatRoom&) = delete;

  [[nodiscard]] float* data() { return first_; }
  [[nodiscard]] const float* data() const { return first_; }
  /// At least `count` floats; where there were fewer, all are 0 now.
  void make_room(std::size_t count);

 private:
  void let_go();

  float* first_ = nullptr;
  std::size_t count_ = 0;
  bool mapped_ = false;
};

/// What a chunk of 32 slabs has of the box of voxels that is cast: all that kernels know of either.
struct ChunkBox {
  std::int64_t first_k;              ///< of the chunk, whatever the box
  int first_slab, slabs;             ///< those of the box are [first_slab, slabs)
  int i_low, i_last, j_low, j_last;  ///< voxels of the box, the last included
  scene::GridIndex low, high;        ///< the whole box, along the volume's own axes
};

/// The samples that one tile's rays need on their way through a chunk of 32 slabs of voxels, as lane scalars.
///
/// Slices   slice n lies at k = first_k + n (point data: lattice planes 0..32; cell data: voxels 0..31). It holds
///          columns i of [low_i[n], low_i[n] + pitch) and rows j of [low_j[n], low_j[n] + rows): slices slide along
///          with the rays. Columns and rows beyond the box repeat its last ones; slices in front of it hold nothing.
/// Slabs    slab n lies between slices n and n + 1. Samples slab_i[n] <= i <= slab_i_last[n], and so for j, are in both
///          slices; they hold all that the tile's rays meet, and at least 8 columns and rows.
/// Chunks   chunk c begins at k = 32 c, whatever bricks there are.
struct SlabBlock {
  static constexpr int slabs = 32, slices = slabs + 1;
  static constexpr std::ptrdiff_t margin = 64;  ///< floats that may be read past either end

  std::array<int, slices> low_i, low_j;
  std::array<int, slabs> slab_i, slab_i_last, slab_j, slab_j_last;
  std::ptrdiff_t pitch = 0, rows = 0;
  FloatRoom samples;
  /// What floats leave of the samples, as lane scalars too, in the same places: where gradients are wanted of samples
  /// that no float holds. Empty without.
  bool has_rest = false;
  FloatRoom rest;

  /// The rest of a sample in the block; null without.
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
  /// Makes room for `pitch` and `rows` as they are; what is there is garbage, but finite or NaN.
  void reserve() {
    const auto size = static_cast<std::size_t>(2 * margin + slices * pitch * rows);
    samples.make_room(size);
    if (has_rest) rest.make_room(size);
  }
};

}  // namespace tessera::volume
