// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scene/image.hpp"
#include "volume/bricks/brick_cache.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/render.hpp"

namespace tessera::frame {

/// Bytes of memory that this process holds now, shared libraries included; 0 where the system does not tell.
std::uint64_t resident_bytes();

/// What a process holds beside bricks.
struct BesideBricks {
  std::uint64_t resident = 0;  ///< now: the program and what it has read, ranges of cells
  std::uint64_t frames = 0;    ///< what frames keep of cells and bricks: bytes_of_frames()
  scene::ImageSize picture;
  int threads = 0;
};

/// What frames of this size keep: of which cells and bricks show, in the cache of where bricks are, and a thread of the
/// samples of its tile and of those for rays that are cast in double precision.
std::uint64_t bytes_of_frames(const scene::GridGeometry& geometry, const volume::CellRanges& ranges,
                              const volume::RenderSettings& settings, scene::ImageSize picture);

/// What of a process's `memory` is left for bricks of `brick` bytes beside the rest of it: what it holds, the picture
/// and its copy on the way out, what each thread keeps for its tiles, what the heap and the cache add to each brick. At
/// least 8 MiB, or all of `memory` if that is less: so small budgets are exceeded by the program itself.
std::uint64_t brick_memory(std::uint64_t memory, const BesideBricks& rest, std::uint64_t brick);

}  // namespace tessera::frame
