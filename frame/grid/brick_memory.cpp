// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/brick_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "scene/threads.hpp"
#include "volume/bricks/sample_blocks.hpp"
#include "volume/bricks/slab_block.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::frame {

std::uint64_t resident_bytes() {
  std::uint64_t whole = 0, resident = 0;
  std::ifstream statm("/proc/self/statm");
  if (!(statm >> whole >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

namespace {

/// Bytes of the samples that a thread lays out for a tile's rays (volume/bricks/slab_block.hpp), if the volume fills
/// the image. If the eye is farther away, a tile covers more of the volume.
std::uint64_t bytes_of_tile(const scene::GridGeometry& geometry, scene::ImageSize picture) {
  constexpr double pixels = volume::TileRays::side, leaning = 1.5, beside = 10;
  scene::GridIndex samples = geometry.samples();
  std::ranges::sort(samples);
  const double across = pixels * leaning * static_cast<double>(samples[2]) / std::min(picture.width, picture.height);
  const auto along = [&](std::size_t a) { return std::min(across + beside, static_cast<double>(samples[a])); };
  return static_cast<std::uint64_t>(along(1) * along(2)) * volume::SlabBlock::slices * sizeof(float);
}

}  // namespace

std::uint64_t bytes_of_frames(const scene::GridGeometry& geometry, const volume::CellRanges& ranges,
                              const volume::RenderSettings& settings, scene::ImageSize picture) {
  // Bytes per cell: one for the frame's flags, one for the flags by which sort-last splits the volume, and two for the
  // flags of surfaces and a copy of these.
  std::uint64_t a_cell = 1;
  if (settings.parts > 1) a_cell += 1;
  if (!settings.surfaces.empty()) a_cell += 2;
  const IntegratorKind kind = settings.integrator.kind;
  if (kind == IntegratorKind::preintegrated) a_cell += 2 * sizeof(float);  // ranges of values within reach of a step
  // Casting rays again and finding surfaces each need blocks of samples in every thread.
  const std::uint64_t walks = (volume::in_steps(kind) ? 0 : 1) + (settings.surfaces.empty() ? 0 : 1);
  const std::uint64_t a_thread = walks * volume::SampleBlocks::most_bytes(geometry) + bytes_of_tile(geometry, picture);
  const auto threads = static_cast<std::uint64_t>(scene::threads_for(settings.threads));
  return ranges.count() * a_cell + threads * a_thread +
         volume::BrickCache::bytes_of_table({geometry, settings.grid.brick_size, settings.grid.edge_bricks});
}

std::uint64_t brick_memory(std::uint64_t memory, const OtherMemory& rest, std::uint64_t brick) {
  constexpr std::uint64_t mib = 1 << 20, least = 8 * mib, a_thread = 2 * mib, heap = 8 * mib;
  constexpr std::uint64_t a_pixel = 5 * sizeof(float);  // RGBA and depth
  const auto threads = static_cast<std::uint64_t>(scene::threads_for(rest.threads));
  const auto pixels = static_cast<std::uint64_t>(rest.picture.width) * static_cast<std::uint64_t>(rest.picture.height);
  const std::uint64_t taken = rest.resident + rest.frames + 2 * a_pixel * pixels + threads * a_thread + heap;
  const std::uint64_t left = memory > taken ? memory - taken : 0;
  const double bricks =
      static_cast<double>(brick) / static_cast<double>(brick + volume::BrickCache::bytes_beside_brick);
  return std::max(std::min(memory, least), static_cast<std::uint64_t>(static_cast<double>(left) * bricks));
}

}  // namespace tessera::frame
