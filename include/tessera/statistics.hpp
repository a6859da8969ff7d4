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
/// Returns the number of threads that are used if `asked` are requested; 0 requests one for each core.
TESSERA_EXPORT int threads_for(int asked);

/// Statistics of one frame, for all ranks together.
struct FrameStatistics {
  FrameCounters mesh;           ///< counters of a mesh; zero for grids
  GridCounters grid;            ///< counters of a grid; zero for meshes
  bool on_lattice = false;      ///< meshes: true if the integer lattice was precise enough; false: double precision was
                                ///< used
  std::string instruction_set;  ///< the instruction set of the kernels that ran
  std::string integrator;       ///< the integrator chosen by `automatic`
  std::string composited_on;    ///< where a mesh was composited, on several ranks or on a device
  bool overlapping = false;     ///< meshes: cells of several ranks overlap, so that segments were sent instead of runs
  double milliseconds = 0;      ///< time from when all ranks were ready until the image was in memory
  /// For grids, one entry per rank: the rank's rectangle of the image (vertical edges may step by 4 pixels), the number
  /// of pieces or samples that it integrated, and its CPU seconds.
  std::vector<PixelRect> rectangles;
  std::vector<std::uint64_t> samples;
  std::vector<double> cpu_seconds;
  std::vector<double> split_cpu_seconds;  ///< CPU seconds for finding the rectangles: cost map and pilot rays
  std::vector<GridCounters> ranks;        ///< the counters of each rank, from which `grid` is computed
  /// With sort-last, for each rank: its voxels, given by the first index and one past the last index.
  std::vector<std::array<std::array<std::int64_t, 3>, 2>> parts;
};

}  // namespace v0_1
}  // namespace tessera
