// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "projection/cull_cells.hpp"
#include "projection/footprint.hpp"
#include "projection/large_array.hpp"
#include "projection/planes_rasterizer.hpp"
#include "scene/team.hpp"
#include "scene/trace.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::projection {

/// The image divided into square tiles in scanline order; those at the right and bottom edge may be smaller.
struct TileGrid {
  scene::ImageSize image;
  int tile_size;
  [[nodiscard]] int columns() const { return (image.width + tile_size - 1) / tile_size; }
  [[nodiscard]] int rows() const { return (image.height + tile_size - 1) / tile_size; }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
  }
  [[nodiscard]] scene::PixelRect rect(std::size_t tile) const;
};

/// The number of cells that were left out, by reason.
struct CullCounts {
  std::uint64_t invisible = 0;       ///< the transfer function is zero over all of their scalars
  std::uint64_t outside_view = 0;    ///< outside the window or the clipping range
  std::uint64_t between_pixels = 0;  ///< in view, but too small to cover the centre of a pixel
  std::uint64_t projected = 0;
};

/// What the passes have read, summed over threads. Only the counters depend on the number of runs.
struct TileListReads {
  std::uint64_t cells = 0;            ///< cells whose extents or places were read, including those of invisible blocks
  std::uint64_t counters = 0;         ///< tile counters of runs
  std::uint64_t serial_counters = 0;  ///< those read on one thread while the others wait
};

/// Memory of TileLists, kept from frame to frame.
struct TileListBuffers {
  LargeArray<CullVertex> vertices;
  LargeArray<std::uint32_t> places;  ///< one per tet: the place of its box (cull_cells.hpp), if it is projected
  LargeArray<float> near_depths;     ///< one per tet
  LargeArray<TileEntry> entries;     ///< the lists
};

/// How TileLists are built.
struct TileListSettings {
  scene::Trace* trace = nullptr;       ///< gets spans `cull` and `bin` of the threads that take part
  TileListBuffers* buffers = nullptr;  ///< must outlive the lists, which alone use it; null: the lists have their own
  bool cull_invisible = true;          ///< leave out cells that the transfer function makes invisible
  std::stop_token stop{};              ///< both passes throw scene::FrameStopped once it is requested
  scene::Team* team = nullptr;         ///< whose members build the lists together; null: none
};

/// The cells of each tile, for one view and transfer function.
///
/// Two passes, count and fill, so that lists have their final size from the start and are the same for any number of
/// threads. They are in the order of the tets' blocks; within a block, the cells in a single tile come first (a bit
/// distinguishes them, not a branch). Both passes process the tets in runs of blocks of 64; each run counts its entries
/// of every tile, and writes them where those of the previous run end. A block without visible scalars costs almost
/// nothing in either pass. The results of the first pass take 8 bytes per tet, in addition to 16 per vertex; the lists,
/// 8 bytes per entry, are filled for a band of tiles at a time.
class TileLists {
 public:
  /// First pass: culls and counts. Work runs in the caller's task arena (oneTBB).
  ///
  /// With a team, the members build the lists together: each culls and fills its share of the blocks and counts its own
  /// cells and reads, and all have all lists. The mesh and `projected.vertices` are in shared memory; each member has
  /// written its share of the latter.
  TileLists(const ProjectedMesh& projected, const TileGrid& grid, const scene::TransferFunction& transfer_function,
            bool emits_without_extinction, TileListSettings settings = {});
  TileLists(const TileLists&) = delete;
  TileLists& operator=(const TileLists&) = delete;

  [[nodiscard]] const CullCounts& counts() const { return counts_; }

  /// TileEntry::near_depth is relative to this depth, the mesh's nearest, so that a float distinguishes cells also far
  /// from the eye.
  [[nodiscard]] double depth_origin() const { return depth_origin_; }

  /// Entries of tile `tile`.
  [[nodiscard]] std::size_t entry_count(std::size_t tile) const { return tile_counts_[tile]; }

  /// Second pass: builds the lists of tiles [first, last). No member of a team may still read the lists of the previous
  /// call.
  void fill(std::size_t first, std::size_t last);

  /// The list of a tile of the last fill(); the caller may reorder it.
  [[nodiscard]] std::span<TileEntry> tile(std::size_t tile);

  /// Of the first pass and all second ones so far.
  [[nodiscard]] const TileListReads& reads() const { return reads_; }

  /// Bytes in use.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Run {
    std::size_t first_block = 0, last_block = 0;
    CullCounts culled;
    std::uint64_t cells_read = 0;
    std::vector<std::uint32_t> tiles;  ///< entries in each tile; later the sums over the previous runs
  };
  void cull(Run& run, const ClearIntervals& clear);
  bool cull_exactly(std::size_t tet, const ClearIntervals& clear, CullCounts& counts);
  void fill(std::size_t run, std::size_t first, std::size_t last);
  void add_counts();
  void add_reads(std::size_t tiles);
  template <class Visit>
  void for_each_tile(std::size_t tet, Visit visit) const;

  const ProjectedMesh* projected_;
  scene::Trace* trace_;
  TileGrid grid_;
  std::stop_token stop_;
  scene::Team* team_;
  std::size_t columns_;  ///< of the grid: computing them for every tet would take a division
  TileListBuffers own_;
  TileListBuffers* buffers_;
  double depth_origin_;
  CullView view_;
  CullCounts counts_;
  TileListReads reads_;
  std::vector<Run> runs_;
  std::vector<std::uint64_t> projected_tets_;  ///< one bit per tet
  std::vector<std::uint64_t> in_one_tile_;     ///< one bit per tet, for projected ones
  std::vector<std::uint64_t> tile_counts_;     ///< one per tile
  std::vector<std::uint64_t> ends_;            ///< one per tile: where in its list the entries of the last run end
  std::size_t first_ = 0;                      ///< the first tile of the last fill()
  std::vector<std::uint64_t> offsets_;         ///< one per tile of the last fill(), and the end
};

}  // namespace tessera::projection
