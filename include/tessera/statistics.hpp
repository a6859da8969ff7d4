#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/export.hpp"
#include "tessera/frame_counters.hpp"
#include "tessera/pixel_rect.hpp"

namespace tessera {

/// What a frame of a grid took, counted.
struct GridCounters {
  std::uint64_t rays = 0;                                ///< rays that meet the volume
  std::uint64_t voxels_visited = 0;                      ///< stretches of rays in one voxel that were evaluated
  std::uint64_t samples = 0;                             ///< pieces integrated, or samples taken
  std::uint64_t pixels_again = 0;                        ///< cast again in double precision
  std::uint64_t bricks_total = 0, bricks_invisible = 0;  ///< the latter are never loaded
  std::uint64_t brick_hits = 0, bricks_loaded = 0, bricks_evicted = 0;  ///< uses that found it in memory; else
  std::uint64_t bytes_loaded = 0, bytes_resident = 0, peak_bytes = 0;   ///< of bricks; the last two at the end
  std::uint64_t blank_samples = 0;                                      ///< of the whole volume (NaN, infinite)
};

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
  double milliseconds = 0;      ///< from when all ranks were ready to the picture in memory
  /// Grids, of each rank: its rectangle of the picture, pieces integrated, CPU time of all its threads.
  std::vector<PixelRect> rectangles;
  std::vector<std::uint64_t> samples;
  std::vector<double> cpu_seconds;
};

}  // namespace tessera
