#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/footprint.hpp"
#include "projection/planes_rasterizer.hpp"
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
  [[nodiscard]] PixelRect rect(std::size_t tile) const;
};

/// Which cells were left out, and why.
struct CullCounts {
  std::uint64_t invisible = 0;       ///< the transfer function is zero over all of their scalars
  std::uint64_t outside_view = 0;    ///< outside the window or the clipping range
  std::uint64_t between_pixels = 0;  ///< in view, but too small to cover any pixel's centre
  std::uint64_t projected = 0;
};

/// The cells of each tile, for one view and transfer function.
///
/// Two passes, count and fill, so that lists have their final size at once and stand in tet order whatever the threads
/// do. 12 bytes a tet hold what the first pass found; the lists themselves are filled for a band of tiles at a time.
class TileLists {
 public:
  /// First pass: culls and counts. Work runs in the caller's task arena (oneTBB); `trace`, if any, gets spans `cull`
  /// and `bin` of the threads that help.
  TileLists(const ProjectedMesh& projected, const TileGrid& grid, const scene::TransferFunction& transfer_function,
            bool emits_without_extinction, scene::Trace* trace = nullptr);

  [[nodiscard]] const CullCounts& counts() const { return counts_; }

  /// Depth from which TileEntry::near_depth counts: the mesh's nearest, so that a float tells cells apart far from the
  /// eye too.
  [[nodiscard]] double depth_origin() const { return depth_origin_; }

  /// Entries of tile `tile`.
  [[nodiscard]] std::size_t entry_count(std::size_t tile) const { return tile_counts_[tile]; }

  /// Second pass: makes the lists of tiles [first, last).
  void fill(std::size_t first, std::size_t last);

  /// A tile of the last fill, in tet order; the caller may reorder it.
  [[nodiscard]] std::span<TileEntry> tile(std::size_t tile);

  /// Bytes held now.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Extent {
    std::uint16_t column0, row0, column1, row1;  ///< inclusive tiles; column0 > column1: culled
    float near_depth;
  };
  template <class Visit>
  void for_each_tile(std::size_t tet, Visit visit) const;

  const ProjectedMesh* projected_;
  scene::Trace* trace_;
  TileGrid grid_;
  double depth_origin_;
  CullCounts counts_;
  std::vector<Extent> extents_;             ///< one a tet
  std::vector<std::uint64_t> tile_counts_;  ///< one a tile
  std::size_t first_ = 0;                   ///< of the last fill
  std::vector<std::uint64_t> offsets_;      ///< one a tile of the last fill, and the end
  std::vector<TileEntry> entries_;
};

}  // namespace tessera::projection
