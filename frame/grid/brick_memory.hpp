// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scene/image.hpp"
#include "volume/bricks/brick_cache.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/render.hpp"

namespace tessera::frame {

/// Resident memory of this process in bytes, including shared libraries; 0 if the system does not report it.
std::uint64_t resident_bytes();

/// The memory of a process that is not available for bricks.
struct OtherMemory {
  std::uint64_t resident = 0;  ///< in use now: the program and what it has read, including ranges of cells
  std::uint64_t frames = 0;    ///< what frames keep about cells and bricks: bytes_of_frames()
  scene::ImageSize picture;
  int threads = 0;
};

/// Bytes that frames of this size keep: the flags of visible cells and bricks, the cache's table of bricks and, for
/// each thread, the samples of its tile and of the rays that it casts in double precision.
std::uint64_t bytes_of_frames(const scene::GridGeometry& geometry, const volume::CellRanges& ranges,
                              const volume::RenderSettings& settings, scene::ImageSize picture);

/// Returns the part of a process's `memory` that remains for bricks of `brick` bytes each. Subtracted are `rest`, the
/// image and its copy during output, each thread's data for its tiles, and what the heap and the cache add to each
/// brick. The result is at least 8 MiB, or all of `memory` if that is less: the program alone may exceed a small
/// budget, but it still needs memory for bricks.
std::uint64_t brick_memory(std::uint64_t memory, const OtherMemory& rest, std::uint64_t brick);

}  // namespace tessera::frame
