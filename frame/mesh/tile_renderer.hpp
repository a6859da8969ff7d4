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

/// A tile renderer's view of its frame.
struct TileContext {
  const projection::ProjectedMesh* projected;
  double depth_origin;         ///< of the entries' near_depth
  std::uint64_t budget_bytes;  ///< for this renderer's buffers
  scene::Trace* trace;
  Rasterizer rasterizer = Rasterizer::planes;
  float longest_edge = 1;                              ///< scanline: of the whole data set
  bool opaque = false;                                 ///< a typical ray ends in a fraction of the mesh's depth
  std::span<const projection::Step> steps{};           ///< of the transfer function
  const projection::CellsAtSteps* at_steps = nullptr;  ///< whose segments are cut there; null: none
  const projection::FrameFaces* faces = nullptr;       ///< surfaces of triangles, in double precision; null: none
  std::stop_token stop{};                              ///< renderers throw scene::FrameStopped once it is requested
};

/// Sums over the tiles of one renderer.
struct TileCounts {
  std::uint64_t max_segments_alive = 0, peak_bytes = 0, tiles_split = 0;
  projection::RasterCounts raster;
};

/// Renders tiles one after the other: rasterizes cells and passes the segments to a sink; one renderer per thread.
///
/// A tile's cells come in the order of their nearest depth. When the store of segments is full, all segments nearer
/// than the next cell are final: the sink takes them, the others stay. So memory does not depend on the depth
/// complexity, only on the number of segments that overlap in depth. If that exceeds the store, the store grows up to
/// the budget. After that, a sink that accepts segments in any order gets all of them; for another sink the rectangle
/// is rendered in quarters, which hold a quarter of the segments each. No segment is ever dropped.
///
/// `Source` fills a store of its encoding from cells (DoubleSource, LatticeSource):
///
///   bool start(rect, order)     empties the store for these pixels; false: even that exceeds the budget
///   bool fill(sink)             adds cells until the store is full (true), or until all are in it or the sink needs no
///                               more (false)
///   Depth final_depth()         after fill() returned true: no later segment is before this depth
///   std::size_t at_least()      shorter lists may wait
///   bool make_room()            after the sink took the final segments: whether fill() can continue
///   Store& store(); std::size_t capacity(); std::uint64_t alive()
template <class Source>
class TileRenderer {
 public:
  using Encoding = typename Source::Encoding;
  using Sink = compositor::TileSink<Encoding>;

  /// `more`: additional arguments of the source.
  template <class... More>
  explicit TileRenderer(const TileContext& context, More&&... more)
      : trace_(context.trace), source_(context, counts_, std::forward<More>(more)...) {}
  TileRenderer(const TileRenderer&) = delete;
  TileRenderer& operator=(const TileRenderer&) = delete;

  /// Passes the pixels of `rect` from `entries`, which are reordered, to `sink`. Throws Error(system_failure) if one
  /// pixel alone has more segments that overlap in depth than the budget holds.
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
