#pragma once

#include <cstdint>
#include <span>

#include "compositor/window_sink.hpp"
#include "frame/tile_renderer.hpp"
#include "projection/lattice_rasterizer.hpp"

namespace tessera::frame {

/// Makes tiles one after the other on the integer lattice: rasterize sixteen cells, deal their segments to the pixels'
/// windows, and where one is full hand over what is final; one renderer a thread. TileRenderer is its counterpart in
/// double precision.
///
/// Windows hold a few dozen segments a pixel. If one is full of segments that overlap in depth, all grow, up to the
/// budget; then a sink that takes segments in any order gets them all, and for one that does not the square is rendered
/// in quarters. Nothing is ever dropped.
class LatticeTileRenderer {
 public:
  /// `context` is the double-precision renderer's: entries, budget and trace are the same.
  LatticeTileRenderer(const TileContext& context, const projection::LatticeView& view)
      : context_(context), view_(view) {}

  /// Gives `sink` the pixels of `rect` from `entries`, whose order is lost. Throws Error(system_failure) if one pixel
  /// alone has more segments that overlap in depth than the budget holds.
  void render(const scene::PixelRect& rect, std::span<projection::TileEntry> entries, compositor::WindowSink& sink);

  [[nodiscard]] const TileCounts& counts() const { return counts_; }

 private:
  void render_square(const scene::PixelRect& rect, const projection::DepthOrder& order, compositor::WindowSink& sink);
  bool try_render(const scene::PixelRect& rect, const projection::DepthOrder& order, compositor::WindowSink& sink);
  [[nodiscard]] std::int64_t step_before(double near_depth) const;

  TileContext context_;
  projection::LatticeView view_;
  projection::DepthOrderScratch depth_order_;
  projection::LatticeScratch scratch_;
  projection::SegmentStream stream_;
  projection::SegmentWindows windows_;
  TileCounts counts_;
};

}  // namespace tessera::frame
