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

/// Divides the image into square tiles in scanline order. Tiles at the right and bottom edge may be smaller.
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
  std::uint64_t between_pixels = 0;  ///< cells in view that are too small to cover the centre of a pixel
  std::uint64_t projected = 0;
};

/// What the passes have read, summed over threads. Only the counts of tile counters depend on the number of runs.
struct TileListReads {
  std::uint64_t cells = 0;            ///< cells whose extents or places were read, including those of invisible blocks
  std::uint64_t counters = 0;         ///< tile counters of runs
  std::uint64_t serial_counters = 0;  ///< tile counters that were read on one thread while the others waited
};

/// Memory of TileLists, kept from frame to frame.
struct TileListBuffers {
  LargeArray<CullVertex> vertices;
  /// One per tet: the place of the tet's box (cull_cells.hpp), if the tet is projected.
  LargeArray<std::uint32_t> places;
  LargeArray<float> near_depths;  ///< one per tet
  LargeArray<TileEntry> entries;  ///< the lists
};

/// How TileLists are built.
struct TileListSettings {
  scene::Trace* trace = nullptr;       ///< gets spans `cull` and `bin` of the threads that take part
  TileListBuffers* buffers = nullptr;  ///< memory that only these lists use, and that must outlive them; null: the
                                       ///< lists have memory of their own
  bool cull_invisible = true;          ///< whether to leave out cells that the transfer function makes invisible
  std::stop_token stop{};              ///< both passes throw scene::FrameStopped once a stop is requested
  scene::Team* team = nullptr;         ///< the team whose members build the lists together; null: none
};

/// The cells of each tile, for one view and transfer function.
///
/// The lists are built in two passes, count and fill, so that they have their final size from the start and are the
/// same for any number of threads. Their entries are in the order of the tets' blocks; within a block, the cells that
/// are in a single tile come first (a bit distinguishes them, not a branch). Both passes process the tets in runs of
/// blocks of 64 tets; each run counts its entries of every tile, and writes them where the entries of the previous run
/// end. A block without visible scalars costs almost no time in either pass. The results of the first pass take 8 bytes
/// per tet, in addition to 16 bytes per vertex; the lists take 8 bytes per entry, and are filled for a band of tiles at
/// a time.
class TileLists {
 public:
  /// First pass: culls and counts. Runs in the caller's task arena (oneTBB).
  ///
  /// With a team, the members build the lists together: each member culls and fills its share of the blocks, and counts
  /// its own cells and reads; all members have all lists. The mesh and `projected.vertices` must be in shared memory,
  /// and each member must have written its share of the vertices.
  TileLists(const ProjectedMesh& projected, const TileGrid& grid, const scene::TransferFunction& transfer_function,
            bool emits_without_extinction, TileListSettings settings = {});
  TileLists(const TileLists&) = delete;
  TileLists& operator=(const TileLists&) = delete;

  [[nodiscard]] const CullCounts& counts() const { return counts_; }

  /// The depth to which TileEntry::near_depth is relative. It is the mesh's nearest depth, so that a float
  /// distinguishes cells even far from the eye.
  [[nodiscard]] double depth_origin() const { return depth_origin_; }

  /// Entries of tile `tile`.
  [[nodiscard]] std::size_t entry_count(std::size_t tile) const { return tile_counts_[tile]; }

  /// Second pass: builds the lists of tiles [first, last). All members of a team must have finished reading the lists
  /// of the previous call.
  void fill(std::size_t first, std::size_t last);

  /// Returns the list of a tile of the last fill(). The caller may reorder it.
  [[nodiscard]] std::span<TileEntry> tile(std::size_t tile);

  /// What the first pass and all second passes so far have read.
  [[nodiscard]] const TileListReads& reads() const { return reads_; }

  /// Bytes in use.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Run {
    std::size_t first_block = 0, last_block = 0;
    CullCounts culled;
    std::uint64_t cells_read = 0;
    std::vector<std::uint32_t> tiles;  ///< number of entries in each tile; later the sums over the previous runs
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
  std::size_t columns_;  ///< columns of the grid, stored because computing them for every tet would take a division
  TileListBuffers own_;
  TileListBuffers* buffers_;
  double depth_origin_;
  CullView view_;
  CullCounts counts_;
  TileListReads reads_;
  std::vector<Run> runs_;
  std::vector<std::uint64_t> projected_tets_;  ///< one bit per tet
  std::vector<std::uint64_t> in_one_tile_;     ///< one bit per tet; only valid for projected tets
  std::vector<std::uint64_t> tile_counts_;     ///< one per tile
  std::vector<std::uint64_t> ends_;     ///< one per tile: where in the tile's list the entries of the last run end
  std::size_t first_ = 0;               ///< the first tile of the last fill()
  std::vector<std::uint64_t> offsets_;  ///< one per tile of the last fill(), and one for the end
};

}  // namespace tessera::projection
