// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/sample_source.hpp"

namespace tessera::volume {

/// Provides a source's values in double precision, voxel by voxel, for one thread. They are read in blocks of 16^3
/// voxels; 256 blocks are cached (10 MB). The source must outlive this object.
class SampleBlocks {
 public:
  explicit SampleBlocks(const scene::SampleSource& source);

  /// Upper bound of the memory of one object, in bytes.
  static std::uint64_t most_bytes(const scene::GridGeometry& geometry);

  /// Returns the values at a voxel's corners; corner (a, b, c) has index a + 2 b + 4 c. For cell data, all values are
  /// the same. Blank values are NaN.
  [[nodiscard]] std::array<double, 8> corners(const scene::GridIndex& voxel);

  /// These counts start at construction.
  [[nodiscard]] std::uint64_t blocks_read() const { return blocks_read_; }
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  struct Block {
    scene::GridIndex place{-1, -1, -1};
    scene::SampleBox box;
    std::vector<double> values;
  };
  void fill(Block& block, const scene::GridIndex& place);

  const scene::SampleSource& source_;
  scene::GridIndex samples_;
  std::int64_t shared_;
  std::vector<Block> blocks_;
  std::uint64_t blocks_read_ = 0, bytes_read_ = 0;
};

}  // namespace tessera::volume
