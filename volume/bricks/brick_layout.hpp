// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/grid.hpp"
#include "volume/render.hpp"

namespace tessera::volume {

/// The division of a volume into bricks of size^3 voxels (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU
/// 2008, 3.2). Bricks at the high ends have the remaining voxels.
///
/// Numbers   Brick (a, b, c) has the number a + bricks[0] * (b + bricks[1] * c).
/// Samples   Point data: the voxels of a brick and one more sample along each axis, which it shares with its neighbour.
///           Cell data: one sample per voxel, none shared.
struct BrickLayout {
  scene::GridIndex samples, voxels, bricks;
  std::int64_t size;
  std::int64_t shared;  ///< samples shared with the next brick: 1 for point data, 0 for cell data
  EdgeBricks edge;

  BrickLayout(const scene::GridGeometry& geometry, int brick_size, EdgeBricks edge_bricks)
      : samples(geometry.samples()),
        voxels(geometry.voxels()),
        size(brick_size),
        shared(geometry.association == scene::Association::point ? 1 : 0),
        edge(edge_bricks) {
    for (std::size_t a = 0; a < 3; ++a) bricks[a] = (voxels[a] + size - 1) / size;
  }

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(bricks[0] * bricks[1] * bricks[2]); }
  [[nodiscard]] std::size_t number(const scene::GridIndex& b) const {
    return static_cast<std::size_t>(b[0] + bricks[0] * (b[1] + bricks[1] * b[2]));
  }
  [[nodiscard]] scene::GridIndex place(std::size_t brick) const {
    const auto n = static_cast<std::int64_t>(brick);
    return {n % bricks[0], n / bricks[0] % bricks[1], n / bricks[0] / bricks[1]};
  }
  /// Returns the number, along `axis`, of the brick that contains a sample; for a shared sample, that of the upper
  /// brick.
  [[nodiscard]] std::int64_t brick_of(std::size_t axis, std::int64_t sample) const {
    return std::min(sample / size, bricks[axis] - 1);
  }
  [[nodiscard]] scene::SampleBox box(const scene::GridIndex& b) const {
    scene::SampleBox box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = b[a] * size;
      box.high[a] = std::min(box.low[a] + size + shared, samples[a]);
    }
    return box;
  }
  /// Returns the number of samples along each axis for which a brick's memory has room.
  [[nodiscard]] scene::GridIndex room(const scene::GridIndex& b) const {
    if (edge == EdgeBricks::fixed) return {size + shared, size + shared, size + shared};
    const scene::SampleBox samples_box = box(b);
    return {samples_box.extent(0), samples_box.extent(1), samples_box.extent(2)};
  }
};

}  // namespace tessera::volume
