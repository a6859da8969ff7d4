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

/// The picture cut into square tiles in scanline order; those at the right and bottom edge may be narrower.
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

/// Which cells were left out, and why.
struct CullCounts {
  std::uint64_t invisible = 0;       ///< the transfer function is zero over all of their scalars
  std::uint64_t outside_view = 0;    ///< outside the window or the clipping range
  std::uint64_t between_pixels = 0;  ///< in view, but too small to cover any pixel's centre
  std::uint64_t projected = 0;
};

/// What the passes have read, of all threads together: it grows with the number of runs only by their counters.
struct TileListReads {
  std::uint64_t cells = 0;            ///< cells of which extents or places were read, with blocks that show nothing
  std::uint64_t counters = 0;         ///< tile counters of runs
  std::uint64_t serial_counters = 0;  ///< of these, on one thread while the others wait
};

/// Memory of TileLists, kept from frame to frame.
struct TileListBuffers {
  LargeArray<CullVertex> vertices;
  LargeArray<std::uint32_t> places;  ///< one a tet: where its box lies (cull_cells.hpp), if it is projected
  LargeArray<float> near_depths;     ///< one a tet
  LargeArray<TileEntry> entries;     ///< the lists
};

/// How TileLists are made.
struct TileListSettings {
  scene::Trace* trace = nullptr;       ///< gets spans `cull` and `bin` of the threads that help
  TileListBuffers* buffers = nullptr;  ///< must outlive the lists and serve no others meanwhile; null: their own
  bool cull_invisible = true;          ///< leave out cells of which the transfer function shows nothing
  std::stop_token stop{};              ///< both passes throw scene::FrameStopped once it is asked for
  scene::Team* team = nullptr;         ///< whose members make the lists together; null: none
};

/// The cells of each tile, for one view and transfer function.
///
/// Two passes, count and fill, so that lists have their final size at once and are the same whatever the threads
/// do: in the order of the tets' blocks, of each block those in one tile first (which is told from the others by a bit,
/// not a branch). Both go over the tets in runs of blocks of 64; each run counts its entries of every tile, and fills
/// them where the runs before it end. A block without visible scalars costs nothing, in either pass. 8 bytes a tet hold
/// what the first pass found, beside 16 a vertex; the lists, 8 bytes an entry, are filled for a band of tiles at a
/// time.
class TileLists {
 public:
  /// First pass: culls and counts. Work runs in the caller's task arena (oneTBB).
  ///
  /// With a team the members make the lists together: each culls and fills its share of the blocks and counts its own
  /// cells and reads, and all have all lists. The mesh and `projected.vertices` are in shared memory, of the latter
  /// each member's share is there.
  TileLists(const ProjectedMesh& projected, const TileGrid& grid, const scene::TransferFunction& transfer_function,
            bool emits_without_extinction, TileListSettings settings = {});
  TileLists(const TileLists&) = delete;
  TileLists& operator=(const TileLists&) = delete;

  [[nodiscard]] const CullCounts& counts() const { return counts_; }

  /// Depth from which TileEntry::near_depth counts: the mesh's nearest, so that a float tells cells apart far from the
  /// eye too.
  [[nodiscard]] double depth_origin() const { return depth_origin_; }

  /// Entries of tile `tile`.
  [[nodiscard]] std::size_t entry_count(std::size_t tile) const { return tile_counts_[tile]; }

  /// Second pass: makes the lists of tiles [first, last). No member of a team reads those of the pass before any more.
  void fill(std::size_t first, std::size_t last);

  /// A tile of the last fill; the caller may reorder it.
  [[nodiscard]] std::span<TileEntry> tile(std::size_t tile);

  /// Of the first pass and every second one so far.
  [[nodiscard]] const TileListReads& reads() const { return reads_; }

  /// Bytes held now.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Run {
    std::size_t first_block = 0, last_block = 0;
    CullCounts culled;
    std::uint64_t cells_read = 0;
    std::vector<std::uint32_t> tiles;  ///< entries in each tile; later those of the runs before
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
  std::size_t columns_;  ///< of the grid, which would divide for them tet by tet
  TileListBuffers own_;
  TileListBuffers* buffers_;
  double depth_origin_;
  CullView view_;
  CullCounts counts_;
  TileListReads reads_;
  std::vector<Run> runs_;
  std::vector<std::uint64_t> projected_tets_;  ///< a bit a tet
  std::vector<std::uint64_t> in_one_tile_;     ///< the same, of those projected
  std::vector<std::uint64_t> tile_counts_;     ///< one a tile
  std::vector<std::uint64_t> ends_;            ///< one a tile: where in its list the entries of the last run end
  std::size_t first_ = 0;                      ///< of the last fill
  std::vector<std::uint64_t> offsets_;         ///< one a tile of the last fill, and the end
};

}  // namespace tessera::projection
