#pragma once

#include <cstdint>
#include <span>
#include <stop_token>

#include "compositor/tile_sink.hpp"
#include "frame/render.hpp"
#include "integrals/segment_batch.hpp"
#include "projection/depth_order.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/ray_segments.hpp"
#include "projection/scanline_rasterizer.hpp"
#include "projection/steps.hpp"
#include "scene/trace.hpp"
#include "sorting/pixel_lists.hpp"

namespace tessera::frame {

/// What a tile renderer needs to know of its frame.
struct TileContext {
  const projection::ProjectedMesh* projected;
  double depth_origin;         ///< of the entries' near_depth
  std::uint64_t budget_bytes;  ///< for this renderer's buffers
  scene::Trace* trace;
  Rasterizer rasterizer = Rasterizer::planes;
  float longest_edge = 1;                              ///< scanline: of the whole data set
  bool opaque = false;                                 ///< a usual ray ends in a fraction of the mesh's depth
  std::span<const projection::Step> steps{};           ///< of the transfer function
  const projection::CellsAtSteps* at_steps = nullptr;  ///< whose segments are cut there; null: none
  std::stop_token stop{};                              ///< renderers throw scene::FrameStopped once it is asked for
};

/// Sums over the tiles that one renderer made.
struct TileCounts {
  std::uint64_t segments = 0, max_segments_alive = 0, peak_bytes = 0, tiles_split = 0;
  projection::RasterCounts raster;
};

/// Makes tiles one after the other: rasterize, sort, and hand the segments to a sink; one renderer a thread.
///
/// A tile's cells come by their nearest depth. When the segment buffer is full, all segments nearer than the next
/// cell's nearest depth are final (scanline, whose key is the back: all whose back is nearer): they are sorted, handed
/// over and forgotten, the rest stays. So the depth complexity
/// costs no memory, only the number of segments that overlap in depth does; where that outgrows the buffer, the buffer
/// grows up to the budget; then a sink that takes segments in any order gets them all, and for one that does not the
/// tile is rendered in quarters, which hold a quarter of the segments each. Nothing is ever dropped.
class TileRenderer {
 public:
  explicit TileRenderer(const TileContext& context) : context_(context) {}

  /// Gives `sink` the pixels of `rect` from `entries`, whose order is lost. Throws Error(system_failure) if one pixel
  /// alone has more segments that overlap in depth than the budget holds.
  void render(const scene::PixelRect& rect, std::span<projection::TileEntry> entries, compositor::TileSink& sink);

  [[nodiscard]] const TileCounts& counts() const { return counts_; }

  /// What the segments given to a sink are ordered by.
  [[nodiscard]] sorting::PixelLists::Key key() const {
    return context_.rasterizer == Rasterizer::scanline ? sorting::PixelLists::Key::back
                                                       : sorting::PixelLists::Key::front;
  }

  /// Bytes that one segment takes in all buffers of a renderer.
  static constexpr std::size_t bytes_a_segment =
      projection::RaySegments::bytes_each + sorting::PixelLists::bytes_each + integrals::SegmentBatch::bytes_each;

 private:
  void render_sorted(const scene::PixelRect& rect, const projection::DepthOrder& order, compositor::TileSink& sink);
  bool try_render(const scene::PixelRect& rect, const projection::DepthOrder& order, compositor::TileSink& sink);
  void flush(std::size_t pixel_count, double final_depth, compositor::TileSink& sink);
  bool reserve(std::size_t segments);
  std::size_t rasterize(std::span<const projection::TileEntry> entries, const scene::PixelRect& rect);
  std::size_t rasterize_at_steps(std::span<const projection::TileEntry> entries, const scene::PixelRect& rect);

  TileContext context_;
  projection::DepthOrderScratch depth_order_;
  projection::RaySegments segments_;
  projection::ScanlineBuffers scanline_;
  projection::SplitRasterizer splitter_;
  sorting::PixelLists lists_;
  TileCounts counts_;
};

}  // namespace tessera::frame
