// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tessera/export.hpp"
#include "tessera/frame_counters.hpp"
#include "tessera/pixel_rect.hpp"

namespace tessera {
inline namespace v0_1 {

/// The instruction set that kernels of this process run on.
TESSERA_EXPORT std::string instruction_set();
/// How many threads work gets that asks for so many; 0: all cores.
TESSERA_EXPORT int threads_for(int asked);

/// What happened in one frame, on all ranks together.
struct FrameStatistics {
  FrameCounters mesh;           ///< zero for grids
  GridCounters grid;            ///< zero for meshes
  bool on_lattice = false;      ///< meshes: the integer lattice held the frame; false: double precision
  std::string instruction_set;  ///< of the kernels that ran
  std::string integrator;       ///< what `automatic` chose
  std::string composited_on;    ///< meshes on several ranks, or on a device
  bool overlapping = false;     ///< meshes: cells of several ranks overlap, so Exchange::segments took runs' place
  double milliseconds = 0;      ///< from when all ranks were ready to the picture in memory
  /// Grids, of each rank: its rectangle of the picture (vertical edges may step by 4 pixels), pieces, CPU seconds.
  std::vector<PixelRect> rectangles;
  std::vector<std::uint64_t> samples;
  std::vector<double> cpu_seconds;
  std::vector<double> split_cpu_seconds;  ///< the same, of finding the rectangles: cost map, pilot pass
  std::vector<GridCounters> ranks;        ///< what `grid` is put together of
  /// Sort-last, of each rank: the voxels that it has, from the lowest up to those that it has no longer.
  std::vector<std::array<std::array<std::int64_t, 3>, 2>> parts;
};

}  // namespace v0_1
}  // namespace tessera
