// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/sample_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace tessera::volume {
namespace {

constexpr std::int64_t block_side = 16;
constexpr std::size_t blocks_kept = 256;

}  // namespace

SampleBlocks::SampleBlocks(const scene::SampleSource& source)
    : source_(source),
      samples_(source.geometry().samples()),
      shared_(source.geometry().association == scene::Association::point ? 1 : 0),
      blocks_(blocks_kept) {}

std::uint64_t SampleBlocks::most_bytes(const scene::GridGeometry& geometry) {
  double all = 1;
  for (const std::int64_t n : geometry.voxels()) {
    const std::int64_t blocks = (n + block_side - 1) / block_side;
    all *= static_cast<double>(blocks);
  }
  constexpr std::uint64_t side = block_side + 1;
  return static_cast<std::uint64_t>(std::min(all, static_cast<double>(blocks_kept))) * side * side * side *
         sizeof(double);
}

std::array<double, 8> SampleBlocks::corners(const scene::GridIndex& voxel) {
  const scene::GridIndex place{voxel[0] / block_side, voxel[1] / block_side, voxel[2] / block_side};
  Block& block = blocks_[static_cast<std::size_t>(place[0] + 7 * place[1] + 49 * place[2]) % blocks_kept];
  if (block.place != place || block.values.empty()) fill(block, place);
  const std::int64_t width = block.box.extent(0), slice = width * block.box.extent(1);
  const double* const at = &block.values[static_cast<std::size_t>(
      (voxel[0] - block.box.low[0]) + width * (voxel[1] - block.box.low[1]) + slice * (voxel[2] - block.box.low[2]))];
  const std::int64_t i = shared_, j = shared_ * width, k = shared_ * slice;
  return {at[0], at[i], at[j], at[i + j], at[k], at[k + i], at[k + j], at[k + i + j]};
}

void SampleBlocks::fill(Block& block, const scene::GridIndex& place) {
  for (std::size_t a = 0; a < 3; ++a) {
    block.box.low[a] = place[a] * block_side;
    block.box.high[a] = std::min(block.box.low[a] + block_side + shared_, samples_[a]);
  }
  block.values.resize(static_cast<std::size_t>(block.box.count()));
  block.place = place;
  source_.read(block.box, std::span<double>(block.values));
  for (double& v : block.values) v = std::isfinite(v) ? source_.grid().value(v) : std::nan("");
  ++blocks_read_;
  bytes_read_ += static_cast<std::uint64_t>(block.box.count()) * scene::size_of(source_.grid().type);
}

}  // namespace tessera::volume
