// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "tessera/counter.hpp"

namespace tessera {
inline namespace v0_1 {

/// Counters of one frame of a mesh. The table frame_counters contains their names and meanings; docs/REFERENCE.md
/// repeats them.
struct FrameCounters {
  std::uint64_t tets_total = 0;
  std::uint64_t tets_invisible = 0;
  std::uint64_t tets_outside_view = 0;
  std::uint64_t tets_between_pixels = 0;
  std::uint64_t tets_projected = 0;
  std::uint64_t segments = 0;
  std::uint64_t segments_in_double_precision = 0;
  std::uint64_t max_segments_alive = 0;
  std::uint64_t peak_buffer_bytes = 0;
  std::uint64_t exact_sign_tests = 0;
  std::uint64_t unpaired = 0;
  std::uint64_t tiles_split = 0;
  std::uint64_t deep_samples = 0;
  std::uint64_t cells_on_device = 0;
  std::uint64_t fragments = 0;
  std::uint64_t exchange_bytes = 0;
  std::uint64_t exchange_messages = 0;

  FrameCounters& operator+=(const FrameCounters& other);
};

/// Counters of one frame of a grid. The table grid_counters contains their names and meanings.
struct GridCounters {
  std::uint64_t rays = 0;
  std::uint64_t voxels_visited = 0;
  std::uint64_t samples = 0;
  std::uint64_t pixels_again = 0;
  std::uint64_t bricks_total = 0;
  std::uint64_t bricks_invisible = 0;
  std::uint64_t brick_hits = 0;
  std::uint64_t bricks_loaded = 0;
  std::uint64_t bricks_evicted = 0;
  std::uint64_t bytes_loaded = 0;
  std::uint64_t bytes_resident = 0;
  std::uint64_t peak_bytes = 0;
  std::uint64_t blank_samples = 0;
  std::uint64_t bricks_preloaded = 0;
  std::uint64_t load_us = 0;
  std::uint64_t cull_us = 0;
  std::uint64_t evict_us = 0;
  std::uint64_t exchange_bytes = 0;
  std::uint64_t exchange_messages = 0;
  std::uint64_t composite_us = 0;

  GridCounters& operator+=(const GridCounters& other);
};

using FrameCounter = Counter<FrameCounters>;
using GridCounter = Counter<GridCounters>;

/// All counters of meshes, in the order of reports. tets_total is the sum of the four counters that follow it.
inline constexpr std::array<FrameCounter, 17> frame_counters{{
    {"tets_total", &FrameCounters::tets_total, FrameCounter::Together::sum, false, "tetrahedra of the mesh"},
    {"tets_invisible", &FrameCounters::tets_invisible, FrameCounter::Together::sum, false,
     "never projected: the transfer function is zero over all of their scalars"},
    {"tets_outside_view", &FrameCounters::tets_outside_view, FrameCounter::Together::sum, false,
     "remaining tetrahedra outside the image or the clipping range"},
    {"tets_between_pixels", &FrameCounters::tets_between_pixels, FrameCounter::Together::sum, false,
     "remaining tetrahedra too small to cover the centre of any pixel"},
    {"tets_projected", &FrameCounters::tets_projected, FrameCounter::Together::sum, false,
     "the other tetrahedra, which are projected"},
    {"segments", &FrameCounters::segments, FrameCounter::Together::sum, false,
     "ray segments composited, or left out behind opaque ones"},
    {"segments_in_double_precision", &FrameCounters::segments_in_double_precision, FrameCounter::Together::sum, false,
     "segments of the cells that float lanes cannot represent; all if the whole frame is in double precision"},
    {"max_segments_alive", &FrameCounters::max_segments_alive, FrameCounter::Together::largest, false,
     "most segments that one thread held at once"},
    {"peak_buffer_bytes", &FrameCounters::peak_buffer_bytes, FrameCounter::Together::sum, false,
     "most bytes of frame buffers held at once, estimated from capacities"},
    {"exact_sign_tests", &FrameCounters::exact_sign_tests, FrameCounter::Together::sum, false,
     "edge signs that exact arithmetic decided"},
    {"unpaired", &FrameCounters::unpaired, FrameCounter::Together::sum, false,
     "scanline: front-face fragments left out, because they have no matching back-face fragment"},
    {"tiles_split", &FrameCounters::tiles_split, FrameCounter::Together::sum, false,
     "tiles worked through in parts to stay within the memory budget"},
    {"deep_samples", &FrameCounters::deep_samples, FrameCounter::Together::sum, true, "samples of the deep image"},
    {"cells_on_device", &FrameCounters::cells_on_device, FrameCounter::Together::sum, true,
     "tetrahedra that OpenGL devices rasterized, counted once for each tile in which they are visible"},
    {"fragments", &FrameCounters::fragments, FrameCounter::Together::sum, true,
     "runs, segments or cells that projectors sent to compositors"},
    {"exchange_bytes", &FrameCounters::exchange_bytes, FrameCounter::Together::sum, true,
     "bytes of the messages that contained these fragments, including messages to the same process"},
    {"exchange_messages", &FrameCounters::exchange_messages, FrameCounter::Together::sum, true,
     "number of these messages"},
}};
/// All counters of grids, in the order of reports. Counters whose values are the same on all processes are combined by
/// taking the largest value.
inline constexpr std::array<GridCounter, 20> grid_counters{{
    {"rays", &GridCounters::rays, GridCounter::Together::sum, false, "rays that meet the volume"},
    {"voxels_visited", &GridCounters::voxels_visited, GridCounter::Together::sum, false,
     "parts of rays, each within one voxel, that were evaluated"},
    {"samples", &GridCounters::samples, GridCounter::Together::sum, false, "pieces integrated, or samples taken"},
    {"pixels_in_double_precision", &GridCounters::pixels_again, GridCounter::Together::sum, false,
     "pixels cast again in double precision"},
    {"bricks_total", &GridCounters::bricks_total, GridCounter::Together::largest, false, "bricks of the volume"},
    {"bricks_invisible", &GridCounters::bricks_invisible, GridCounter::Together::largest, false,
     "of them, those never loaded: the transfer function is zero over all of their samples"},
    {"brick_hits", &GridCounters::brick_hits, GridCounter::Together::sum, false, "uses that found the brick in memory"},
    {"bricks_loaded", &GridCounters::bricks_loaded, GridCounter::Together::sum, false,
     "uses that did not find the brick in memory"},
    {"bricks_evicted", &GridCounters::bricks_evicted, GridCounter::Together::sum, false,
     "bricks that made room for others"},
    {"bytes_loaded", &GridCounters::bytes_loaded, GridCounter::Together::sum, false,
     "bytes of bricks read from the source"},
    {"bytes_resident", &GridCounters::bytes_resident, GridCounter::Together::sum, false,
     "bytes of bricks in memory at the end"},
    {"peak_bytes", &GridCounters::peak_bytes, GridCounter::Together::sum, false,
     "largest number of bytes of bricks in memory since the start"},
    {"blank_samples", &GridCounters::blank_samples, GridCounter::Together::largest, false,
     "samples of the whole volume that are NaN or infinite"},
    {"bricks_preloaded", &GridCounters::bricks_preloaded, GridCounter::Together::sum, true,
     "bricks loaded ahead of their use, since the previous frame"},
    {"brick_load_us", &GridCounters::load_us, GridCounter::Together::sum, true,
     "microseconds that threads spent on reading bricks that a ray waited for"},
    {"brick_cull_us", &GridCounters::cull_us, GridCounter::Together::sum, true,
     "microseconds spent on finding which cells and bricks are visible"},
    {"brick_evict_us", &GridCounters::evict_us, GridCounter::Together::sum, true,
     "microseconds spent on making room for bricks"},
    {"exchange_bytes", &GridCounters::exchange_bytes, GridCounter::Together::sum, true,
     "sort-last: bytes of pixels sent to the processes that composite them"},
    {"exchange_messages", &GridCounters::exchange_messages, GridCounter::Together::sum, true,
     "number of messages that contained these pixels"},
    {"composite_us", &GridCounters::composite_us, GridCounter::Together::largest, true,
     "sort-last: microseconds from a process's last ray to its last composited pixel, waiting included"},
}};
static_assert(sizeof(FrameCounters) == frame_counters.size() * sizeof(std::uint64_t), "a counter is not in the table");
static_assert(sizeof(GridCounters) == grid_counters.size() * sizeof(std::uint64_t), "a counter is not in the table");
static_assert(std::is_trivially_copyable_v<FrameCounters> && std::is_trivially_copyable_v<GridCounters>,
              "processes send them unchanged");

inline FrameCounters& FrameCounters::operator+=(const FrameCounters& other) {
  add_counters(frame_counters, other, *this);
  return *this;
}

inline GridCounters& GridCounters::operator+=(const GridCounters& other) {
  add_counters(grid_counters, other, *this);
  return *this;
}

}  // namespace v0_1
}  // namespace tessera
