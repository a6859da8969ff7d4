// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/sample_source.hpp"

/// The layout of a brick file (brick_file.hpp), for its readers and writers.
namespace tessera::io {

inline constexpr std::string_view brick_magic = "TESSBRK1";
inline constexpr int least_side = 8, most_side = 1024;

/// Range of a block's values as they are stored, before scale and shift.
struct BlockRange {
  double low = 1e300, high = -1e300;
  std::uint64_t blanks = 0;

  /// Adds samples, given in the grid's storage format.
  void add(const scene::Grid& grid, std::span<const std::byte> samples);
};
static_assert(sizeof(BlockRange) == 24);

/// The blocks into which a volume is divided. Positions of samples in the file are counted in samples, not in bytes.
class Blocks {
 public:
  Blocks(const scene::GridIndex& samples, std::int64_t side);

  [[nodiscard]] const scene::GridIndex& count() const { return count_; }
  [[nodiscard]] std::int64_t total() const { return count_[0] * count_[1] * count_[2]; }
  [[nodiscard]] std::int64_t number(const scene::GridIndex& b) const {
    return (b[2] * count_[1] + b[1]) * count_[0] + b[0];
  }
  [[nodiscard]] scene::SampleBox box(const scene::GridIndex& b) const;
  /// Number of samples in all blocks before block `b`: those in whole layers of blocks, in whole rows of the block's
  /// layer, and in the block's row.
  [[nodiscard]] std::int64_t first_sample(const scene::GridIndex& b) const;

 private:
  scene::GridIndex samples_, count_{};
  std::int64_t side_;
};

/// Additional header entries as pairs of name and text (volume_tags.hpp).
using BrickWords = std::vector<std::pair<std::string, std::string>>;

/// Positions of bytes in a brick file that is to be written. Keeps a reference to the grid.
class BrickLayout {
 public:
  BrickLayout(const scene::Grid& grid, int side, BrickWords words = {});

  [[nodiscard]] const Blocks& blocks() const { return blocks_; }
  [[nodiscard]] std::int64_t side() const { return side_; }
  /// Position of the first block's samples.
  [[nodiscard]] std::uint64_t first_byte() const;
  [[nodiscard]] std::uint64_t bytes() const;
  /// Returns the bytes of the file that precede the samples, given the ranges of all blocks.
  [[nodiscard]] std::string beginning(std::span<const BlockRange> ranges) const;

 private:
  const scene::Grid& grid_;
  int side_;
  BrickWords words_;
  Blocks blocks_;
  std::uint64_t header_bytes_ = 0;
};

}  // namespace tessera::io
