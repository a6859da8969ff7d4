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

/// The instruction set that this process's kernels use.
TESSERA_EXPORT std::string instruction_set();
/// The number of threads for a setting of `asked`; 0: all cores.
TESSERA_EXPORT int threads_for(int asked);

/// Statistics of one frame, for all ranks together.
struct FrameStatistics {
  FrameCounters mesh;           ///< zero for grids
  GridCounters grid;            ///< zero for meshes
  bool on_lattice = false;      ///< meshes: the integer lattice was precise enough; false: double precision
  std::string instruction_set;  ///< of the kernels that ran
  std::string integrator;       ///< chosen by `automatic`
  std::string composited_on;    ///< meshes on several ranks, or on a device
  bool overlapping = false;     ///< meshes: cells of several ranks overlap, so Exchange::segments replaced runs
  double milliseconds = 0;      ///< from when all ranks were ready to the image in memory
  /// Grids, for each rank: its rectangle of the image (vertical edges may step by 4 pixels), pieces, CPU seconds.
  std::vector<PixelRect> rectangles;
  std::vector<std::uint64_t> samples;
  std::vector<double> cpu_seconds;
  std::vector<double> split_cpu_seconds;  ///< the same for finding the rectangles: cost map, pilot pass
  std::vector<GridCounters> ranks;        ///< the counters from which `grid` is combined
  /// Sort-last, for each rank: its voxels, from the first index to one past the last.
  std::vector<std::array<std::array<std::int64_t, 3>, 2>> parts;
};

}  // namespace v0_1
}  // namespace tessera
