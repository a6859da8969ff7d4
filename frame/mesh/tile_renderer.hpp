// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>

#include "compositor/tile_sink.hpp"
#include "frame/mesh/render.hpp"
#include "projection/depth_order.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/steps.hpp"
#include "projection/surface_faces.hpp"
#include "scene/trace.hpp"

namespace tessera::frame {

/// What a tile renderer needs to know about its frame.
struct TileContext {
  const projection::ProjectedMesh* projected;
  double depth_origin;         ///< depth to which the entries' `near_depth` is relative
  std::uint64_t budget_bytes;  ///< memory for the buffers of this renderer
  scene::Trace* trace;
  Rasterizer rasterizer = Rasterizer::planes;
  float longest_edge = 1;                              ///< scanline: longest edge of the whole data set
  bool opaque = false;                                 ///< whether a typical ray ends in a fraction of the mesh's depth
  std::span<const projection::Step> steps{};           ///< steps of the transfer function
  const projection::CellsAtSteps* at_steps = nullptr;  ///< cells whose segments are cut at the steps; null: none
  const projection::FrameFaces* faces = nullptr;       ///< triangle surfaces, in double precision; null: none
  std::stop_token stop{};                              ///< renderers throw scene::FrameStopped once a stop is requested
};

/// Sums over the tiles of one renderer.
struct TileCounts {
  std::uint64_t max_segments_alive = 0, peak_bytes = 0, tiles_split = 0;
  projection::RasterCounts raster;
};

/// Renders tiles one after the other: rasterizes cells and passes the segments to a sink. Each thread has one renderer.
///
/// The cells of a tile are sorted by their nearest depth. When the store of segments is full, all segments in front of
/// the next cell are final: the sink takes the final segments, and the others stay in the store. So the required memory
/// does not depend on the depth complexity, only on the number of segments that overlap in depth. If that number
/// exceeds the store, the store grows up to the budget. After that, a sink that accepts segments in any order gets all
/// of them; for any other sink, the rectangle is rendered in quarters, each with about a quarter of the segments. No
/// segment is ever dropped.
///
/// `Source` rasterizes cells into a store of its encoding (DoubleSource, LatticeSource):
///
///   bool start(rect, order)     empties the store for these pixels; false: even that exceeds the budget
///   bool fill(sink)             adds cells to the store; returns true when the store is full, false when all cells are
///                               in the store or the sink needs no further cells
///   Depth final_depth()         after fill() returned true: no later segment begins in front of this depth
///   std::size_t at_least()      lists with fewer segments may stay in the store until they have grown
///   bool make_room()            called after the sink took the final segments; returns whether fill() can continue
///   Store& store(); std::size_t capacity(); std::uint64_t alive()
template <class Source>
class TileRenderer {
 public:
  using Encoding = typename Source::Encoding;
  using Sink = compositor::TileSink<Encoding>;

  /// `more`: additional arguments for the source.
  template <class... More>
  explicit TileRenderer(const TileContext& context, More&&... more)
      : trace_(context.trace), source_(context, counts_, std::forward<More>(more)...) {}
  TileRenderer(const TileRenderer&) = delete;
  TileRenderer& operator=(const TileRenderer&) = delete;

  /// Passes the segments of the pixels of `rect` to `sink`; `entries` are the cells of the tile, which this function
  /// reorders. Throws Error(system_failure) if one pixel alone has more segments that overlap in depth than the budget
  /// can hold.
  void render(const scene::PixelRect& rect, std::span<projection::TileEntry> entries, Sink& sink);

  [[nodiscard]] const TileCounts& counts() const { return counts_; }

 private:
  void render_part(const scene::PixelRect& rect, const projection::DepthOrder& order, Sink& sink);
  bool try_render(const scene::PixelRect& rect, const projection::DepthOrder& order, Sink& sink);

  scene::Trace* trace_;
  projection::DepthOrderScratch depth_order_;
  TileCounts counts_;
  Source source_;
};

}  // namespace tessera::frame
